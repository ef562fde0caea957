#include "sage/analysis/exits.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sage/model/active_dofs.hpp"

namespace sage {

void Exits::enter(const Model& model, const Activity& activity, int stage) {
  places_.clear();
  const int field = find_unknown(model.unknowns, "head");
  if (field < 0) return;
  std::map<int, double> limits;  // by node
  for (int s = 0; s <= stage; ++s) {
    const Stage& one = model.stages[static_cast<std::size_t>(s)];
    for (const FieldFixity& f : one.field_fixities)
      if (f.field == field && f.code != FixityCode::unchanged) limits.erase(f.node);
    for (const Exit& exit : one.exits) limits[exit.node] = model.mesh.x(1, exit.node) + exit.pressure_head;
  }
  if (limits.empty()) return;
  const std::vector<char> active = active_dofs(model, activity);
  for (const auto& [node, limit] : limits)
    if (const int dof = activity.dof_map.of(node, field);
        dof >= 0 && active[static_cast<std::size_t>(dof)] != 0)
      places_.push_back({node, dof, limit});
  size_ = model.mesh.x.row(1).maxCoeff() - model.mesh.x.row(1).minCoeff();
}

void Exits::start(const Eigen::VectorXd& u, std::vector<char>& held) {
  const auto known = [&](const Place& place) { return u[place.dof] != 0.0; };
  const bool begun = std::ranges::any_of(places_, known);
  for (const Place& place : places_)
    held[static_cast<std::size_t>(place.dof)] = !begun || u[place.dof] >= place.limit - tolerance() ? 1 : 0;
}

void Exits::set_rates(const Eigen::VectorXd& u, double part, const std::vector<char>& held,
                      Eigen::VectorXd& rate) const {
  for (const Place& place : places_)
    rate[place.dof] =
        held[static_cast<std::size_t>(place.dof)] != 0 ? (place.limit - u[place.dof]) / part : 0.0;
}

bool Exits::update(const Eigen::VectorXd& u, const Eigen::VectorXd& inflow, std::vector<char>& held) {
  constexpr double kNoFlow = 1e-7;  // of the largest
  double largest = 0.0;
  for (const Place& place : places_)
    if (held[static_cast<std::size_t>(place.dof)] != 0)
      largest = std::max(largest, std::abs(inflow[place.dof]));
  switched_.clear();
  for (const Place& place : places_) {
    char& is_held = held[static_cast<std::size_t>(place.dof)];
    const bool enters = is_held != 0 && inflow[place.dof] > kNoFlow * largest;
    const bool stands_too_high = is_held == 0 && u[place.dof] > place.limit + tolerance();
    if (!enters && !stands_too_high) continue;
    is_held = enters ? 0 : 1;
    switched_.push_back(place.node);
  }
  return !switched_.empty();
}

}  // namespace sage

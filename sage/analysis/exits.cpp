#include "sage/analysis/exits.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sage/model/active_dofs.hpp"

namespace sage {

void Exits::enter(const Model& model, const Activity& activity, int stage) {
  places_.clear();
  size_ = model.mesh.x.row(1).maxCoeff() - model.mesh.x.row(1).minCoeff();
  if (const int head = find_unknown(model.unknowns, "head"); head >= 0)
    enter_field(model, activity, stage, head, false);
  const bool flows = model.stages[stage].pores == PoreWater::flows;
  if (const int pores = model.pore_field(); pores >= 0 && flows)
    enter_field(model, activity, stage, pores, true);
}

void Exits::enter_field(const Model& model, const Activity& activity, int stage, int field, bool of_pores) {
  std::map<int, double> limits;  // by node
  for (int s = 0; s <= stage; ++s) {
    const Stage& one = model.stages[s];
    for (const FieldFixity& f : one.field_fixities)
      if (f.field == field && f.code != FixityCode::unchanged) limits.erase(f.node);
    for (const Exit& exit : one.exits)
      if (exit.field == (of_pores ? field : -1))
        limits[exit.node] = exit.pressure_head + (of_pores ? 0.0 : model.mesh.x(1, exit.node));
  }
  if (limits.empty()) return;
  const std::vector<char> active = active_dofs(model, activity);
  for (const auto& [node, limit] : limits)
    if (const int dof = activity.dof_map.of(node, field); dof >= 0 && active[dof] != 0)
      places_.push_back({node, dof, limit, of_pores});
}

// Heads are compared in parts of the model's height, pressures in parts of the largest at an exit.
double Exits::tolerance(const Place& place, const Eigen::VectorXd& u) const {
  if (!place.of_pores) return 1e-7 * size_;
  double largest = 0.0;
  for (const Place& one : places_)
    if (one.of_pores) largest = std::max({largest, std::abs(u[one.dof]), std::abs(one.limit)});
  return 1e-9 * largest;
}

void Exits::start(const Eigen::VectorXd& u, std::vector<char>& held) {
  const auto known = [&](const Place& place) { return place.of_pores || u[place.dof] != 0.0; };
  const bool begun = std::ranges::any_of(places_, known);
  for (const Place& place : places_)
    held[place.dof] = !begun || u[place.dof] >= place.limit - tolerance(place, u) ? 1 : 0;
}

void Exits::set_rates(const Eigen::VectorXd& u, double part, const std::vector<char>& held,
                      Eigen::VectorXd& rate) const {
  for (const Place& place : places_)
    rate[place.dof] = held[place.dof] != 0 ? (place.limit - u[place.dof]) / part : 0.0;
}

// Of excess pressures `inflow` is what leaves.
bool Exits::update(const Eigen::VectorXd& u, const Eigen::VectorXd& inflow, std::vector<char>& held) {
  constexpr double kNoFlow = 1e-7;  // of the largest
  const auto comes_in = [&](const Place& place) {
    return place.of_pores ? -inflow[place.dof] : inflow[place.dof];
  };
  double largest = 0.0;
  for (const Place& place : places_)
    if (held[place.dof] != 0) largest = std::max(largest, std::abs(inflow[place.dof]));
  switched_.clear();
  for (const Place& place : places_) {
    char& is_held = held[place.dof];
    const bool enters = is_held != 0 && comes_in(place) > kNoFlow * largest;
    const bool stands_too_high = is_held == 0 && u[place.dof] > place.limit + tolerance(place, u);
    if (!enters && !stands_too_high) continue;
    is_held = enters ? 0 : 1;
    switched_.push_back(place.node);
  }
  return !switched_.empty();
}

std::vector<int> Exits::open_pores(const std::vector<char>& held) const {
  std::vector<int> dofs;
  for (const Place& place : places_)
    if (place.of_pores && held[place.dof] != 0) dofs.push_back(place.dof);
  return dofs;
}

std::vector<int> Exits::nodes() const {
  std::vector<int> nodes;
  for (const Place& place : places_) nodes.push_back(place.node);
  return nodes;
}

}  // namespace sage

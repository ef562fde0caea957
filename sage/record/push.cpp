#include "sage/record/push.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "sage/analysis/external_loads.hpp"
#include "sage/model/strength.hpp"

namespace sage {

namespace {

constexpr std::size_t kFewest = 8;  // increments of a push whose plateau is shown

// What forces at nodes, every dof, do on the motion of the supports, divided by the largest displacement: of a body that is
// moved without turning, their sum along the motion.  Nothing where no support is moved.
std::optional<double> force_along(const Model& model, int stage, const Activity& activity,
                                  const Eigen::VectorXd& forces) {
  const Stage& now = model.stages[stage];
  if (!now.moves_supports()) return {};
  Eigen::VectorXd motion = prescribed_rate(now, activity.dof_map);
  add_turned_rate(now, activity, motion);
  double work = 0.0, largest = 0.0;
  for (int node = 0; node < model.mesh.nodes(); ++node) {
    const Vector2 u = motion.segment<2>(DofMap::displacement(node));
    work += u.dot(forces.segment<2>(DofMap::displacement(node)));
    largest = std::max(largest, u.norm());
  }
  if (largest == 0.0) return {};
  return work / largest;
}

double mean(const std::vector<double>& forces, std::size_t from, std::size_t to) {
  const auto at = [&](std::size_t i) { return forces.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::accumulate(at(from), at(to), 0.0) / static_cast<double>(to - from);
}

}  // namespace

Plateau plateau_of(const std::vector<double>& forces) {
  const std::size_t all = forces.size(), half = all / 2, quarters = all - all / 4;
  Plateau plateau{mean(forces, half, all), 0.0, mean(forces, half, quarters), mean(forces, quarters, all)};
  for (std::size_t i = half; i < all; ++i) plateau.scatter += std::pow(forces[i] - plateau.mean, 2);
  plateau.scatter = std::sqrt(plateau.scatter / static_cast<double>(all - half));
  return plateau;
}

bool Pushes::needs_nodes(const Model& model, int stage, std::span<const char> flags) {
  const Stage& now = model.stages[stage];
  if (model.combines_dofs()) return now.moves_supports();
  return std::ranges::any_of(now.fixities, [&](const Fixity& one) {
    return (one.value[0] != 0.0 || one.value[1] != 0.0) && flags[one.node] != 0;
  });
}

void Pushes::increment(const Model& model, const StepReport& report, const Solution& solution) {
  const std::optional<double> force = force_along(model, report.stage, *solution.activity, *solution.internal);
  if (!force) return;
  if (pushes_.empty() || pushes_.back().stage != report.stage) {
    Vector2 gravity = Vector2::Zero();
    for (int s = 0; s <= report.stage; ++s) gravity += model.stages[s].gravity;
    const Eigen::VectorXd weight = weight_of(model, solution.activity->group, gravity, report.stage);
    pushes_.push_back(
        {report.stage, report.increments, *force_along(model, report.stage, *solution.activity, weight), {}});
  }
  pushes_.back().forces.push_back(*force - pushes_.back().weight);
}

void Pushes::exchange(Archive& archive) {
  std::size_t count = pushes_.size();
  archive(count);
  pushes_.resize(count);
  for (Push& push : pushes_) {
    archive(push.stage);
    archive(push.increments);
    archive(push.weight);
    archive(push.forces);
  }
}

std::string Pushes::text(const Model& model, long yielded) const {
  std::string text;
  if (yielded == 0) return text;
  for (const Push& push : pushes_) {
    const std::vector<double>& forces = push.forces;
    if (forces.size() < kFewest || static_cast<int>(forces.size()) < push.increments) continue;
    const Plateau plateau = plateau_of(forces);
    const auto largest = std::ranges::max_element(forces);
    fmt::format_to(std::back_inserter(text),
                   "  push        stage {}: force along the motion {:.5g} +- {:.2g} {}\n"
                   "              (second half; its third quarter {:.5g}, its last {:.5g})\n"
                   "              largest {:.5g} in increment {}\n",
                   push.stage + 1, plateau.mean, plateau.scatter, model.units.force, plateau.third_quarter,
                   plateau.last_quarter, *largest, largest - forces.begin() + 1);
  }
  if (!text.empty() && has_less_dilation(model))
    text += "              dilation is less than friction: this load depends on the mesh and on the path\n";
  return text;
}

}  // namespace sage

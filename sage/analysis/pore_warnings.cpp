#include "sage/analysis/pore_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/stage_warnings.hpp"

namespace sage {

namespace {

constexpr std::size_t kNamed = 8;

// "element(s) 3, 4, 5 and 12 more"
std::string listed(const char* what, const std::vector<int>& numbers) {
  std::string text = std::string(what) + "(s) ";
  for (std::size_t i = 0; i < std::min(numbers.size(), kNamed); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
  return numbers.size() > kNamed ? text + " and " + std::to_string(numbers.size() - kNamed) + " more" : text;
}

// Constrained modulus, mobility in a direction and storage at the first point of an element, by its laws at rest.
struct PoreStiffness {
  double modulus = 0.0, storage = 0.0;
  Matrix2 mobility = Matrix2::Zero();

  double coefficient_along(const Vector2& n) const {
    const double compressibility = (modulus > 0.0 ? 1.0 / modulus : 0.0) + storage;
    return compressibility > 0.0 ? n.dot(mobility * n) / compressibility : 0.0;
  }
};

PoreStiffness stiffness_of(const GroupData& data, int element, const PointContext& context) {
  PoreStiffness found;
  const SolidLaw& law = *std::get<const SolidLaw*>(data.law);
  const std::size_t point =
      static_cast<std::size_t>(element) * static_cast<std::size_t>(data.group->element->traits().points);
  const PointStates& state = data.state.committed;
  std::vector<double> h0(law.traits().history.size()), h1(h0.size());
  PointIn<4> in{Vector4::Zero(), Vector4::Zero(), Vector4::Zero(), h0, &context};
  if (!state.sigma.empty()) {  // else a linear group whose states no output needs
    in.sigma0 = Vector4::Map(state.sigma.data() + 4 * point);
    in.eps0 = Vector4::Map(state.eps.data() + 4 * point);
    in.h0 = {state.h.data() + point * static_cast<std::size_t>(data.state.history_size()), h1.size()};
  }
  PointOut<4> out;
  out.h1 = h1;
  if (law.update(in, out) == Outcome::ok) found.modulus = std::max(out.D(0, 0), out.D(1, 1));
  PointIn<3> flow{Vector<3>::Zero(), Vector<3>::Zero(), Vector<3>::Zero(), {}, nullptr};
  PointOut<3> of_flow;
  if (std::get<const Law<3>*>(data.second_law)->update(flow, of_flow) == Outcome::ok) {
    found.mobility = of_flow.D.topLeftCorner<2, 2>();
    found.storage = of_flow.D(2, 2);
  }
  return found;
}

// Area of the polygon of the corners.
double area_of(const Eigen::Matrix2Xd& x, int corners) {
  double twice = 0.0;
  for (int i = 0, j = corners - 1; i < corners; j = i++) twice += x(0, j) * x(1, i) - x(0, i) * x(1, j);
  return 0.5 * twice;
}

// Where water can leave is what it was in an earlier stage in which water flows: that has been said.
bool goes_on(const Model& model, const Stage& stage) {
  for (auto s = static_cast<std::size_t>(&stage - model.stages.data()); s > 0; --s) {
    const Stage& one = model.stages[s];
    if (!one.births.empty() || !one.deaths.empty() || !one.field_fixities.empty() || !one.exits.empty())
      return false;
    if (model.stages[s - 1].pores == PoreWater::flows) return true;
  }
  return false;
}

}  // namespace

std::vector<Diagnostic> closed_part_warnings(const Model& model, const Stage& stage, const Activity& activity,
                                             const std::vector<int>& exits) {
  if (stage.pores != PoreWater::flows || goes_on(model, stage)) return {};
  const std::vector<int> part = connected_parts(
      model, [&](std::size_t g, int) { return activity.group[g] != 0 && model.groups[g].entry->has_pores(); });
  const int parts = part.empty() ? 0 : *std::ranges::max_element(part) + 1;
  std::vector<char> open(static_cast<std::size_t>(parts), 0);
  for (const auto& [dof, supported] : activity.pores)
    if (const int p = part[activity.dof_map.at(dof).node]; supported && p >= 0) open[p] = 1;
  for (const int node : exits)
    if (const int p = part[node]; p >= 0) open[p] = 1;
  std::vector<Diagnostic> list;
  for (int p = 0; p < parts; ++p)
    if (!open[p])
      list.push_back(stage_message(stage, "S365",
                                   "no excess pressure is held in the " + part_name(model, part, p) +
                                       ": no water can leave, and pressures even out without going to zero"));
  return list;
}

std::vector<Diagnostic> short_step_warnings(const Model& model, const Stage& stage, const Assembly& assembly,
                                            const Eigen::VectorXd& jump, double dt) {
  const int field = model.pore_field();
  std::vector<int> numbers;
  double least = 0.0;
  Eigen::Matrix2Xd x;
  for (const GroupData& data : assembly.groups()) {
    if (!data.active || !data.group->solid() || !data.group->entry->has_pores()) continue;
    const int corners = data.group->entry->corners;
    for (int e = 0; e < data.group->elements(); ++e) {
      element_coordinates(model.mesh, *data.group, e, x);
      const auto jumps = [&](int corner) {
        const int dof = assembly.dof_map().of(data.group->nodes_of(e)[corner], field);
        return dof >= 0 && jump[dof] != 0.0;
      };
      double longest = 0.0;  // step that the element needs
      for (int i = 0; i < corners; ++i) {
        const int next = (i + 1) % corners;
        if (!jumps(i) || !jumps(next)) continue;
        const Vector2 side = x.col(next) - x.col(i);
        const double length = side.norm(), h = area_of(x, corners) / length * (corners == 3 ? 2.0 : 1.0);
        const PointContext context = context_of(data, e, x, 0, {});
        const double c =
            stiffness_of(data, e, context).coefficient_along(Vector2(-side.y(), side.x()) / length);
        if (c > 0.0) longest = std::max(longest, h * h / (6.0 * stage.theta * c));
      }
      if (!(dt < (1.0 - 1e-9) * longest)) continue;
      numbers.push_back(data.group->element_numbers[e]);
      least = std::max(least, longest);
    }
  }
  if (numbers.empty()) return {};
  return {stage_message(
      stage, "S363",
      "the first step of " + short_number(dt) + " is shorter than h^2/(6 theta c) = " + short_number(least) +
          " in " + listed("element", numbers) +
          " beside drained nodes: excess pressures there oscillate from node to node at first")};
}

std::vector<Diagnostic> oscillation_warnings(const Model& model, const Stage& stage, int increment,
                                             const Assembly& assembly, const Eigen::VectorXd& u) {
  constexpr double kSmall = 0.01;  // of the largest pressure
  const int field = model.pore_field();
  const auto nodes = static_cast<std::size_t>(model.mesh.nodes());
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> least(nodes, kNone), most(nodes, -kNone);  // around each
  const auto dof_of = [&](int node) { return assembly.dof_map().of(node, field); };
  const auto visit = [&](auto&& use) {
    for (const GroupData& data : assembly.groups()) {
      if (!data.active || !data.group->solid() || !data.group->entry->has_pores()) continue;
      const int corners = data.group->entry->corners;
      for (int e = 0; e < data.group->elements(); ++e)
        for (int i = 0; i < corners; ++i)
          for (int j = 0; j < corners; ++j)
            if (i != j) use(data.group->nodes_of(e)[i], data.group->nodes_of(e)[j]);
    }
  };
  double largest = 0.0;
  visit([&](int a, int b) {
    const double p = u[dof_of(b)];
    least[a] = std::min(least[a], p);
    most[a] = std::max(most[a], p);
    largest = std::max(largest, std::abs(p));
  });
  // Nodes across a flow along one direction have the same pressure.
  const double even = 1e-9 * largest;
  const auto is_top = [&](int node) { return u[dof_of(node)] >= most[node] - even; };
  const auto is_bottom = [&](int node) { return u[dof_of(node)] <= least[node] + even; };
  std::vector<int> numbers;
  visit([&](int a, int b) {
    const bool held = assembly.equation_of(dof_of(a)) < 0 || assembly.equation_of(dof_of(b)) < 0;
    if (!held && u[dof_of(a)] - u[dof_of(b)] > kSmall * largest && is_top(a) && is_bottom(b))
      numbers.push_back(model.mesh.number[a]);
  });
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.empty()) return {};
  return {stage_message(stage, "S364",
                        "increment " + std::to_string(increment) +
                            ": excess pressures oscillate from corner to "
                            "corner around " +
                            listed("node", numbers))};
}

}  // namespace sage

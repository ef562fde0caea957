#include "sage/analysis/explain.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "sage/analysis/uniqueness.hpp"

namespace sage {

namespace {

struct Neighbours {
  std::string elements;  // the first few, "12 (quad4 full), 13 (quad4 full)"
  bool only_interfaces = true;
  bool open_point = false;
  bool yielded_point = false;
};

// Elements around a node and what their points do.
Neighbours around(const Assembly& assembly, int node) {
  Neighbours result;
  int shown = 0;
  for (const GroupData& data : assembly.groups()) {
    if (!data.active) continue;
    const Group& group = *data.group;
    const auto points = static_cast<std::size_t>(group.element->traits().points);
    for (int e = 0; e < group.elements(); ++e) {
      const int* nodes = group.nodes_of(e);
      if (std::find(nodes, nodes + group.node_count(), node) == nodes + group.node_count()) continue;
      if (!group.interface()) result.only_interfaces = false;
      for (std::size_t p = 0; p < points; ++p) {
        const PointStatus status = data.state.trial.status[static_cast<std::size_t>(e) * points + p];
        result.open_point = result.open_point || status == PointStatus::open;
        result.yielded_point = result.yielded_point || is_plastic(status);
      }
      if (++shown > 4) continue;
      result.elements +=
          (shown > 1 ? ", " : "") + std::to_string(group.element_numbers[e]) + " (" + group.element_name + ")";
    }
  }
  return result;
}

constexpr double kFlat = 0.1;  // share of the stage's largest stiffness at which a curve counts as flat

enum class StateKind { trial, committed };

// Every point of an interface is open: it carries nothing.
bool all_open(const GroupData& data, const std::vector<PointStatus>& status, int element) {
  const int points = data.group->element->traits().points;
  const auto first = status.begin() + static_cast<std::ptrdiff_t>(element) * points;
  return std::all_of(first, first + points, [](PointStatus s) { return s == PointStatus::open; });
}

// Parts as they are joined without the interfaces that are open at all their points.
std::vector<int> parts_between_open_joints(const Model& model, const Assembly& assembly, StateKind state) {
  return connected_parts(model, [&](std::size_t g, int e) {
    const GroupData& data = assembly.groups()[g];
    return data.active &&
           !all_open(data, state == StateKind::trial ? data.state.trial.status : data.state.committed.status,
                     e);
  });
}

// True where a node's part of the mesh hangs on open interfaces: its supports alone leave it free to move.
bool behind_open_joint(const Model& model, const Activity& activity, const Assembly& assembly, int node) {
  const std::vector<int> part = parts_between_open_joints(model, assembly, StateKind::trial);
  const int own = part[node];
  if (own < 0) return true;
  const std::vector<LoosePart> loose = loose_parts(model, activity, part);
  return std::any_of(loose.begin(), loose.end(), [own](const LoosePart& p) { return p.part == own; });
}

std::string counts_line(const std::array<long, kStatuses>& points) {
  static constexpr const char* kNames[kStatuses] = {"elastic", "unloading",   "yielded",           "slipping",
                                                    "open",    "at the apex", "cut off in tension"};
  std::string text;
  for (std::size_t s = 0; s < points.size(); ++s)
    if (points[s] > 0) text += (text.empty() ? "" : ", ") + std::to_string(points[s]) + " " + kNames[s];
  return text.empty() ? "none" : text;
}

// True where the stage prescribes displacements.
bool moves(const Stage& stage) {
  return stage.moves_supports() ||
         std::ranges::any_of(stage.field_fixities, [](const FieldFixity& f) { return f.value != 0.0; });
}

// Laws of one stiffness: nothing collapses, and what fails is arithmetic or support.
bool is_linear(const Assembly& assembly) {
  return std::ranges::all_of(assembly.groups(), [](const GroupData& data) {
    return !data.active || (!data.group->element->traits().large_strain &&
                            std::visit([](const auto* law) { return has_constant_stiffness(*law); }, data.law));
  });
}

// What else may find an equilibrium.
std::string advice(const Stage& stage, bool linear) {
  if (linear)
    return "the usual skips (without --without factors), another solver, or less stiff stiff parts: in a "
           "linear model "
           "what is left out of balance is rounding";
  const std::string control = moves(stage) ? "" : "displacement control if a limit load is near; ";
  const std::string more = control + "more increments; more iterations";
  switch (stage.method) {
    case Method::newton:
      return control + "more increments; method 3 (Newton with dogleg) with more iterations";
    case Method::dogleg:
      return more;
    case Method::modified_newton:
    case Method::initial_stiffness:
      break;
  }
  return more + "; method 0 (Newton): a matrix kept from before can stall where joints open, close or slip";
}

const char* method_name(Method method) {
  switch (method) {
    case Method::newton:
      return "0 (Newton)";
    case Method::modified_newton:
      return "1 (modified Newton)";
    case Method::initial_stiffness:
      return "2 (initial stiffness)";
    case Method::dogleg:
      return "3 (Newton with dogleg)";
  }
  return "";
}

std::array<long, kStatuses> trial_points(const Assembly& assembly) {
  std::array<long, kStatuses> counts{};
  for (const GroupData& data : assembly.groups())
    if (data.active)
      for (PointStatus status : data.state.trial.status) ++counts[static_cast<std::size_t>(status)];
  return counts;
}

bool loads(const Stage& stage) {
  return !stage.loads.empty() || !stage.field_loads.empty() || !stage.pressures.empty() ||
         !stage.gravity.isZero(0.0);
}

const char* driver_name(const Stage& stage) {
  return loads(stage) && moves(stage) ? "stage's loads and displacements"
         : loads(stage)               ? "stage's load"
         : moves(stage)               ? "stage's displacement"
                                      : "stage";
}

// The last equilibrium and the next attempt, with as many digits as tell them apart.
std::array<std::string, 2> bracket(const StepReport& report) {
  std::string from = short_number(report.load_factor), to = short_number(report.failed_at);
  if (from == to) {  // a bracket narrower than four digits
    char text[2][32];
    std::snprintf(text[0], sizeof text[0], "%.9g", report.load_factor);
    std::snprintf(text[1], sizeof text[1], "%.9g", report.failed_at);
    from = text[0];
    to = text[1];
  }
  return {from, to};
}

// "limit load: between 0.71 and 0.72 of the stage's load", for a structure that has no stiffness left.
std::string bracket_line(const Model& model, const StepReport& report) {
  const Stage& stage = model.stages[report.stage];
  const auto [from, to] = bracket(report);
  return std::string(loads(stage) && !moves(stage) ? "  limit load: " : "  equilibrium ends: ") + "between " +
         from + " and " + to + " of the " + driver_name(stage) +
         " (equilibrium was found at the first, not at the second)\n";
}

// For one that has stiffness left, or of which nothing is known: that the program found no equilibrium does not
// say that there is none.
std::string unknown_end_line(const Model& model, const StepReport& report) {
  const Stage& stage = model.stages[report.stage];
  const auto [from, to] = bracket(report);
  std::string text = "  equilibrium was found up to " + from + " of the " + driver_name(stage) + ", not at " +
                     to + "; this needs not be a limit: ";
  return text + (report.stiffness_share < 0.0
                     ? "the stage has no step whose stiffness would show one\n"
                     : "the stiffness along the motion is still " +
                           short_number(100.0 * report.stiffness_share) + " % of the largest in the stage\n");
}

std::string refused_line(const StepReport& report) {
  if (!(report.refused > 0.0)) return {};
  return "  refused: a step of this increment balances its forces only after a motion of " +
         short_number(report.refused) + " times the model's size, with next to no resistance\n";
}

// Of a field that nothing gives a level: what goes in can't go out.
std::string missing_level(const UnknownField& field) {
  if (field.turns)
    return "nothing holds the beam there against turning: a mechanism of hinges, or a beam without "
           "stiffness in bending.\n  try: a fixity of the " +
           field.name + " at one of its nodes, or a hinge less.";
  return "nothing determines the level of the " + field.name +
         " there: no node of that part has it prescribed.\n" + "  try: a fixity of the " + field.name +
         " at one node or more of the part.";
}

const std::string& load_name(const Model& model, int field) {
  return model.unknowns[field].load;
}

std::string load_unit(const Model& model, int field) {
  return unit_text(model.unknowns[field].load_dimension, model.units);
}

// "tried: method 0 (Newton), 50 iterations, steps down to 6.1e-06 of the stage".
std::string tried_line(const Stage& stage, const StepReport& report) {
  return std::string("  tried: method ") + method_name(stage.method) + ", up to " +
         std::to_string(stage.max_iterations) + " iterations a step, steps down to " +
         short_number(report.failed_at - report.load_factor) + " of the stage\n";
}

// What the states say of a singular matrix whose solver can't name the equation.
std::string likely_anywhere(const Model& model, const Activity& activity, const Assembly& assembly) {
  const std::array<long, kStatuses> points = trial_points(assembly);
  const auto count = [&](PointStatus status) { return points[static_cast<std::size_t>(status)]; };
  std::string text;
  if (count(PointStatus::open) > 0) {
    const std::vector<int> part = parts_between_open_joints(model, assembly, StateKind::trial);
    const std::vector<LoosePart> loose = loose_parts(model, activity, part);
    if (!loose.empty())
      text = "  likely: interfaces are open and nothing holds the " + part_name(model, part, loose[0].part) +
             " against " + loose[0].motion + ".\n";
  }
  if (text.empty() &&
      std::ranges::any_of(kAtStrength, [&](PointStatus s) { return is_plastic(s) && count(s) > 0; }))
    text = "  likely: a collapse mechanism.\n";
  if (text.empty())
    text =
        "  likely: a rigid motion or an hourglass mode (too few fixities, reduced integration on a single "
        "layer), or an interface\n  without stiffness.\n";
  return text + "  points at the last attempt: " + counts_line(points) +
         "\n  try: --solver frontal, which names the node.\n";
}

}  // namespace

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string unknown_name(const Model& model, const DofMap::Unknown& unknown) {
  const std::string node = "node " + std::to_string(model.mesh.number[unknown.node]) + ", ";
  if (unknown.field > 0) return node + model.unknowns[unknown.field].name;
  const bool axisymmetric = model.geometry == Geometry::axisymmetric;
  const char* direction = unknown.component == 0 ? (axisymmetric ? "r" : "x") : (axisymmetric ? "z" : "y");
  return node + "direction " + direction;
}

std::string explain_singular(const Model& model, const Activity& activity, const Assembly& assembly,
                             const StepReport& report, const NewtonStep& step) {
  const Stage& stage = model.stages[report.stage];
  const std::string place = "stage " + std::to_string(report.stage + 1) + ", increment " +
                            std::to_string(report.increment) + ": the stiffness matrix is singular";
  const std::string where_it_ends = is_linear(assembly) ? "" : bracket_line(model, report);
  if (step.singular_equation < 0 || step.singular_equation >= assembly.equations())
    return place + " (" + step.message + "); this solver can't tell where.\n" +
           likely_anywhere(model, activity, assembly) + where_it_ends + refused_line(report);
  const DofMap::Unknown unknown = assembly.dof_map().at(assembly.dof_of(step.singular_equation));
  const Neighbours near = around(assembly, unknown.node);
  std::string text = place + " at " + unknown_name(model, unknown) + " (" + step.message + ").\n";
  text += "  elements there: " + near.elements + "\n  likely: ";
  if (unknown.field > 0)
    text += missing_level(model.unknowns[unknown.field]);
  else if (near.open_point || behind_open_joint(model, activity, assembly, unknown.node))
    text +=
        "an interface there is open and carries nothing: the part behind it is loose.\n"
        "  try: support that part, give the interface a small residual stiffness, or close it first.";
  else if (near.yielded_point)
    text +=
        std::string("a collapse mechanism: the material around it has no stiffness left.\n  try: ") +
        (moves(stage) ? "method 2 (initial stiffness), full instead of reduced integration, a dilation angle "
                        "nearer to friction, or read the load reached so far as the limit."
                      : "displacement control instead of load control, or read the load reached so far as "
                        "the limit.");
  else if (near.only_interfaces)
    text +=
        "a node held by interfaces alone, one of whose stiffnesses is zero (k_j = 0, zero friction, a "
        "Newton-Cotes pair at r = 0).\n"
        "  try: a fixity for that direction, or row-sum integration.";
  else
    text +=
        "a rigid motion or an hourglass mode: too few fixities, reduced integration on a single layer, or a "
        "part joined only by\n"
        "  an interface without stiffness in that direction.\n"
        "  try: add a fixity, or full integration (see `sagefe list elements`).";
  return text + "\n" + where_it_ends + refused_line(report);
}

namespace {

// A node that active interfaces alone have, all of them open.
std::string loose_node(const Model& model, const Activity& activity, const std::vector<int>& part) {
  const std::vector<char> active = active_nodes(model, activity);
  for (int dof = 0; dof < activity.dof_map.displacements(); ++dof) {
    const DofMap::Unknown unknown = activity.dof_map.at(dof);
    const auto node = static_cast<std::size_t>(unknown.node);
    if (!active[node] || part[node] >= 0 || activity.held[dof]) continue;
    return "all interfaces at " + unknown_name(model, unknown) +
           ", are open and no solid is active there: nothing holds it, " + "where it stands is arbitrary";
  }
  return {};
}

}  // namespace

std::string explain_loose_part(const Model& model, const Activity& activity, const Assembly& assembly) {
  const std::vector<int> part = parts_between_open_joints(model, assembly, StateKind::committed);
  const std::vector<LoosePart> loose = loose_parts(model, activity, part);
  if (loose.empty()) return loose_node(model, activity, part);
  return "all interfaces around the " + part_name(model, part, loose[0].part) +
         " are open: nothing holds it against " + loose[0].motion + ", where it stands is arbitrary";
}

namespace {

// Length of the smallest active solid element beside that of the largest.
double smallest_of_largest(const Model& model, const Assembly& assembly) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  Eigen::Matrix2Xd x;
  for (const GroupData& data : assembly.groups()) {
    if (!data.active || !data.group->solid()) continue;
    for (int e = 0; e < data.group->elements(); ++e) {
      element_coordinates(model.mesh, *data.group, e, x);
      const double length = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
      smallest = std::min(smallest, length);
      largest = std::max(largest, length);
    }
  }
  return largest > 0.0 ? smallest / largest : 1.0;
}

// What a mesh adds to a loss of uniqueness: legacy_inputs/hyperbolic/strip_footing has the numbers.
std::string finer_than_helps(const Model& model, const Assembly& assembly) {
  constexpr double kGraded = 1e-3;  // three layers of --grade or more; meshes made by hand stay above
  const double ratio = smallest_of_largest(model, assembly);
  if (!(ratio < kGraded)) return {};
  return "fewer layers of grading (--grade auto:2): the smallest element measures " + short_number(ratio) +
         " of the largest, and at that size such soil fails on its own beside an edge of the load; ";
}

}  // namespace

std::string explain_failure(const Model& model, const Assembly& assembly, const StepReport& report,
                            const NewtonStep& step) {
  std::string text = "stage " + std::to_string(report.stage + 1) + ", increment " +
                     std::to_string(report.increment) + " of " + std::to_string(report.increments) +
                     ": no equilibrium found after " + std::to_string(report.cuts) + " cuts of the step.\n";
  const Stage& stage = model.stages[report.stage];
  const bool linear = is_linear(assembly);
  const bool limit = report.stiffness_share >= 0.0 && report.stiffness_share <= kFlat;
  if (!linear) text += limit ? bracket_line(model, report) : unknown_end_line(model, report);
  text += tried_line(stage, report);
  text += refused_line(report);
  if (step.worst.node >= 0)
    text += "  largest out-of-balance " + load_name(model, step.worst.field) +
            " of the best iteration: " + short_number(step.worst.residual) + " " +
            load_unit(model, step.worst.field) + " at " +
            unknown_name(model, {step.worst.node, step.worst.field, step.worst.component}) +
            ", between elements " + around(assembly, step.worst.node).elements + "\n";
  text += "  points at the last attempt: " + counts_line(trial_points(assembly)) + "\n";
  if (!step.iterations.empty()) {
    text += "  relative out-of-balance force by iteration:";
    const std::size_t first = step.iterations.size() > 6 ? step.iterations.size() - 6 : 0;
    for (std::size_t i = first; i < step.iterations.size(); ++i)
      text += " " + short_number(step.iterations[i].force);
    text += "\n";
  }
  const UniquenessCount unique = count_loss_of_uniqueness(assembly, StepKind::attempted);
  if (unique.lost > 0)
    text += "  loss of uniqueness: the determinant of the acoustic tensor is negative at " +
            std::to_string(unique.lost) + " of " + std::to_string(unique.plastic) +
            " yielding points (flow is not associated): a dilation angle nearer to friction helps\n";
  if (step.outcome == StepOutcome::law_cut) text += "  a law found no answer for the strain it was given.\n";
  return text + "  try: " + (unique.lost > 0 ? finer_than_helps(model, assembly) : "") + advice(stage, linear);
}

std::string lost_free_surface(const Stage& stage, double easing, double from) {
  std::string text = "stage " + std::to_string(stage.number) +
                     ": no free surface was found: no heads with a ramp of the permeability " +
                     short_number(easing) + " times as high as is meant";
  if (from > 0.0) text += ", from those of one " + short_number(from) + " times as high";
  return text +
         ".\n  try: a larger ramp or a larger part that dry soil keeps, smaller elements, more iterations";
}

std::string chattering_exits(const Model& model, const Stage& stage, const std::vector<int>& switched,
                             int rounds) {
  constexpr std::size_t kShown = 10;
  std::string text = "stage " + std::to_string(stage.number) + ": after " + std::to_string(rounds) +
                     " rounds it is not settled where water leaves: the exit is switched to and fro at node";
  if (switched.size() > 1) text += "s";
  for (std::size_t i = 0; i < std::min(kShown, switched.size()); ++i)
    text += (i > 0 ? ", " : " ") + std::to_string(model.mesh.number[switched[i]]);
  if (switched.size() > kShown) text += " and " + std::to_string(switched.size() - kShown) + " more";
  return text + ".\n  try: smaller elements there, or fewer exits, where it is known that they stay dry";
}

}  // namespace sage

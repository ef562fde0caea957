#include "sage/analysis/stage_warnings.hpp"

#include <algorithm>
#include <vector>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/free_surface.hpp"
#include "sage/analysis/stream_function.hpp"
#include "sage/analysis/uniqueness.hpp"
#include "sage/core/contact.hpp"

namespace sage {

namespace {

// The messages of one stage.
class Messages {
 public:
  explicit Messages(const Stage& stage) : stage_(stage) {}
  void add(Code code, const std::string& message, Severity severity = Severity::warning) {
    list_.push_back(stage_message(stage_, code, message, severity));
  }
  std::vector<Diagnostic> list() && { return std::move(list_); }

 private:
  const Stage& stage_;
  std::vector<Diagnostic> list_;
};

// Beyond it the results are those of small strains, which describe something else.
void add_motion(Messages& messages, double motion) {
  if (!(motion > kLargeMotion)) return;
  messages.add("S521", "displacements reach " + short_number(motion) +
                           " times the model's size: results that suppose small strains (to about " +
                           short_number(kLargeMotion) + " times) do not describe this");
}

// Elements by number, the first few of them.
class NamedElements {
 public:
  void add(int number) {
    if (++count_ <= kNamed) named_ += (count_ > 1 ? ", " : "") + std::to_string(number);
  }
  bool empty() const { return count_ == 0; }
  std::string words() const {
    const std::string text = "in element(s) " + named_;
    return count_ > kNamed ? text + " and " + std::to_string(count_ - kNamed) + " more" : text;
  }

 private:
  static constexpr int kNamed = 8;
  int count_ = 0;
  std::string named_;
};

// Points at the apex, cut off in tension, or otherwise without stiffness in the tangent of the last iteration, and the
// elements that have them.
struct WeakPoints {
  long apex = 0, cut_off = 0, others = 0;
  NamedElements elements;

  std::string words() const {
    std::string text;
    const auto add = [&](long count, const char* what) {
      if (count == 0) return;
      text += (text.empty() ? "" : ", ") + std::to_string(count) + (text.empty() ? " point(s) " : " ") + what;
    };
    add(apex, "at the apex");
    add(cut_off, "cut off in tension");
    add(others, "with a tangent that has no stiffness");
    return text + ", " + elements.words();
  }
};

void add_weak_points(WeakPoints& weak, const Assembly& assembly, const GroupData& data) {
  const std::vector<PointStatus>& status = data.state.committed.status;
  const std::vector<std::size_t> without = points_without_stiffness(assembly, data);
  const auto points = static_cast<std::size_t>(data.group->element->traits().points);
  auto next = without.begin();
  std::size_t last = data.group->element_numbers.size();  // element that is counted
  for (std::size_t p = 0; p < status.size(); ++p) {
    const bool singular = next != without.end() && *next == p;
    if (singular) ++next;
    const bool apex = status[p] == PointStatus::apex, cut_off = status[p] == PointStatus::cut_off;
    if (!singular && !apex && !cut_off) continue;
    ++(apex ? weak.apex : cut_off ? weak.cut_off : weak.others);
    if (p / points == last) continue;
    last = p / points;
    weak.elements.add(data.group->element_numbers[last]);
  }
}

// An interface that follows the motion joins pairs of nodes, which slip parts.
void add_slips(Messages& messages, const Assembly& assembly) {
  constexpr double kFar = 0.5;  // of the element's length
  NamedElements far;
  for (const GroupData& data : assembly.groups()) {
    const Group& group = *data.group;
    const ElementTraits& traits = group.element->traits();
    if (!data.active || !group.interface() || is_contact(*group.entry) || !traits.sees_coordinates) continue;
    const auto slips = static_cast<std::size_t>(2 * traits.points);
    for (int e = 0; e < group.elements(); ++e) {
      const int* const nodes = group.nodes_of(e);
      const double length = (assembly.mesh().x.col(nodes[1]) - assembly.mesh().x.col(nodes[0])).norm();
      const double* const w = data.state.committed.eps.data() + static_cast<std::size_t>(e) * slips;
      double slip = 0.0;
      for (int point = 0; point < traits.points; ++point) slip = std::max(slip, std::abs(w[2 * point]));
      if (slip > kFar * length) far.add(group.element_numbers[e]);
    }
  }
  if (!far.empty())
    messages.add("S559", "a slip of more than half an element's length " + far.words() +
                             ": its sides lie opposite to other elements than those that it joins");
}

void add_points(Messages& messages, const Assembly& assembly) {
  WeakPoints weak;
  for (const GroupData& data : assembly.groups())
    if (data.active) add_weak_points(weak, assembly, data);
  if (!weak.elements.empty())
    messages.add("S522",
                 weak.words() +
                     ": the tangent there has little stiffness or none; results there depend on how the "
                     "law treats tension, and on the path of the iteration");
  const UniquenessCount unique = count_loss_of_uniqueness(assembly);
  if (unique.lost == 0) return;
  NamedElements elements;
  for (const int number : unique.elements) elements.add(number);
  const std::string count = std::to_string(unique.lost) + " of " + std::to_string(unique.plastic) +
                            " yielding points " + elements.words();
  if (unique.softening > 0)
    messages.add("S523", "loss of uniqueness at " + count + ", and the strength falls at " +
                             std::to_string(unique.softening) +
                             " of them: the answer depends on mesh and steps");
  else
    messages.add("S523",
                 "loss of uniqueness: the determinant of the acoustic tensor is negative at " + count +
                     " (flow is not associated): the answer can depend on mesh and steps",
                 Severity::note);
}

}  // namespace

Diagnostic stage_message(const Stage& stage, Code code, const std::string& message, Severity severity) {
  return {severity, code, stage.where, "stage " + std::to_string(stage.number) + ": " + message, {}};
}

std::vector<Diagnostic> motion_warnings(const Stage& stage, double motion) {
  Messages messages(stage);
  add_motion(messages, motion);
  return std::move(messages).list();
}

std::vector<Diagnostic> free_surface_warnings(const Model& model, const Stage& stage,
                                              const Assembly& assembly) {
  constexpr double kMuchBetween = 0.25, kMuchDry = 0.02;
  Messages messages(stage);
  if (!assembly.eases()) return {};
  const FreeSurfaceBlur blur = free_surface_blur(model, assembly.groups());
  if (blur.half_dry > kMuchBetween)
    messages.add("S537", "the soil falls dry over " + short_number(100.0 * blur.half_dry) +
                             " % of what is wet: heads and discharge near the free surface are blurred");
  if (blur.dry_flow > kMuchDry)
    messages.add("S538",
                 short_number(100.0 * blur.dry_flow) + " % of the flow goes through soil that should be dry");
  return std::move(messages).list();
}

std::vector<Diagnostic> gradient_warnings(const Model& model, const Stage& stage, const Activity& activity) {
  Messages messages(stage);
  for (std::size_t i = 0; i < model.reports.size(); ++i) {
    const Report& report = model.reports[i];
    if (report.kind != ReportKind::discharge) continue;
    const std::vector<int> corners = unbounded_corners(model, activity, report.nodes);
    if (corners.empty()) continue;
    messages.add("S542", "report " + std::to_string(i + 1) +
                             ": the gradient across the line has no bound at node " +
                             std::to_string(model.mesh.number[corners.front()]) +
                             ", where the edge of the flow makes a corner: it is left blank");
  }
  return std::move(messages).list();
}

std::vector<Diagnostic> stream_warnings(const Model& model, const Stage& stage, const Solution& solution) {
  Messages messages(stage);
  if (const std::string& reason = stream_function(model, solution).reason; !reason.empty())
    messages.add("S540", "no stream function: " + reason);
  return std::move(messages).list();
}

std::vector<Diagnostic> stage_warnings(const Stage& stage, const StageFindings& findings,
                                       const Assembly& assembly) {
  constexpr double kPoorAudit = 1e-6;
  Messages messages(stage);
  add_motion(messages, findings.motion);
  if (findings.out_of_balance > kPoorAudit)
    messages.add("S524", "loads and reactions of the whole model are out of balance by " +
                             short_number(findings.out_of_balance) + " of the largest force");
  if (!findings.digits.words.empty())
    messages.add("S525", findings.digits.words, findings.digits.poor ? Severity::warning : Severity::note);
  if (findings.path_error > kPathTolerance)
    messages.add("S526",
                 "the stiffness of a law changes so much that an increment in 64 parts is still too long; "
                 "with more increments the results would change by more than 1 %");
  if (!findings.loose_part.empty()) messages.add("S527", findings.loose_part);
  if (findings.relaxed > 0)
    messages.add(
        "S550",
        "Newton's method found no equilibrium for some increments: " + std::to_string(findings.relaxed) +
            " step(s) were found by dynamic relaxation. They satisfy the same tolerance, but the answer "
            "depends on the path",
        Severity::note);
  add_points(messages, assembly);
  add_slips(messages, assembly);
  if (findings.last_force > stage.tolerance)
    messages.add(
        "S525",
        "equilibrium to " + short_number(findings.last_force) + " of the forces only, the tolerance is " +
            short_number(stage.tolerance) +
            ": no correction improves it further, what is left is rounding (very stiff beside very soft "
            "parts, or nu close to 1/2)");
  return std::move(messages).list();
}

}  // namespace sage

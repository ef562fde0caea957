#include "sage/analysis/stage_warnings.hpp"

#include <algorithm>
#include <span>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/flow_through.hpp"
#include "sage/analysis/free_surface.hpp"
#include "sage/analysis/stream_function.hpp"
#include "sage/analysis/uniqueness.hpp"

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

// Points at the apex or cut off in tension, and the elements that have them, the first few by number.
struct PointsWithout {
  long apex = 0, cut_off = 0;
  std::string elements;

  std::string words() const {
    std::string text = apex > 0 ? std::to_string(apex) + " point(s) at the apex" : "";
    if (apex > 0 && cut_off > 0) text += " and ";
    if (cut_off > 0) text += std::to_string(cut_off) + (apex > 0 ? "" : " point(s)") + " cut off in tension";
    return text + ", in element(s) " + elements;
  }
};

PointsWithout points_without_stiffness(const Assembly& assembly) {
  constexpr int kNamed = 8;
  PointsWithout found;
  int count = 0;
  for (const GroupData& data : assembly.groups()) {
    if (!data.active) continue;
    const auto points = static_cast<std::size_t>(data.group->element->traits().points);
    for (std::size_t e = 0; e < data.group->element_numbers.size(); ++e) {
      const std::span status(data.state.committed.status.data() + e * points, points);
      const long apex = std::ranges::count(status, PointStatus::apex),
                 cut_off = std::ranges::count(status, PointStatus::cut_off);
      found.apex += apex;
      found.cut_off += cut_off;
      if (apex + cut_off == 0 || ++count > kNamed) continue;
      found.elements += (count > 1 ? ", " : "") + std::to_string(data.group->element_numbers[e]);
    }
  }
  if (count > kNamed) found.elements += " and " + std::to_string(count - kNamed) + " more";
  return found;
}

void add_points(Messages& messages, const Assembly& assembly) {
  const PointsWithout without = points_without_stiffness(assembly);
  if (without.apex + without.cut_off > 0)
    messages.add(
        "S522", without.words() +
                    ": the tangent there has no stiffness; results there depend on how the law treats tension, "
                    "and on the path of the iteration");
  const UniquenessCount unique = count_loss_of_uniqueness(assembly);
  if (unique.lost == 0) return;
  const std::string count =
      std::to_string(unique.lost) + " of " + std::to_string(unique.plastic) + " yielding points";
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
                             std::to_string(model.mesh.number[static_cast<std::size_t>(corners.front())]) +
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
    messages.add(
        "S526",
        "the stiffness of a hyperbolic law changes so much that an increment in 64 parts is still too long; "
        "with more increments the results would change by more than 1 %");
  if (!findings.loose_part.empty()) messages.add("S527", findings.loose_part);
  add_points(messages, assembly);
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

#include "sage/analysis/stage_warnings.hpp"

#include "sage/analysis/explain.hpp"
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

void add_points(Messages& messages, const Assembly& assembly) {
  const auto points = assembly.count_points();
  const long apex = points[static_cast<std::size_t>(PointStatus::apex)];
  if (apex > 0)
    messages.add(
        "S522",
        std::to_string(apex) +
            " point(s) at the apex or cut off in tension: results there depend on how the law treats tension");
  const UniquenessCount unique = count_loss_of_uniqueness(assembly);
  if (unique.lost > 0)
    messages.add("S523",
                 "loss of uniqueness: the determinant of the acoustic tensor is negative at " +
                     std::to_string(unique.lost) + " of " + std::to_string(unique.plastic) +
                     " yielding points (flow is not associated): the answer can depend on mesh and steps");
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

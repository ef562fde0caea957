#include "sage/analysis/load_control.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sage/analysis/explain.hpp"
#include "sage/analysis/step_iteration.hpp"

namespace sage {

namespace {

std::string control_name(const Model& model, const LoadControl& control) {
  const std::string axis = unknown_name(model, {control.node, 0, control.component});
  if (control.other < 0) return "displacement of " + axis;
  return "displacement of " + axis + " less that of node " + std::to_string(model.mesh.number[control.other]);
}

std::array<ControlTerm, 2> terms_of(const LoadControl& control) {
  std::array<ControlTerm, 2> terms;
  terms[0] = {DofMap::displacement(control.node, control.component), 1.0};
  if (control.other >= 0) terms[1] = {DofMap::displacement(control.other, control.component), -1.0};
  return terms;
}

double sum_of(const std::array<ControlTerm, 2>& terms, const Eigen::VectorXd& u) {
  double sum = 0.0;
  for (const ControlTerm& term : terms)
    if (term.dof >= 0) sum += term.factor * u[term.dof];
  return sum;
}

}  // namespace

double controlled_displacement(const RunParts& run) {
  return sum_of(terms_of(run.stage().control), run.state.u);
}

ControlledLoad::ControlledLoad(const RunParts& run, double to, Eigen::VectorXd& target)
    : assembly_(run.assembly()),
      target_(target),
      direction_(run.state.path.force_end - run.state.path.force_start),
      terms_(terms_of(run.stage().control)) {
  const LoadControl& control = run.stage().control;
  const auto is_free = [&](const ControlTerm& term) {
    return term.dof >= 0 && assembly_.equation_of(term.dof) >= 0;
  };
  if (std::ranges::none_of(terms_, is_free))
    throw AnalysisError("S582", "stage " + std::to_string(run.stage().number) +
                                    ": the load is controlled by the " + control_name(run.model, control) +
                                    ", which is prescribed, or belongs to no active element");
  goal_ = to * control.growth - (controlled_displacement(run) - run.state.path.control_start);
}

void ControlledLoad::correct(StepIteration& step) {
  const int n = assembly_.equations();
  load_.resize(n);
  motion_.resize(n);
  for (int eq = 0; eq < n; ++eq) load_[eq] = assembly_.numbering().force(direction_, eq);
  step.tangent.solve(load_, motion_, step.work);
  double missing = goal_ - sum_of(terms_, step.du), flexibility = 0.0;
  for (const ControlTerm& term : terms_) {
    const int eq = term.dof >= 0 ? assembly_.equation_of(term.dof) : -1;
    if (eq < 0) continue;
    const double factor = term.factor * assembly_.numbering().share(term.dof);
    missing -= factor * step.correction[eq];
    flexibility += factor * motion_[eq];
  }
  const double change = missing / flexibility;
  step.correction += change * motion_;
  step.residual += change * load_;
  target_ += change * direction_;
  change_ += change;
}

bool drops_off(const RunParts& run, double share) {
  constexpr double kMost = 0.2;  // of the largest load of the stage
  const StagePath& path = run.state.path;
  return std::abs(share) < std::abs(path.load_share) - kMost * path.largest_share;
}

std::string explain_controlled(const RunParts& run, const StepReport& report, const NewtonStep& step) {
  const LoadControl& control = run.stage().control;
  std::string text =
      "stage " + std::to_string(report.stage + 1) + ", increment " + std::to_string(report.increment) + " of " +
      std::to_string(report.increments) + ": no equilibrium found after " + std::to_string(report.cuts) +
      " cuts of the step.\n  the load is controlled by the " + control_name(run.model, control) +
      ": it has grown by " + short_number(run.state.reached * control.growth) + " of " +
      short_number(control.growth) + ", at load factor " + short_number(report.load_factor) + "\n";
  if (!step.message.empty()) text += "  the stiffness matrix is singular (" + step.message + ")\n";
  return text +
         "  likely: a snap-back: load and displacement would have to decrease together here, while the failure "
         "goes on\n"
         "  try: load_control by a displacement that grows throughout, as the difference of two nodes on both "
         "sides of\n"
         "  the part that fails; or more increments.";
}

void refuse_controlled_trials(const Model& model) {
  for (const Stage& stage : model.stages)
    if (stage.is_controlled())
      throw InputError("S583", stage.where,
                       "strengths cannot be reduced in a stage whose load is controlled by a displacement "
                       "(load_control): its load is unknown; state the load in place of it");
}

}  // namespace sage

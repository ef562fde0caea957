#include "sage/analysis/current_stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

// Work of the stage's loads along the step in hand.
double CurrentStiffness::load_work() const {
  const StagePath& path = run_.state.path;
  const Eigen::VectorXd loads = path.force_end - path.force_start;
  return run_.assembly().eliminated().load_work(loads, run_.state.du);
}

void CurrentStiffness::measure(double size) {
  if (run_.tangent().linear() || run_.stage().is_controlled()) return;
  StagePath& path = run_.state.path;
  const Eigen::VectorXd& rate = run_.system.rate();
  double work = 0.0;
  if (!rate.isZero(0.0)) {
    const Eigen::VectorXd& f = run_.assembly().internal_force();
    for (int dof = 0; dof < run_.assembly().dof_map().dofs(); ++dof)
      if (rate[dof] != 0.0) work += (f[dof] - committed_force_[dof]) * rate[dof];
    path.last_stiffness = work / size;
  } else {
    work = load_work();
    path.last_stiffness = work > 0.0 ? size / work : 0.0;
  }
  path.stiffest = std::max(path.stiffest, path.last_stiffness);
}

double CurrentStiffness::share(double size, const NewtonStep& step) const {
  if (run_.tangent().linear() || run_.stage().is_controlled()) return -1.0;
  const StagePath& path = run_.state.path;
  if (!run_.system.rate().isZero(0.0))
    return path.stiffest > 0.0 && path.last_size > 0.0 ? path.last_stiffness / path.stiffest : -1.0;
  const double work = load_work();
  const double attempt = work > 0.0 && std::isfinite(work) ? size / work : 0.0;
  const double elastic = step.predicted_work > 0.0 ? size * size / step.predicted_work : 0.0;
  const double largest = std::max(path.stiffest, elastic);
  if (!(largest > 0.0)) return -1.0;
  return std::min(attempt, path.last_size > 0.0 ? path.last_stiffness : attempt) / largest;
}

}  // namespace sage

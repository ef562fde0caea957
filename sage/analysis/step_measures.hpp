// How far an iterate of a step is from equilibrium: each field of unknowns against what the step has to balance in it.
#pragma once

#include <array>
#include <span>

#include "sage/analysis/by_field.hpp"
#include "sage/analysis/convergence_criterion.hpp"
#include "sage/analysis/newton.hpp"

namespace sage {

class StepMeasures final : public RoundingBounds {
 public:
  // target: loads at the end of the step, every dof.  du: the step so far, every dof.  All must outlive it.
  StepMeasures(const Assembly& assembly, const Tangent& tangent, const Eigen::VectorXd& target,
               const NewtonSettings& settings, const Eigen::VectorXd& du);

  const ByField& fields() const { return fields_; }

  // Scales that the step begins with: the forces of the elements now (a step may end without any stress), ...
  void take_start();
  // ... the largest displacement that supports prescribe in the step, ...
  void take_prescribed(const Eigen::VectorXd& rate, double rate_part);
  // ... the motion of the first correction and the forces that it balances, one entry per equation.  Returns their work.
  double take_first(const Eigen::VectorXd& motion, const Eigen::VectorXd& force);
  // ... and the work of any correction.
  void take_energy(const Eigen::VectorXd& correction, const Eigen::VectorXd& residual);

  // Measures all fields; returns the largest of their measures.  Vectors have one entry per equation.
  IterationRecord measure(const Eigen::VectorXd& correction, const Eigen::VectorXd& residual,
                          double step_length);
  // As measured last.
  std::span<const FieldMeasure> measured() const {
    return {measured_.data(), static_cast<std::size_t>(fields_.count())};
  }

  // |residual|; of several fields each by what the step had to balance in it.
  double size_of(const Eigen::VectorXd& residual) const;
  // correction . residual; of several fields each by the largest of its corrections so far.
  double work_left(const Eigen::VectorXd& correction, const Eigen::VectorXd& residual) const;
  // The residual is so large that no digit of the step's own forces is left in it, or no number.
  bool is_hopeless(const Eigen::VectorXd& residual) const;
  // The largest entry, against the scale of its field.
  WorstDof worst(const Eigen::VectorXd& residual) const;

  bool known() const override { return tangent_.sizes().norm1() >= 0.0; }
  double of_step(int field) const override;
  double of_all_steps(int field) const override;
  double of_prescribed(int field) const override;
  double of_unknowns(int field) const override;
  double of_all_unknowns(int field) const override;
  double of_moments(int field) const override;

 private:
  double scale(int field) const;
  double load_size(int field) const;
  double own_forces(const Eigen::VectorXd& motion, int field) const;
  double stiffness_norm(int field) const;
  double size_of_unknown(int field) const;
  FieldMeasure measure(int field, const Eigen::VectorXd& correction, const Eigen::VectorXd& residual,
                       double step_length) const;

  const Assembly& assembly_;
  const Tangent& tangent_;
  const Eigen::VectorXd& target_;
  const NewtonSettings& settings_;
  const Eigen::VectorXd& du_;
  const ByField fields_;
  // Of each field of unknowns:
  FieldSums prescribed_{};   // largest unknown that supports are given in this step
  FieldSums load_scale_{};   // |loads| of all free dofs
  FieldSums first_force_{};  // largest of the step's start, its loads, and what its first correction balances
  FieldSums energy_scale_{}, start_scale_{};
  std::array<FieldMeasure, kMostFields> measured_{};
};

}  // namespace sage

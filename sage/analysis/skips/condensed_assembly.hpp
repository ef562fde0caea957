// The skip 'condensation' in a pass over the elements: in a step a constant region may act by its interface dofs alone.
#pragma once

#include "sage/analysis/skips/assembly_by_regions.hpp"
#include "sage/analysis/skips/condensation.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

// What one solution leaves of the forces is rounding, times the stiffness ratio within the region.
inline constexpr double kRegionRounding = rounding::kSolution;

class CondensedAssembly final : public AssemblyByRegions {
 public:
  using AssemblyByRegions::AssemblyByRegions;

  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate) override;
  // Condenses the constant region where that pays in so many increments.
  void enter_stage(const Activity& activity, const Eigen::VectorXd& rate, int increments,
                   const SolverMaker& make) override;
  void set_stage_loads(const Eigen::VectorXd& loads) override;
  // Of changing groups, and the region's dense matrix last.
  ElementEquations element_equations() const override;
  const EliminatedDofs& eliminated() const override;
  // While the region is behind, its forces are those of its border in the step in hand.
  Outcome evaluate(const Eigen::VectorXd& du, Tangent* tangent) override;
  std::unique_ptr<IteratedStep> begin_step(const Eigen::VectorXd& target, double rate_part,
                                           const StageSoFar& so_far) override;
  void commit(const Eigen::VectorXd& du) override;
  void commit_again(const Eigen::VectorXd& du) override;
  bool is_behind() const override { return condensation_ != nullptr && condensation_->predictor().is_behind(); }
  void drop_step() override { region_step_ = RegionStep::open; }
  void catch_up(const Eigen::VectorXd& target, double load_factor, const Eigen::VectorXd& start,
                Eigen::VectorXd& u) override;
  void show_recovered(Eigen::VectorXd& motion, Eigen::VectorXd& forces) override;
  void recover_states_at(const Eigen::VectorXd& motion) override;
  void exchange(Archive& archive, bool before_step) override;

 protected:
  bool in_system(const GroupData& data) const override {
    return data.active && !(condensation_ && data.constant);
  }
  bool has_constant_forces() const override { return region_step_ != RegionStep::waits; }
  void fill(Tangent& tangent) const override;
  void add_constant(const Eigen::VectorXd& du, Eigen::VectorXd& to) override;

 private:
  friend class CondensedStep;

  Outcome evaluate_with_border(const Eigen::VectorXd& du, Tangent* tangent);
  void fill_in(Eigen::VectorXd& du, Eigen::VectorXd& forces);
  void take_constant_force();

  // What the step in hand has for the inner dofs of a condensed region.
  enum class RegionStep { open, filled_in, waits };

  std::unique_ptr<Condensation> condensation_;
  RegionStep region_step_ = RegionStep::open;
  Eigen::VectorXd rate_;            // displacement of every prescribed dof over the stage
  Eigen::VectorXd constant_force_;  // of a condensed region, at its last recovery
  Eigen::VectorXd motion_;          // work space
};

}  // namespace sage

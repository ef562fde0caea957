// When the iterations of a step end: the rules (C1) to (C8) of docs/theory/analysis.md, on numbers alone.
#pragma once

#include <span>
#include <vector>

#include "sage/analysis/records.hpp"

namespace sage {

// What one field of unknowns (displacements, heads, ...) leaves at an iterate.
struct FieldMeasure {
  IterationRecord record;  // relative measures: R, D and E of the theory page
  double scale = 0.0;      // S: forces of the elements and loads
  double first = 0.0;      // B: what the step had to balance at its start; 0 = nothing
  double largest = 0.0;    // max |R_i|
};

// Residuals that the rounding of the unknowns alone makes: no correction gets below them.  In the unit of the residual;
// K of the last assembly, K_fg its block of the equations of field f and the unknowns of field g.
class RoundingBounds {
 public:
  virtual ~RoundingBounds() = default;
  // The solver knows the sizes of K; without them only of_moments() counts.
  virtual bool known() const = 0;
  virtual double of_step(int field) const = 0;        // 8 eps |K_ff| max|du_f|
  virtual double of_all_steps(int field) const = 0;   // 8 eps sum over g of |K_fg| max|du_g|
  virtual double of_prescribed(int field) const = 0;  // 8 eps |K_ff| max|du_f prescribed|
  virtual double of_unknowns(int field) const = 0;    // 8 eps |K_ff| (max|u_f| + max|du_f|)
  virtual double of_all_unknowns(int field) const = 0;
  // Of a field of rotations: 8 eps times the forces of the displacements times the size of the model; else negative.
  virtual double of_moments(int field) const = 0;
};

class ConvergenceCriterion {
 public:
  // tolerance: of force and energy; the displacement has its root.  refine: a first correction alone ends no step.
  // linear: K cannot change.
  ConvergenceCriterion(double tolerance, bool refine, bool linear)
      : tolerance_(tolerance), refine_(refine), linear_(linear) {}

  double tolerance() const { return tolerance_; }

  // fields: the iterate, one entry per field of unknowns.  record: the largest measures of all fields.  history: the
  // iterations of the step, the last one included.
  bool is_met(std::span<const FieldMeasure> fields, const IterationRecord& record,
              const std::vector<IterationRecord>& history, const RoundingBounds& rounding) const;

  // (C8): a field that has nothing to balance except for rounding.
  bool is_even(const FieldMeasure& measure, int field, const RoundingBounds& rounding) const;

 private:
  bool is_met(const FieldMeasure& measure, const IterationRecord& record, int field, int fields,
              const std::vector<IterationRecord>& history, const RoundingBounds& rounding) const;
  bool outgrown(const FieldMeasure& measure, const IterationRecord& record) const;
  bool stopped_falling_linear(const IterationRecord& record, const std::vector<IterationRecord>& history) const;
  bool at_rounding(const FieldMeasure& measure, const IterationRecord& record, int field, int fields,
                   const std::vector<IterationRecord>& history, const RoundingBounds& rounding) const;

  double tolerance_;
  bool refine_, linear_;
};

}  // namespace sage

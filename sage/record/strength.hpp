// A row for every factor by which the strengths were divided: equilibrium or none, and how far the body moved.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sage/analysis/observer.hpp"

namespace sage {

// Without padding: its bytes stand in checkpoints.
struct StrengthRow {
  double factor = 0.0;
  double load_factor = 0.0;  // of the stage, in equilibrium
  double largest = 0.0;      // displacement along an axis in the stage, without its sign
  std::int64_t iterations = 0;
  int node = -1;        // where; -1 = nothing moved
  int equilibrium = 0;  // 1: found for the whole stage
};

// Gathers the rows from the calls of an Observer; stages without a factor give none.
class StrengthRows {
 public:
  void start(const Model& model, int stage, const Solution& solution);
  void increment(const Model& model, const StepReport& report);
  void end(const Model& model, int stage, const Solution& solution);
  void failed(const Model& model, const StepReport& report, const Solution& solution);
  void exchange(Archive& archive);
  const std::vector<StrengthRow>& rows() const { return rows_; }

 private:
  void finish(const Model& model, const Solution& solution);
  std::vector<double> from_;  // displacements at the start of the stage
  StrengthRow now_;
  std::vector<StrengthRow> rows_;
};

// A table, a line a factor that was tried; empty without rows.
std::string strength_table(const Model& model, const std::vector<StrengthRow>& rows);

}  // namespace sage

// The assembled matrix in compressed columns.  The first assembly looks up the place of every
// term; for a second one the places (slots) are kept, and assembly is a plain scatter.  Many
// matrices are assembled only once.
#pragma once

#include <span>
#include <vector>

#include "sage/core/linear_solver.hpp"
#include "sage/core/solver_extensions.hpp"
#include "sage/platform/large_pages.hpp"
#include "solvers/equation_graph.hpp"

namespace sage {

// The pattern is structurally symmetric and always has the diagonal.  A symmetric matrix stores only its upper
// triangle (row <= column).  Rows ascend within a column.
class AssembledMatrix {
 public:
  // Throws std::length_error above 2^31 - 2 stored terms.
  void analyse(const EquationGraph& graph, ElementEquations elements, bool symmetric);
  void clear();
  void add(int element, const double* K);
  // As LinearSolver::add_part.  A part is some columns, if there are slots.
  void add_part(const ElementMatrices& some, int part, int parts);

  int equations() const { return equations_; }
  bool symmetric() const { return symmetric_; }
  std::span<const int> column_start() const { return column_start_; }  // equations + 1
  std::span<const int> row() const { return row_; }
  std::span<const double> value() const { return {value_.data(), row_.size()}; }

  // y = K x.
  void multiply(std::span<const double> x, std::span<double> y) const;
  // y = K^T x.
  void multiply_transposed(std::span<const double> x, std::span<double> y) const;
  // r = b - K x with twice the digits in all products and sums; `low` is work space.  All of size equations.
  void residual(std::span<const double> b, std::span<const double> x, std::span<double> r,
                std::span<double> low) const;
  // Largest column sum of |K|.  Uses work space of this object: one caller at a time.
  double norm1() const;
  // Largest |term| of every row.
  void row_maxima(std::vector<double>& maximum) const;
  std::size_t memory_bytes() const;

 private:
  void make_pattern(const EquationGraph& graph);
  void make_slots();
  void find_pairs();
  void raise_row_maxima(int column, std::vector<double>& maximum) const;
  void fill_slots(std::span<const int> equations, int element, int column, const std::vector<int>& position);
  std::int64_t packed(std::int64_t r, std::int64_t c, std::int64_t dofs) const;
  void add_by_search(int element, const double* K);
  void add_columns(int element, const double* K, int first_column, int end_column);
  int place_of(int row, int column) const;
  int column_of_part(int part, int parts) const;

  int equations_ = 0;
  bool symmetric_ = false;
  bool assembled_ = false;  // something has been added
  ElementEquations elements_;
  std::vector<int> column_start_{0};
  LargeVector<int> row_;
  LargeVector<double> value_;  // one more than stored terms: the last takes what belongs to prescribed dofs
  // Slots of element e: slot_[slot_start_[e]] ..., all terms column by column, or the upper triangle only.
  std::vector<std::int64_t> slot_start_;
  std::vector<int> slot_;
  std::vector<char>
      paired_;  // unsymmetric: rows of the element's equations 2i and 2i + 1 stand in a row everywhere
  std::vector<char> twin_;  // unsymmetric: the column has the same rows as the next one
  // A symmetric element matrix that has one equation twice (tied dofs) adds such a term once more.
  struct Repeated {
    int element, r, c, slot;
  };
  std::vector<Repeated> repeated_;  // ordered by element, c, r
  mutable std::vector<double> column_sum_;
};

}  // namespace sage

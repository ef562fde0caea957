#include "solvers/assembled_matrix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sage/core/four.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}
std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

void raise_to(TwoInARow& maximum, const TwoInARow& x) {
  using Bits = std::int64_t __attribute__((vector_size(sizeof x)));
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  const TwoInARow size =
      reinterpret_cast<TwoInARow>(reinterpret_cast<Bits>(x) & Bits{kAllButSign, kAllButSign});
  maximum = maximum < size ? size : maximum;
}

// (high, low) -= a b: the rounding errors of the product and of the sum, both exact (Dekker 1971), go to `low`.
void subtract_product(double& high, double& low, double a, double b) {
  const double product = a * b, error = std::fma(a, b, -product);
  const double sum = high - product, part = sum - high;
  low += (high - (sum - part)) - (product + part) - error;
  high = sum;
}

}  // namespace

void AssembledMatrix::analyse(const EquationGraph& graph, ElementEquations elements, bool symmetric) {
  symmetric_ = symmetric;
  equations_ = static_cast<int>(graph.group_of.size());
  elements_ = std::move(elements);
  make_pattern(graph);
  assembled_ = false;
  slot_start_.clear();
  slot_.clear();
  paired_.clear();
  twin_.clear();
  value_.assign(row_.size() + 1, 0.0);
  column_sum_.reserve(at(equations_));
}

void AssembledMatrix::make_pattern(const EquationGraph& graph) {
  const int groups = graph.members.count();
  column_start_.assign(at(equations_) + 1, 0);
  std::int64_t total = 0;
  for (int equation = 0; equation < equations_; ++equation) {
    const int group = graph.group_of[at(equation)];
    int rows = 0;
    const auto count = [&](int member_group) {
      for (const int row : graph.members.of(member_group)) rows += !symmetric_ || row <= equation;
    };
    count(group);
    for (const int other : graph.neighbours.of(group)) count(other);
    total += rows;
    if (total >= std::numeric_limits<int>::max()) throw std::length_error("matrix has more than 2^31 terms");
    column_start_[at(equation) + 1] = static_cast<int>(total);
  }
  row_.resize(at(total));
  std::vector<int> rows;
  for (int group = 0; group < groups; ++group) {
    rows.clear();
    const auto append = [&](int g) {
      rows.insert(rows.end(), graph.members.of(g).begin(), graph.members.of(g).end());
    };
    append(group);
    for (const int other : graph.neighbours.of(group)) append(other);
    std::ranges::sort(rows);
    for (const int column : graph.members.of(group))
      std::copy_n(rows.begin(), column_start_[at(column) + 1] - column_start_[at(column)],
                  row_.begin() + column_start_[at(column)]);
  }
}

std::int64_t AssembledMatrix::packed(std::int64_t r, std::int64_t c, std::int64_t dofs) const {
  if (!symmetric_) return c * dofs + r;
  return r <= c ? c * (c + 1) / 2 + r : r * (r + 1) / 2 + c;
}

void AssembledMatrix::fill_slots(std::span<const int> equations, int element, int column,
                                 const std::vector<int>& position) {
  const int dofs = static_cast<int>(equations.size());
  for (int c = 0; c < dofs; ++c) {
    if (equations[at(c)] != column) continue;
    for (int r = 0; r < dofs; ++r) {
      const int row = equations[at(r)];
      if (row < 0 || (symmetric_ && row > column)) continue;
      slot_[at(slot_start_[at(element)] + packed(r, c, dofs))] = position[at(row)];
      if (symmetric_ && row == column && r < c) repeated_.push_back({element, r, c, position[at(row)]});
    }
  }
}

void AssembledMatrix::make_slots() {
  slot_start_.reserve(elements_.offset.size());
  slot_start_.assign(1, 0);
  repeated_.clear();
  for (int element = 0; element < elements_.count(); ++element) {
    const auto dofs = static_cast<std::int64_t>(elements_.of(element).size());
    slot_start_.push_back(slot_start_.back() + (symmetric_ ? dofs * (dofs + 1) / 2 : dofs * dofs));
  }
  slot_.assign(at(slot_start_.back()), static_cast<int>(row_.size()));
  const IndexLists elements_of = elements_of_equations(equations_, elements_);
  std::vector<int> position(at(equations_), 0);
  for (int column = 0; column < equations_; ++column) {
    for (int k = column_start_[at(column)]; k < column_start_[at(column) + 1]; ++k)
      position[at(row_[at(k)])] = k;
    for (const int element : elements_of.of(column))
      fill_slots(elements_.of(element), element, column, position);
  }
  find_pairs();
  std::ranges::sort(repeated_, {}, [](const Repeated& t) { return std::array{t.element, t.c, t.r}; });
}

void AssembledMatrix::find_pairs() {
  if (symmetric_) return;
  paired_.assign(at(elements_.count()), 1);
  for (int element = 0; element < elements_.count(); ++element) {
    const std::size_t begin = at(slot_start_[at(element)]), end = at(slot_start_[at(element) + 1]);
    bool paired = elements_.of(element).size() % 2 == 0;
    for (std::size_t k = begin; paired && k < end; k += 2) paired = slot_[k + 1] == slot_[k] + 1;
    paired_[at(element)] = paired ? 1 : 0;
  }
  twin_.assign(at(equations_), 0);
  for (int column = 0; column + 1 < equations_; ++column) {
    const auto begin = row_.begin() + column_start_[at(column)],
               end = row_.begin() + column_start_[at(column) + 1];
    const auto next_end = row_.begin() + column_start_[at(column) + 2];
    twin_[at(column)] = std::equal(begin, end, end, next_end) ? 1 : 0;
  }
}

void AssembledMatrix::clear() {
  if (assembled_ && slot_start_.empty()) make_slots();
  std::ranges::fill(value_, 0.0);
}

int AssembledMatrix::place_of(int row, int column) const {
  const auto begin = row_.begin() + column_start_[at(column)],
             end = row_.begin() + column_start_[at(column) + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - row_.begin());
}

// The same sums in the same order as with slots.
void AssembledMatrix::add_by_search(int element, const double* K) {
  const std::span<const int> equations = elements_.of(element);
  const int dofs = static_cast<int>(equations.size());
  const auto add_column = [&](int c, auto&& wanted) {
    const int column = equations[at(c)], last = column_start_[at(column) + 1] - 1;
    int place = column_start_[at(column)];
    for (int r = 0; r < (symmetric_ ? c + 1 : dofs); ++r) {
      const int row = equations[at(r)];
      if (row < 0 || !wanted(r)) continue;
      if (symmetric_ && row > column) {
        value_[at(place_of(column, row))] += K[c * dofs + r];
        continue;
      }
      // The equations of a node stand in a row.
      if (place < last && row_[at(place + 1)] == row)
        ++place;
      else if (row_[at(place)] != row)
        place = place_of(row, column);
      value_[at(place)] += K[c * dofs + r];
    }
  };
  for (int c = 0; c < dofs; ++c)
    if (equations[at(c)] >= 0) add_column(c, [](int) { return true; });
  if (!symmetric_) return;
  for (int c = 0; c < dofs; ++c)
    if (equations[at(c)] >= 0)
      add_column(c, [&](int r) { return r < c && equations[at(r)] == equations[at(c)]; });
}

namespace {

// value[slot[k]] += K[k]; paired: two by two.
void add_terms(const int* slot, const double* K, int count, bool paired, double* value) {
  if (!paired) {
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) value[slot[k]] += K[k];
    return;
  }
  const int eights = count / 8 * 8;
  for (int k = 0; k < eights; k += 8)
#pragma GCC unroll 4
    for (int pair = k; pair < k + 8; pair += 2) two_in_a_row(value + slot[pair]) += two_in_a_row(K + pair);
  for (int k = eights; k < count; k += 2) two_in_a_row(value + slot[k]) += two_in_a_row(K + k);
}

}  // namespace

void AssembledMatrix::add(int element, const double* K) {
  assembled_ = true;
  if (slot_start_.empty()) return add_by_search(element, K);
  const int* slot = slot_.data() + slot_start_[at(element)];
  double* value = value_.data();
  const int dofs = static_cast<int>(elements_.of(element).size());
  if (!symmetric_) return add_terms(slot, K, dofs * dofs, paired_[at(element)] != 0, value);
  for (int c = 0; c < dofs; ++c)
    for (int r = 0; r <= c; ++r) value[*slot++] += K[c * dofs + r];
  if (repeated_.empty()) return;
  for (auto it = std::ranges::lower_bound(repeated_, element, {}, &Repeated::element);
       it != repeated_.end() && it->element == element; ++it)
    value[it->slot] += K[it->c * dofs + it->r];
}

// Unsymmetric: of an element's matrix the columns of these equations.  The place for terms of prescribed dofs
// is left alone: it would be written by several at once.
void AssembledMatrix::add_columns(int element, const double* K, int first_column, int end_column) {
  const std::span<const int> equations = elements_.of(element);
  const int dofs = static_cast<int>(equations.size()), nowhere = static_cast<int>(row_.size());
  const int* slot = slot_.data() + slot_start_[at(element)];
  const bool paired = paired_[at(element)] != 0;
  for (int c = 0; c < dofs; ++c, slot += dofs, K += dofs) {
    if (equations[at(c)] < first_column || equations[at(c)] >= end_column) continue;
    if (paired) {
      add_terms(slot, K, dofs, true, value_.data());
      continue;
    }
    for (int r = 0; r < dofs; ++r)
      if (slot[r] != nowhere) value_[at(slot[r])] += K[r];
  }
}

// The first column of a part: parts have about the same number of terms.
int AssembledMatrix::column_of_part(int part, int parts) const {
  const std::int64_t before = static_cast<std::int64_t>(row_.size()) * part / parts;
  return static_cast<int>(std::ranges::lower_bound(column_start_, before) - column_start_.begin());
}

void AssembledMatrix::add_part(const ElementMatrices& some, int part, int parts) {
  const auto each = [&](const auto& use) {
    for (int e = 0; e < some.count; ++e) use(some.first + e, some.K + at(e) * some.size);
  };
  if (parts == 1 || symmetric_ || slot_start_.empty()) {
    if (part == 0) each([&](int element, const double* K) { add(element, K); });
    return;
  }
  const int first = column_of_part(part, parts), end = column_of_part(part + 1, parts);
  each([&](int element, const double* K) { add_columns(element, K, first, end); });
}

// Rows of a column ascend: the diagonal is the last one of a symmetric matrix.  Columns before the first entry of
// x that is not zero do nothing.
void AssembledMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  std::ranges::fill(y, 0.0);
  const auto first = std::ranges::find_if(x, [](double entry) { return entry != 0.0; }) - x.begin();
  const double* const in = x.data();
  double* const out = y.data();
  const int begin = column_start_[at(first)];
  const int* row = row_.data() + begin;
  const double* value = value_.data() + begin;
  for (int column = static_cast<int>(first); column < equations_; ++column) {
    const double of_column = in[column];
    const int* const end = row_.data() + column_start_[at(column) + 1];
    if (!symmetric_) {
      for (; row != end; ++row, ++value) out[*row] += *value * of_column;
      continue;
    }
    double mirrored = 0.0;
    for (; row != end - 1; ++row, ++value) {
      out[*row] += *value * of_column;
      mirrored += *value * in[*row];
    }
    out[column] += *value * of_column;
    out[column] += mirrored;
    ++row, ++value;
  }
}

void AssembledMatrix::multiply_transposed(std::span<const double> x, std::span<double> y) const {
  if (symmetric_) return multiply(x, y);
  for (int column = 0; column < equations_; ++column) {
    double sum = 0.0;
    for (int k = column_start_[at(column)]; k < column_start_[at(column) + 1]; ++k)
      sum += value_[at(k)] * x[at(row_[at(k)])];
    y[at(column)] = sum;
  }
}

void AssembledMatrix::residual(std::span<const double> b, std::span<const double> x, std::span<double> r,
                               std::span<double> low) const {
  std::ranges::copy(b, r.begin());
  std::ranges::fill(low, 0.0);
  for (int column = 0; column < equations_; ++column)
    for (int k = column_start_[at(column)]; k < column_start_[at(column) + 1]; ++k) {
      const int row = row_[at(k)];
      subtract_product(r[at(row)], low[at(row)], value_[at(k)], x[at(column)]);
      if (symmetric_ && row != column)
        subtract_product(r[at(column)], low[at(column)], value_[at(k)], x[at(row)]);
    }
  for (std::size_t i = 0; i < r.size(); ++i) r[i] += low[i];
}

double AssembledMatrix::norm1() const {
  column_sum_.assign(at(equations_), 0.0);
  double* const sum = column_sum_.data();
  const int* row = row_.data();
  const double* value = value_.data();
  for (int column = 0; column < equations_; ++column) {
    const int* const end = row_.data() + column_start_[at(column) + 1] - (symmetric_ ? 1 : 0);
    double own = sum[column];
    for (; row != end; ++row, ++value) {
      const double term = std::abs(*value);
      own += term;
      if (symmetric_) sum[*row] += term;
    }
    if (symmetric_) own += std::abs(*value), ++row, ++value;  // the diagonal
    sum[column] = own;
  }
  return column_sum_.empty() ? 0.0 : *std::ranges::max_element(column_sum_);
}

// The same for two columns of the same rows at once, and where two of those stand in a row, for both of these.
void AssembledMatrix::raise_row_maxima(int column, std::vector<double>& maximum) const {
  const int first = column_start_[at(column)], count = column_start_[at(column) + 1] - first;
  const double *a = value_.data() + first, *b = a + count;
  const int* row = row_.data() + first;
  for (int k = 0; k < count; ++k) {
    if (k + 1 < count && row[k + 1] == row[k] + 1) {
      TwoInARow& of_rows = two_in_a_row(maximum.data() + row[k]);
      raise_to(of_rows, two_in_a_row(a + k));
      raise_to(of_rows, two_in_a_row(b + k++));
      continue;
    }
    double& of_row = maximum[at(row[k])];
    of_row = std::max(std::max(of_row, std::abs(a[k])), std::abs(b[k]));
  }
}

void AssembledMatrix::row_maxima(std::vector<double>& maximum) const {
  maximum.assign(at(equations_), 0.0);
  for (int column = 0; column < equations_; ++column) {
    if (!twin_.empty() && twin_[at(column)]) {
      raise_row_maxima(column++, maximum);
      continue;
    }
    double of_column = 0.0;
    for (int k = column_start_[at(column)]; k < column_start_[at(column) + 1]; ++k) {
      const double term = std::abs(value_[at(k)]);
      double& of_row = maximum[at(row_[at(k)])];
      of_row = std::max(of_row, term);
      of_column = std::max(of_column, term);
    }
    if (symmetric_) maximum[at(column)] = std::max(maximum[at(column)], of_column);
  }
}

std::size_t AssembledMatrix::memory_bytes() const {
  return (column_start_.size() + row_.size() + slot_.size() + elements_.equations.size()) * sizeof(int) +
         value_.size() * sizeof(double) + (slot_start_.size() + elements_.offset.size()) * sizeof(std::int64_t);
}

}  // namespace sage

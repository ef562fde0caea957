#include "solvers/frontal_solver.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "solvers/frontal.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Largest part of the mesh that becomes one dense front.
constexpr int kLeafEquations = 16;

// Neighbouring columns of a child that stay neighbours within one tile of the parent.
struct Run {
  int source_lane, target_lane, count;
};

Run find_run(const int* to, int begin, int end, int source_lane) {
  Run run{source_lane, to[begin] % kTile, 1};
  while (begin + run.count < end && to[begin + run.count] == to[begin] + run.count &&
         run.target_lane + run.count < kTile)
    ++run.count;
  return run;
}

// A length known to the compiler becomes one or two vector operations a row.
template <int count>
void add_rows_of(double* target, const double* source, const int* to, int begin, int end) {
  for (int r = begin; r < end; ++r)
    for (int m = 0; m < count; ++m) target[to[r] * kTile + m] += source[r * kTile + m];
}

void add_rows(double* target, const double* source, const int* to, int begin, int end, const Run& run) {
  source += run.source_lane;
  target += run.target_lane;
  switch (run.count) {
    case 1:
      return add_rows_of<1>(target, source, to, begin, end);
    case 2:
      return add_rows_of<2>(target, source, to, begin, end);
    case 3:
      return add_rows_of<3>(target, source, to, begin, end);
    case 4:
      return add_rows_of<4>(target, source, to, begin, end);
    case 5:
      return add_rows_of<5>(target, source, to, begin, end);
    case 6:
      return add_rows_of<6>(target, source, to, begin, end);
    case 7:
      return add_rows_of<7>(target, source, to, begin, end);
    default:
      return add_rows_of<8>(target, source, to, begin, end);
  }
}

void add_transposed(const Arms& a, const double* source, const int* to, int begin, int end, int column,
                    int columns, int lane) {
  for (int r = begin; r < end; ++r) {
    double* panel = a.l(0, to[r] / kTile) + to[r] % kTile;
    for (int m = 0; m < columns; ++m) panel[to[column + m] * kTile] += source[r * kTile + lane + m];
  }
}

}  // namespace

void Frontal::configure(const SolverSettings& settings) {
  MatrixSolver::configure(settings);
  wanted_kernels_ = &choose_kernels(settings.kernels);
}

void Frontal::factorise_matrix() {
  early_.stop();
  if (given_back_) take_room();
  if (once()) {
    take_sharing(fronts_that_share());
    place_factors();
    report_.memory_bytes = memory_bytes();
  }
  const std::span<const double> maxima = row_maxima();
  for (Lane& lane : lanes_) {
    lane.check = PivotCheck(traits().name, maxima);
    std::ranges::fill(lane.maximum, 0.0);
  }
  given_back_ = once();  // also where a pivot ends it: the lists of some subtrees have gone then
  pool_->run(static_cast<int>(tree_.subtrees.size()), [this](int s, int thread) {
    eliminate_subtree(tree_.subtrees[at(s)], lanes_[at(thread)]);
    if (once()) give_back_entries(s);
  });
  if (once()) give_back_subtrees();
  for (const int f : tree_.top) {
    if (!has_own_factors(f)) continue;
    assemble(f, lanes_[0]);
    if (once()) give_back_borders(f);
    if (f != tree_.kept) eliminate_together(f);
    finish_borders(f, f + 1, true);
  }
  take_report();
  if (once()) give_back_rest();
}

void Frontal::analyse_matrix(const EquationGraph& graph) {
  kernels_ = wanted_kernels_;
  tree_ = make_front_tree(graph, matrix(), kLeafEquations, kernels_->width, border_equations(), threads());
  early_.stop();
  factors_ = AlignedArray(static_cast<std::size_t>(tree_.factor_terms));
  take_sharing(fronts_that_may_share());
  touch_subtrees_early();
  take_sharing({});
  list_entries(matrix(), tree_);
  place_factors();
  widest_ = 0;
  int pivots = 0;
  for (const Front& front : tree_.fronts) {
    pivots += front.pivot_tiles * kTile;
    widest_ = std::max(widest_, front.pivot_tiles + front.border_tiles);
  }
  reciprocal_.assign(at(pivots), 1.0);
  position_values_ = AlignedArray(at(matrix().equations()));
  list_outside();
  sweeps_.clear();
  make_workspace();
  given_back_ = false;
  report_.kernels = kernels_->name;
  report_.solve_operations = (traits().symmetric ? 4.0 : 2.0) * static_cast<double>(tree_.factor_terms);
  report_.memory_bytes = memory_bytes();
}

void Frontal::touch_subtrees_early() {
  if (threads() == 1 || tree_.subtrees.empty()) return;
  std::int64_t terms = 0;
  for (int f = 0; f < tree_.subtrees.back().end; ++f)
    if (has_own_factors(f)) terms += terms_of(f);
  early_.start(factors_.data(), static_cast<std::size_t>(terms) * sizeof(double));
}

void Frontal::take_sharing(std::vector<int> first_of) {
  first_of_ = std::move(first_of);
  if (!first_of_.empty()) return;
  first_of_.resize(tree_.fronts.size());
  std::iota(first_of_.begin(), first_of_.end(), 0);
}

void Frontal::place_factors() {
  std::int64_t next = 0;
  int pivots = 0;
  report_.repeated_equations = 0;
  first_pivot_.resize(tree_.fronts.size());
  for (int f = 0; at(f) < tree_.fronts.size(); ++f) {
    Front& front = tree_.fronts[at(f)];
    const auto first = at(first_of_[at(f)]);
    front.arms = has_own_factors(f) ? next : tree_.fronts[first].arms;
    first_pivot_[at(f)] = has_own_factors(f) ? pivots : first_pivot_[first];
    if (!has_own_factors(f)) {
      report_.repeated_equations += front.pivots;
      continue;
    }
    next += terms_of(f);
    pivots += front.pivot_tiles * kTile;
  }
  report_.factor_operations = operations();
  report_.factor_entries = next;
}

double Frontal::operations() const {
  double count = 0.0;
  for (int f = 0; at(f) < tree_.fronts.size(); ++f)
    if (f != tree_.kept && has_own_factors(f))
      count += elimination_operations(tree_.fronts[at(f)], traits().symmetric);
  return count;
}

std::size_t Frontal::memory_bytes() const {
  std::size_t terms = static_cast<std::size_t>(report_.factor_entries) + shared_.size() + reciprocal_.size() +
                      position_values_.size();
  for (const Lane& lane : lanes_) terms += lane.workspace.size() + lane.scratch.size();
  return terms * sizeof(double) +
         (2 * matrix().row().size() + 2 * tree_.border.size() + 2 * tree_.order.size()) * sizeof(int);
}

void Frontal::make_workspace() {
  shared_ = AlignedArray(static_cast<std::size_t>(tree_.shared_terms));
  const int useful = std::max(1, static_cast<int>(tree_.subtrees.size()));
  const int used = std::min(threads(), useful);
  if (!pool_ || pool_->threads() != used) pool_ = std::make_unique<ThreadPool>(used);
  std::int64_t largest_below = 0, largest_arm = 0;
  for (const Subtree& subtree : tree_.subtrees)
    for (int f = subtree.begin; f < subtree.end; ++f)
      largest_below = std::max(largest_below, tree_.fronts[at(f)].arm_terms());
  for (int f = 0; f < tree_.children.count(); ++f)
    if (f != tree_.kept) largest_arm = std::max(largest_arm, tree_.fronts[at(f)].arm_terms());
  lanes_.clear();
  for (int t = 0; t < used; ++t) {
    Lane lane;
    lane.workspace = AlignedArray(static_cast<std::size_t>(tree_.subtree_terms));
    if (traits().symmetric)
      lane.scratch = AlignedArray(static_cast<std::size_t>(t == 0 ? largest_arm : largest_below));
    lanes_.push_back(std::move(lane));
  }
  while (sweeps_.size() < at(used))
    sweeps_.push_back({AlignedArray(at(widest_) * kTile), AlignedArray(at(widest_) * kTile * kMostSums)});
}

void Frontal::give_back_entries(int subtree) {
  tree_.entries[at(subtree)] = {};
  if (is_large()) return_freed_memory();
}

void Frontal::give_back_subtrees() {
  for (Lane& lane : lanes_) {
    lane.workspace = {};
    if (&lane != lanes_.data()) lane.scratch = {};
  }
  if (is_large()) return_freed_memory();
}

void Frontal::give_back_borders(int f) {
  if (!is_large()) return;
  for (const int child : tree_.children.of(f)) {
    const Front& front = tree_.fronts[at(child)];
    return_pages(shared_.data() + front.border_at,
                 static_cast<std::size_t>(front.border_terms()) * sizeof(double));
  }
}

void Frontal::give_back_rest() {
  shared_ = {};
  lanes_.clear();
  tree_.entries.clear();
}

void Frontal::take_room() {
  list_entries(matrix(), tree_);
  make_workspace();
  given_back_ = false;
}

void Frontal::list_outside() {
  outside_begin_.assign(tree_.fronts.size() + 1, 0);
  for (const Subtree& subtree : tree_.subtrees) {
    const Front& root = tree_.fronts[at(subtree.end - 1)];
    const int end = root.first + root.pivots;
    for (int f = subtree.begin; f < subtree.end; ++f) {
      const std::span<const int> border = border_of(tree_.fronts[at(f)]);
      outside_begin_[at(f) + 1] = static_cast<int>(border.end() - std::ranges::lower_bound(border, end));
    }
  }
  for (std::size_t f = 1; f < outside_begin_.size(); ++f) outside_begin_[f] += outside_begin_[f - 1];
  outside_values_ = AlignedArray(at(outside_begin_.back()));
}

int Frontal::negative_pivots() const {
  int count = 0;
  for (int f = 0; at(f) < tree_.fronts.size(); ++f) {
    if (f == tree_.kept) continue;
    const double* const reciprocal = reciprocal_.data() + first_pivot_[at(f)];
    for (int k = 0; k < tree_.fronts[at(f)].pivots; ++k) count += reciprocal[k] < 0.0;
  }
  return count;
}

void Frontal::take_report() {
  const bool any = matrix().equations() > border_equations();
  double ratio = any ? 1e300 : 1.0, size = 0.0;
  for (const Lane& lane : lanes_) {
    ratio = std::min(ratio, any ? lane.check.smallest_ratio() : 1.0);
    size = std::max(size, *std::ranges::max_element(lane.maximum));
  }
  report_.smallest_pivot_ratio = ratio;
  report_.growth = any ? size / lanes_[0].check.largest_term() : 1.0;
  if (traits().symmetric) report_.negative_pivots = negative_pivots();
}

double* Frontal::border(int f, Lane& lane) {
  if (double* const lent = lent_border(f)) return lent;
  const Front& front = tree_.fronts[at(f)];
  return (front.shared ? shared_ : lane.workspace).data() + front.border_at;
}

const double* Frontal::border_of_child(int child, Lane& lane) {
  const double* const lent = read_border(child);
  return lent != nullptr ? lent : border(child, lane);
}

void Frontal::eliminate_subtree(const Subtree& subtree, Lane& lane) {
  try {
    for (int f = subtree.begin; f < subtree.end; ++f) {
      if (!has_own_factors(f)) continue;
      assemble(f, lane);
      if (f != tree_.kept) eliminate(f, lane);
      finish_borders(f, f + 1, true);
    }
  } catch (...) {
    finish_borders(subtree.begin, subtree.end, false);  // others may wait for one
    throw;
  }
}

void Frontal::assemble(int f, Lane& lane) {
  const Front& front = tree_.fronts[at(f)];
  double* terms = factors_.data() + front.arms;
  std::fill_n(terms, (traits().symmetric ? 1 : 2) * front.arm_terms(), 0.0);
  std::fill_n(border(f, lane), front.border_terms(), 0.0);
  const double* value = matrix().value().data();
  const EntryRange& range = tree_.entries_of[at(f)];
  const Entries& list = tree_.entries[at(range.list)];
  for (auto s = at(range.begin); s < at(range.end); ++s) terms[list.target[s]] = value[list.source[s]];
  const Arms a = arms(f, lane);
  for (const int child : tree_.children.of(f)) {
    const int like = first_of_[at(child)];
    add_border(tree_.fronts[at(child)], border_of_child(like, lane), a, border(f, lane));
    release_border(like);
  }
}

void Frontal::add_border(const Front& child, const double* child_border, const Arms& a, double* border) {
  const Front& front = a.front;
  const int* to = tree_.in_parent.data() + child.border_begin;
  const int pivot_rows = front.pivot_tiles * kTile;
  const auto rows_below = [&](int end) {
    return static_cast<int>(std::lower_bound(to, to + child.border, end) - to);
  };
  const int split = rows_below(pivot_rows);
  for (int c = 0; c < child.border; c += kTile) {
    const double* source = child_border + child.border_panel(c / kTile);
    const int end = std::min(c + kTile, child.border);
    for (int s = c; s < end;) {
      const Run run = find_run(to, s, end, s - c);
      const int J = to[s] / kTile, rows = traits().symmetric ? s + run.count : child.border;
      if (s < split) {  // a pivot column: rows up to its own tile belong to U, the others to L
        const int own = std::min(rows, rows_below((J + 1) * kTile));
        add_rows(a.u(0, J), source, to, 0, own, run);
        if (!traits().symmetric) add_transposed(a, source, to, own, rows, s, run.count, s - c);
      } else {
        const std::ptrdiff_t panel = front.border_panel(J - front.pivot_tiles);
        add_rows(a.u(0, J), source, to, 0, split, run);
        add_rows(border + panel - std::ptrdiff_t{pivot_rows} * kTile, source, to, split, rows, run);
      }
      s += run.count;
    }
  }
}

void Frontal::eliminate(int f, Lane& lane) {
  const Arms a = arms(f, lane);
  eliminate_pivots(a, lane);
  reduce_border_columns(a, 0, a.front.border_tiles, lane);
  update_border(a, border(f, lane), 0, a.front.border_tiles);
}

void Frontal::eliminate_together(int f) {
  constexpr int kReduced = 24, kUpdated = 6;  // columns of tiles taken at a time: multiples of any width
  const Arms a = arms(f, lanes_[0]);
  const int Q = a.front.border_tiles;
  eliminate_pivots(a, lanes_[0]);
  const auto reduce = [&](int part, int thread) {
    reduce_border_columns(a, part * kReduced, std::min(Q, (part + 1) * kReduced), lanes_[at(thread)]);
  };
  pool_->run((Q + kReduced - 1) / kReduced, reduce);
  double* const border_matrix = border(f, lanes_[0]);
  const auto update = [&](int part, int) {
    update_border(a, border_matrix, part * kUpdated, std::min(Q, (part + 1) * kUpdated));
  };
  pool_->run((Q + kUpdated - 1) / kUpdated, update);
}

void Frontal::eliminate_pivots(const Arms& a, Lane& lane) const {
  for (int J = 0; J < a.front.pivot_tiles; ++J) {
    stop_here_if_asked();
    kernels_->reduce_pivot_column(a, J, lane.maximum);
    const int* equation = tree_.order.data() + a.front.first + J * kTile;
    for (int k = 0; k < a.front.live(J); ++k) lane.check.take(equation[k], a.u(J, J)[k * kTile + k]);
  }
}

void Frontal::reduce_border_columns(const Arms& a, int begin, int end, Lane& lane) const {
  stop_here_if_asked();
  kernels_->reduce_border_columns(a, begin, end, lane.maximum);
}

void Frontal::update_border(const Arms& a, double* border_matrix, int begin, int end) const {
  constexpr int kBlock = 16;
  for (int K = 0; K < a.front.pivot_tiles; K += kBlock) {
    stop_here_if_asked();
    const int count = std::min(kBlock * kTile, a.front.pivots - K * kTile);
    kernels_->update_border(a, border_matrix, K, count, begin, end);
  }
}

// Pivots of one front by forward substitution.  Their share of the border goes to where it belongs, but what lies
// outside of the front's subtree, where other threads work, is left in outside_values_.
void Frontal::forward(int f, bool transposed, Sweep& sweep) const {
  const Front& front = tree_.fronts[at(f)];
  double* const w = position_values_.data();
  double* const y = sweep.values.data();
  const double* const reciprocal = reciprocal_.data() + first_pivot_[at(f)];
  const bool lower = !transposed;
  const int P = front.pivot_tiles;
  ask_for_front(f + 1, lower);
  std::copy_n(w + front.first, front.pivots, y);
  std::fill(y + front.pivots, y + (P + front.border_tiles) * kTile, 0.0);
  kernels_->forward_front(front, arm_of(f, lower), lower ? nullptr : reciprocal, y);
  std::copy_n(y, front.pivots, w + front.first);
  const std::span<const int> border = border_of(front);
  const int outside = outside_begin_[at(f) + 1] - outside_begin_[at(f)], inside = front.border - outside;
  for (int k = 0; k < inside; ++k) w[border[at(k)]] += y[P * kTile + k];
  std::copy_n(y + P * kTile + inside, outside, outside_values_.data() + outside_begin_[at(f)]);
  if (traits().symmetric)
    for (int k = 0; k < front.pivots; ++k) w[front.first + k] /= reciprocal[k];
}

void Frontal::take_outside(int f) const {
  const std::span<const int> border = border_of(tree_.fronts[at(f)]);
  const int begin = outside_begin_[at(f)], count = outside_begin_[at(f) + 1] - begin;
  double* const w = position_values_.data();
  for (int k = 0; k < count; ++k)
    w[border[border.size() - at(count) + at(k)]] += outside_values_.data()[begin + k];
}

// Pivots of one front by back substitution; the border is known.
void Frontal::backward(int f, bool transposed, Sweep& sweep) const {
  const Front& front = tree_.fronts[at(f)];
  double* const w = position_values_.data();
  double* const y = sweep.values.data();
  const std::span<const int> border = border_of(front);
  const bool lower = transposed && !traits().symmetric;
  const int P = front.pivot_tiles;
  ask_for_front(f - 1, lower);
  std::fill(y, y + (P + front.border_tiles) * kTile, 0.0);
  std::copy_n(w + front.first, front.pivots, y);
  for (int k = 0; k < front.border; ++k) y[P * kTile + k] = w[border[at(k)]];
  const double* const reciprocal = lower ? nullptr : reciprocal_.data() + first_pivot_[at(f)];
  kernels_->backward_front(front, arm_of(f, lower), reciprocal, y, sweep.sums.data());
  std::copy_n(y, front.pivots, w + front.first);
}

// L then U; transposed: U^T, then L^T.  For symmetric matrices L^T = D^-1 U.  Values stand by position.  Subtrees go
// side by side; then all sums beyond them are taken in the order of the fronts, on any number of threads.
void Frontal::forward_fronts(bool transposed) const {
  pool_->run(static_cast<int>(tree_.subtrees.size()), [&](int s, int thread) {
    const Subtree& subtree = tree_.subtrees[at(s)];
    for (int f = subtree.begin; f < subtree.end; ++f)
      if (f != tree_.kept) forward(f, transposed, sweeps_[at(thread)]);
  });
  auto subtree = tree_.subtrees.begin();
  for (int f = 0; f < static_cast<int>(tree_.fronts.size()); ++f) {
    if (subtree != tree_.subtrees.end() && f == subtree->end) ++subtree;
    if (subtree != tree_.subtrees.end() && f >= subtree->begin)
      take_outside(f);
    else if (f != tree_.kept)
      forward(f, transposed, sweeps_[0]);
  }
}

// A front needs the unknowns of its border and no others: those above all subtrees come first.
void Frontal::backward_fronts(bool transposed) const {
  for (auto f = tree_.top.rbegin(); f != tree_.top.rend(); ++f)
    if (*f != tree_.kept) backward(*f, transposed, sweeps_[0]);
  pool_->run(static_cast<int>(tree_.subtrees.size()), [&](int s, int thread) {
    const Subtree& subtree = tree_.subtrees[at(s)];
    for (int f = subtree.end; f-- > subtree.begin;)
      if (f != tree_.kept) backward(f, transposed, sweeps_[at(thread)]);
  });
}

void Frontal::solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const {
  double* const w = position_values_.data();
  for (std::size_t p = 0; p < tree_.order.size(); ++p) w[p] = b[at(tree_.order[p])];
  forward_fronts(transposed);
  backward_fronts(transposed);
  for (std::size_t p = 0; p < tree_.order.size(); ++p) x[at(tree_.order[p])] = w[p];
}

void Frontal::eliminate(std::span<const double> b, std::span<double> y) const {
  stop_here_if_asked();
  double* const w = position_values_.data();
  for (std::size_t p = 0; p < tree_.order.size(); ++p) w[p] = b[at(tree_.order[p])];
  forward_fronts(traits().symmetric);
  for (std::size_t p = 0; p < tree_.order.size(); ++p) y[at(tree_.order[p])] = w[p];
}

void Frontal::recover(std::span<double> x) const {
  stop_here_if_asked();
  double* const w = position_values_.data();
  for (std::size_t p = 0; p < tree_.order.size(); ++p) w[p] = x[at(tree_.order[p])];
  backward_fronts(traits().symmetric);
  for (std::size_t p = 0; p < tree_.order.size(); ++p) x[at(tree_.order[p])] = w[p];
}

// The front that stays holds what is left of K_nn, by its own order of the border.
void Frontal::border_matrix(double* S) const {
  if (tree_.kept < 0) return;
  const Front& front = tree_.fronts[at(tree_.kept)];
  const double* const terms = factors_.data() + front.arms;
  const int inner = matrix().equations() - border_equations();
  const auto column = [&](int local) { return tree_.order[at(front.first + local)] - inner; };
  for (int j = 0; j < front.pivots; ++j)
    for (int i = 0; i < front.pivots; ++i) {
      const bool mirrored = traits().symmetric && i > j;
      S[std::ptrdiff_t{column(j)} * front.pivots + column(i)] =
          terms[mirrored ? arm_target(front, j, i) : arm_target(front, i, j)];
    }
}

std::unique_ptr<LinearSolver> make_frontal() {
  return std::make_unique<Frontal>(SolverTraits{"frontal", false});
}
std::unique_ptr<LinearSolver> make_frontal_ldlt() {
  return std::make_unique<Frontal>(SolverTraits{"frontal_ldlt", true});
}

}  // namespace sage

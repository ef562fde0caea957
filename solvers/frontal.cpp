#include "solvers/frontal.hpp"

#include <algorithm>

#include "sage/core/thread_pool.hpp"
#include "solvers/aligned_array.hpp"
#include "solvers/choose_kernels.hpp"
#include "solvers/early_pages.hpp"
#include "solvers/front_tree.hpp"
#include "solvers/matrix_solver.hpp"
#include "solvers/twin_fronts.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Largest part of the mesh that becomes one dense front.
constexpr int kLeafEquations = 16;

// What one thread has of its own.
struct Lane {
  AlignedArray workspace, scratch;
  PivotCheck check{"", {}};
  alignas(64) double maximum[kTile] = {};  // largest terms, see TileKernels
};

// What one thread needs for substitutions: values of a front, and sums of its rows.
struct Sweep {
  AlignedArray values, sums;
};

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

// The thread that was to make a border has given up, with an error of its own that comes first.
struct NoBorder {};

// K = L U, or K = U^T D^-1 U with D the diagonal of U where K is symmetric.
class Frontal final : public MatrixSolver, public BorderSolver, public RepeatedParts {
 public:
  explicit Frontal(SolverTraits solver_traits) : MatrixSolver(solver_traits) {}

  void configure(const SolverSettings& settings) override {
    MatrixSolver::configure(settings);
    wanted_kernels_ = &choose_kernels(settings.kernels);
  }
  void use_repeated_parts(bool wanted) override { wanted_twins_ = wanted; }
  int repeated_equations() const override { return repeated_equations_; }

  void factorise_matrix() override {
    early_.stop();
    if (given_back_) take_room();
    if (once()) look_for_twins();
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
      if (!twins_.is_first(f)) continue;
      assemble(f, lanes_[0]);
      if (once()) give_back_borders(f);
      if (f != tree_.kept) eliminate_together(f);
      if (lent_.lends(f)) lent_.publish(f);
    }
    take_report();
    if (once()) give_back_rest();
  }

  void solve_matrix(std::span<const double> b, std::span<double> x) const override {
    solve_fronts(b, x, traits().symmetric);
  }
  void solve_transposed(std::span<const double> b, std::span<double> x) const override {
    solve_fronts(b, x, true);
  }

  bool set_border(int equations) override { return take_border(equations); }
  void border_matrix(double* S) const override;
  void eliminate(std::span<const double> b, std::span<double> y) const override;
  void recover(std::span<double> x) const override;

 protected:
  void analyse_matrix(const EquationGraph& graph) override {
    kernels_ = wanted_kernels_;
    tree_ =
        make_front_tree(graph, matrix(), kLeafEquations, kernels_->width, border_equations(), threads());
    early_.stop();
    factors_ = AlignedArray(static_cast<std::size_t>(tree_.factor_terms));
    twins_.analyse(tree_, once() && wanted_twins_);
    lent_ = {};
    touch_subtrees_early();
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

 private:
  int threads() const { return std::max(1, settings().threads); }
  bool once() const { return settings().one_factorisation; }

  // Their room is needed first.  That of the largest fronts comes when the workspaces of the subtrees have gone: the
  // run is largest then.  No more than what there is if all fronts of one shape turn out to be the same.
  void touch_subtrees_early() {
    if (threads() == 1 || tree_.subtrees.empty()) return;
    std::int64_t terms = 0;
    for (int f = 0; f < tree_.subtrees.back().end; ++f)
      if (!twins_.may_repeat(f)) terms += terms_of(f);
    early_.start(factors_.data(), static_cast<std::size_t>(terms) * sizeof(double));
  }

  std::int64_t terms_of(int f) const { return (traits().symmetric ? 1 : 2) * tree_.fronts[at(f)].arm_terms(); }

  void look_for_twins() {
    twins_.find(tree_, matrix().value());
    lent_.plan(tree_, twins_.first());
    place_factors();
    report_.memory_bytes = memory_bytes();
  }

  // Where the factors of every front stand: one after the other, twins where the first of them does.
  void place_factors() {
    std::int64_t next = 0;
    int pivots = 0;
    repeated_equations_ = 0;
    first_pivot_.resize(tree_.fronts.size());
    for (int f = 0; at(f) < tree_.fronts.size(); ++f) {
      Front& front = tree_.fronts[at(f)];
      const auto first = at(twins_.first(f));
      front.arms = twins_.is_first(f) ? next : tree_.fronts[first].arms;
      first_pivot_[at(f)] = twins_.is_first(f) ? pivots : first_pivot_[first];
      if (!twins_.is_first(f)) {
        repeated_equations_ += front.pivots;
        continue;
      }
      next += terms_of(f);
      pivots += front.pivot_tiles * kTile;
    }
    report_.factor_operations = operations();
    report_.factor_entries = next;
  }

  double operations() const {
    double count = 0.0;
    for (int f = 0; at(f) < tree_.fronts.size(); ++f)
      if (f != tree_.kept && twins_.is_first(f))
        count += elimination_operations(tree_.fronts[at(f)], traits().symmetric);
    return count;
  }

  // Of what is touched: of the factors, those that are kept.
  std::size_t memory_bytes() const {
    std::size_t terms = static_cast<std::size_t>(report_.factor_entries) + shared_.size() + reciprocal_.size() +
                        position_values_.size();
    for (const Lane& lane : lanes_) terms += lane.workspace.size() + lane.scratch.size();
    return terms * sizeof(double) +
           (2 * matrix().row().size() + 2 * tree_.border.size() + 2 * tree_.order.size()) * sizeof(int);
  }

  // The first thread works on the fronts above the subtrees too, and all others in the arms of the first.
  void make_workspace() {
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

  bool is_large() const { return matrix().row().size() > std::size_t{1} << 20; }
  void give_back_entries(int subtree) {
    tree_.entries[at(subtree)] = {};
    if (is_large()) return_freed_memory();
  }
  // What only the subtrees needed goes before the largest fronts come: the run is largest at its last front.
  void give_back_subtrees() {
    for (Lane& lane : lanes_) {
      lane.workspace = {};
      if (&lane != lanes_.data()) lane.scratch = {};
    }
    if (is_large()) return_freed_memory();
  }
  // Of the children of a front that is assembled; later borders that get their places take new pages.
  void give_back_borders(int f) {
    if (!is_large()) return;
    for (const int child : tree_.children.of(f)) {
      const Front& front = tree_.fronts[at(child)];
      return_pages(shared_.data() + front.border_at,
                   static_cast<std::size_t>(front.border_terms()) * sizeof(double));
    }
  }
  void give_back_rest() {
    shared_ = {};
    lanes_.clear();
    tree_.entries.clear();
  }
  void take_room() {
    list_entries(matrix(), tree_);
    make_workspace();
    given_back_ = false;
  }

  // Of every front of a subtree the part of the border that lies outside of it, the last so many.
  void list_outside() {
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
  std::span<const int> border_of(const Front& front) const {
    return {tree_.border.data() + front.border_begin, at(front.border)};
  }

  // Pivots of fronts that were eliminated, and of those that are like one of them.
  int negative_pivots() const {
    int count = 0;
    for (int f = 0; at(f) < tree_.fronts.size(); ++f) {
      if (f == tree_.kept) continue;
      const double* const reciprocal = reciprocal_.data() + first_pivot_[at(f)];
      for (int k = 0; k < tree_.fronts[at(f)].pivots; ++k) count += reciprocal[k] < 0.0;
    }
    return count;
  }

  void take_report() {
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

  Arms arms(int f, Lane& lane) {
    const Front& front = tree_.fronts[at(f)];
    double* upper = factors_.data() + front.arms;
    double* lower = traits().symmetric ? lane.scratch.data() : upper + front.arm_terms();
    return {front, upper, lower, reciprocal_.data() + first_pivot_[at(f)]};
  }
  double* border(int f, Lane& lane) {
    if (lent_.lends(f)) return lent_.room(f);
    const Front& front = tree_.fronts[at(f)];
    return (front.shared ? shared_ : lane.workspace).data() + front.border_at;
  }
  // A border that is complete.  Throws NoBorder.
  const double* border_of_child(int child, Lane& lane) {
    if (!lent_.lends(child)) return border(child, lane);
    const double* const terms = lent_.wait_for(child);
    if (terms == nullptr) throw NoBorder();
    return terms;
  }

  void eliminate_subtree(const Subtree& subtree, Lane& lane) {
    try {
      for (int f = subtree.begin; f < subtree.end; ++f) {
        if (!twins_.is_first(f)) continue;
        assemble(f, lane);
        if (f != tree_.kept) eliminate(f, lane);
        if (lent_.lends(f)) lent_.publish(f);
      }
    } catch (...) {
      lent_.give_up(subtree.begin, subtree.end);  // others may wait for one
      throw;
    }
  }

  // Original terms and the border matrices of the children.  Of a symmetric matrix only the upper triangle is
  // assembled; what lands below the diagonal of a diagonal tile is never read.
  void assemble(int f, Lane& lane) {
    const Front& front = tree_.fronts[at(f)];
    double* terms = factors_.data() + front.arms;
    std::fill_n(terms, (traits().symmetric ? 1 : 2) * front.arm_terms(), 0.0);
    if (lent_.lends(f)) lent_.make(f, static_cast<std::size_t>(front.border_terms()));
    std::fill_n(border(f, lane), front.border_terms(), 0.0);
    const double* value = matrix().value().data();
    const EntryRange& range = tree_.entries_of[at(f)];
    const Entries& list = tree_.entries[at(range.list)];
    for (auto s = at(range.begin); s < at(range.end); ++s) terms[list.target[s]] = value[list.source[s]];
    const Arms a = arms(f, lane);
    for (const int child : tree_.children.of(f)) {
      const int like = twins_.first(child);
      add_border(tree_.fronts[at(child)], border_of_child(like, lane), a, border(f, lane));
      if (lent_.lends(like)) lent_.release(like);
    }
  }

  // Extended addition of a child's border matrix, eight columns at a time.
  void add_border(const Front& child, const double* child_border, const Arms& a, double* border) {
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

  // Elimination of the pivots: as in the skyline solver with full columns, and then the border matrix.
  void eliminate(int f, Lane& lane) {
    const Arms a = arms(f, lane);
    eliminate_pivots(a, lane);
    reduce_border_columns(a, 0, a.front.border_tiles, lane);
    update_border(a, border(f, lane), 0, a.front.border_tiles);
  }

  // The same with the columns of the border divided among all threads.
  void eliminate_together(int f) {
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

  void eliminate_pivots(const Arms& a, Lane& lane) const {
    for (int J = 0; J < a.front.pivot_tiles; ++J) {
      stop_here_if_asked();
      kernels_->reduce_pivot_column(a, J, lane.maximum);
      const int* equation = tree_.order.data() + a.front.first + J * kTile;
      for (int k = 0; k < a.front.live(J); ++k) lane.check.take(equation[k], a.u(J, J)[k * kTile + k]);
    }
  }

  void reduce_border_columns(const Arms& a, int begin, int end, Lane& lane) const {
    stop_here_if_asked();
    kernels_->reduce_border_columns(a, begin, end, lane.maximum);
  }

  // Border columns begin .. end - 1 take the product of all pivots, in blocks of pivots whose arms stay in the
  // nearest cache.
  void update_border(const Arms& a, double* border_matrix, int begin, int end) const {
    constexpr int kBlock = 16;
    for (int K = 0; K < a.front.pivot_tiles; K += kBlock) {
      stop_here_if_asked();
      const int count = std::min(kBlock * kTile, a.front.pivots - K * kTile);
      kernels_->update_border(a, border_matrix, K, count, begin, end);
    }
  }

  void solve_fronts(std::span<const double> b, std::span<double> x, bool transposed) const;
  void forward_fronts(bool transposed) const;
  void backward_fronts(bool transposed) const;
  void forward(int f, bool transposed, Sweep& sweep) const;
  void backward(int f, bool transposed, Sweep& sweep) const;
  void take_outside(int f) const;
  // U, or L transposed, which only unsymmetric matrices have.
  const double* arm_of(int f, bool lower) const {
    const Front& front = tree_.fronts[at(f)];
    return factors_.data() + front.arms + (lower ? front.arm_terms() : 0);
  }
  // Asks the memory for an arm of the front that comes next, while the one before it is in work: fronts are short, and
  // the processor finds where the next one lies only when it is there.  Measured: solutions take 2/3 of the time.
  // Always inlined: the compiler drops calls of a function that only asks.
  [[gnu::always_inline]] void ask_for_front(int f, bool lower) const {
    constexpr std::int64_t kLine = 8, kMost = 16384;  // terms: of a cache line; half of a small second cache
    if (f < 0 || at(f) >= tree_.fronts.size()) return;
    const double* const arm = arm_of(f, lower);
    const std::int64_t terms = std::min(tree_.fronts[at(f)].arm_terms(), kMost);
    for (std::int64_t t = 0; t < terms; t += kLine) __builtin_prefetch(arm + t, 0, 2);
  }

  const TileKernels* wanted_kernels_ = &choose_kernels(Kernels::automatic);
  const TileKernels* kernels_ = wanted_kernels_;  // since analyse(): the tree is laid out for them
  FrontTree tree_;
  AlignedArray factors_, shared_;
  EarlyPages early_;  // of factors_
  std::vector<Lane> lanes_;
  std::unique_ptr<ThreadPool> pool_;
  std::vector<int> first_pivot_;  // of every front, in reciprocal_
  std::vector<double> reciprocal_;
  bool wanted_twins_ = true;
  TwinFronts twins_;
  LentBorders lent_;
  int repeated_equations_ = 0;
  bool given_back_ = false;
  int widest_ = 0;                  // tiles of the widest front
  std::vector<int> outside_begin_;  // of every front, in outside_values_
  // Used by one solution at a time:
  mutable AlignedArray position_values_, outside_values_;
  mutable std::vector<Sweep> sweeps_;
};

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

}  // namespace

std::unique_ptr<LinearSolver> make_frontal() {
  return std::make_unique<Frontal>(SolverTraits{"frontal", false});
}
std::unique_ptr<LinearSolver> make_frontal_ldlt() {
  return std::make_unique<Frontal>(SolverTraits{"frontal_ldlt", true});
}

}  // namespace sage

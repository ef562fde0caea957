// Fronts that repeat.  Where an earlier front has the same terms in the same places, and the same fronts below it, both
// have the same factors and border matrices to the last bit: they are made and kept once.  Meshes of equal elements in
// rows have many such fronts, all others next to none.
#include "solvers/repeated_fronts.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "solvers/frontal_solver.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Of a row of numbers.  Rows of one hash are compared.
class Hash {
 public:
  void add(std::uint64_t number) { value_ = (std::rotl(value_, 23) ^ number) * 0x9e3779b97f4a7c15U; }
  void add(int number) { add(static_cast<std::uint64_t>(number)); }
  std::uint64_t value() const { return value_ ^ (value_ >> 32); }

 private:
  std::uint64_t value_ = 0;
};

// Of each front the first one that is `equal`; children come before their parents.  add_kind takes what is known without
// a look at long lists, and the first fronts of the children: where these differ, as in a mesh without repetition, nothing
// else is read.  add_rest takes the lists.  Two rows of one hash that differ are no more than a repetition that goes
// unnoticed.
template <class AddKind, class AddRest, class Equal>
std::vector<int> first_of_equals(const FrontTree& tree, const AddKind& add_kind, const AddRest& add_rest,
                                 const Equal& equal) {
  std::vector<int> first(tree.fronts.size());
  std::iota(first.begin(), first.end(), 0);
  std::unordered_map<std::uint64_t, int> known;
  known.reserve(first.size());
  // The front that is known by a hash: this one from now on, if there is none.
  const auto known_by = [&](const Hash& hash, int f) {
    return known.try_emplace(hash.value(), f).first->second;
  };
  for (int f = 0; f < static_cast<int>(first.size()); ++f) {
    if (f == tree.kept) continue;
    Hash hash;
    add_kind(f, hash);
    for (const int child : tree.children.of(f)) hash.add(first[at(child)]);
    int like = known_by(hash, f);
    if (like != f && !equal(f, like, first)) {
      add_rest(f, hash);
      like = known_by(hash, f);
      if (like != f && !equal(f, like, first)) like = f;
    }
    first[at(f)] = like;
  }
  return first;
}

std::span<const int> places_in_parent(const FrontTree& tree, int child) {
  const Front& front = tree.fronts[at(child)];
  return {tree.in_parent.data() + front.border_begin, at(front.border)};
}

bool same_children(const FrontTree& tree, int f, int g, const std::vector<int>& first) {
  return std::ranges::equal(
      tree.children.of(f), tree.children.of(g), {}, [&](int c) { return first[at(c)]; },
      [&](int c) { return first[at(c)]; });
}

// Of every front the first one like it by its numbers of equations, and by where the borders below it go.
std::vector<int> fronts_of_one_shape(const FrontTree& tree) {
  const auto add_kind = [&](int f, Hash& hash) {
    hash.add(tree.fronts[at(f)].pivots);
    hash.add(tree.fronts[at(f)].border);
  };
  const auto add_rest = [&](int f, Hash& hash) {
    for (const int child : tree.children.of(f))
      for (const int place : places_in_parent(tree, child)) hash.add(place);
  };
  const auto equal = [&](int f, int g, const std::vector<int>& first) {
    const Front &a = tree.fronts[at(f)], &b = tree.fronts[at(g)];
    if (a.pivots != b.pivots || a.border != b.border || !same_children(tree, f, g, first)) return false;
    return std::ranges::equal(tree.children.of(f), tree.children.of(g), [&](int c, int d) {
      return std::ranges::equal(places_in_parent(tree, c), places_in_parent(tree, d));
    });
  };
  return first_of_equals(tree, add_kind, add_rest, equal);
}

// And by its terms.
std::vector<int> fronts_of_one_value(const FrontTree& tree, std::span<const int> shape,
                                     std::span<const double> values) {
  const auto bits_of = [&](int source) { return std::bit_cast<std::uint64_t>(values[at(source)]); };
  const auto part_of = [&](const LargeVector<int> Entries::*list, int f) {
    const EntryRange& range = tree.entries_of[at(f)];
    return std::span<const int>((tree.entries[at(range.list)].*list).data() + range.begin,
                                at(range.end - range.begin));
  };
  const auto add_kind = [&](int f, Hash& hash) { hash.add(shape[at(f)]); };
  const auto add_rest = [&](int f, Hash& hash) {
    for (const int target : part_of(&Entries::target, f)) hash.add(target);
    for (const int source : part_of(&Entries::source, f)) hash.add(bits_of(source));
  };
  const auto equal = [&](int f, int g, const std::vector<int>& first) {
    return shape[at(f)] == shape[at(g)] && same_children(tree, f, g, first) &&
           std::ranges::equal(part_of(&Entries::target, f), part_of(&Entries::target, g)) &&
           std::ranges::equal(part_of(&Entries::source, f), part_of(&Entries::source, g), {}, bits_of, bits_of);
  };
  return first_of_equals(tree, add_kind, add_rest, equal);
}

bool saves_much(const FrontTree& tree, std::span<const int> first) {
  std::int64_t all = 0, own = 0;
  for (int f = 0; at(f) < first.size(); ++f) {
    all += tree.fronts[at(f)].arm_terms();
    if (first[at(f)] == f) own += tree.fronts[at(f)].arm_terms();
  }
  return own < all - all / 10;
}

// For matrices that are factorised once: where points yield, fronts soon differ.  They are used where they save a tenth
// of the factors at least.
class RepeatedFronts {
 public:
  // Of a new tree, whose values are not known yet.
  void analyse(const FrontTree& tree, bool wanted) {
    shape_.clear();
    if (wanted) shape_ = fronts_of_one_shape(tree);
    if (!saves_much(tree, shape_)) shape_.clear();
  }
  // Of every front the first one of its shape; empty: there is no use in looking for repetitions.
  const std::vector<int>& shapes() const { return shape_; }
  // Of every front the first one with its factors.  Needs the lists of entries.
  std::vector<int> find(const FrontTree& tree, std::span<const double> values) const {
    std::vector<int> first(tree.fronts.size());
    if (!shape_.empty()) first = fronts_of_one_value(tree, shape_, values);
    if (shape_.empty() || !saves_much(tree, first)) std::iota(first.begin(), first.end(), 0);
    return first;
  }

 private:
  std::vector<int> shape_;
};

// Border matrices that more than one front takes.  They outlive the place that a border has in a workspace, and who
// takes one may have to wait for the thread that makes it.
class LentBorders {
 public:
  // first: of every front the first one like it.  None is made yet.
  void plan(const FrontTree& tree, std::span<const int> first);
  bool lends(int front) const { return !slot_.empty() && slot_[front] >= 0; }

  // Room for the border of a front that lends, zeroed by nobody; who has filled it finishes it.
  double* room(int front, std::size_t terms);
  // complete: it may be read.  Otherwise, unless it is complete already, it will not come.
  void finish(int front, bool complete);
  // The border once it is complete; nullptr where its maker has given it up.
  const double* wait_for(int front);
  // The last of those that take it frees it; after an error the rest goes with the next plan().
  void release(int front);

 private:
  enum State { kPending, kComplete, kGivenUp };
  struct Border {
    AlignedArray terms;
    std::atomic<int> state{kPending}, takers{0};
  };
  Border& border_of(int front) { return borders_[slot_[front]]; }

  std::vector<int> slot_;  // of every front, -1 = lends none; empty: nobody does
  std::vector<Border> borders_;
};

void LentBorders::plan(const FrontTree& tree, std::span<const int> first) {
  std::vector<int> takers(first.size(), 0);
  for (int f = 0; f < static_cast<int>(first.size()); ++f)
    if (first[at(f)] == f)
      for (const int child : tree.children.of(f)) ++takers[at(first[at(child)])];
  slot_.assign(first.size(), -1);
  int lenders = 0;
  for (std::size_t f = 0; f < first.size(); ++f)
    if (takers[f] > 1) slot_[f] = lenders++;
  borders_ = std::vector<Border>(at(lenders));
  for (std::size_t f = 0; f < first.size(); ++f)
    if (slot_[f] >= 0) borders_[at(slot_[f])].takers = takers[f];
  if (lenders == 0) slot_.clear();
}

double* LentBorders::room(int front, std::size_t terms) {
  AlignedArray& room = border_of(front).terms;
  if (room.size() == 0) room = AlignedArray(terms);
  return room.data();
}

void LentBorders::finish(int front, bool complete) {
  std::atomic<int>& state = border_of(front).state;
  if (state != kPending) return;
  state = complete ? kComplete : kGivenUp;
  state.notify_all();
}

const double* LentBorders::wait_for(int front) {
  Border& border = border_of(front);
  border.state.wait(kPending);
  return border.state == kComplete ? border.terms.data() : nullptr;
}

void LentBorders::release(int front) {
  Border& border = border_of(front);
  if (--border.takers == 0) border.terms = {};
}

// The thread that was to make a border has given up, with an error of its own that comes first.
struct NoBorder {};

class FrontalWithRepeats final : public Frontal {
 public:
  explicit FrontalWithRepeats(SolverTraits solver_traits) : Frontal(solver_traits) {}

 protected:
  std::vector<int> fronts_that_may_share() override {
    lent_ = {};
    repeated_.analyse(tree(), once());
    return repeated_.shapes();
  }
  std::vector<int> fronts_that_share() override {
    std::vector<int> first = repeated_.find(tree(), matrix().value());
    lent_.plan(tree(), first);
    return first;
  }

  double* lent_border(int front) override {
    return lent_.lends(front)
               ? lent_.room(front, static_cast<std::size_t>(tree().fronts[at(front)].border_terms()))
               : nullptr;
  }
  void finish_borders(int begin, int end, bool complete) override {
    for (int front = begin; front < end; ++front)
      if (lent_.lends(front)) lent_.finish(front, complete);
  }
  const double* read_border(int front) override {
    if (!lent_.lends(front)) return nullptr;
    const double* const terms = lent_.wait_for(front);
    if (terms == nullptr) throw NoBorder();
    return terms;
  }
  void release_border(int front) override {
    if (lent_.lends(front)) lent_.release(front);
  }

 private:
  RepeatedFronts repeated_;
  LentBorders lent_;
};

}  // namespace

SolverFactory frontal_with_repeats(bool symmetric) {
  return [symmetric]() -> std::unique_ptr<LinearSolver> {
    return std::make_unique<FrontalWithRepeats>(symmetric ? SolverTraits{"frontal_ldlt", true}
                                                          : SolverTraits{"frontal", false});
  };
}

}  // namespace sage

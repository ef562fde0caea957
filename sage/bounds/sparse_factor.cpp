#include "sage/bounds/sparse_factor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sage::bounds {

namespace {

constexpr int kLeaf = 6;    // couplings that are not divided any further
constexpr int kPanel = 32;  // columns that are eliminated at once
constexpr double kHuge = 1e100;

// L L^T of a diagonal block in its lower triangle.  Returns how many pivots were negligible.
int factorise_panel(Eigen::Ref<Eigen::MatrixXd> a, const double* diagonal, double negligible) {
  int dropped = 0;
  const Eigen::Index n = a.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    double pivot = a(j, j);
    if (!(pivot > negligible * diagonal[j])) {
      pivot = kHuge;
      ++dropped;
    }
    const double root = std::sqrt(pivot);
    a(j, j) = root;
    const Eigen::Index below = n - j - 1;
    a.col(j).tail(below) /= root;
    for (Eigen::Index k = j + 1; k < n; ++k) a.col(k).tail(n - k) -= a(k, j) * a.col(j).tail(n - k);
  }
  return dropped;
}

}  // namespace

SparseFactor::SparseFactor(int equations, std::span<const Coupling> couplings, std::span<const int> left_out)
    : couplings_(couplings.begin(), couplings.end()),
      place_(static_cast<std::size_t>(equations), -1),
      left_out_(static_cast<std::size_t>(equations), 0) {
  for (const int e : left_out) left_out_[e] = 1;
  std::vector<int> order(couplings.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  if (!order.empty()) divide(order, 0, static_cast<int>(order.size()), couplings);
  number(order, equations);
}

// The front of a set of couplings, behind those of its halves.  Returns its index.
int SparseFactor::divide(std::vector<int>& order, int begin, int end, std::span<const Coupling> couplings) {
  Front front;
  front.begin = begin;
  front.end = end;
  if (end - begin <= kLeaf) {
    front.couplings.assign(order.begin() + begin, order.begin() + end);
  } else {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    for (int i = begin; i < end; ++i) {
      const Eigen::Vector2d& x = couplings[order[i]].place;
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const int axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1, middle = (begin + end) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
      const double xa = couplings[a].place[axis];
      const double xb = couplings[b].place[axis];
      return xa != xb ? xa < xb : a < b;
    });
    const int first = divide(order, begin, middle, couplings);
    const int second = divide(order, middle, end, couplings);
    front.children = {first, second};
  }
  fronts_.push_back(std::move(front));
  return static_cast<int>(fronts_.size()) - 1;
}

// An equation is eliminated in the first front whose set has all couplings with it.
void SparseFactor::number(const std::vector<int>& order, int equations) {
  const int count = static_cast<int>(order.size());
  std::vector<int> first(static_cast<std::size_t>(equations), count), last(first.size(), -1),
      stamp(first.size(), -1);
  for (int i = 0; i < count; ++i)
    for (const int e : couplings_[order[i]].equations) {
      first[e] = std::min(first[e], i);
      last[e] = i;
    }
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    std::vector<int> kept;
    const auto take = [&](int e) {
      const auto place = static_cast<std::size_t>(e);
      if (stamp[place] == static_cast<int>(f)) return;
      stamp[place] = static_cast<int>(f);
      const bool whole = first[place] >= front.begin && last[place] < front.end;
      (whole ? front.equations : kept).push_back(e);
    };
    for (const int i : front.couplings)
      for (const int e : couplings_[i].equations) take(e);
    for (const int child : front.children) {
      const Front& below = fronts_[child];
      for (auto k = static_cast<std::size_t>(below.pivots); k < below.equations.size(); ++k)
        take(below.equations[k]);
    }
    front.pivots = static_cast<int>(front.equations.size());
    front.equations.insert(front.equations.end(), kept.begin(), kept.end());
  }
}

void SparseFactor::clear_front(std::size_t f) {
  Front& front = fronts_[f];
  const auto n = static_cast<Eigen::Index>(front.equations.size());
  for (Eigen::Index k = 0; k < n; ++k)
    place_[front.equations[static_cast<std::size_t>(k)]] = static_cast<int>(k);
  work_.setZero(n, n);
  for (const int child : front.children) {
    Front& below = fronts_[child];
    const auto first = static_cast<std::size_t>(below.pivots);
    for (Eigen::Index j = 0; j < below.border.cols(); ++j) {
      const int pj = place_[below.equations[first + static_cast<std::size_t>(j)]];
      for (Eigen::Index i = j; i < below.border.rows(); ++i) {
        const int pi = place_[below.equations[first + static_cast<std::size_t>(i)]];
        work_(std::max(pi, pj), std::min(pi, pj)) += below.border(i, j);
      }
    }
    below.border.resize(0, 0);
  }
}

void SparseFactor::scatter(int coupling, const Eigen::MatrixXd& part) {
  const std::vector<int>& equations = couplings_[coupling].equations;
  for (std::size_t j = 0; j < equations.size(); ++j) {
    const int pj = place_[equations[j]];
    for (std::size_t i = j; i < equations.size(); ++i) {
      const int pi = place_[equations[i]];
      work_(std::max(pi, pj), std::min(pi, pj)) +=
          part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
}

void SparseFactor::eliminate(std::size_t f, double negligible) {
  Front& front = fronts_[f];
  const Eigen::Index n = work_.rows(), pivots = front.pivots;
  Eigen::VectorXd diagonal = work_.diagonal();
  for (Eigen::Index k = 0; k < pivots; ++k)
    if (left_out_[front.equations[static_cast<std::size_t>(k)]]) diagonal[k] = kHuge;
  for (Eigen::Index j = 0; j < pivots; j += kPanel) {
    const Eigen::Index width = std::min<Eigen::Index>(kPanel, pivots - j), below = n - j - width;
    auto block = work_.block(j, j, width, width);
    dropped_ += factorise_panel(block, diagonal.data() + j, negligible);
    if (below == 0) continue;
    auto under = work_.block(j + width, j, below, width);
    block.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(under);
    work_.bottomRightCorner(below, below).selfadjointView<Eigen::Lower>().rankUpdate(under, -1.0);
  }
  front.factor = work_.leftCols(pivots);
  front.border = work_.bottomRightCorner(n - pivots, n - pivots);
}

void SparseFactor::solve(Eigen::VectorXd& x) const {
  Eigen::VectorXd part;
  const auto gather = [&](const Front& front) {
    part.resize(front.equations.size());
    for (std::size_t k = 0; k < front.equations.size(); ++k)
      part[static_cast<Eigen::Index>(k)] = x[front.equations[k]];
  };
  for (const Front& front : fronts_) {
    gather(front);
    const Eigen::Index pivots = front.pivots, rest = part.size() - pivots;
    const auto top = front.factor.topRows(pivots);
    auto head = part.head(pivots);
    top.triangularView<Eigen::Lower>().solveInPlace(head);
    part.tail(rest) -= front.factor.bottomRows(rest) * head;
    for (std::size_t k = 0; k < front.equations.size(); ++k)
      x[front.equations[k]] = part[static_cast<Eigen::Index>(k)];
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const Front& front = fronts_[f];
    gather(front);
    const Eigen::Index pivots = front.pivots, rest = part.size() - pivots;
    const auto top = front.factor.topRows(pivots);
    auto head = part.head(pivots);
    head -= front.factor.bottomRows(rest).transpose() * part.tail(rest);
    top.triangularView<Eigen::Lower>().transpose().solveInPlace(head);
    for (Eigen::Index k = 0; k < pivots; ++k) x[front.equations[static_cast<std::size_t>(k)]] = part[k];
  }
}

}  // namespace sage::bounds

#include "sage/bounds/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sage/bounds/check.hpp"

namespace sage::bounds {

namespace {

struct Solved {
  BoundProgram program;
  ConeSolution solution;
  Check check;
  bool solved() const { return solution.status == ConeStatus::solved; }
};

BoundProgram program_of(const Domain& domain, const Edges& edges, Quantity quantity, Side side) {
  return side == Side::primal ? lower_program(domain, edges, quantity) : upper_program(domain, edges, quantity);
}

Solved solve_one(const Domain& domain, const Edges& edges, Quantity quantity, Side side,
                 const Options& options) {
  Solved one;
  one.program = program_of(domain, edges, quantity, side);
  ConeOptions cone;
  cone.side = side;
  cone.gap = options.accuracy;
  cone.stop_asked = options.stop_asked;
  one.solution = solve(one.program.program, cone);
  if (one.solved())
    one.check = side == Side::primal ? check_stress(one.program.program, one.solution.sigma, one.solution.tau)
                                     : check_velocity(one.program.program, one.solution.u);
  return one;
}

void count(Bound& bound, const Solved& one) {
  ++bound.solved;
  bound.iterations += one.solution.iterations;
}

std::string reason_of(const Solved& one, Side side, Quantity quantity) {
  switch (one.solution.status) {
    case ConeStatus::solved:
      break;
    case ConeStatus::stopped:
      return "interrupted";
    case ConeStatus::infeasible:
      return quantity == Quantity::load
                 ? "no stress field carries the fixed loads: they alone exceed the strength"
                 : "no stress field carries the loads";
    case ConeStatus::unbounded:
      return "the load can grow without limit: no mechanism in which it does work is possible";
    case ConeStatus::no_progress:
      return "the optimisation ended without a solution: the fixed loads may exceed the strength, or the load "
             "has no limit";
  }
  return side == Side::primal ? "the stress field failed the check of equilibrium or yield"
                              : "the velocity field failed the check of the flow rule";
}

void keep_check(Bound& bound, const Solved& one) {
  bound.residual = one.check.residual;
  bound.reserve = std::max(0.0, one.check.reserve);
}

// ---- bounds on a load

Solved bound_load(const Domain& domain, const Edges& edges, Side side, const Options& options, Bound& bound) {
  Solved one = solve_one(domain, edges, Quantity::load, side, options);
  count(bound, one);
  if (!one.solved() || !one.check.passed()) {
    bound.reason = reason_of(one, side, Quantity::load);
    return one;
  }
  bound.value = one.check.value * one.program.units.tau;
  keep_check(bound, one);
  const double optimum = side == Side::primal ? one.solution.dual : one.solution.tau;
  bound.margin = std::abs(optimum - one.check.value) / std::max(std::abs(one.check.value), 1e-12);
  return one;
}

// ---- bounds on the factor of safety

// Largest F for which a circle of this radius and centre (tension positive) does not yield.
double factor_of(const Strength& strength, double radius, double centre) {
  if (strength.yield == Yield::mohr_coulomb) {
    const double tangent = std::tan(strength.friction), room = strength.cohesion - centre * tangent;
    const double ratio = room / radius, square = ratio * ratio - tangent * tangent;
    return room > 0.0 && square > 0.0 ? std::sqrt(square) : 0.0;
  }
  double low = 0.0, high = 1e3;
  for (int step = 0; step < 60; ++step) {
    const double middle = low > 0.0 ? std::sqrt(low * high) : 1e-3;
    if (low == 0.0) low = 1e-6;
    const Strength s = strength.reduced(middle).in_plane();
    (radius <= s.cohesion * std::cos(s.friction) - centre * std::sin(s.friction) ? low : high) = middle;
  }
  return low;
}

// Largest F for which a stress field stays within c / F and tan(phi) / F.
double factor_of(const Domain& domain, const BoundProgram& program, const Eigen::Matrix3Xd& sigma) {
  double factor = 1e300;
  for (std::size_t t = 0; t < domain.triangles.size(); ++t) {
    const Strength& soil = domain.soils[at(domain.triangles[t].soil)].strength;
    for (std::size_t i = 0; i < 3; ++i) {
      if (program.stress_free[3 * t + i]) continue;
      const Vector3 s = program.units.stress * sigma.col(static_cast<Eigen::Index>(3 * t + i));
      const double radius = std::hypot(0.5 * (s[0] - s[1]), s[2]);
      if (radius > 1e-14 * program.units.stress)
        factor = std::min(factor, factor_of(soil, radius, 0.5 * (s[0] + s[1])));
    }
  }
  auto point = static_cast<Eigen::Index>(3 * domain.triangles.size());
  for (const Joint& joint : domain.joints)
    for (int end = 0; end < 2; ++end, ++point) {
      const Vector3 s = program.units.stress * sigma.col(point);
      const double room = joint.lower_cohesion - s[0] * std::tan(joint.strength.friction);
      if (room < 0.0) return 0.0;
      if (s[1] != 0.0) factor = std::min(factor, room / std::abs(s[1]));
    }
  return factor;
}

// Root of a function that falls with F: t > 0 below it.
class FactorRoot {
 public:
  explicit FactorRoot(const Options& options) : options_(options) {}
  void take(double factor, double t) {
    const bool stable = t >= 0.0;
    (stable ? low_ : high_) = {factor, t};
    (stable ? has_low_ : has_high_) = true;
    if (has_low_ && has_high_ && stable == last_stable_ && tries_ > 0)  // Illinois
      (stable ? high_ : low_).t *= 0.5;
    last_stable_ = stable;
    ++tries_;
  }
  bool found() const {
    return has_low_ && has_high_ && high_.factor - low_.factor <= options_.tolerance * low_.factor;
  }
  bool exhausted() const {
    return tries_ >= 14 || (!has_high_ && low_.factor >= options_.largest) ||
           (!has_low_ && high_.factor <= options_.smallest);
  }
  // slope: of t over 1 / F, where the last trial was.
  double next(double slope) const {
    const double step = 0.3 * options_.tolerance;
    if (has_low_ && has_high_) {
      const double a = 1.0 / low_.factor, b = 1.0 / high_.factor;
      const double root = 1.0 / (a + (b - a) * low_.t / (low_.t - high_.t));
      const double narrow = step * root;
      // Near the root the next trial lies on the other side of it.
      return std::clamp(root + (last_stable_ ? narrow : -narrow), low_.factor + 0.2 * narrow,
                        high_.factor - 0.2 * narrow);
    }
    const Trial& last = has_low_ ? low_ : high_;
    const double inverse = 1.0 / last.factor - last.t / slope;
    const double guess = inverse > 0.0 ? 1.0 / inverse : 2.0 * last.factor;
    // The root of the tangent is wrong by about the square of the way to it.
    const double way = guess / last.factor - 1.0, margin = std::min(step + 2.0 * way * way, 0.01);
    const double beyond = guess * (1.0 + (has_low_ ? margin : -margin));
    return std::clamp(std::clamp(beyond, 0.5 * last.factor, 2.0 * last.factor), options_.smallest,
                      options_.largest);
  }
  double stable() const { return has_low_ ? low_.factor : options_.smallest; }

 private:
  struct Trial {
    double factor = 1.0, t = 0.0;
  };
  const Options& options_;
  Trial low_, high_;
  bool has_low_ = false, has_high_ = false, last_stable_ = false;
  int tries_ = 0;
};

// Change of t with 1 / F: the strain rates are the multipliers of the yield conditions.
double slope_of(const Domain& domain, const Edges& edges, Side side, double factor, const Solved& one) {
  constexpr double kStep = 1e-4;  // of 1 / F, relative
  const BoundProgram other =
      program_of(reduced(domain, factor / (1.0 + kStep)), edges, Quantity::strength, side);
  const double unit = other.units.stress / one.program.units.stress;
  double change = 0.0;
  for (std::size_t c = 0; c < other.program.cones.size(); ++c) {
    const Cone &now = one.program.program.cones[c], &then = other.program.cones[c];
    const auto k = static_cast<Eigen::Index>(c);
    if (now.h1[0] == 0.0) continue;
    const Vector3 room = unit * then.h0 - now.h0 - (then.G - now.G) * one.solution.sigma.col(k);
    change += room.dot(one.solution.z.col(k));
  }
  return std::max(change * factor / kStep, 1e-6);
}

Solved bound_factor(const Domain& domain, const Edges& edges, Side side, const Options& options, double start,
                    Bound& bound) {
  FactorRoot root(options);
  Solved best;
  double factor = start;
  while (!root.found() && !root.exhausted()) {
    Solved one = solve_one(reduced(domain, factor), edges, Quantity::strength, side, options);
    count(bound, one);
    if (!one.solved()) {
      if (!bound.value) bound.reason = reason_of(one, side, Quantity::strength);
      if (bound.value || one.solution.status == ConeStatus::stopped) break;
      return one;
    }
    const double t = side == Side::primal ? one.solution.tau : one.check.value;
    if (one.check.passed()) {
      const double here = side == Side::primal ? factor_of(domain, one.program, one.solution.sigma) : factor;
      const bool better = !bound.value || (side == Side::primal ? here > *bound.value : here < *bound.value);
      if (better && (side == Side::primal ? here > 0.0 : t <= 0.0)) {
        bound.value = here;
        keep_check(bound, one);
        best = one;
      }
    }
    root.take(factor, t);
    if (!root.found()) factor = root.next(slope_of(domain, edges, side, factor, one));
    if (!best.solved()) best = std::move(one);
  }
  if (!bound.value && bound.reason.empty())
    bound.reason = root.exhausted() ? "no factor in the range that is searched proves it"
                                    : reason_of(best, side, Quantity::strength);
  if (bound.value) bound.margin = std::abs(root.stable() / *bound.value - 1.0);
  return best;
}

// ---- refining

// s z by triangle, of the slack of one field and the strain rates of the other; their sum is 1.
std::vector<double> meeting(const Solved& slack, const Solved& rates, const std::vector<char>& stress_free,
                            std::size_t triangles) {
  std::vector<double> part(triangles, 0.0);
  for (std::size_t t = 0; t < triangles; ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(3 * t + i);
      if (stress_free[3 * t + i]) continue;
      part[t] += std::max(0.0, slack.solution.s.col(k).dot(rates.solution.z.col(k)));
    }
  const double sum = std::accumulate(part.begin(), part.end(), 0.0);
  for (double& one : part) one /= std::max(sum, 1e-300);
  return part;
}

// Where stresses off yield meet strain rates, the bounds part.  Each program has both: where the lower one fails at a
// place that the upper field leaves at rest, its own rates meet the slack of the upper one.
std::vector<double> gap_by_triangle(const Domain& domain, const Solved& lower, const Solved& upper) {
  const std::vector<char>& stress_free = lower.program.stress_free;
  std::vector<double> gap = meeting(lower, upper, stress_free, domain.triangles.size());
  const std::vector<double> other = meeting(upper, lower, stress_free, domain.triangles.size());
  for (std::size_t t = 0; t < gap.size(); ++t) gap[t] = 0.5 * (gap[t] + other[t]);
  return gap;
}

// The triangles with most of the gap: one at least, and at most so many.
std::vector<char> mark(const std::vector<double>& gap, int most) {
  constexpr double kShare = 0.6;
  std::vector<int> order(gap.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return gap[at(a)] != gap[at(b)] ? gap[at(a)] > gap[at(b)] : a < b; });
  const double total = std::accumulate(gap.begin(), gap.end(), 0.0);
  std::vector<char> marked(gap.size(), 0);
  double sum = 0.0;
  for (int i = 0; i < most && i < static_cast<int>(order.size()) && (i == 0 || sum < kShare * total); ++i) {
    marked[at(order[at(i)])] = 1;
    sum += gap[at(order[at(i)])];
  }
  return marked;
}

// Divides triangles until there are about so many.  A slip line crosses ever more triangles of size h, each with a gap of
// h^2: where triangles are divided, the gap to come goes with area^1.5.
void refine_to(Domain& domain, std::vector<double> gap, int elements) {
  for (int now = static_cast<int>(domain.triangles.size()); now < elements;
       now = static_cast<int>(domain.triangles.size())) {
    std::vector<double> area;
    for (const Triangle& t : domain.triangles) area.push_back(domain.area(t));
    // A marked triangle makes two or three more.
    const std::vector<int> parents = refine(domain, mark(gap, (elements - now) / 2 + 1));
    std::vector<double> expected(parents.size());
    for (std::size_t t = 0; t < parents.size(); ++t)
      expected[t] =
          gap[at(parents[t])] * std::pow(domain.area(domain.triangles[t]) / area[at(parents[t])], 1.5);
    gap = std::move(expected);
  }
}

// Meshes grow by equal factors, so that all of them cost little more than the last.
int next_size(int now, int elements) {
  constexpr double kGrowth = 1.4;  // at most, about
  const double ratio = static_cast<double>(elements) / now;
  return static_cast<int>(
      std::ceil(now * std::pow(ratio, 1.0 / std::ceil(std::log(ratio) / std::log(kGrowth)))));
}

void keep_fields(Bounds& all, const Solved& lower, const Solved& upper) {
  all.stress.resize(3, 0);
  all.velocity.resize(2, 0);
  all.gap.clear();
  const auto points = static_cast<Eigen::Index>(3 * all.domain.triangles.size());
  if (lower.solved() && all.lower.value) {
    all.stress = lower.program.units.stress * lower.solution.sigma.leftCols(points);
    for (Eigen::Index k = 0; k < points; ++k)
      if (lower.program.stress_free[static_cast<std::size_t>(k)]) all.stress.col(k).setZero();
  }
  if (upper.solved() && all.upper.value) {
    const std::vector<int>& place = upper.program.velocity;
    all.velocity.setZero(2, static_cast<Eigen::Index>(place.size() / 2));
    for (std::size_t i = 0; i < place.size(); ++i)
      if (place[i] >= 0)
        all.velocity(static_cast<Eigen::Index>(i % 2), static_cast<Eigen::Index>(i / 2)) =
            upper.program.share[i] * upper.solution.u[place[i]];
    const double size = all.velocity.cwiseAbs().maxCoeff();
    if (size > 0.0) all.velocity /= size;
  }
  if (lower.solved() && upper.solved()) all.gap = gap_by_triangle(all.domain, lower, upper);
}

void solve_round(Bounds& all, const Options& options, bool last, double& factor) {
  all.edges = edges_of(all.domain);
  all.lower = all.upper = {};
  Solved lower, upper;
  if (options.quantity == Quantity::load) {
    lower = bound_load(all.domain, all.edges, Side::primal, options, all.lower);
    upper = bound_load(all.domain, all.edges, Side::dual, options, all.upper);
  } else {
    // What a coarse mesh is refined for needs no more than a rough factor.
    Options rough = options;
    if (!last) {
      rough.tolerance = std::max(0.005, options.tolerance);
      rough.accuracy = std::max(1e-3, options.accuracy);
    }
    lower = bound_factor(all.domain, all.edges, Side::primal, rough, factor, all.lower);
    if (all.lower.value) factor = *all.lower.value * 1.005;
    upper = bound_factor(all.domain, all.edges, Side::dual, rough, factor, all.upper);
    if (all.upper.value && all.lower.value) factor = 0.5 * (*all.lower.value + *all.upper.value);
  }
  all.stopped = lower.solution.status == ConeStatus::stopped || upper.solution.status == ConeStatus::stopped;
  // Rounding cannot make them cross; a fault of the mesh or of the program can.
  if (all.lower.value && all.upper.value &&
      *all.lower.value > *all.upper.value + 1e-6 * std::abs(*all.upper.value)) {
    const std::string reason = fmt::format("the fields contradict each other: lower {:.6g} above upper {:.6g}",
                                           *all.lower.value, *all.upper.value);
    all.lower = all.upper = {};
    all.lower.reason = all.upper.reason = reason;
  }
  keep_fields(all, lower, upper);
  all.rounds.push_back({static_cast<int>(all.domain.triangles.size()), all.lower.value, all.upper.value});
}

}  // namespace

std::optional<double> Bounds::relative_gap() const {
  if (!lower.value || !upper.value) return {};
  return (*upper.value - *lower.value) / std::max(1e-300, 0.5 * std::abs(*upper.value + *lower.value));
}

Domain reduced(Domain domain, double factor) {
  for (Soil& soil : domain.soils) soil.strength = soil.strength.reduced(factor);
  for (Joint& joint : domain.joints) {
    joint.strength = joint.strength.reduced(factor);
    joint.lower_cohesion /= factor;
  }
  return domain;
}

Bounds find_bounds(const Domain& domain, const Options& options) {
  Bounds all;
  all.domain = domain;
  if (options.elements > 0) fan_out(all.domain, 2);
  double factor = 1.0;
  Bounds best;  // on the finest mesh so far that gave both
  for (bool last = static_cast<int>(all.domain.triangles.size()) >= options.elements;;) {
    solve_round(all, options, last, factor);
    const auto gap = all.relative_gap();
    if (last || all.stopped || all.gap.empty()) break;
    if (gap && *gap <= options.gap && options.quantity == Quantity::load) break;
    if (gap) best = all;
    refine_to(all.domain, all.gap, next_size(static_cast<int>(all.domain.triangles.size()), options.elements));
    last = static_cast<int>(all.domain.triangles.size()) >= 0.95 * options.elements ||
           (gap && *gap <= options.gap);
  }
  return proved(std::move(best), std::move(all));
}

Bounds proved(Bounds best, Bounds last) {
  if (!best.relative_gap() || last.relative_gap() || last.stopped) return last;
  best.rounds = std::move(last.rounds);
  return best;
}

}  // namespace sage::bounds

// What the suite of laws checks, by a law's size: the suite runs it over samples, and tests run it over faulty laws.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "sage/conformance/allocations.hpp"
#include "sage/conformance/law_driver.hpp"
#include "sage/conformance/suites.hpp"
#include "sage/core/four_at_a_time.hpp"

namespace sage::conformance {

// Random but reproducible states: an admissible isotropic start, then a few random increments.
class Walker {
 public:
  explicit Walker(unsigned seed) : random_(seed) {}
  template <int N>
  Vector<N> increment(double size) {
    Vector<N> d;
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < N; ++i) d[i] = size * uniform(random_);
    return d;
  }
  Vector4 strain(double size, Vector<4>*) {  // mostly shearing: volume change a fifth of the rest
    Vector4 d = increment<4>(size);
    const double mean = d.head<3>().mean();
    d.head<3>().array() -= 0.8 * mean;
    return d;
  }
  template <int N>
  Vector<N> strain(double size, Vector<N>*) {
    return increment<N>(size);
  }
  Vector2 strain(double size, Vector<2>*) {  // normal stiffness is 50 times the shear stiffness
    return increment<2>(size).cwiseProduct(Vector2(1.0, 0.05));
  }

 private:
  std::mt19937 random_;
};

inline Vector4 start_stress(const SolidLaw&) {
  return {-60.0, -60.0, -60.0, 0.0};
}
inline Vector2 start_stress(const InterfaceLaw&) {
  return {0.0, -60.0};
}
template <int N>
Vector<N> start_stress(const Law<N>&) {  // of structures
  return Vector<N>::Zero();
}

template <int N>
struct State {
  Vector<N> sigma;
  std::vector<double> h;
};

// A state after `steps` random increments.  Steps that the law refuses are left out, as the analysis would.
template <int N>
State<N> wander(const Law<N>& law, Walker& walker, double size, int steps) {
  State<N> s{start_stress(law), {}};
  s.h = initial_history<N>(law, s.sigma);
  for (int i = 0; i < steps; ++i) {
    const Vector<N> deps = walker.strain(size, static_cast<Vector<N>*>(nullptr));
    const auto a = update<N>(law, s.sigma, deps, s.h);
    if (a.outcome == Outcome::ok) s = {a.sigma, a.h};
  }
  return s;
}

template <int N>
void check_zero_increment(const Law<N>& law, double size) {
  Walker walker(11);
  for (int trial = 0; trial < 100; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 7);
    const auto a = update<N>(law, s.sigma, Vector<N>::Zero(), s.h);
    EXPECT_EQ(a.outcome, Outcome::ok);
    EXPECT_LE((a.sigma - s.sigma).norm(), 1e-13 * (s.sigma.norm() + 60.0)) << trial;
    for (std::size_t i = 0; i < s.h.size(); ++i) EXPECT_NEAR(a.h[i], s.h[i], 1e-13 * (1.0 + std::abs(s.h[i])));
  }
}

// An increment of ordinary size has an answer, nearly always; one that the law refuses has one in parts of it,
// as few halvings away as the analysis tries (12); a linear law never refuses.  Without this a law that refuses
// everything would pass all the rest.
template <int N>
void check_answers(const Law<N>& law, double size) {
  Walker walker(13);
  constexpr int kStates = 200, kHalvings = 12;
  int refused = 0;
  for (int trial = 0; trial < kStates; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    Vector<N> deps = walker.strain(std::pow(10.0, -(trial % 3)) * size, static_cast<Vector<N>*>(nullptr));
    if (update<N>(law, s.sigma, deps, s.h).outcome == Outcome::ok) continue;
    ++refused;
    int halvings = 0;
    do deps *= 0.5;
    while (++halvings < kHalvings && update<N>(law, s.sigma, deps, s.h).outcome != Outcome::ok);
    EXPECT_LT(halvings, kHalvings) << "refused down to a 4096th, trial " << trial;
  }
  EXPECT_LE(refused, law.traits().linear ? 0 : kStates / 20);
}

// The fraction of states where the tangent and central differences agree must be all but the kinks: at a
// corner of a yield surface or a branch of the law one-sided derivatives differ, so 3 % of random states
// may fail.  Step: 1e-6 of the increment.  Tolerance 2e-5 of the largest term of D: truncation and
// rounding of the differences.
template <int N>
void check_tangent(const Law<N>& law, double size) {
  Walker walker(7);
  int kinks = 0, refused = 0;
  const int states = 200;
  for (int trial = 0; trial < states; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    const Vector<N> deps = walker.strain(size, static_cast<Vector<N>*>(nullptr));
    const auto a = update<N>(law, s.sigma, deps, s.h);
    if (a.outcome != Outcome::ok) {
      ++refused;
      continue;
    }
    const Matrix<N> D = difference_tangent<N>(law, s.sigma, deps, s.h, 1e-6 * size);
    // Where the true tangent vanishes the law may leave up to 1e-6 of its elastic one.
    const double largest = std::max(a.D.cwiseAbs().maxCoeff(), D.cwiseAbs().maxCoeff());
    const double initial =
        update<N>(law, start_stress(law), Vector<N>::Zero(), initial_history<N>(law, start_stress(law)))
            .D.cwiseAbs()
            .maxCoeff();
    if (!((a.D - D).cwiseAbs().maxCoeff() <= 2e-5 * largest + 1e-6 * initial)) ++kinks;
  }
  EXPECT_LE(kinks, states * 3 / 100);
  EXPECT_LE(refused, states / 20) << "not looked at";
}

// symmetric() = true must hold in every state; a law that says false must show an
// unsymmetric tangent somewhere.
template <int N>
void check_symmetry(const Law<N>& law, double size) {
  Walker walker(5);
  double worst = 0.0;
  for (int trial = 0; trial < 150; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    const auto a = update<N>(law, s.sigma, walker.strain(size, static_cast<Vector<N>*>(nullptr)), s.h);
    const double largest = a.D.cwiseAbs().maxCoeff();
    if (largest > 0.0) worst = std::max(worst, (a.D - a.D.transpose()).cwiseAbs().maxCoeff() / largest);
  }
  if (law.traits().symmetric) {
    EXPECT_LE(worst, 1e-12);
  } else {
    EXPECT_GT(worst, 1e-6) << "the law could say that it is symmetric";
  }
}

// linear() = true: one D for ever, sigma = sigma0 + D deps.
template <int N>
void check_linear(const Law<N>& law, double size) {
  if (!law.traits().linear) return;
  Walker walker(3);
  const Matrix<N> D =
      update<N>(law, Vector<N>::Zero(), Vector<N>::Zero(), initial_history<N>(law, Vector<N>::Zero())).D;
  for (int trial = 0; trial < 50; ++trial) {
    const State<N> s = wander<N>(law, walker, size, 3);
    const Vector<N> deps = walker.strain(100.0 * size, static_cast<Vector<N>*>(nullptr));
    const auto a = update<N>(law, s.sigma, deps, s.h);
    EXPECT_EQ((a.D - D).norm(), 0.0);
    EXPECT_LE((a.sigma - s.sigma - D * deps).norm(), 1e-13 * a.sigma.norm());
  }
}

// stress_level <= 1 + 1e-8 after any increment, from a thousandth of the sample's strain to a thousand times
// it; increments that the law refuses (cut_step) aren't an answer.
template <int N>
void check_surface(const Law<N>& law, double size) {
  Walker walker(2);
  int answered = 0;  // of increments up to the sample's
  for (int trial = 0; trial < 280; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    const double factor = std::pow(10.0, trial % 7 - 3);
    const auto a = update<N>(law, s.sigma, walker.strain(factor * size, static_cast<Vector<N>*>(nullptr)), s.h);
    if (a.outcome != Outcome::ok) continue;
    answered += factor <= 1.0 ? 1 : 0;
    EXPECT_LE(law.stress_level(a.sigma, a.h), 1.0 + 1e-8) << trial << " " << a.sigma;
  }
  EXPECT_GE(answered, 160 * 19 / 20) << "the others were not looked at";
}

// A law at its strength says so, and no other.  Where a law starts below its strength a small increment does not reach it;
// yielded and slipping are said at stress level 1 only (a joint without strength slips at 0), open only without stress,
// and a linear law says nothing but elastic.  At the apex and where tension is cut off the level may be anything.
inline bool at_strength(PointStatus status) {
  return status != PointStatus::elastic && status != PointStatus::unloading && status != PointStatus::open;
}
template <int N>
void check_status_of_state(const Law<N>& law, double size) {
  Walker walker(47);
  const std::vector<double> h = initial_history<N>(law, start_stress(law));
  for (int trial = 0; trial < 150; ++trial) {
    const State<N> s =
        trial % 5 == 0 ? State<N>{start_stress(law), h} : wander<N>(law, walker, size, trial % 5);
    const double factor = trial % 5 == 0 ? (trial % 2 == 0 ? 0.0 : 1e-6) : std::pow(10.0, 1 - trial % 4);
    const auto a = update<N>(law, s.sigma, walker.strain(factor * size, static_cast<Vector<N>*>(nullptr)), s.h);
    if (a.outcome != Outcome::ok) continue;
    if (law.traits().linear) {
      EXPECT_EQ(a.status, PointStatus::elastic) << trial;
    }
    const double level = law.stress_level(a.sigma, a.h);
    const bool strengthless = a.status == PointStatus::slipping && level == 0.0;
    if (trial % 5 == 0 && level < 1.0 - 1e-8 && !strengthless) {
      EXPECT_FALSE(at_strength(a.status)) << "status " << static_cast<int>(a.status) << " at the start";
    }
    if ((a.status == PointStatus::yielded || a.status == PointStatus::slipping) && !strengthless) {
      EXPECT_GT(level, 1.0 - 1e-8) << "status " << static_cast<int>(a.status) << ", trial " << trial;
    }
    if (a.status == PointStatus::open) {
      EXPECT_EQ(a.sigma.norm(), 0.0) << trial;
    }
  }
}

// Status says what happened: with increments that reach the strength some points yield, exactly at it.
template <int N>
void check_status(const Law<N>& law, double size) {
  Walker walker(23);
  int yielded = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    const auto a = update<N>(law, s.sigma, walker.strain(size, static_cast<Vector<N>*>(nullptr)), s.h);
    const double level = law.stress_level(a.sigma, a.h);
    const bool fails = a.status == PointStatus::yielded || a.status == PointStatus::slipping;
    const bool strengthless = a.status == PointStatus::slipping && level == 0.0;
    if (fails && !strengthless) {
      EXPECT_NEAR(level, 1.0, 1e-8);
    }
    if (a.status == PointStatus::open) {
      EXPECT_EQ(a.sigma.norm(), 0.0);
    }
    if (fails) ++yielded;
  }
  EXPECT_GT(yielded, 0);
}

// Finite numbers for any increment: 1e3 of strain, 1e-300, pure tension, from an unstressed start as well.
template <int N>
void check_finite(const Law<N>& law) {
  Walker walker(17);
  for (int trial = 0; trial < 160; ++trial) {
    const double size = trial % 4 == 0 ? 1e3 : trial % 4 == 1 ? 1.0 : trial % 4 == 2 ? 1e-9 : 1e-300;
    const Vector<N> sigma = trial % 3 == 0 ? Vector<N>(Vector<N>::Zero()) : Vector<N>(start_stress(law));
    const auto h = initial_history<N>(law, sigma);
    const auto a = update<N>(law, sigma, walker.increment<N>(size), h);
    EXPECT_TRUE(a.sigma.allFinite()) << a.sigma;
    EXPECT_TRUE(a.D.allFinite()) << a.D;
    for (const double value : a.h) EXPECT_TRUE(std::isfinite(value));
    EXPECT_FALSE(std::isnan(law.stress_level(a.sigma, a.h)));
  }
}

// Every field of the answer is written in every branch, status and history included: whatever stood there before.
template <int N>
void check_written(const Law<N>& law, double size) {
  Walker walker(29);
  for (int trial = 0; trial < 100; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    const double factor = trial % 5 == 4 ? 0.0 : std::pow(10.0, 1 - trial % 4);
    const Vector<N> deps = walker.strain(factor * size, static_cast<Vector<N>*>(nullptr));
    const auto a = update<N>(law, s.sigma, deps, s.h, kPresets[0]);
    const auto b = update<N>(law, s.sigma, deps, s.h, kPresets[1]);
    EXPECT_EQ(a.outcome, b.outcome) << trial;
    if (a.outcome != Outcome::ok) continue;
    EXPECT_EQ(a.sigma, b.sigma) << "stress, trial " << trial;
    EXPECT_EQ(a.D, b.D) << "tangent, trial " << trial;
    EXPECT_EQ(a.h, b.h) << "history, trial " << trial;
    EXPECT_EQ(a.status, b.status) << "status, trial " << trial;
  }
}

// Stress-like parameters and stresses times 1e12 or 1e-12: same status, same relative stress.  1e-9: the
// substeps of the hyperbolic laws and the corners of the planes amplify rounding.
template <int N>
void check_scaling(const Law<N>& law, const Law<N>& scaled, double factor, double size) {
  Walker walker(31);
  for (int trial = 0; trial < 100; ++trial) {
    const State<N> s = wander<N>(law, walker, size, trial % 5);
    const Vector<N> deps = walker.strain(size, static_cast<Vector<N>*>(nullptr));
    std::vector<double> h = s.h;
    const auto quantities = law.traits().history;
    for (std::size_t i = 0; i < h.size(); ++i)
      if (quantities[i].dimension == Dimension::stress) h[i] *= factor;
    const auto a = update<N>(law, s.sigma, deps, s.h);
    const auto b = update<N>(scaled, factor * s.sigma, deps, h);
    EXPECT_EQ(a.status, b.status);
    EXPECT_LE((b.sigma / factor - a.sigma).norm(), 1e-9 * (a.sigma.norm() + 60.0)) << trial;
    EXPECT_LE((b.D / factor - a.D).norm(), 1e-7 * a.D.norm()) << trial;
    const double error = path_error(law, point_in<N>(law, s.sigma, deps, s.h), a.sigma, a.h);
    EXPECT_NEAR(path_error(scaled, point_in<N>(scaled, factor * s.sigma, deps, h), b.sigma, b.h), error,
                1e-6 * error)
        << trial;
  }
}

// Of stress; strain, with its engineering shear, turns by the inverse transposed.
inline Matrix4 turned_by(double degrees) {
  const double c = std::cos(degrees * kRadiansPerDegree), s = std::sin(degrees * kRadiansPerDegree);
  Matrix4 turn;
  turn << c * c, s * s, 0.0, 2.0 * c * s,  //
      s * s, c * c, 0.0, -2.0 * c * s,     //
      0.0, 0.0, 1.0, 0.0,                  //
      -c * s, c * s, 0.0, c * c - s * s;
  return turn;
}

// A law that knows no direction in the plane: in turned axes it answer the turned stress.  90 degrees change the
// places of xx and yy alone; only another angle brings the shear into it.  Tangents may differ at kinks, which
// rounding meets from either side: 3 % of the states.
inline void check_turning(const SolidLaw& law, double size) {
  for (const double degrees : {27.0, 90.0, -63.0}) {
    const Matrix4 stress = turned_by(degrees), strain = turned_by(-degrees).transpose();
    Walker walker(37);
    int kinks = 0;
    constexpr int kStates = 100;
    for (int trial = 0; trial < kStates; ++trial) {
      const auto s = wander<4>(law, walker, size, trial % 5);
      const Vector4 deps = walker.strain(size, static_cast<Vector4*>(nullptr));
      const auto a = update<4>(law, s.sigma, deps, s.h);
      const auto b = update<4>(law, stress * s.sigma, strain * deps, s.h);
      EXPECT_EQ(a.outcome, b.outcome) << trial << ", " << degrees << " degrees";
      EXPECT_LE((stress * a.sigma - b.sigma).norm(), 1e-9 * (a.sigma.norm() + 60.0))
          << trial << ", " << degrees << " degrees";
      if (!((stress * a.D * stress.transpose() - b.D).norm() <= 1e-6 * a.D.norm())) ++kinks;
    }
    EXPECT_LE(kinks, kStates * 3 / 100) << degrees << " degrees";
  }
}
template <int N>
void check_turning(const Law<N>&, double) {}  // the axes are those of the joint or the structure

// Fours of points in different branches side by side, and the answers of update_four.
template <int N>
struct Fours {
  template <class T>
  using Each = std::vector<std::array<T, kAbreast>>;
  Each<State<N>> from;
  Each<Vector<N>> deps;
  Each<std::vector<double>> h1;
  std::vector<FourPointsOut<N>> out;

  Fours(const Law<N>& law, Walker& walker, double size, int trial, std::size_t fours)
      : from(fours), deps(fours), h1(fours), out(fours) {
    for (std::size_t p = 0; p < fours; ++p)
      for (std::size_t l = 0; l < kAbreast; ++l) {
        const int branch = trial + static_cast<int>(p + l);
        from[p][l] = wander<N>(law, walker, size, branch % 5);
        deps[p][l] = walker.strain(std::pow(10.0, 1 - branch % 4) * size, static_cast<Vector<N>*>(nullptr));
      }
  }

  Outcome update(const Law<N>& law, const Preset& preset) {
    std::vector<FourPointsIn<N>> in(out.size());
    for (std::size_t p = 0; p < out.size(); ++p)
      for (std::size_t l = 0; l < kAbreast; ++l) {
        h1[p][l].assign(from[p][l].h.size(), preset.number);
        in[p].h0[l] = from[p][l].h.data();
        out[p].h1[l] = h1[p][l].data();
        out[p].status[l] = preset.status;
        for (std::size_t i = 0; i < N; ++i) {
          const auto at = static_cast<Eigen::Index>(i);
          one_of_four(in[p].sigma0[i], l) = from[p][l].sigma[at];
          one_of_four(in[p].eps0[i], l) = 0.0;
          one_of_four(in[p].deps[i], l) = deps[p][l][at];
          out[p].sigma[i] = all_four(preset.number);
          for (std::size_t j = 0; j < N; ++j) out[p].D[i][j] = all_four(preset.number);
        }
      }
    return dynamic_cast<const FourPointLaw<N>&>(law).update_four(in, out);
  }
};

// The answers, one by one; whether one of them was refused.
template <int N>
bool compare_fours(const Law<N>& law, const Fours<N>& fours, bool answered,
                   std::optional<Matrix<N>>& constant_D) {
  bool refused = false;
  for (std::size_t p = 0; p < fours.out.size(); ++p)
    for (std::size_t l = 0; l < kAbreast; ++l) {
      const State<N>& from = fours.from[p][l];
      const auto one = update<N>(law, from.sigma, fours.deps[p][l], from.h);
      refused = refused || one.outcome == Outcome::cut_step;
      if (!answered) continue;
      const FourPointsOut<N>& out = fours.out[p];
      EXPECT_EQ(out.status[l], one.status) << "four " << p << " of " << fours.out.size();
      EXPECT_EQ(fours.h1[p][l], one.h);
      if (out.constant_D) {
        if (!constant_D) constant_D = one.D;
        EXPECT_EQ(one.D, *constant_D) << "said to be constant";
      }
      for (std::size_t i = 0; i < N; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        EXPECT_EQ(one_of_four(out.sigma[i], l), one.sigma[row]) << "four " << p << " of " << fours.out.size();
        for (std::size_t j = 0; j < N; ++j)
          EXPECT_EQ(one_of_four(out.D[i][j], l), one.D(row, static_cast<Eigen::Index>(j)));
      }
    }
  return refused;
}

// Against one by one, to the last bit.  As many fours as elements with
// 1, 2 or 9 points bring, over whatever stood in the answers before.
template <int N>
void check_four(const Law<N>& law, double size) {
  Walker walker(43);
  std::optional<Matrix<N>> constant_D;
  for (const std::size_t fours : {std::size_t{1}, std::size_t{2}, kMostFours})
    for (int trial = 0; trial < (fours == 1 ? 200 : 40); ++trial) {
      Fours<N> together(law, walker, size, trial, fours);
      for (const Preset& preset : kPresets) {
        const Outcome all = together.update(law, preset);
        const bool refused = compare_fours(law, together, all == Outcome::ok, constant_D);
        EXPECT_EQ(all == Outcome::cut_step, refused);
      }
    }
}

}  // namespace sage::conformance

#include "materials/drucker_prager_four.hpp"

#include <algorithm>
#include <cmath>

namespace sage {

namespace {

Eigen::Index at(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

// Whether the elastic D has a term there.
constexpr bool couples(std::size_t i, std::size_t j) {
  return (i < 3) == (j < 3);
}

void set_status(const FourMask& here, PointStatus status, FourPointsOut<4>& out) {
  const int places = bits_of_four(here);
#pragma GCC unroll 4
  for (std::size_t l = 0; l < kAbreast; ++l) out.status[l] = (places >> l & 1) != 0 ? status : out.status[l];
}

}  // namespace

// Roots and quotients make a chain of each of the two halves: chains of several points go side by side.
Outcome DruckerPragerFour::update_four(std::span<const FourPointsIn<4>> in,
                                       std::span<FourPointsOut<4>> out) const {
  std::array<Trial, kMostFours> trial;
  for (std::size_t p = 0; p < in.size(); ++p) predict(in[p], trial[p]);
  for (std::size_t p = 0; p < in.size(); ++p) finish(in[p], trial[p], out[p]);
  return Outcome::ok;
}

// The initial stress is part of sigma0.
void DruckerPragerFour::predict(const FourPointsIn<4>& in, Trial& trial) const {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    Four change{};
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j)
      if (couples(i, j)) change = multiply_add(all_four(D_elastic_(at(i), at(j))), in.deps[j], change);
    trial.stress[i] = in.sigma0[i] + change;
  }
  trial.of = invariants(trial.stress);
  const auto& [s, p, q] = trial.of;
  trial.f = q + 3.0 * p_.cone.alpha * p - p_.cone.k;  // Equation 7.25
  trial.rounding = kRounding * scale(abs_of_four(p), q);
  trial.elastic = (trial.f <= trial.rounding) & (p <= p_max_ + trial.rounding);
}

void DruckerPragerFour::finish(const FourPointsIn<4>& in, const Trial& trial, FourPointsOut<4>& out) const {
  const auto [K, G] = p_.elastic;
  const FourMask elastic = trial.elastic;
  out.constant_D = bits_of_four(elastic) == kAllOfFour;
  Four shear, volume;
  load_pairs_of_four(in.h0[0], in.h0[1], in.h0[2], in.h0[3], shear, volume);
  if (!out.constant_D) {
    // Return: to the cone, if that is in front of its tip and of the tension limit.
    const Four dlambda = trial.f / (G + 9.0 * K * p_.cone.alpha * p_.beta);
    const Four p_cone = trial.of.p - 3.0 * K * p_.beta * dlambda;
    const FourMask in_front = (trial.f > trial.rounding) & (p_cone <= p_max_ + trial.rounding);  // theta >= 0
    const FourMask on_cone = in_front & ~elastic, beyond = ~(in_front | elastic);
    return_to_cone(trial.of, p_cone, out);
    if (p_.exact) take_exact_answers(in, on_cone, out);
    if (bits_of_four(beyond) != 0)
      p_.free_mean ? drop_deviator(trial.of, beyond, out) : return_to_cap(trial.of, beyond, out);

    FourTensors fall;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < 4; ++i) fall[i] = trial.stress[i] - out.sigma[i];
    const FourInvariants plastic = invariants(fall);
    shear += elastic ? Four{} : plastic.q / G;
    volume += elastic ? Four{} : plastic.p / K;
  }
  if (bits_of_four(elastic) != 0) stay_elastic(trial.stress, elastic, out);
  static_assert(kShear == 0 && kVolume == 1);
  store_pairs_of_four(shear, volume, out.h1[0], out.h1[1], out.h1[2], out.h1[3]);
}

void DruckerPragerFour::stay_elastic(const FourTensors& trial, const FourMask& here,
                                     FourPointsOut<4>& out) const {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    out.sigma[i] = here ? trial[i] : out.sigma[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) out.D[i][j] = here ? all_four(D_elastic_(at(i), at(j))) : out.D[i][j];
  }
  set_status(here, PointStatus::elastic, out);
}

// s = theta s_tr,  p = p_tr - 3 K beta dlambda; tangent: de Souza Neto, Peric & Owen (2008), ch. 8.
void DruckerPragerFour::return_to_cone(const FourInvariants& trial, const Four& p,
                                       FourPointsOut<4>& out) const {
  const auto [K, G] = p_.elastic;
  const auto [alpha, k] = p_.cone;
  const double beta = p_.beta, A = 1.0 / (G + 9.0 * K * alpha * beta);
  const Four room = k - 3.0 * alpha * p, q = room > 0.0 ? room : Four{};  // on the surface to the last digit
  const Four theta = q / trial.q, length = std::sqrt(2.0) * trial.q;
  const Four shear = 2.0 * G * theta, turning = 2.0 * G * multiply_add(all_four(-G), all_four(A), 1.0 - theta);
  FourTensors n;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    n[i] = trial.s[i] / length;
    out.sigma[i] = multiply_add(all_four(kUnit[i]), p, theta * trial.s[i]);
  }
  const double coupling = 3.0 * std::sqrt(2.0) * G * K * A, volume = K * (1.0 - 9.0 * K * alpha * beta * A);
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    const Four turned = turning * n[i], pushed = alpha * n[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      Four D = turned * n[j];
      if (couples(i, j)) D = multiply_add(shear, all_four(kProjection[i][j]), D);
      Four mixed = j < 3 ? pushed : Four{};  // beta n_j 1_i + alpha n_i 1_j
      if (i < 3) mixed = multiply_add(n[j], all_four(beta), mixed);
      D = multiply_add(mixed, all_four(-coupling), D);
      out.D[i][j] = i < 3 && j < 3 ? D + volume : D;
    }
  }
  out.status.fill(PointStatus::yielded);
}

// s = 0,  p = p_trial.
void DruckerPragerFour::drop_deviator(const FourInvariants& trial, const FourMask& here,
                                      FourPointsOut<4>& out) const {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    out.sigma[i] = here ? kUnit[i] * trial.p : out.sigma[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      const double D =
          multiply_add(kApexStiffness, D_elastic_(at(i), at(j)), p_.elastic.K * kUnit[i] * kUnit[j]);
      out.D[i][j] = here ? all_four(D) : out.D[i][j];
    }
  }
  set_status(here, PointStatus::apex, out);
}

// p = p_max; the deviator is cut to what the cone leaves there, which is nothing at the apex.
void DruckerPragerFour::return_to_cap(const FourInvariants& trial, const FourMask& here,
                                      FourPointsOut<4>& out) const {
  const double left = std::max(p_.cone.k - 3.0 * p_.cone.alpha * p_max_, 0.0);
  const bool at_apex = p_max_ < p_.mean_tension || left <= kRounding * p_.cone.k;
  const Four none{}, whole = all_four(1.0);
  const FourMask corner = trial.q > left;
  const Four theta = at_apex ? none : corner ? left / trial.q : whole;
  const FourMask cut = corner & (theta > 0.0);
  const Four shear = 2.0 * p_.elastic.G * theta, length = std::sqrt(2.0) * trial.q;
  FourTensors n;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) n[i] = trial.s[i] / length;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < 4; ++i) {
    const Four sigma = multiply_add(all_four(p_max_), all_four(kUnit[i]), theta * trial.s[i]);
    const Four turned = -shear * n[i];
    out.sigma[i] = here ? sigma : out.sigma[i];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      Four D = shear * kProjection[i][j];
      D = cut ? multiply_add(turned, n[j], D) : D;
      D = multiply_add(all_four(kApexStiffness), all_four(D_elastic_(at(i), at(j))), D);
      out.D[i][j] = here ? D : out.D[i][j];
    }
  }
  set_status(here, at_apex ? PointStatus::apex : PointStatus::cut_off, out);
}

// Point by point, in place of the return to the cone.
void DruckerPragerFour::take_exact_answers(const FourPointsIn<4>& in, const FourMask& here,
                                           FourPointsOut<4>& out) const {
  const int places = bits_of_four(here);
  for (std::size_t l = 0; l < kAbreast; ++l) {
    if ((places >> l & 1) == 0) continue;
    PointIn<4> point;
    PointOut<4> answer;
    for (std::size_t i = 0; i < 4; ++i) {
      point.sigma0[at(i)] = one_of_four(in.sigma0[i], l);
      point.deps[at(i)] = one_of_four(in.deps[i], l);
    }
    if (!integrate_exactly(point, answer)) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      one_of_four(out.sigma[i], l) = answer.sigma[at(i)];
      for (std::size_t j = 0; j < 4; ++j) one_of_four(out.D[i][j], l) = answer.D(at(i), at(j));
    }
  }
}

}  // namespace sage

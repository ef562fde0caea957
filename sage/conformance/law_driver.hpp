// A law driven by hand: one update with its own history, and tangents by differences.
#pragma once

#include <array>
#include <vector>

#include "sage/core/law.hpp"
#include "sage/core/units.hpp"

namespace sage::conformance {

inline UnitSystem kpa_units() {
  return {"m", "kN", "kPa", 101.325, 9.807};
}

// For laws that want it: a step of the first increment, and the state that stands at its end.
inline const PointContext& some_context(bool step_taken) {
  static const PointContext step{.element = 1, .stage = 1, .increment = 1, .time = 0.5, .dt = 0.5};
  static const PointContext still{.element = 1, .stage = 1, .increment = 1, .time = 0.5, .dt = 0.0};
  return step_taken ? step : still;
}

// Input without strain so far; a step that strains takes its time, one that doesn't takes none.
template <int N>
PointIn<N> point_in(const Law<N>& law, const Vector<N>& sigma0, const Vector<N>& deps,
                    std::span<const double> h0) {
  return {sigma0, Vector<N>::Zero(), deps, h0,
          law.traits().wants_context ? &some_context(!deps.isZero(0.0)) : nullptr};
}

// What stands in the outputs before a call: a field that a law leaves out differs between the two.
struct Preset {
  double number = 0.0;
  PointStatus status = PointStatus::elastic;
};
inline constexpr std::array<Preset, 2> kPresets{
    {{-12345.0, PointStatus::elastic}, {54321.0, PointStatus::apex}}};

// One update with its own history storage.
template <int N>
struct Answer {
  Vector<N> sigma;
  Matrix<N> D;
  std::vector<double> h;
  PointStatus status;
  Outcome outcome;
};
template <int N>
Answer<N> update(const Law<N>& law, const Vector<N>& sigma0, const Vector<N>& deps, std::vector<double> h0,
                 const Preset& preset = kPresets[0]) {
  Answer<N> a;
  a.h.assign(h0.size(), preset.number);
  PointOut<N> out;
  out.sigma.setConstant(preset.number);
  out.D.setConstant(preset.number);
  out.status = preset.status;
  out.h1 = a.h;
  a.outcome = law.update(point_in<N>(law, sigma0, deps, h0), out);
  a.sigma = out.sigma;
  a.D = out.D;
  a.status = out.status;
  return a;
}
template <int N>
std::vector<double> initial_history(const Law<N>& law, const Vector<N>& sigma) {
  std::vector<double> h = initial_values(law.traits().history);
  law.initialise(sigma, h);
  return h;
}

// d sigma/d deps by central differences; `step` is the strain increment on either side.
template <int N>
Matrix<N> difference_tangent(const Law<N>& law, const Vector<N>& sigma0, const Vector<N>& deps,
                             const std::vector<double>& h0, double step) {
  Matrix<N> D;
  for (int j = 0; j < N; ++j) {
    const Vector<N> d = step * Vector<N>::Unit(j);
    D.col(j) = (update<N>(law, sigma0, deps + d, h0).sigma - update<N>(law, sigma0, deps - d, h0).sigma) /
               (2.0 * step);
  }
  return D;
}

}  // namespace sage::conformance

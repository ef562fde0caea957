// One point of a law, driven without a mesh.  Laboratory paths (triaxial, oedometer, direct shear)
// are such paths, and so is the answer of any test with uniform stress: the "correct" response
// that a mesh is compared with.
#pragma once

#include <array>
#include <vector>

#include "sage/core/law.hpp"

namespace sage {

enum class Control { strain, stress };

// Tension positive, components as in law.hpp.
template <int N>
class PointDriver {
 public:
  // Starts from an initial stress, strain zero.  Throws AnalysisError if the law can't carry that stress.
  // The law must outlive the driver.  history: first values of the law's first quantities, in its own sign; NaN
  // leaves one as the law has it.  Throws AnalysisError if the law can't go on from them.
  explicit PointDriver(const Law<N>& law, const Vector<N>& sigma = Vector<N>::Zero(),
                       std::span<const double> history = {});

  // One step.  target[i] is the strain increment of a strain-controlled component, or the stress that a
  // stress-controlled one has at the end.  Newton on the law's tangent, from the law's stiffness at the start of the
  // step; a step that fails is halved, up to 2^12 parts.  Held stresses are met to 1e-12 of the largest stress of
  // start, target or answer, to 1e-9 where the law's own rounding allows no more.  Throws AnalysisError (S501) with
  // the reason where no state is found (collapse, lost contact); the state is then the last one that was reached.
  // duration: time of the step, for laws that want it.
  // springs [stress per strain, >= 0]: a stress-controlled component ends at target[i] - springs[i] times its own
  // strain increment, as a joint between rocks that give way does (constant normal stiffness).
  void advance(const std::array<Control, N>& control, const Vector<N>& target, double duration = 1.0,
               const Vector<N>& springs = Vector<N>::Zero());

  const Vector<N>& sigma() const { return sigma_; }
  const Vector<N>& eps() const { return eps_; }
  std::span<const double> history() const { return h_; }
  PointStatus status() const { return status_; }
  double stress_level() const { return law_.stress_level(sigma_, h_); }
  int iterations() const {
    return iterations_;
  }                                     // Newton iterations so far, 1 a step where the guess was right
  int steps() const { return steps_; }  // accepted parts so far

 private:
  struct Aim;  // of an attempt: what is controlled, and its targets
  bool attempt(Aim& aim, bool may_divide);
  bool search(const Aim& aim, Vector<N>& deps, PointOut<N>& out);
  bool improve(const Aim& aim, Vector<N>& deps, PointOut<N>& out);
  Outcome call(const Vector<N>& deps, PointOut<N>& out);
  void put_differences(const Aim& aim, const Vector<N>& deps, PointOut<N>& out);
  PointIn<N> input(const Vector<N>& deps) const;

  const Law<N>& law_;
  Vector<N> sigma_, eps_;
  std::vector<double> h_, h_trial_;
  PointStatus status_ = PointStatus::elastic;
  int iterations_ = 0, steps_ = 0;
  bool differences_ = false;  // stand for the law's tangent, with which the path went no further
  double left_ = 0.0;  // of the held stresses after the last attempt, of the largest stress; NaN: no answer
  // Element 1 of size 1, stage 1, an increment for each advance(), at the origin; handed on where the law wants it.
  PointContext context_{.element = 1, .stage = 1, .size = 1.0};
};

extern template class PointDriver<1>;
extern template class PointDriver<2>;
extern template class PointDriver<3>;
extern template class PointDriver<4>;
extern template class PointDriver<5>;

// Compression positive, as the laboratory plots it.
struct TriaxialPoint {
  double axial_strain, volume_strain, deviator;
  PointStatus status;
};

// Drained triaxial test on a specimen with frictionless ends: isotropic cell pressure, then axial strain in
// equal steps while the radial stress stays at the cell pressure.  axial_strain > 0 shortens, < 0 is extension.
// Returns steps + 1 points, the first at zero strain.
std::vector<TriaxialPoint> triaxial_test(const SolidLaw& law, double cell_pressure, double axial_strain,
                                         int steps);

}  // namespace sage

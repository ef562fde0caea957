// Optional interfaces for four points or four elements at a time, side by side in vector registers (four.hpp).  A law or
// an element derives from one beside Law<N> or Element; the analysis looks for both once, when a stage opens, and takes
// fours where both offer it.  The code for one point and one element stays, and results are the same.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "sage/core/element.hpp"
#include "sage/core/four.hpp"

namespace sage {

// PointIn and PointOut of four points; without context.  Some of the four may be one and the same point: results are
// written, never added to.
inline constexpr std::size_t kMostFours = 9;
template <int N>
struct FourPointsIn {
  std::array<Four, N> sigma0, eps0, deps;
  std::array<const double*, kAbreast> h0;  // of each point
};
template <int N>
struct FourPointsOut {
  std::array<Four, N> sigma;
  std::array<std::array<Four, N>, N> D;  // D[i][j] = d(sigma_i)/d(deps_j)
  std::array<double*, kAbreast> h1;
  std::array<PointStatus, kAbreast> status{};
  // D of all four is the one that this law has wherever it says so: matrices may be kept.
  bool constant_D = false;
};

// A law that updates four points at once, to the last bit as Law<N>::update does one by one.
template <int N>
class FourPointLaw {
 public:
  // Up to kMostFours fours, an answer each.  cut_step where one of the points has no answer.
  virtual Outcome update_four(std::span<const FourPointsIn<N>> in, std::span<FourPointsOut<N>> out) const = 0;

 protected:
  ~FourPointLaw() = default;
};

// Largest number of dofs of an element that is evaluated four at a time.
inline constexpr int kMostDofsOfFour = 18;
// Whether elements with these traits may be.  Larger ones are evaluated one by one, whatever they offer: callers and
// laws keep arrays of these sizes.
inline bool four_may_go_together(const ElementTraits& traits) {
  return traits.law_size == 4 && traits.dofs == 2 * traits.nodes && traits.dofs <= kMostDofsOfFour &&
         traits.points <= static_cast<int>(kMostFours) && !traits.sees_unknowns;
}

// Four elements of a group at once.  Some may be one and the same: results are written, never added to.
struct FourElementsIn {
  const double* geometry = nullptr;  // from FourElements::place_among_four of each
  const double* du = nullptr;        // for each dof those of the four elements in a row
  const FourPointLaw<4>* law = nullptr;
  std::size_t history = 0;                                     // doubles of history of a point
  std::array<const double*, kAbreast> sigma0{}, eps0{}, h0{};  // of each element as in ElementIn
};

struct FourElementsOut {
  std::array<double*, kAbreast> K{};  // nullptr = not wanted; the rest of each element as in ElementOut
  std::array<double*, kAbreast> f{}, sigma1{}, eps1{}, h1{};
  std::array<PointStatus*, kAbreast> status{};
  // Some K is not, to the bit, what stood there.  True before: nobody asks any more.
  bool changed = false;
  // K is that of a law's constant D (FourPointsOut::constant_D).  True before: so is what stands there, and it is
  // left alone where it would be the same again.
  bool constant = false;
};

// An element that is evaluated four at a time, as Element::evaluate does one by one; sums may differ by rounding.
class FourElements {
 public:
  // Doubles per element of w and B in the form that evaluate_four reads: those of a point together, w first.
  virtual int four_geometry_size() const = 0;
  // From Element::geometry into every fourth double of among_four, which has room for four elements.
  virtual void place_among_four(std::span<const double> geometry, double* among_four) const = 0;
  virtual Outcome evaluate_four(const FourElementsIn& in, FourElementsOut& out) const = 0;

 protected:
  ~FourElements() = default;
};

}  // namespace sage

// What a row of results on finer and finer meshes says about its limit.
#pragma once

#include <optional>
#include <span>

namespace sage::convergence {

struct MeshSequence {
  enum Kind {
    halving,   // each mesh has half the element size of the one before: error ~ h^q with an unknown q
    spectral,  // degree and grading grow together: the error falls by a large factor each time
  };

  Kind kind = halving;
  std::size_t degrees = 3;  // spectral: so many meshes of rising degree, then halved elements of the highest
  double most = 16.0;  // halving: by what a mesh divides the error at best, 4^p (energy, elements of degree p)
};

// No stated error is smaller than this part of the value: what equilibrium to 1e-8 of the forces, the numbers
// of a deck and the rounding of a hundred layers leave open.
inline constexpr double kLeastError = 1e-10;

struct Limit {
  double value = 0.0;
  double error = 0.0;          // half the width of what the limit is expected in; infinite = nothing is known
  std::optional<double> rate;  // q of halving where two successive rates agree, so that `value` is extrapolated
};

// halving: with differences d1, d2 of the last three values and r = d2 / d1 = 2^-q the limit is
// v + d2 r / (1 - r) (Richardson 1911).  Extrapolated only where the rates of two successive triples differ by
// less than 0.2; then `error` is the change that the last mesh made to the extrapolated value, and no less than
// a tenth of the extrapolation itself.  In all other cases the last value stands, with the last difference or, where it falls
// slowly (r > 1/2), the sum of the geometric series.  A last difference much smaller than the ones before can
// be chance: the error is no less than what they let expect.
//
// around: errors that the surroundings of a point show, a mesh each; empty or NaN: there are none.
struct Around {
  std::span<const double> error;
  bool alone = false;  // they are the error; else the least that is stated

  Around first(std::size_t meshes) const { return {error.empty() ? error : error.first(meshes), alone}; }
};
Limit limit_of(std::span<const double> values, MeshSequence sequence, Around around = {});

// What the first `meshes` of the values show, with an error that holds the later values too, which may lie no
// further from the limit than the last of the first ones does, and the later limits that are more certain.
Limit limit_after(std::span<const double> values, std::size_t meshes, MeshSequence sequence,
                  Around around = {});

}  // namespace sage::convergence

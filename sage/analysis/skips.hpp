// What a run leaves out because the scene does not need it.  Every skip can be switched off.  Without factors, elements,
// states, condensation or twins results differ by rounding.  Without repeats, contraction or prediction the iterations
// take another path: results differ by what the tolerance allows, and by more where several states are in equilibrium
// (points at the apex of a yield surface, a singular tangent).
// Each has a file in skips/: kept_matrices (factors), constant_region (elements), deferred_states, condensation, repeats,
// contraction, prediction; and in solvers/ repeated_fronts (twins).
#pragma once

#include <array>
#include <string_view>

namespace sage {

// From here on a factorisation costs a dozen force passes and solutions, and a solution more than a force pass.
inline bool is_large(int equations) {
  constexpr int kLarge = 20000;
  return equations > kLarge;
}

struct Skips {
  bool factors = true;       // factors are kept while K has not changed
  bool elements = true;      // linear elements: K once, one for congruent elements; forces by K u
  bool states = true;        // linear elements: stress only where an output needs it; u of condensed regions
  bool condensation = true;  // a large linear region leaves the iterations: only its border stays
  bool repeats = true;       // after an increment that was linear to the last digit, the next is its repetition
  bool contraction = true;   // large systems: Newton keeps its factors while they contract well
  bool twins = true;         // parts of the matrix that repeat are eliminated once
  bool prediction = true;  // the first correction of an increment: it starts from the change of the one before
};

struct SkipName {
  std::string_view name;
  bool Skips::*flag;
  std::string_view what;
};

inline constexpr std::array<SkipName, 8> kSkipNames{{
    {"factors", &Skips::factors, "factors are kept while K has not changed"},
    {"elements", &Skips::elements, "linear elements: K once, one for congruent elements; forces by K u"},
    {"states", &Skips::states,
     "linear elements: stress only where an output asks; displacements of condensed regions"},
    {"condensation", &Skips::condensation, "a large linear region leaves the iterations"},
    {"repeats", &Skips::repeats, "an increment like the linear one before it"},
    {"contraction", &Skips::contraction, "large systems: factors kept while Newton contracts well"},
    {"twins", &Skips::twins, "parts of the matrix that repeat are eliminated once"},
    {"prediction", &Skips::prediction, "increments start from the change of the one before"},
}};

}  // namespace sage

// Catalogue codes of the solvers, as decks write them.
#pragma once

namespace sage::solver_code {

inline constexpr int skyline_lu = 1;
inline constexpr int skyline_ldlt = 2;
inline constexpr int cholmod = 3;
inline constexpr int umfpack = 4;
inline constexpr int frontal = 5;
inline constexpr int mumps = 6;  // only where the library was found
inline constexpr int frontal_ldlt = 8;

}  // namespace sage::solver_code

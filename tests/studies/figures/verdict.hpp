// Verdicts on the chapter's sentences, computed from the checks.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/studies/figures/evaluate.hpp"

namespace sage::figures {

enum class Verdict { holds, away_from_corner, artefact, depends_on_k_j, does_not_hold };
const char* name_of(Verdict verdict);

// Numbers of a check, [Elements][0 everywhere, 1 away from the corner], and whether they pass.
struct Outcome {
  double k_j = 0.0;  // of the lubricated platen; 0 = the check does not depend on it
  std::array<std::array<double, 2>, 2> number{};
  std::array<std::array<bool, 2>, 2> pass{};
};
// Of one K_j.
Verdict verdict_of(const Outcome& outcome);
// Of all of them.
Verdict verdict_of(const std::vector<Outcome>& outcomes);

struct Result {
  const Check* check = nullptr;
  std::vector<Outcome> outcomes;  // one, or one a K_j
  Verdict verdict = Verdict::does_not_hold;
  bool b_bar_only = false;    // does not hold as published, but with B-bar
  bool near_limit = false;    // another one, if numbers within 5 percent of a limit lay on its other side
  std::string shown_to_fail;  // the alterations that the check sees; "itself" where it does not hold anywhere
};

// Whether the verdict is decided by numbers that are near a limit of the check (is_near_limit).
bool near_limit(const Check& check, const std::vector<Outcome>& outcomes);
// "holds", "holds (near the limit)"
std::string verdict_words(const Result& result);

// The lubricated platen's K_j by name.
struct StiffnessChoice {
  std::string name;
  double k_j = 0.0;
};

// The K_j for which the largest |conf / 50 psi - 1| away from the corner is `percent` at 10 percent of strain, with full
// elements, to 1e-3 of itself; 0 where none between 1e-3 and 1e5 does.
double fitted_k_j(const scenes::Workbench& bench, double percent = 3.0);

std::vector<Result> evaluate(Runs& runs, std::span<const Check> checks,
                             const std::vector<StiffnessChoice>& choices);

}  // namespace sage::figures

// What comes of a sweep: one table in the order of the cases, one plot, and what they say on a screen.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sage/sweep/probability.hpp"
#include "sage/sweep/sweep.hpp"

namespace sage::sweep {

// case, the names, the quantities, fails (where there is a rule), status, same_as, warnings, reason.  The same bytes for
// the same cases, whatever computed them and in which order.  page: the file of a case, a column behind the others.
std::string csv_text(const Sweep& sweep, const SweepResult& result, int digits,
                     const std::function<std::string(CaseKey)>& page = {});

// The values of a case in words, "material.1.nu = 0.3, refine = 1".
std::string case_words(const Study& study, std::size_t index);

// Of the cases with an answer, for each combination of the values that are not drawn.
struct FailureRow {
  std::string combination;                    // "material.1.nu = 0.3"; empty: there is one alone
  long failures = 0, cases = 0, without = 0;  // without an answer
  Probability probability;
};
std::vector<FailureRow> failure_rows(const Sweep& sweep, const SweepResult& result);

// A quantity over a name, as the study chooses them.
std::string plot_text(const Sweep& sweep, const SweepResult& result);

std::string summary_text(const Sweep& sweep, const SweepResult& result);

}  // namespace sage::sweep

// The page and the table that `sagefe figures` writes.
#pragma once

#include <string>
#include <vector>

#include "tests/studies/figures/verdict.hpp"

namespace sage::figures {

// What is computed for a check: "largest |sigma_r - correct| / correct deviator stress, conv, 10 %".
std::string what_of(const Check& check);
// "at most 0.33", "0.4 to 0.6"
std::string limits_of(const Check& check);
// "figure_7_04.svg"
std::string file_of(int figure, const std::string& ending = "svg");
// "L/D = 2, pinned ends, linear elastic, E = 3000 psi, nu = 0.495, cell pressure 50 psi; 14 x 28 elements"
std::string parameters_of(const Scene& scene);
const Caption& caption_of(int figure);

// "holds: 9 (1 near the limit), does not hold: 2"; figure 0: of all
std::string tally(const std::vector<Result>& results, int figure);

// What one K_j of the lubricated platen gives beside what the chapter prints.
struct StiffnessRow {
  StiffnessChoice choice;
  struct Entry {
    std::string what;
    double computed = 0.0, printed = 0.0, tolerance = 0.0;  // half of the last printed digit
    bool meets() const;
  };
  std::vector<Entry> entries;  // Tables 7.3 and 7.4, phi = 0.8
};
std::vector<StiffnessRow> stiffness_rows(Runs& runs, const std::vector<StiffnessChoice>& choices);

struct Evaluation {
  std::vector<int> figures;
  std::vector<Result> results;
  std::vector<StiffnessRow> stiffness;
};
// Markdown that shows the figures by links to files beside it.
std::string page_text(const Evaluation& all, const std::string& picture_ending);
// A row a check and K_j.
std::string csv_text(const std::vector<Result>& results);

}  // namespace sage::figures

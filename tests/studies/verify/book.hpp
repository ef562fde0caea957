// All cases, and what is written about them.
#pragma once

#include <string>
#include <vector>

#include "tests/studies/verify/record.hpp"

namespace sage::verify {

std::vector<Section> book();

// A section's cases that were run.
struct Chapter {
  std::string title;
  std::vector<CaseResult> outcomes;
};

// One line a case and geometry, the row that comes closest to its gate; with_rows: every row.
std::string table_text(const Chapter& chapter, bool with_rows);
std::string table_header();
std::string csv_text(const std::vector<Chapter>& chapters);
// docs/verification.md; picture_folder: where the plots will stand, relative to it.
std::string markdown_text(const std::vector<Chapter>& chapters, const std::string& picture_folder);

struct NamedPicture {
  std::string file, svg;
};
// A plot of the errors for every case with sequences.
std::vector<NamedPicture> pictures(const std::vector<Chapter>& chapters);

}  // namespace sage::verify

// sagefe tables --large: Tables 7.3 and 7.4 under large strain, with platens that end at the specimen's rim and with wider ones
// onto which its side may roll.
#pragma once

#include <filesystem>
#include <vector>

#include "sage/app/chapter_tables.hpp"
#include "sage/core/catalogue.hpp"

namespace sage::app {

struct LargeStudy {
  std::vector<double> poissons_ratios{0.25, 0.333, 0.495};  // of Table 7.3
  bool plastic = true;                                      // Table 7.4 too
  std::vector<double> strains{0.02, 0.05, 0.10, 0.15, 0.20};
  double platen = 2.0;  // radius of the wide ones over the specimen's
  int increments = 40;
  double fineness = 1.0;  // of the meshes
};

// Runs all specimens, prints their tables, and writes FOLDER/large_specimens.csv and, of each specimen, a model file.  Throws
// OutputError; what ends a test early is printed.
void print_large_tables(const LargeStudy& study, const std::vector<ChapterEntry>& chapter,
                        const std::filesystem::path& folder, const Catalogue& catalogue);

}  // namespace sage::app

// sagefe tables --water: what rough platens do to a closed specimen whose water is free to move, beside one whose water is
// shut in everywhere.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage::app {

// How fine a specimen is computed.
struct Fineness {
  int columns, steps;  // steps: of each part of a third of a decade, or of a thirtieth of the clay's strain
  std::string element;
};

struct WaterStudy {
  std::vector<double> poissons_ratios{0.2, 0.25, 0.333}, slenderness{1.0, 2.0};  // of elastic skeletons
  std::vector<double> ocr{1.0, 2.0, 4.0, 8.0};                                   // of Cam clay
  Fineness elastic{32, 8, "quad9p4"}, clay{9, 2, "quad8p4"};
};

// Runs all specimens, prints their tables, and writes FOLDER/closed_specimens.csv and, of each specimen, a model file.
// Throws OutputError, and AnalysisError where an elastic specimen finds no equilibrium; what ends a clay's test early is
// printed.
void print_water_tables(const WaterStudy& study, const std::filesystem::path& folder,
                        const Catalogue& catalogue);

}  // namespace sage::app

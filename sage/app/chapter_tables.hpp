// The numbers of the source chapter's Tables 7.3 and 7.4, with the decks that give them: legacy_inputs/chapter7/tables.csv.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sage::app {

// A line of tables.csv.
struct ChapterEntry {
  std::string table, row, column, deck;
  int stage = 0, increment = 0;
  double chapter = 0.0,
         converged = 0.0;  // converged: of small strains in the limit of fine meshes; 0 = not known
};

// Throws InputError where the file can't be read.
std::vector<ChapterEntry> read_chapter_entries(const std::filesystem::path& cases);

}  // namespace sage::app

// A CSV file of a run read back, for plots: reports, increments, points, tables of --converge.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sage {

struct CsvTable {
  struct Column {
    std::string name, unit;      // "measured_deviator", "psi"; empty = none, "-" of a pure number
    std::vector<double> values;  // one a row; NaN where the cell is blank or no number
  };
  // A cell that is neither blank nor a finite number.
  struct Word {
    int line = 0;  // of the file, from 1
    std::size_t column = 0;
    std::string text;
  };

  std::vector<std::string> comments;  // without "# "; the first is the title
  std::vector<Column> columns;        // all of one length
  std::vector<int> lines;             // of the rows in the file, from 1
  std::vector<Word> words;
  bool ended = true;  // by the end of a line: else the file may be cut short

  std::string title() const { return comments.empty() ? "" : comments.front(); }
  // nullptr = there is none.
  const Column* find(const std::string& name) const;
  // "stage, increment, ..."
  std::string names() const;
};

// Blanks around names and numbers don't count.  Throws InputError where the file can't be read, has no line of names, or a row with too many or too few cells.
CsvTable read_csv_table(const std::filesystem::path& file);

}  // namespace sage

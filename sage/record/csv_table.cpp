#include "sage/record/csv_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "sage/messages/error.hpp"
#include "sage/messages/parse_number.hpp"

namespace sage {

namespace {

// Cells between commas; one in double quotes may hold commas.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::string trimmed(const std::string& cell) {
  const std::size_t first = cell.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return cell.substr(first, cell.find_last_not_of(" \t") - first + 1);
}

// "force[lbf]", also "force [lbf]" and "force [ lbf ]" of other programs.
CsvTable::Column column_of(const std::string& cell) {
  const std::size_t bracket = cell.find('[');
  if (bracket == std::string::npos || cell.back() != ']') return {cell, "", {}};
  return {trimmed(cell.substr(0, bracket)), trimmed(cell.substr(bracket + 1, cell.size() - bracket - 2)), {}};
}

double number_of(const std::string& cell) {
  const std::string_view digits = std::string_view(cell).substr(cell.starts_with('+') ? 1 : 0);
  return parse_number<double>(digits).value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

const CsvTable::Column* CsvTable::find(const std::string& name) const {
  for (const Column& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

std::string CsvTable::names() const {
  std::string all;
  for (const Column& column : columns) all += (all.empty() ? "" : ", ") + column.name;
  return all;
}

CsvTable read_csv_table(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError("S101", {file.string(), 0, 0, 0}, "can't be opened");
  CsvTable table;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    table.ended = !stream.eof();
    if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // the mark that spreadsheets write
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    if (line.front() == '#') {
      table.comments.push_back(line.substr(line.size() > 1 && line[1] == ' ' ? 2 : 1));
      continue;
    }
    std::vector<std::string> cells = cells_of(line);
    for (std::string& cell : cells) cell = trimmed(cell);
    if (table.columns.empty()) {
      for (const std::string& cell : cells) table.columns.push_back(column_of(cell));
      continue;
    }
    if (cells.size() != table.columns.size())
      throw InputError(
          "S641", {file.string(), number, 0, 0},
          fmt::format("{} cells, where the line of names has {}", cells.size(), table.columns.size()));
    table.lines.push_back(number);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double value = number_of(cells[i]);
      table.columns[i].values.push_back(value);
      if (!cells[i].empty() && !std::isfinite(value)) table.words.push_back({number, i, cells[i]});
    }
  }
  if (table.columns.empty())
    throw InputError("S641", {file.string(), 0, 0, 0}, "has no line with the names of columns");
  return table;
}

}  // namespace sage

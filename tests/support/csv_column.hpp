// Columns of CSV files.
#pragma once

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace sage::test {

// Numbers of a column, by its name without the unit; NaN where a cell is blank.  Empty: there is no such column.
inline std::vector<double> csv_column(const std::string& csv, const std::string& name) {
  std::vector<double> numbers;
  std::ptrdiff_t at = -1;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (line.ends_with(',')) cells.emplace_back();
    if (at < 0) {
      const auto is = [&](const std::string& cell) { return cell.substr(0, cell.find('[')) == name; };
      at = std::find_if(cells.begin(), cells.end(), is) - cells.begin();
      if (at == std::ssize(cells)) return {};
    } else {
      const std::string& cell = cells.at(at);
      numbers.push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell));
    }
  }
  return numbers;
}

}  // namespace sage::test

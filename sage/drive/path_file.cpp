#include "sage/drive/path_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "sage/messages/error.hpp"
#include "sage/record/csv_table.hpp"

namespace sage::drive {

namespace {

constexpr double kMostSteps = 1e6;

class PathTable {
 public:
  PathTable(const std::filesystem::path& file, int law_size)
      : file_(file.string()), size_(law_size), table_(read_csv_table(file)) {}

  std::size_t rows() const { return table_.lines.size(); }
  bool has(std::string_view column) const { return table_.find(std::string(column)) != nullptr; }
  // NaN = blank; all others are finite, since expect_columns() rejects words, "inf" among them.
  double value(std::string_view column, std::size_t row) const {
    const CsvTable::Column* found = table_.find(std::string(column));
    return found == nullptr ? std::nan("") : found->values[row];
  }
  [[noreturn]] void fail(std::size_t row, const std::string& message) const {
    throw InputError("S650", {file_, table_.lines[row], 0, 0}, message);
  }

  void expect_columns() const {
    std::string known;
    for (int i = 0; i < size_; ++i)
      known += fmt::format("{}, {}, ", stress_column(size_, i), strain_column(size_, i));
    known += "steps, duration";
    for (const CsvTable::Column& column : table_.columns) {
      bool good = column.name == "steps" || column.name == "duration";
      for (int i = 0; i < size_; ++i)
        good = good || column.name == stress_column(size_, i) || column.name == strain_column(size_, i);
      if (!good) throw InputError("S650", {file_}, fmt::format("column {} is none of {}", column.name, known));
    }
    if (table_.words.empty()) return;
    const CsvTable::Word& word = table_.words.front();
    throw InputError("S650", {file_, word.line, 0, 0},
                     fmt::format("column {}: {} is no number", table_.columns[word.column].name, word.text));
  }

 private:
  std::string file_;
  int size_;
  CsvTable table_;
};

// The normal strain that keeps the volume: the one without a column.
int closing_component(const PathTable& table, const std::filesystem::path& file) {
  int closing = -1, absent = 0;
  for (int i = 0; i < 3; ++i) {
    if (table.has(stress_column(4, i)))
      throw InputError(
          "S650", {file.string()},
          fmt::format("{}: an undrained path is one of strains; its effective normal stresses are what "
                      "it is to find",
                      stress_column(4, i)));
    if (table.has(strain_column(4, i))) continue;
    closing = i;
    ++absent;
  }
  if (absent != 1)
    throw InputError(
        "S650", {file.string()},
        "an undrained path has two of strain_xx, strain_yy and strain_zz; the third keeps the volume");
  return closing;
}

Goal goal_at(const PathTable& table, int law_size, int component, std::size_t row) {
  const double stress = table.value(stress_column(law_size, component), row);
  const double strain = table.value(strain_column(law_size, component), row);
  if (!std::isnan(stress) && !std::isnan(strain))
    table.fail(row, fmt::format("{} and {} are both given; a component has one of them",
                                stress_column(law_size, component), strain_column(law_size, component)));
  if (!std::isnan(stress)) return {Control::stress, stress};
  return {Control::strain, strain};  // NaN: stays
}

Leg leg_at(const PathTable& table, int law_size, std::size_t row, int steps) {
  Leg leg{{}, steps, 1.0};
  for (int i = 0; i < law_size; ++i) leg.goals.push_back(goal_at(table, law_size, i, row));
  if (const double n = table.value("steps", row); !std::isnan(n)) {
    if (n < 1.0 || n > kMostSteps || n != std::floor(n))
      table.fail(row, fmt::format("steps: wanted a whole number from 1 to {:g}, not {:g}", kMostSteps, n));
    leg.steps = static_cast<int>(n);
  }
  if (const double time = table.value("duration", row); !std::isnan(time)) {
    if (!(time > 0.0)) table.fail(row, fmt::format("duration: must be above 0; it is {:g}", time));
    leg.duration = time;
  }
  return leg;
}

// The strain of the component that keeps the volume, from those of the other two.
void close_volume(std::vector<Leg>& legs, int closing) {
  std::array<double, 3> strain{};
  for (Leg& leg : legs) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (i == closing) continue;
      const double value = leg.goals[i].value;
      double& known = strain[i];
      if (!std::isnan(value)) known = value;
      sum += known;
    }
    leg.goals[closing] = {Control::strain, -sum};
  }
}

}  // namespace

std::vector<Leg> read_path(const std::filesystem::path& file, int law_size, bool undrained, int steps) {
  const PathTable table(file, law_size);
  table.expect_columns();
  if (table.rows() == 0) throw InputError("S650", {file.string()}, "has no row of the path");
  const int closing = undrained && law_size == 4 ? closing_component(table, file) : -1;
  std::vector<Leg> legs;
  for (std::size_t row = 0; row < table.rows(); ++row) legs.push_back(leg_at(table, law_size, row, steps));
  if (closing >= 0) close_volume(legs, closing);
  return legs;
}

}  // namespace sage::drive

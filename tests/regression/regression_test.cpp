// Runs every case of legacy_inputs that has an expected.csv (for deck.dat) or STEM.expected.csv (for the deck
// STEM.*) and compares, row by row, with the tolerance that stands there.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::app {
namespace {

namespace fs = std::filesystem;

struct Expected {
  std::string quantity;
  int stage = 0, increment = 0;
  double value = 0.0, tolerance = 0.0;
  std::string options, source;
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  cells.resize(std::max<std::size_t>(cells.size(), 7));
  return cells;
}

std::vector<Expected> read_expected(const fs::path& path) {
  std::ifstream in(path);
  std::vector<Expected> rows;
  std::string line;
  bool header = true;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (std::exchange(header, false)) continue;
    const auto c = cells_of(line);
    rows.push_back({c[0], std::stoi(c[1]), std::stoi(c[2]), std::stod(c[3]), std::stod(c[4]), c[5], c[6]});
  }
  return rows;
}

// "--formulation 2 --element 2", as on the command line of `sagefe run`.
BuildOptions options_of(const std::string& text) {
  BuildOptions options;
  std::stringstream stream(text);
  for (std::string key, value; stream >> key >> value;) {
    if (key == "--formulation") options.formulation = std::stoi(value);
    if (key == "--element") options.element = std::stoi(value);
    if (key == "--geometry") options.geometry = std::stoi(value);
    if (key == "--refine") options.refine = std::stoi(value);
    if (key == "--grade") options.gradings.push_back(grading_from(value));
  }
  return options;
}

fs::path scratch() {
  return test::scratch_folder("regression");
}

// "--layout sg_p61"; empty = found from the deck.
std::string layout_of(const std::string& text) {
  std::stringstream stream(text);
  for (std::string key, value; stream >> key >> value;)
    if (key == "--layout") return value;
  return "";
}

RunOutcome run_case(const fs::path& deck, const std::string& options) {
  RunRequest request;
  request.deck = deck.string();
  request.quiet = true;
  request.input.build = options_of(options);
  request.input.layout = layout_of(options);
  request.output.folder = scratch();
  request.output.points = true;
  request.output.nodes = true;
  return run_deck(request, full_catalogue());
}

// A column of a comma-separated table: the row whose first cells are `keys`.
double table_value(const fs::path& path, const std::vector<std::string>& keys, const std::string& column) {
  std::ifstream in(path);
  std::string line;
  std::vector<std::string> header;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    const auto cells = cells_of(line);
    if (header.empty()) {
      header = cells;
      continue;
    }
    bool match = true;
    for (std::size_t i = 0; i < keys.size(); ++i) match = match && (keys[i].empty() || cells[i] == keys[i]);
    if (!match) continue;
    for (std::size_t i = 0; i < header.size(); ++i)
      if (header[i].substr(0, header[i].find('[')) == column) return std::stod(cells[i]);
  }
  return std::nan("");
}

double quantity_of(const RunOutcome& outcome, const fs::path& deck, const Expected& row) {
  std::vector<std::string> part;
  std::stringstream stream(row.quantity);
  for (std::string p; std::getline(stream, p, '.');) part.push_back(p);
  if (part[0] == "report1") {
    for (const TriaxialRow& r : outcome.reports->triaxial(0))
      if (r.stage == row.stage && r.increment == row.increment)
        return part[1] == "ratio" ? r.ratio : part[1] == "force" ? r.force : r.measured_deviator;
    for (const NodesRow& r : outcome.reports->nodes(0))
      if (r.stage == row.stage && r.increment == row.increment && part[1] == "fy") return r.force[1];
    return std::nan("");
  }
  const std::string stage = std::to_string(row.stage), increment = std::to_string(row.increment);
  if (part[0] == "node")  // node.NUMBER.column
    return table_value(scratch() / (case_name(deck.string()) + ".nodes.csv"), {stage, increment, part[1]},
                       part[2]);
  if (part[0] == "point")  // point.ELEMENT.POINT.column
    return table_value(scratch() / (case_name(deck.string()) + ".points.csv"),
                       {stage, increment, "", part[1], part[2]}, part[3]);
  const fs::path nodes = scratch() / (case_name(deck.string()) + ".nodes.csv");
  if (part[0] == "step")  // step.NUMBER.column: what the increment adds
    return table_value(nodes, {stage, increment, part[1]}, part[2]) -
           table_value(nodes, {stage, std::to_string(row.increment - 1), part[1]}, part[2]);
  if (part[0] == "exit_code") return outcome.exit_code;
  if (part[0] == "load_factor")  // of the last state
    return table_value(scratch() / (case_name(deck.string()) + ".increments.csv"), {stage, increment},
                       "load_factor");
  // interface.ELEMENT.POINT.column
  const fs::path table = scratch() / (case_name(deck.string()) + ".interfaces.csv");
  return table_value(table, {stage, increment, "", part[1], part[2]}, part[3]);
}

// deck.dat beside expected.csv, STEM.anything beside STEM.expected.csv.
fs::path deck_of(const fs::path& expected) {
  if (expected.filename() == "expected.csv") return expected.parent_path() / "deck.dat";
  const std::string stem = expected.stem().stem().string();
  for (const auto& entry : fs::directory_iterator(expected.parent_path())) {
    const std::string ending = entry.path().extension().string();
    if (entry.path().stem() == stem && ending != ".csv" && ending != ".res" && ending != ".md")
      return entry.path();
  }
  return {};
}

class RegressionCase : public testing::TestWithParam<std::string> {};

TEST_P(RegressionCase, AgreesWithExpectedCsv) {
  const fs::path expected = fs::path(SAGE_SOURCE_DIR) / "legacy_inputs" / GetParam();
  const fs::path deck = deck_of(expected);
  const std::vector<Expected> rows = read_expected(expected);
  ASSERT_FALSE(rows.empty());
  // A case may end without equilibrium, if that is what it shows.
  const bool stops =
      std::any_of(rows.begin(), rows.end(), [](const Expected& r) { return r.quantity == "exit_code"; });
  std::map<std::string, RunOutcome> runs;
  for (const Expected& row : rows) {
    if (!runs.count(row.options)) runs.emplace(row.options, run_case(deck, row.options));
    const RunOutcome& outcome = runs.at(row.options);
    if (!stops) {
      ASSERT_EQ(outcome.exit_code, 0) << outcome.record.result.reason;
    }
    EXPECT_LT(outcome.record.out_of_balance, 1e-7) << "equilibrium of the whole model";
    EXPECT_NEAR(quantity_of(outcome, deck, row), row.value, row.tolerance)
        << row.quantity << " stage " << row.stage << " increment " << row.increment << " " << row.options
        << " (" << row.source << ")";
  }
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  const fs::path root = fs::path(SAGE_SOURCE_DIR) / "legacy_inputs";
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.path().filename().string().ends_with("expected.csv"))
      names.push_back(fs::relative(entry.path(), root).string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(LegacyInputs, RegressionCase, testing::ValuesIn(cases()), [](const auto& one) {
  std::string name = one.param.substr(0, one.param.rfind("expected.csv") - 1);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
}  // namespace sage::app

// Runs every case of legacy_inputs that has an expected.csv (for deck.dat) or STEM.expected.csv (for the deck
// STEM.*) and compares, row by row, with the tolerance that stands there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/page/page.hpp"
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

// The cells of a comma-separated table; the last one read is kept.
const std::vector<std::vector<std::string>>& table_cells(const fs::path& path) {
  static std::pair<fs::path, fs::file_time_type> kept;
  static std::vector<std::vector<std::string>> rows;
  const std::pair<fs::path, fs::file_time_type> now{path, fs::last_write_time(path)};
  if (now == kept) return rows;
  kept = now;
  rows.clear();
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#') rows.push_back(cells_of(line));
  return rows;
}

// A column of a table: the row whose first cells are `keys`.
double table_value(const fs::path& path, const std::vector<std::string>& keys, const std::string& column) {
  const auto& rows = table_cells(path);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    bool match = true;
    for (std::size_t i = 0; i < keys.size(); ++i) match = match && (keys[i].empty() || rows[r][i] == keys[i]);
    if (!match) continue;
    for (std::size_t i = 0; i < rows[0].size(); ++i)
      if (rows[0][i].substr(0, rows[0][i].find('[')) == column) return std::stod(rows[r][i]);
  }
  return std::nan("");
}

double one_quantity(const RunOutcome& outcome, const fs::path& deck, const Expected& row) {
  std::vector<std::string> part;
  std::stringstream stream(row.quantity);
  for (std::string p; std::getline(stream, p, '.');) part.push_back(p);
  if (part[0].starts_with("report")) {
    const auto report = static_cast<std::size_t>(std::stoi(part[0].substr(6))) - 1;
    for (const TriaxialRow& r : outcome.reports->triaxial(report))
      if (r.stage == row.stage && r.increment == row.increment)
        return part[1] == "ratio" ? r.ratio : part[1] == "force" ? r.force : r.measured_deviator;
    for (const NodesRow& r : outcome.reports->nodes(report))
      if (r.stage == row.stage && r.increment == row.increment && part[1][0] == 'f')
        return r.force[part[1] == "fx" ? 0 : 1];
    for (const DischargeRow& r : outcome.reports->discharges(report))
      if (r.stage == row.stage && r.increment == row.increment)
        return part[1] == "discharge"  ? r.discharge
               : part[1] == "gradient" ? r.gradient
               : part[1] == "head"     ? r.head
                                       : r.force[part[1] == "fx" ? 0 : 1];
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
  if (part[0] == "end")  // end.ELEMENT.END.column, of a structure
    return table_value(scratch() / (case_name(deck.string()) + ".ends.csv"),
                       {stage, increment, "", part[1], part[2]}, part[3]);
  if (part[0] == "sum") {  // sum.FIRST.LAST.STEP.column: over nodes
    double sum = 0.0;
    for (int node = std::stoi(part[1]); node <= std::stoi(part[2]); node += std::stoi(part[3]))
      sum += table_value(nodes, {stage, increment, std::to_string(node)}, part[4]);
    return sum;
  }
  if (part[0] == "level") {  // level.Y.column: over all nodes at a height
    const auto& rows = table_cells(nodes);
    const auto at = [&](const std::string& name) {
      const auto found = std::ranges::find_if(
          rows.front(), [&](const std::string& cell) { return cell.substr(0, cell.find('[')) == name; });
      return static_cast<std::size_t>(found - rows.front().begin());
    };
    const std::size_t y = at("y"), column = at(part[2]);
    double sum = 0.0;
    for (const auto& cells : rows)
      if (cells[0] == stage && cells[1] == increment && std::stod(cells[y]) == std::stod(part[1]))
        sum += std::stod(cells[column]);
    return sum;
  }
  // pressed.FIRST.LAST.column: over interface4 of length 1, each of whose points stands for a half.
  if (part[0] == "pressed") {
    const fs::path table = scratch() / (case_name(deck.string()) + ".interfaces.csv");
    double sum = 0.0;
    for (int element = std::stoi(part[1]); element <= std::stoi(part[2]); ++element)
      for (const char* point : {"1", "2"})
        sum += 0.5 * table_value(table, {stage, increment, "", std::to_string(element), point}, part[3]);
    return sum;
  }
  if (part[0] == "strength") {  // strength.ROW.largest: displacement of one strength factor
    const std::vector<StrengthRow>& factors = outcome.record.strength.rows();
    const auto at = static_cast<std::size_t>(std::stoi(part[1])) - 1;
    return at < factors.size() ? factors[at].largest : std::nan("");
  }
  if (part[0] == "moment_x") {  // moment_x.FIRST.LAST: sum over nodes of the reaction along x times y
    double sum = 0.0;
    for (int node = std::stoi(part[1]); node <= std::stoi(part[2]); ++node)
      sum += table_value(nodes, {stage, increment, std::to_string(node)}, "reaction_x") *
             table_value(nodes, {stage, increment, std::to_string(node)}, "y");
    return sum;
  }
  if (part[0] ==
      "front") {  // front.FIRST.LAST: elements' mean stress xx at their two left points times their height
    double sum = 0.0;
    const fs::path points = scratch() / (case_name(deck.string()) + ".points.csv");
    for (int element = std::stoi(part[1]); element <= std::stoi(part[2]); ++element) {
      std::vector<std::array<double, 3>> at;  // x, y, stress
      for (int p = 1; p <= 4; ++p) {
        const std::vector<std::string> keys{stage, increment, "", std::to_string(element), std::to_string(p)};
        at.push_back({table_value(points, keys, "x"), table_value(points, keys, "y"),
                      table_value(points, keys, "stress_xx")});
      }
      std::sort(at.begin(), at.end());
      sum += std::abs(at[1][1] - at[0][1]) * std::sqrt(3.0) * 0.5 * (at[0][2] + at[1][2]);  // 2 x 2 Gauss
    }
    return sum;
  }
  if (part[0] == "exit_code") return outcome.exit_code;
  if (part[0] == "load_factor")  // of the last state
    return table_value(scratch() / (case_name(deck.string()) + ".increments.csv"), {stage, increment},
                       "load_factor");
  // interface.ELEMENT.POINT.column
  const fs::path table = scratch() / (case_name(deck.string()) + ".interfaces.csv");
  return table_value(table, {stage, increment, "", part[1], part[2]}, part[3]);
}

// "a + 2*b - c@4.1": terms with factors, each of the row's stage and increment or of its own.
double quantity_of(const RunOutcome& outcome, const fs::path& deck, const Expected& row) {
  double sum = 0.0, sign = 1.0;
  std::stringstream stream(row.quantity);
  for (std::string term; stream >> term;) {
    if (term == "+" || term == "-") {
      sign = term == "+" ? 1.0 : -1.0;
      continue;
    }
    Expected one = row;
    double factor = sign;
    if (const std::size_t times = term.find('*'); times != std::string::npos) {
      factor *= std::stod(term.substr(0, times));
      term.erase(0, times + 1);
    }
    if (const std::size_t at = term.find('@'); at != std::string::npos) {
      const std::size_t dot = term.find('.', at);
      one.stage = std::stoi(term.substr(at + 1, dot - at - 1));
      one.increment = std::stoi(term.substr(dot + 1));
      term.erase(at);
    }
    one.quantity = term;
    sum += factor * one_quantity(outcome, deck, one);
  }
  return sum;
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

// docs/verification/textbook.md: the textbook's printed numbers beside this program's, from the same files.

std::string page_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// The comment lines of an expected.csv.
std::string reason_of(const fs::path& expected) {
  std::ifstream in(expected);
  std::string text;
  for (std::string line; std::getline(in, line) && !line.empty() && line[0] == '#';)
    text += (text.empty() ? "" : " ") + line.substr(std::min<std::size_t>(2, line.size()));
  return text;
}

void add_rows(Page& page, const std::vector<Expected>& rows, const std::vector<double>& ours) {
  constexpr std::size_t kMostRows = 40;  // longer tables are told in one sentence if every digit agrees
  std::size_t exact = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    exact += page_number(ours[i]) == page_number(rows[i].value) || std::abs(ours[i] - rows[i].value) <= 1e-12
                 ? 1
                 : 0;
  const std::string count = std::to_string(rows.size()) + " printed numbers, ";
  if (rows.size() > kMostRows && exact + 2 >= rows.size())
    return page.prose(count +
                      "all of them equal here to the last printed digit, except at most two that round to the "
                      "neighbouring digit.");
  page.prose(count + "and the number of those that are equal here to the last printed digit is " +
             std::to_string(exact) + ".");
  page.table({"quantity", "stage", "increment", "printed", "here", "difference", "from"});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Expected& row = rows[i];
    char relative[32] = "0";
    if (row.value != 0.0)
      std::snprintf(relative, sizeof relative, "%+.3f %%", 100.0 * (ours[i] - row.value) / std::abs(row.value));
    page.row({row.quantity, std::to_string(row.stage), std::to_string(row.increment), page_number(row.value),
              page_number(ours[i]), relative, row.source});
  }
}

std::string textbook_page() {
  Page page("Textbook decks beside their printed results");
  page.note("Written by the test TextbookPage with SAGE_WRITE_MANUAL=1: run it again, do not edit.");
  page.prose(
      "Decks and printed results of Smith and Griffiths, *Programming the Finite Element Method*, 5th edition "
      "(`legacy_inputs/smith_griffiths`), run under the layouts `sg_*`. Each table is in `STEM.expected.csv` "
      "too, with "
      "the tolerance of the regression tests. The quantities `node.NUMBER.column` and "
      "`point.ELEMENT.POINT.column` are values of the result tables. `step.NUMBER.column` is the change of a "
      "nodal value in the increment. `strength.ROW.largest` is the largest displacement in a row of the table "
      "of strength factors, and `report1.column` a value of the first report. `front.FIRST.LAST` is the "
      "horizontal force that follows from the stresses at the left points of these elements. "
      "`moment_x.FIRST.LAST` is the moment of the horizontal reactions of these nodes about y = 0. The reasons "
      "for differences "
      "were found by running the book's own iterations on the same mesh and points "
      "(`tests/verification/textbook_test.cpp`).");
  for (const std::string& name : cases()) {
    if (!name.starts_with("smith_griffiths/")) continue;
    const fs::path expected = fs::path(SAGE_SOURCE_DIR) / "legacy_inputs" / name;
    const fs::path deck = deck_of(expected);
    std::vector<Expected> rows = read_expected(expected);
    const RunOutcome outcome = run_case(deck, rows.front().options);
    std::vector<double> ours;
    // What no one printed: how the run ends.
    std::erase_if(rows,
                  [](const Expected& r) { return r.quantity == "exit_code" || r.quantity == "load_factor"; });
    for (const Expected& row : rows) ours.push_back(quantity_of(outcome, deck, row));
    page.heading(2, deck.stem().string());
    if (const std::string reason = reason_of(expected); !reason.empty()) page.prose(reason);
    add_rows(page, rows, ours);
  }
  return page.text();
}

// Words agree, numbers to 0.1 % (or 2e-3 of a percent): the last digit may go either way on another machine.
bool same_page(const std::string& a, const std::string& b) {
  std::stringstream left(a), right(b);
  std::string x, y;
  while (true) {
    const bool more = static_cast<bool>(left >> x);
    if (more != static_cast<bool>(right >> y)) return false;
    if (!more) return true;
    if (x == y) continue;
    char *end_x = nullptr, *end_y = nullptr;
    const double u = std::strtod(x.c_str(), &end_x), v = std::strtod(y.c_str(), &end_y);
    if (*end_x != 0 || *end_y != 0 || std::abs(u - v) > std::max(2e-3, 1e-3 * std::abs(v))) return false;
  }
}

TEST(TextbookPage, IsWrittenDown) {
  const fs::path path = fs::path(SAGE_SOURCE_DIR) / "docs" / "verification" / "textbook.md";
  const std::string page = textbook_page();
  if (std::getenv("SAGE_WRITE_MANUAL") != nullptr) std::ofstream(path) << page;
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_TRUE(same_page(text.str(), page))
      << "run test_regression --gtest_filter=TextbookPage.* with SAGE_WRITE_MANUAL=1";
}

}  // namespace
}  // namespace sage::app

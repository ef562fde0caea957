// sagefe tables: the source chapter's Tables 7.3 and 7.4, rerun from decks, beside the chapter's numbers.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/large_tables.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/water_tables.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/platform/module.hpp"

namespace sage::app {

std::filesystem::path shipped_decks() {
  std::error_code ignored;
  const std::filesystem::path beside = program_folder();
  const auto installed = (beside / SAGE_CASES_RELATIVE).lexically_normal();
  const bool is_there =
      !beside.empty() && std::filesystem::exists(installed / "chapter7" / "tables.csv", ignored);
  return is_there ? installed : std::filesystem::path(SAGE_CASES_DIR);
}

std::vector<ChapterEntry> read_chapter_entries(const std::filesystem::path& cases) {
  const std::filesystem::path path = cases / "tables.csv";
  std::ifstream in(path);
  if (!in)
    throw InputError("S101", {path.string(), 0, 0, 0}, "the list of table entries can't be read (see --cases)");
  std::vector<ChapterEntry> entries;
  std::string line;
  bool header = true;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (std::exchange(header, false)) continue;
    const std::vector<std::string_view> parts = split_at(',', line);
    std::vector<std::string> cells(parts.begin(), parts.end());
    cells.resize(8);
    entries.push_back({cells[0], cells[1], cells[2], cells[3], std::stoi(cells[4]), std::stoi(cells[5]),
                       std::stod(cells[6]), cells[7].empty() ? 0.0 : std::stod(cells[7])});
  }
  return entries;
}

namespace {

struct TableOptions {
  std::filesystem::path cases = shipped_decks() / "chapter7";
  std::filesystem::path folder = "out";
  bool pinned = false, water = false, large = false;
};

std::vector<ChapterEntry> chosen_entries(const TableOptions& options) {
  std::vector<ChapterEntry> entries = read_chapter_entries(options.cases);
  if (options.pinned)
    std::erase_if(entries, [](const ChapterEntry& entry) { return !entry.column.starts_with("pinned"); });
  return entries;
}

double ratio_of(const RunOutcome& outcome, const ChapterEntry& entry) {
  for (const TriaxialRow& row : outcome.reports->triaxial(0))
    if (row.stage == entry.stage && row.increment == entry.increment) return row.ratio;
  return std::nan("");
}

// Decimals of the chapter's ratios, which it prints with four in Table 7.3 and three in Table 7.4, and of computed ones.
struct Decimals {
  int chapter, computed;
};

Decimals decimals_of(const std::string& table) {
  return table == "7.3" ? Decimals{4, 5} : Decimals{3, 3};
}

// "+0.00031"; a number that rounds to zero has a plus.
std::string signed_text(double value, int decimals) {
  std::string text = fmt::format("{:+.{}f}", value, decimals);
  if (text.find_first_of("123456789") == std::string::npos && text.front() == '-') text.front() = '+';
  return text;
}

void print_header(const std::string& table) {
  fmt::print("\nTable {}: measured / correct axial stress\n", table);
  fmt::print("{:<11} {:<19} {:>8}{:>10}{:>11}{:>10}{:>10}\n", "", "", "chapter", "sagefe", "difference",
             "converged", "its error");
}

void print_entry(const ChapterEntry& entry, double ratio) {
  const auto [chapter, computed] = decimals_of(entry.table);
  fmt::print("{:<11} {:<19} {:8.{}f}{:10.{}f}{:>11}", entry.row, entry.column, entry.chapter, chapter, ratio,
             computed, signed_text(ratio - entry.chapter, computed));
  if (entry.converged > 0.0)
    fmt::print("{:10.{}f}{:>9}%", entry.converged, computed,
               signed_text(100.0 * (entry.chapter / entry.converged - 1.0), 2));
  fmt::print("\n");
}

// Where in an increment a joint's law takes k_s, in words: " with k_s ..."; empty where the law has no such rule.
std::string shear_rule_text(const Material& material) {
  constexpr const char* kRules[] = {"at the start", "in the middle", "by its integral"};
  const auto& names = material.entry->parameters;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].name != "shear_rule") continue;
    const std::size_t rule =
        i < material.parameters.size() ? static_cast<std::size_t>(material.parameters[i]) : 0;
    return fmt::format(", k_s {} of each increment (shear_rule {})", kRules[std::min<std::size_t>(rule, 2)],
                       rule);
  }
  return {};
}

// What the decks are made of: "quad4 full", "interface4 row-sum, k_s ...".
std::string pieces_text(const std::map<std::string, RunOutcome>& runs, bool joints) {
  std::set<std::string> pieces;
  for (const auto& [deck, outcome] : runs) {
    if (outcome.model == nullptr) continue;
    for (const Group& group : outcome.model->groups)
      if (joints ? group.interface() : group.solid())
        pieces.insert(group.element_name +
                      (joints ? shear_rule_text(outcome.model->materials[group.material]) : ""));
  }
  std::string text;
  for (const std::string& piece : pieces) text += (text.empty() ? "" : "; ") + piece;
  return text;
}

void print_footer(const std::map<std::string, RunOutcome>& runs, const std::filesystem::path& folder) {
  fmt::print("\nCompression positive. Solids: {}.\n", pieces_text(runs, false));
  if (const std::string joints = pieces_text(runs, true); !joints.empty())
    fmt::print(
        "Joints: {}.\nThe chapter prefers Gauss points for joints and does not print where it takes k_s.\n",
        joints);
  fmt::print(
      "Full 2x2 integration gives the chapter's pinned columns. It locks near nu = 1/2; the converged\n"
      "answer needs b-bar or 8-node elements.\n"
      "Results of all decks: {}\n",
      folder.string());
}

Json entry_json(const ChapterEntry& entry, double ratio) {
  return {{"table", entry.table},
          {"row", entry.row},
          {"column", entry.column},
          {"deck", entry.deck},
          {"stage", entry.stage},
          {"increment", entry.increment},
          {"chapter", entry.chapter},
          {"computed", ratio},
          {"converged", entry.converged > 0.0 ? Json(entry.converged) : Json(nullptr)}};
}

int print_tables(const TableOptions& options, const Catalogue& catalogue) {
  std::map<std::string, RunOutcome> runs;
  std::string table;
  int worst = kOk;
  const std::vector<ChapterEntry> entries = chosen_entries(options);
  Task task("tables");
  int number = 0;
  for (const ChapterEntry& entry : entries) {
    task.part(entry.deck, ++number, static_cast<int>(entries.size()));
    if (!runs.count(entry.deck)) {
      RunRequest request;
      request.deck = (options.cases / entry.deck / "deck.dat").string();
      request.output.folder = options.folder;
      request.quiet = true;
      runs.emplace(entry.deck, run_deck(request, catalogue));
      const RunOutcome& outcome = runs.at(entry.deck);
      worst = std::max(worst, outcome.exit_code);
      if (outcome.exit_code != kOk)
        say_error(request.deck, outcome.record.result.reason, *outcome.record.result.code);
    }
    if (Json* json = answer())
      (*json)["entries"].push_back(entry_json(entry, ratio_of(runs.at(entry.deck), entry)));
    const ProgressPause pause;
    if (entry.table != table) print_header(table = entry.table);
    print_entry(entry, ratio_of(runs.at(entry.deck), entry));
  }
  print_footer(runs, options.folder);
  if (Json* json = answer()) {
    (*json)["solids"] = pieces_text(runs, false);
    (*json)["joints"] = pieces_text(runs, true);
  }
  if (Json* json = answer()) (*json)["folder"] = json_text(options.folder.string());
  return worst;
}

}  // namespace

Command tables_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<TableOptions>();
  parser.add_option("--cases", options->cases,
                    "folder with tables.csv and the decks (default: the program's own, see sagefe list decks)");
  parser.add_option("-o,--output", options->folder, "folder for results (default: out)");
  CLI::Option* pinned = parser.add_flag("--pinned", options->pinned, "only the columns with pinned ends");
  CLI::Option* const water = parser
                                 .add_flag("--water", options->water,
                                           "the same tables for closed specimens whose water is free to move "
                                           "(docs/theory/closed_specimen.md)")
                                 ->excludes(pinned);
  parser
      .add_flag("--large", options->large,
                "the same tables under large strain, up to 20 % (docs/theory/large_specimens.md)")
      ->excludes(pinned)
      ->excludes(water);
  return [options, &catalogue] {
    if (options->water)
      print_water_tables({}, options->folder, catalogue);
    else if (options->large)
      print_large_tables({}, read_chapter_entries(options->cases), options->folder, catalogue);
    else
      return print_tables(*options, catalogue);
    return static_cast<int>(kOk);
  };
}

}  // namespace sage::app

// What the page shows besides the states: summary, tables, messages, pictures, the deck.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "sage/deck/optional_file.hpp"
#include "sage/messages/messages.hpp"
#include "sage/model/dof_map.hpp"
#include "sage/record/csv_table.hpp"
#include "sage/record/values.hpp"
#include "sage/report/run_data.hpp"

namespace sage::report {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDeck = 1000000, kMostPicture = 400000, kMostPictures = 1500000, kMostRows = 20000,
                      kMostAnswer = 20000;

// Files STEM.*ending and STEM_*ending beside the result file, by name.
std::vector<fs::path> beside(const fs::path& result, const std::string& ending) {
  const std::string stem = result.stem().string();
  std::vector<fs::path> files;
  std::error_code error;
  const fs::path folder = result.has_parent_path() ? result.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > stem.size() + ending.size() && name.starts_with(stem) && name.ends_with(ending) &&
        (name[stem.size()] == '.' || name[stem.size()] == '_') && entry.is_regular_file(error))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Tables of places, which the views show.
bool of_places(const std::string& rest) {
  constexpr std::string_view kPlaces[] = {".nodes.csv", ".points.csv", ".interfaces.csv", ".structures.csv",
                                          ".flow.csv",  ".ends.csv",   ".envelope.csv",   ".bounds.fields.csv"};
  return std::ranges::find(kPlaces, rest) != std::end(kPlaces);
}

Json table_json(const CsvTable& table, const std::string& rest) {
  Json columns = Json::array();
  for (const CsvTable::Column& column : table.columns) {
    std::vector<double> values = column.values;
    if (values.size() > kMostRows) values.resize(kMostRows);
    columns.push_back({{"name", clean(column.name)},
                       {"unit", clean(column.unit)},
                       {"values", packed(values, Precision::whole)}});
  }
  return {{"name", clean(rest)}, {"title", clean(table.title())}, {"columns", std::move(columns)}};
}

void note_rows(const std::string& name, const CsvTable& table, std::vector<std::string>& omitted) {
  if (table.lines.size() > kMostRows)
    omitted.push_back(
        fmt::format("{} has {} rows: the page has the first {}", name, table.lines.size(), kMostRows));
}

Json tables_json(const PageRun& run, std::vector<std::string>& omitted) {
  Json tables = Json::array();
  const std::string stem = run.file.stem().string();
  const std::string ending = run.goes_on ? ".csv.partial" : ".csv";
  for (const fs::path& file : beside(run.file, ending)) {
    const std::string name = file.filename().string();
    const std::string rest = name.substr(stem.size(), name.size() - stem.size() - ending.size() + 4);
    if (of_places(rest)) continue;
    try {
      const CsvTable table = read_csv_table(file);
      note_rows(name, table, omitted);
      if (!table.lines.empty()) tables.push_back(table_json(table, rest.substr(1, rest.size() - 5)));
    } catch (const InputError& error) {
      omitted.push_back(std::string(error.what()));
    }
  }
  return tables;
}

Json pictures_json(const PageRun& run, std::vector<std::string>& omitted) {
  Json pictures = Json::array();
  std::size_t all = 0;
  for (const fs::path& file : beside(run.file, ".svg")) {
    const std::string name = file.filename().string();
    std::error_code error;
    const auto size = static_cast<std::size_t>(fs::file_size(file, error));
    if (error) continue;
    if (size > kMostPicture || all + size > kMostPictures) {
      omitted.push_back(fmt::format("the picture {} has {} kB", name, size / 1000));
      continue;
    }
    all += size;
    pictures.push_back({{"name", clean(name)}, {"svg", base64(read_file_if_any(file).value_or(""))}});
  }
  return pictures;
}

const char* severity_word(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

Json message_json(const std::string& severity, const std::string& code, int line, const std::string& text) {
  Json json = {{"severity", severity}, {"code", code}, {"line", line}, {"text", clean(text)}};
  const int number = code.size() > 1 ? std::atoi(code.c_str() + 1) : 0;
  if (const MessageEntry* entry = find_message(number)) {
    json["cause"] = entry->cause;
    json["cure"] = entry->cure;
  }
  return json;
}

// Of the listing: "deck.dat:71: note: the words [S345]".  What the deck alone says is there too.
Json messages_of_listing(const fs::path& listing) {
  static const std::regex kLine(
      R"(^ (\S.*?)(?::(\d+)(?::\d+(?:-\d+)?)?)?: (note|warning|error): (.*) \[(S\d+)\]\s*$)");
  Json messages = Json::array();
  std::ifstream in(listing, std::ios::binary);
  std::set<std::string> seen;
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (line.size() > 4000 || !line.starts_with(' ') || line.find(" [S") == std::string::npos ||
        !std::regex_match(line, match, kLine) || !seen.insert(line).second)
      continue;
    messages.push_back(
        message_json(match[3], match[5], match[2].matched ? std::atoi(match[2].str().c_str()) : 0, match[4]));
  }
  return messages;
}

Json messages_json(const PageRun& run) {
  const fs::path listing = fs::path(run.file).replace_extension(run.goes_on ? ".lst.partial" : ".lst");
  std::error_code error;
  if (fs::is_regular_file(listing, error)) return messages_of_listing(listing);
  Json messages = Json::array();
  for (const Diagnostic& one : run.model.diagnostics.list())
    messages.push_back(
        message_json(severity_word(one.severity), to_string(one.code), one.where.line, one.message));
  return messages;
}

std::string words_under_way(const PageRun& run) {
  if (run.states.empty()) return "being computed";
  return fmt::format(
      "being computed: this page is of stage {}, increment {}; load it again for the present state",
      run.states.back().stage + 1, run.states.back().increment);
}

Json summary_json(const PageRun& run) {
  const Model& model = run.model;
  Json rows = Json::array();
  const auto add = [&](const char* name, const std::string& text) { rows.push_back({name, clean(text)}); };
  const std::string& failure = run.failure;
  add("status", run.goes_on       ? words_under_way(run)
                : failure.empty() ? completed_words(model, 0.0)
                                  : "not converged: " + failure);
  long elements = 0, points = 0;
  for (const Group& group : model.groups) {
    elements += group.elements();
    points += static_cast<long>(group.elements()) * group.element->traits().points;
  }
  add("geometry", model.geometry == Geometry::axisymmetric ? "axisymmetric" : "plane strain");
  add("mesh", fmt::format("{} nodes, {} elements, {} integration points, {} unknowns", model.mesh.nodes(),
                          elements, points, DofMap(model).dofs()));
  const auto& states = run.states;
  add("path", fmt::format("{} of {} stages, {} states kept", states.empty() ? 0 : states.back().stage + 1,
                          model.stages.size(), states.size()));
  add("units", model.units.length == "-"
                   ? "the deck states none"
                   : fmt::format("{}, {}, {}; forces {}", model.units.length, model.units.force,
                                 model.units.stress, forces_per(model)));
  add("signs", "stress and strain compression positive; displacements and forces along the axes");
  add("deck", run.deck_name);
  return rows;
}

// What sagefe safety and sagefe bounds have said beside the run, as on the screen; pages of failed attempts follow a blank
// line.
Json answers_json(const PageRun& run) {
  Json answers = Json::array();
  for (const char* name : {"safety", "bounds"}) {
    const fs::path listing = fs::path(run.file).replace_extension(std::string(".") + name + ".lst");
    std::string text = read_file_if_any(listing).value_or("");
    if (text.empty()) continue;
    text.resize(std::min({text.find("\n\n"), text.size(), kMostAnswer}));
    answers.push_back({{"name", name}, {"text", clean(text)}});
  }
  return answers;
}

// The deck, or where it is long the lines around those that messages name.
Json deck_json(const PageRun& run, std::vector<std::string>& omitted) {
  const std::string& deck = run.deck;
  if (deck.size() <= kMostDeck) return clean(deck);
  const std::size_t end = deck.rfind('\n', kMostDeck);
  omitted.push_back(
      fmt::format("the deck has {} kB: the page has its first {} kB", deck.size() / 1000, end / 1000));
  return clean(std::string_view(deck).substr(0, end));
}

}  // namespace

Json table_of_cases(const std::filesystem::path& file, std::vector<std::string>& omitted) {
  const CsvTable table = read_csv_table(file);
  note_rows(file.filename().string(), table, omitted);
  Json json = table_json(table, file.stem().string());
  json["words"] = Json::array();
  for (const CsvTable::Word& word : table.words) {
    const auto row = std::ranges::lower_bound(table.lines, word.line) - table.lines.begin();
    if (row < static_cast<std::ptrdiff_t>(kMostRows))
      json["words"].push_back({row, word.column, clean(word.text)});
  }
  return json;
}

std::vector<std::string> add_papers(const PageRun& run, Json& json) {
  std::vector<std::string> omitted;
  json["name"] = clean(run.file.stem().string());
  json["failed"] = !run.failure.empty();
  json["summary"] = summary_json(run);
  json["tables"] = tables_json(run, omitted);
  json["pictures"] = pictures_json(run, omitted);
  json["answers"] = answers_json(run);
  json["messages"] = messages_json(run);
  json["left_out"] = Json::array();
  for (const std::string& part : run.model.left_out) json["left_out"].push_back(clean(part));
  json["deck"] = deck_json(run, omitted);
  return omitted;
}

}  // namespace sage::report

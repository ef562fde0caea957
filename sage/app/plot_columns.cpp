// sagefe plot TABLE...: columns of reports against each other.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "sage/app/input.hpp"
#include "sage/app/plot_command.hpp"
#include "sage/app/screen.hpp"
#include "sage/core/unit_suffix.hpp"
#include "sage/draw/plot.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/record/csv_table.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

namespace fs = std::filesystem;

struct Source {
  fs::path file;
  std::string label;
  CsvTable table;
};

// A column, or its negative: "-uy" is the settlement of a footing.
struct Variable {
  std::string name;
  bool negative = false;
};

struct Panel {
  Variable x;
  std::vector<Variable> y;
};

Variable variable_from(std::string_view text) {
  const bool negative = text.starts_with('-');
  return {std::string(text.substr(negative ? 1 : 0)), negative};
}

Panel panel_from(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size())
    throw UsageError("S904", "--xy " + text + ": wanted X:Y[,Y...], names of columns");
  Panel panel{variable_from(std::string_view(text).substr(0, colon)), {}};
  for (const std::string_view name : split_at(',', std::string_view(text).substr(colon + 1)))
    panel.y.push_back(variable_from(name));
  return panel;
}

const CsvTable::Column& column_of(const Source& source, const Variable& variable) {
  const CsvTable::Column* column = source.table.find(variable.name);
  if (column == nullptr)
    throw UsageError("S642", fmt::format("{}: no column {}; it has {}", source.file.string(), variable.name,
                                         source.table.names()));
  return *column;
}

// Says which cells of the columns that are drawn are no numbers: the curve has gaps there.  A table that a run wrote
// ends with the end of a line.
void note_damage(const Source& source, const std::vector<Variable>& variables) {
  const std::string file = source.file.string();
  if (!source.table.ended && !source.table.comments.empty())
    say_warning(file, "the last line has no end: the file may be cut short", "S609");
  std::vector<std::size_t> seen;
  for (const Variable& variable : variables) {
    const CsvTable::Column& column = column_of(source, variable);
    const auto at = static_cast<std::size_t>(&column - source.table.columns.data());
    if (std::ranges::find(seen, at) != seen.end()) continue;
    seen.push_back(at);
    const auto of_column = [&](const CsvTable::Word& word) { return word.column == at; };
    const auto first = std::ranges::find_if(source.table.words, of_column);
    if (first == source.table.words.end()) continue;
    const auto count = std::ranges::count_if(source.table.words, of_column);
    say_warning(
        fmt::format("{}:{}", file, first->line),
        fmt::format("\"{}\" of column {} is no finite number{}: the curve has a gap", first->text, column.name,
                    count > 1 ? fmt::format(", and {} more cells are none", count - 1) : std::string()),
        "S606");
  }
}

std::vector<double> values_of(const Source& source, const Variable& variable) {
  std::vector<double> values = column_of(source, variable).values;
  if (variable.negative)
    for (double& value : values) value = -value;
  return values;
}

std::string words_of(const Variable& variable) {
  std::string words = (variable.negative ? "-" : "") + variable.name;
  std::ranges::replace(words, '_', ' ');
  return words;
}

// Columns of a table that says so; sizes of displacements and forces along the axes are none of them.
bool compression_positive(const Source& source, const Variable& variable) {
  const auto has = [&](std::string_view word) { return variable.name.find(word) != std::string::npos; };
  const bool says = std::ranges::any_of(source.table.comments, [](const std::string& line) {
    return line.find("compression positive") != std::string::npos;
  });
  return says && !variable.negative && (has("strain") || has("stress") || has("axial") || has("deviator"));
}

// What short names of columns stand for, with a comma; empty where one is another's or says it itself.
std::string quantity_of(const std::vector<Variable>& variables) {
  const auto all_are = [&](const char* x, const char* y) {
    return std::ranges::all_of(variables, [&](const Variable& v) { return v.name == x || v.name == y; });
  };
  return all_are("ux", "uy") ? "displacement, " : all_are("fx", "fy") ? "load, " : "";
}

std::string label_of(const Source& source, const std::vector<Variable>& variables) {
  std::string label;
  for (const Variable& variable : variables) label += (label.empty() ? "" : ", ") + words_of(variable);
  label = quantity_of(variables) + label;
  const std::string& unit = column_of(source, variables.front()).unit;
  label += unit == "-" ? " [-]" : unit_suffix(unit);
  if (std::ranges::all_of(variables, [&](const Variable& v) { return compression_positive(source, v); }))
    label += ", compression positive";
  return label;
}

bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

// Such as the correct deviator of decks of one material.
bool same_in_all(const std::vector<Source>& sources, const Variable& x, const Variable& y) {
  return std::ranges::all_of(sources, [&](const Source& source) {
    return same_numbers(values_of(source, x), values_of(sources.front(), x)) &&
           same_numbers(values_of(source, y), values_of(sources.front(), y));
  });
}

// Throws UsageError where no row has a number of both columns.
void expect_numbers(const Source& source, const Variable& x, const Variable& y) {
  const std::vector<double> xs = values_of(source, x), ys = values_of(source, y);
  for (std::size_t i = 0; i < xs.size(); ++i)
    if (std::isfinite(xs[i]) && std::isfinite(ys[i])) return;
  throw UsageError("S645", fmt::format("{}: no row has a number of both {} and {}: nothing to draw",
                                       source.file.string(), x.name, y.name));
}

// Throws UsageError where the columns of two files, or of one axis, have different units.
void expect_one_unit(const std::vector<Source>& sources, const std::vector<Variable>& variables) {
  const auto unit_of = [](const Source& source, const Variable& variable) {
    const std::string& unit = column_of(source, variable).unit;
    return unit.empty() ? std::string("-") : unit;
  };
  const Source& first = sources.front();
  const std::string unit = unit_of(first, variables.front());
  for (const Source& source : sources)
    for (const Variable& variable : variables)
      if (const std::string other = unit_of(source, variable); other != unit)
        throw UsageError("S646",
                         fmt::format("{} of {} is in {}, {} of {} in {}: they can't be drawn on one axis",
                                     variables.front().name, first.file.string(), unit, variable.name,
                                     source.file.string(), other));
}

// One series a file and y column, but one alone where all files say the same.
Plot plot_of(const std::vector<Source>& sources, const Panel& panel, bool labelled) {
  Plot plot;
  expect_one_unit(sources, {panel.x});
  expect_one_unit(sources, panel.y);
  plot.x_label = label_of(sources.front(), {panel.x});
  plot.y_label = label_of(sources.front(), panel.y);
  const bool several = panel.y.size() > 1;
  for (const Source& source : sources)
    for (const Variable& y : panel.y) {
      expect_numbers(source, panel.x, y);
      const bool shared = several && sources.size() > 1 && same_in_all(sources, panel.x, y);
      if (shared && &source != &sources.front()) continue;
      std::string name = shared || !labelled ? words_of(y) : source.label;
      if (several && labelled && !shared) name += ": " + words_of(y);
      if (!several && !labelled) name.clear();  // the axis says it
      plot.series.push_back({name, values_of(source, panel.x), values_of(source, y), true, true});
    }
  return plot;
}

double span(const CsvTable::Column* column) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (double value : column->values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  return high - low;
}

// What a table is about, where nobody says: stress against strain and its ratio; load against displacement.
std::vector<std::string> usual_panels(const Source& source) {
  const CsvTable& table = source.table;
  if (table.find("ratio") != nullptr)
    return {"axial_strain:measured_deviator,correct_deviator", "axial_strain:ratio"};
  if (table.find("fx") != nullptr && table.find("ux") != nullptr) {
    const std::string axis = span(table.find("ux")) > span(table.find("uy")) ? "x" : "y";
    const auto sign = [&](const std::string& name) {
      return (table.find(name)->values.empty() || table.find(name)->values.back() >= 0.0 ? "" : "-") + name;
    };
    return {sign("u" + axis) + ":" + sign("f" + axis)};
  }
  throw UsageError("S903", fmt::format("{}: which columns? --xy X:Y[,Y...]; it has {}", source.file.string(),
                                       source.table.names()));
}

// "dp_285" of dp_285.report1.csv, "phi_28.5" of phi_28.5.report1.csv and of phi_28.5.csv: what a run adds to its deck's
// name is one of a few words.
std::string stem_of_table(const fs::path& file) {
  const fs::path name = file.filename().stem();
  std::string word = name.extension().string();
  while (!word.empty() && std::isdigit(static_cast<unsigned char>(word.back())) != 0) word.pop_back();
  constexpr std::string_view kAdded[] = {
      ".report", ".increments", ".nodes",       ".points",  ".interfaces", ".structures", ".flow",
      ".ends",   ".envelope",   ".convergence", ".compare", ".safety",     ".bounds",     ".bounds.fields"};
  return (std::ranges::find(kAdded, word) != std::end(kAdded) ? name.stem() : name).string();
}

// The first report of a result file's run lies beside it.
fs::path table_of(const fs::path& file) {
  if (file.extension() != ".h5") return file;
  fs::path table = file;
  return table.replace_extension(".report1.csv");
}

// Files are told apart by their decks' titles, or by their names where titles are the same.
std::vector<Source> read_sources(const PlotOptions& options) {
  std::vector<Source> sources;
  for (const std::string& file : options.files) {
    const fs::path table = table_of(file);
    keep_input(table);
    sources.push_back({table, "", read_csv_table(table)});
  }
  std::vector<std::string> titles;
  for (const Source& source : sources) titles.push_back(source.table.title());
  std::ranges::sort(titles);
  const bool alike = std::ranges::adjacent_find(titles) != titles.end() || titles.front().empty();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    Source& source = sources[i];
    source.label = alike ? (source.file.parent_path().filename() / stem_of_table(source.file)).string()
                         : source.table.title();
    if (i < options.labels.size()) source.label = options.labels[i];
  }
  return sources;
}

// The parts between semicolons of what a table says about its columns.
std::vector<std::string> remarks_of(const Source& source) {
  std::vector<std::string> parts;
  if (source.table.comments.size() < 2) return parts;
  std::string_view rest = source.table.comments[1];
  for (std::size_t end = 0; end != std::string_view::npos; rest.remove_prefix(std::min(end + 2, rest.size()))) {
    end = rest.find("; ");
    parts.emplace_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
  }
  return parts;
}

// What the tables say about their columns: once, with the files' labels where not all say it (plane strain beside
// axisymmetry, reports of several kinds).
std::string note_of(const std::vector<Source>& sources) {
  std::vector<std::pair<std::string, std::vector<std::string>>>
      remarks;  // with the labels of those who make it
  for (const Source& source : sources)
    for (const std::string& part : remarks_of(source)) {
      auto at = std::ranges::find(remarks, part, &std::pair<std::string, std::vector<std::string>>::first);
      if (at == remarks.end()) at = remarks.insert(at, {part, {}});
      at->second.push_back(source.label);
    }
  std::string note;
  for (const auto& [part, labels] : remarks) {
    note += (note.empty() ? "" : "; ") + part;
    if (labels.size() < sources.size()) note += fmt::format(" ({})", fmt::join(labels, "; "));
  }
  return note;
}

// Of columns, as part of a file's name.
std::string name_part(std::string text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  for (char& c : text)
    if (!plain(c)) c = '_';
  return text;
}

}  // namespace

void plot_columns(const PlotOptions& options) {
  const std::vector<Source> sources = read_sources(options);
  const std::vector<std::string> asked = options.xy.empty() ? usual_panels(sources.front()) : options.xy;
  PlotSheet sheet;
  sheet.title = options.title.empty() && sources.size() == 1 ? sources.front().table.title() : options.title;
  sheet.note = note_of(sources);
  const bool labelled = sources.size() > 1 || !options.labels.empty();
  std::string name = stem_of_table(sources.front().file);
  std::vector<Variable> drawn;
  for (const std::string& text : asked) {
    const Panel panel = panel_from(text);
    sheet.panels.push_back(plot_of(sources, panel, labelled));
    sheet.panels.back().log_x = options.log_x;
    drawn.push_back(panel.x);
    drawn.insert(drawn.end(), panel.y.begin(), panel.y.end());
  }
  for (const Source& source : sources) note_damage(source, drawn);
  const Panel first = panel_from(asked.front());
  name += options.xy.empty() ? "_curves" : "_" + name_part(first.y.front().name + "_" + first.x.name);
  write_plot(options, plot_path(options, name), sheet_svg(sheet));
}

}  // namespace sage::app

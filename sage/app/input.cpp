#include "sage/app/input.hpp"

#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "sage/app/commands.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/stored_heads.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/draw/picture.hpp"
#include "sage/messages/near_names.hpp"
#include "sage/messages/parse_number.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

void add_input_options(CLI::App& parser, InputOptions& options) {
  parser.add_option("--layout", options.layout,
                    "card layout: a built-in name or a .toml file (default: found from the deck)");
  parser.add_flag("--strict", options.strict,
                  "treat warnings as errors; those of a run count when it is complete");
}

namespace {

// By code or name; -1 = there is none.  Codes are checked when the model is built.
int element_code(const Catalogue& catalogue, const std::string& text) {
  if (const std::optional<int> code = parse_number<int>(text)) return *code;
  const int found = catalogue.elements.code_of(text);
  return found == 0 ? -1 : found;
}

}  // namespace

Grading grading_from(const std::string& text) {
  const std::string usage = "--grade " + text +
                            ": wanted NODE[:layers[:ratio]] or auto[:layers[:ratio]], layers 1 to 30, "
                            "ratio 0.01 to 0.9";
  Grading grading;
  std::stringstream parts(text);
  std::string part, node;
  std::getline(parts, node, ':');
  const auto number = [&](const std::string& digits, auto& value) {
    const auto read = parse_number<std::remove_reference_t<decltype(value)>>(digits);
    if (!read) throw std::invalid_argument(usage);
    value = *read;
  };
  if (node != "auto") {
    number(node, grading.node);
    if (grading.node < 1) throw std::invalid_argument(usage);
  }
  if (std::getline(parts, part, ':')) number(part, grading.layers);
  if (std::getline(parts, part, ':')) number(part, grading.ratio);
  if (std::getline(parts, part, ':') || grading.layers < 1 || grading.layers > 30 ||
      !(grading.ratio >= 0.01 && grading.ratio <= 0.9))
    throw std::invalid_argument(usage);
  return grading;
}

PointRequest point_from(const std::string& text) {
  const std::string wanted = "--point " + text + ": wanted x,y[:name[:group]]";
  const auto number = [&](std::string_view digits, auto& value) {
    const auto read = parse_number<std::remove_reference_t<decltype(value)>>(digits);
    if (!read || !std::isfinite(static_cast<double>(*read)))
      throw std::invalid_argument(wanted + "; \"" + std::string(digits) + "\" is no number");
    value = *read;
  };
  std::vector<std::string> parts{""};
  for (char c : text) {
    if (c == ':' && parts.size() < 3)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  const std::size_t comma = parts[0].find(',');
  if (comma == std::string::npos) throw std::invalid_argument(wanted);
  PointRequest point;
  number(std::string_view(parts[0]).substr(0, comma), point.place.x());
  number(std::string_view(parts[0]).substr(comma + 1), point.place.y());
  if (parts.size() > 1) point.name = parts[1];
  if (parts.size() > 2) number(parts[2], point.group);
  return point;
}

void add_digits_option(CLI::App& parser, int& digits) {
  parser
      .add_option("--digits", digits,
                  "significant digits of numbers in CSV files and in the reports on the screen (default: 10 in "
                  "CSV; 16 is the precision of the results, 17 keeps every bit)")
      ->check(CLI::Range(2, 17));
}

void add_field_options(CLI::App& parser, std::vector<std::string>& pictures, std::vector<std::string>& fields,
                       const std::string& picture_words, const std::string& field_words) {
  parser.add_option("--picture", pictures, picture_words + ": " + kPictureNames)->allow_extra_args(false);
  parser
      .add_option("--field", fields,
                  "more fields in " + field_words + " (see sagefe list fields); may be repeated")
      ->allow_extra_args(false);
}

namespace {

// The field of that name, or the one that has a component of it.
const FieldEntry* field_of(const std::vector<FieldTable>& tables, const std::string& name) {
  for (const FieldTable& table : tables)
    if (const FieldEntry* row = table.find(name)) return row;
  for (const FieldTable& table : tables)
    if (const auto choice = table.choose(name)) return choice->entry;
  return nullptr;
}

}  // namespace

std::vector<std::string> require_fields(const std::vector<std::string>& pictures,
                                        const std::vector<std::string>& fields,
                                        const std::vector<FieldTable>& tables) {
  std::vector<std::string> names;
  for (const std::string& name : fields) {
    const FieldEntry* field = field_of(tables, name);
    if (field == nullptr) {
      std::string known;
      for (const FieldEntry& row : tables.front().rows()) known += (known.empty() ? "" : ", ") + row.name;
      std::vector<std::string> near;
      for (const FieldEntry& row : tables.front().rows()) near.push_back(row.name);
      throw UsageError("S644", "--field: unknown field " + name + "; known: " + known +
                                   ", or a component of one" + did_you_mean(name, near));
    }
    if (std::ranges::find(names, field->name) == names.end()) names.push_back(field->name);
  }
  for (const std::string& name : pictures) {
    std::string reason;
    for (const FieldTable& table : tables) {
      try {
        picture_field(table, name);
        reason.clear();
        break;
      } catch (const std::invalid_argument& error) {
        reason = error.what();
      }
    }
    if (!reason.empty()) throw UsageError("S644", "--picture: " + reason);
  }
  return names;
}

std::string fields_without_column(const std::vector<std::string>& fields, const FieldTable& table,
                                  const std::function<bool(const FieldEntry&)>& has_column,
                                  const std::string& way_out) {
  std::string names;
  for (const std::string& name : fields) {
    const FieldEntry* row = table.find(name);
    if (row != nullptr && !has_column(*row)) names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? ""
                       : "--field " + names + ": no output that is asked for has a column for it; " + way_out;
}

void add_element_option(CLI::App& parser, const Catalogue& catalogue, const std::string& flag,
                        const std::string& words, const std::function<void(int)>& set) {
  parser
      .add_option_function<std::string>(
          flag, [set, &catalogue](const std::string& text) { set(element_code(catalogue, text)); }, words)
      ->check([&catalogue](const std::string& text) {
        const int code = element_code(catalogue, text);
        if (code < 0)
          return "unknown element " + text + "; known: " + catalogue.elements.known() +
                 did_you_mean(text, names_of(catalogue.elements));
        const ElementEntry* entry = catalogue.elements.find(code);  // codes are checked with the model
        return entry == nullptr || (entry->solid() && entry->square())
                   ? std::string()
                   : entry->name + " can't take the place of a quadrilateral";
      });
}

void add_formulation_option(CLI::App& parser, const std::string& flag, const std::string& words,
                            const std::function<void(int)>& set) {
  parser.add_option_function<int>(flag, set, words)->check(CLI::Range(0, 99));
}

namespace {

void add_factor_options(CLI::App& parser, BuildOptions& options) {
  CLI::Option* const factors =
      parser
          .add_option_function<std::vector<std::string>>(
              "--factors",
              [&options](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                  for (const PartialFactors& set : partial_factors(text)) options.factors.push_back(set);
              },
              "partial factors: " + names_of_factor_sets() + ", or NAME:friction=1.25,variable=1.3,...")
          ->allow_extra_args(false)
          ->check([](const std::string& text) {
            try {
              partial_factors(text);
              return std::string();
            } catch (const std::invalid_argument& error) {
              return std::string(error.what());
            }
          });
  parser
      .add_option("--variable", options.actions.variable,
                  "with --factors: number of a stage whose loads are variable")
      ->allow_extra_args(false)
      ->needs(factors);
  parser
      .add_option("--structural", options.actions.structural,
                  "with --factors: number of a stage whose loads come from a structure")
      ->allow_extra_args(false)
      ->needs(factors);
}

}  // namespace

void add_build_options(CLI::App& parser, BuildOptions& options, const Catalogue& catalogue) {
  add_factor_options(parser, options);
  options.say = [](const std::string& text, Code code) { say_note("sagefe", text, code); };
  options.heads = stored_heads(catalogue);
  add_formulation_option(parser, "--formulation", "replace the formulation code of all solid elements",
                         [&options](int code) { options.formulation = code; });
  add_element_option(
      parser, catalogue, "--element",
      "replace 4-node quadrilaterals by this element, code or name; its other nodes are generated",
      [&options](int code) { options.element = code; });
  parser.add_flag(
      "--coarsen", options.coarsen,
      "use the coarsest mesh of quadrilaterals with the deck's outline, groups, supports, loads and "
      "reported nodes");
  parser
      .add_option_function<int>(
          "--refine", [&options](int times) { options.refine = times; },
          "split every element into four, this many times")
      ->check(CLI::Range(0, 12));
  parser
      .add_option_function<std::vector<std::string>>(
          "--grade",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) options.gradings.push_back(grading_from(text));
          },
          "smaller elements towards a corner: NODE[:layers[:ratio]], or auto for all singular corners")
      ->check([](const std::string& text) {
        try {
          grading_from(text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      });
  parser
      .add_option_function<int>(
          "--refine-graded", [&options](int times) { options.refine_graded = times; },
          "split every element into four, this many times, after --grade has made its layers")
      ->check(CLI::Range(0, 12));
  parser.add_flag(
      "--partial", options.partial,
      "compute a foreign deck without the parts that sagefe does not support; otherwise sagefe rejects "
      "such a deck");
  parser
      .add_option_function<std::vector<std::string>>(
          "--point",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) options.points.push_back(point_from(text));
          },
          "x,y[:name[:group]]: a report of displacement, strain and stress there")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        try {
          point_from(text);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      });
  parser.add_option("--geometry", options.geometry, "replace the geometry: 1 plane strain, 2 axisymmetric")
      ->check(CLI::Range(1, 2));
}

std::function<std::string(const std::string&)> number_in(double low, double high, const std::string& wanted) {
  return [=](const std::string& text) {
    const std::optional<double> value = parse_number<double>(text);
    return value && *value >= low && *value <= high ? std::string()
                                                    : wanted + " is wanted, not \"" + text + "\"";
  };
}

void require_file(const std::string& path, const std::string& who) {
  std::error_code ignored;
  if (std::filesystem::is_fifo(path, ignored))
    throw InputError("S908", {path, 0, 0, 0},
                     who + " reads its deck more than once: a file is wanted, not a pipe");
}

Deck read_input(const std::string& path, const InputOptions& options, bool whole_layout) {
  ReadOptions read;
  read.strict = options.strict;
  read.whole = whole_layout;
  keep_input(path);
  if (!options.layout.empty()) keep_input(options.layout);
  return options.layout.empty() ? read_deck(path, read)
                                : read_deck(path, load_layout(options.layout, whole_layout), read);
}

std::string case_name(const std::string& path) {
  std::filesystem::path p = std::filesystem::path(path).lexically_normal();
  if (p.parent_path().filename() == "..") p = std::filesystem::absolute(p).lexically_normal();
  if (p.stem() == "deck" && !p.parent_path().filename().empty()) return p.parent_path().filename().string();
  const std::string name = p.stem().string();
  return is_model_file(path) ? name.substr(0, name.size() - 5) : name;  // without .sage
}

}  // namespace sage::app

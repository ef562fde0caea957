// From a file name to a model, with every message shown.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <stdexcept>
#include <string>

#include "sage/builder/build_model.hpp"
#include "sage/core/catalogue.hpp"
#include "sage/deck/deck.hpp"

namespace sage::app {

// The command line asks for what there is not (exit code 1), found out when a deck had been read.
class UsageError : public CodedError {
 public:
  using CodedError::CodedError;
};

// Options that every command which reads a deck shares.
struct InputOptions {
  std::string layout;   // name or path of a layout; empty = the deck's own, else the built-in one
  bool strict = false;  // warnings are errors
  BuildOptions build;
};

// Of a registry's entries, for "did you mean".
template <class Entry>
std::vector<std::string> names_of(const Registry<Entry>& registry) {
  std::vector<std::string> names;
  for (const auto& [code, entry] : registry.entries()) names.push_back(entry.name);
  return names;
}

void add_input_options(CLI::App& parser, InputOptions& options);
// NODE[:layers[:ratio]] or auto[:layers[:ratio]].  Throws std::invalid_argument that says what is wanted.
Grading grading_from(const std::string& text);

// x,y[:name[:group]].  Throws std::invalid_argument that says what is wrong.
PointRequest point_from(const std::string& text);
// --digits of tables.
void add_digits_option(CLI::App& parser, int& digits);

// An element by code or name that takes the place of quadrilaterals, and a formulation code: of both sides of a
// comparison, or of one.
void add_element_option(CLI::App& parser, const Catalogue& catalogue, const std::string& flag,
                        const std::string& words, const std::function<void(int)>& set);
void add_formulation_option(CLI::App& parser, const std::string& flag, const std::string& words,
                            const std::function<void(int)>& set);

// What --picture takes, in words.
inline constexpr const char* kPictureNames =
    "conf or sigma_3, dev or sigma_1-sigma_3, SL (stress level), stress_yy, displacement, yielded; for "
    "seepage head, velocity, stream_function, flow_net (head with its flow net); for soil with water "
    "pore_pressure; any other field of `sagefe list fields` that is a number, a component of a field, or a "
    "history "
    "variable of a law; may be repeated";
// --picture and --field, with what they are for; names are looked at by require_fields.
void add_field_options(CLI::App& parser, std::vector<std::string>& pictures, std::vector<std::string>& fields,
                       const std::string& picture_words, const std::string& field_words);
// Gives the names of `fields`, each once; that of a component ("stress_yy") stands for its field.  tables: of the
// results.  Throws UsageError for a field that none of them has, or that can't be drawn.
std::vector<std::string> require_fields(const std::vector<std::string>& pictures,
                                        const std::vector<std::string>& fields,
                                        const std::vector<FieldTable>& tables);
// "--field NAME: no output ...; WAY_OUT": of the fields for which `has_column` is false; empty = there are none.
std::string fields_without_column(const std::vector<std::string>& fields, const FieldTable& table,
                                  const std::function<bool(const FieldEntry&)>& has_column,
                                  const std::string& way_out);

// Those that change how the deck's elements are computed.
void add_build_options(CLI::App& parser, BuildOptions& options, const Catalogue& catalogue);

// Check of an option: a message if the text is no finite number from `low` to `high`, named so in the message.
// (CLI11's own ranges let NaN pass.)
std::function<std::string(const std::string&)> number_in(double low, double high, const std::string& wanted);

// Throws InputError if `path` is a pipe; `who` reads its deck more than once.
void require_file(const std::string& path, const std::string& who);
// whole_layout: a layout file without what a model needs, or with names that nothing uses, is refused.
Deck read_input(const std::string& path, const InputOptions& options, bool whole_layout = true);

// "case" for .../case/deck.dat, otherwise the file's name without its ending (.sage.toml of a model file).
std::string case_name(const std::string& path);

}  // namespace sage::app

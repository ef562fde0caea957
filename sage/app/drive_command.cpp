// sagefe drive: a law along a laboratory's path, without a mesh.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/umat_output.hpp"
#include "sage/drive/curve_files.hpp"
#include "sage/drive/fit.hpp"
#include "sage/drive/path_file.hpp"
#include "sage/drive/subject.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/values.hpp"
#include "sage/umat/law.hpp"

namespace sage::app {

namespace {

using namespace drive;

struct DriveOptions {
  std::string law, deck, layout, cases_file;
  int material = 0;
  std::vector<std::string> settings, cases;
  std::vector<std::string> unit_names;
  UnitSystem units;

  std::string test, path;
  double pressure = 0.0, normal_stiffness = 0.0;
  std::vector<double> start, turns{};
  bool undrained = false, list = false;
  int steps = 100, cycles = 1;

  std::vector<std::string> fits, free;

  std::string csv, plot;
  std::vector<std::string> panels;
  int digits = 10;
};

// Mistakes of a text of the command line are the command line's, those of a file the file's.
template <class Work>
auto of_command_line(const std::string& option, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    const Diagnostic& first = error.diagnostics().list().front();
    if (!first.where.file.empty()) throw;
    throw UsageError(first.code, option + first.message);
  }
}

// A material of a deck, with its parameters and units.
Subject subject_of_deck(const DriveOptions& options, const Catalogue& catalogue) {
  InputOptions input;
  input.layout = options.layout;
  const Deck deck = read_input(options.deck, input);
  const Model model = build_materials_alone(deck, catalogue, input.build);
  std::string known;
  for (const Material& material : model.materials) {
    known += fmt::format("{}{} {}", known.empty() ? "" : ", ", material.number, material.name);
    if (material.number != options.material && !(options.material == 0 && model.materials.size() == 1))
      continue;
    Subject subject = subject_of(catalogue, material.law_name, model.units);
    subject.values = material.parameters;
    if (!material.name.empty()) subject.name = material.name;
    return subject;
  }
  throw UsageError("S903", fmt::format("which material? --material NUMBER; the deck has {}", known));
}

UnitSystem units_of(const DriveOptions& options) {
  UnitSystem units = options.units;
  if (!options.unit_names.empty()) {
    units.length = options.unit_names[0];
    units.force = options.unit_names[1];
    units.stress = options.unit_names[2];
  }
  return units;
}

std::vector<Subject> subjects_of(const DriveOptions& options, const Catalogue& catalogue) {
  if (!options.law.empty() && !options.deck.empty())
    throw UsageError("S905", "--law and --deck exclude each other");
  if (options.law.empty() && options.deck.empty() && options.cases.empty() && options.cases_file.empty())
    throw UsageError("S903", "which law? --law LAW, --deck DECK, --case NAME:LAW,... or --cases FILE");
  UnitSystem units = units_of(options);
  std::vector<Subject> subjects;
  std::unique_ptr<Subject> base;
  if (!options.deck.empty()) base = std::make_unique<Subject>(subject_of_deck(options, catalogue));
  if (!options.law.empty())
    base = of_command_line(
        "--law: ", [&] { return std::make_unique<Subject>(named_subject(catalogue, options.law, units)); });
  if (base) {
    base->pressure = options.pressure;
    units = base->units;
    for (const std::string& text : options.settings)
      of_command_line("--set ", [&] { apply(*base, setting_from(text)); });
  } else if (!options.settings.empty()) {
    throw UsageError("S905", "--set goes with --law or --deck; a case has its own settings");
  }
  if (base && options.cases.empty() && options.cases_file.empty()) {
    of_command_line("", [&] { expect_whole(*base); });
    subjects.push_back(*base);
  }
  for (const std::string& text : options.cases)
    subjects.push_back(of_command_line("--case " + text + ": ", [&] {
      return subject_from(catalogue, text, units, options.pressure, base.get());
    }));
  if (!options.cases_file.empty()) {
    keep_input(options.cases_file);
    for (Subject& subject : read_subjects(catalogue, options.cases_file, units, options.pressure, base.get()))
      subjects.push_back(std::move(subject));
  }
  return subjects;
}

// Start, legs and what holds, for one of the cases.
Path path_of(const DriveOptions& options, const Subject& subject, const LabTest* test) {
  const int size = subject.entry->law_size;
  Path path;
  path.history = subject.history;
  path.start.assign(size, 0.0);
  if (!options.start.empty()) {
    if (options.start.size() > path.start.size())
      throw UsageError("S904", fmt::format("--start: the law has {} components of stress", size));
    std::ranges::copy(options.start, path.start.begin());
  } else if (size == 4) {
    std::fill_n(path.start.begin(), 3, subject.pressure);
  } else {
    path.start[1] = subject.pressure;
  }
  path.normal_stiffness = options.normal_stiffness;
  if (test == nullptr) {
    path.legs = read_path(options.path, size, options.undrained, options.steps);
    return path;
  }
  std::vector<double> turns;
  for (int cycle = 0; cycle < options.cycles; ++cycle)
    turns.insert(turns.end(), options.turns.begin(), options.turns.end());
  path.legs = legs_of(*test, options.undrained, path.start, turns, options.steps);
  if (options.undrained && size == 4) path.total_stress_stays = test->total_stress_stays;
  return path;
}

// nullptr: a path from a file.
const LabTest* test_for(const DriveOptions& options, int size) {
  const bool own_tests = !options.fits.empty() && options.test.empty() && options.path.empty();  // in --fit
  if (options.test.empty() == options.path.empty() && !own_tests)
    throw UsageError("S903",
                     "what is to be done with the law? --test NAME or --path FILE (sagefe drive --list)");
  if (options.normal_stiffness > 0.0 && (size != 2 || options.undrained))
    throw UsageError("S905", "--normal-stiffness is for joints whose volume may change");
  if (!options.path.empty()) {
    if (!options.turns.empty() || options.cycles != 1)
      throw UsageError("S905", "--to and --cycles go with --test");
    keep_input(options.path);
    return nullptr;
  }
  if (!options.fits.empty() && (!options.turns.empty() || !options.start.empty() || options.cycles != 1))
    throw UsageError("S905", "--fit goes where its curves go: without --to, --cycles and --start");
  if (own_tests) return nullptr;
  const LabTest* test = find_lab_test(options.test, size);
  if (test == nullptr)
    throw UsageError("S904", fmt::format("--test {}: none for laws of {}s; there are {}", options.test,
                                         law_words(size), known_lab_tests(size)));
  if (options.undrained && test->undrained.empty())
    throw UsageError("S905",
                     fmt::format("--undrained: nothing moves in {} without change of volume", test->name));
  if (options.fits.empty() && options.turns.empty())
    throw UsageError("S903", fmt::format("--to: how far? {} at the end", driven_column(*test)));
  return test;
}

Heading heading_of(const DriveOptions& options, const std::vector<Subject>& subjects) {
  Heading heading;
  heading.title = !options.path.empty()  ? "path of " + options.path
                  : options.test.empty() ? "curves of several tests"
                                         : options.test;
  if (options.undrained) heading.title += ", constant volume";
  if (options.normal_stiffness > 0.0)
    heading.title += fmt::format(", normal stiffness {:g}", options.normal_stiffness);
  heading.units = subjects.front().units;
  for (const Subject& subject : subjects)
    heading.notes.push_back(
        fmt::format("{}: {}; pressure at the start {:g}", subject.name, words_of(subject), subject.pressure));
  return heading;
}

void list_tests() {
  for (const int size : {4, 2}) {
    fmt::print("of {}s:\n", law_words(size));
    for (const LabTest& test : lab_tests()) {
      if (test.law_size != size) continue;
      if (Json* json = answer())
        (*json)["tests"].push_back({{"of", law_words(size)},
                                    {"name", test.name},
                                    {"about", test.about},
                                    {"driven", driven_column(test)},
                                    {"undrained", !test.undrained.empty()}});
      fmt::print("  {:<22} {}; --to is {}{}\n", test.name, test.about, driven_column(test),
                 test.undrained.empty() ? "" : "; --undrained");
    }
  }
}

// FILE, FILE@PRESSURE or FILE@PRESSURE,TEST[,undrained].  test: of the command line, nullptr = none.
Measured measured_from(const std::string& text, const LabTest* test, bool undrained, const Subject& subject) {
  const auto refuse = [&](const std::string& why) { throw UsageError("S904", "--fit " + text + ": " + why); };
  const std::size_t at = text.rfind('@');
  double pressure = subject.pressure;
  if (at != std::string::npos) {
    const std::vector<std::string_view> parts = split_at(',', std::string_view(text).substr(at + 1));
    const std::string number(parts[0]);
    char* end = nullptr;
    pressure = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(pressure))
      refuse("wanted FILE, FILE@PRESSURE or FILE@PRESSURE,TEST[,undrained]");
    if (parts.size() > 1) {
      const std::string name(parts[1]);
      test = find_lab_test(name, subject.entry->law_size);
      undrained = undrained || parts.size() > 2;
      if (test == nullptr)
        refuse("there is no test " + name + "; there are " + known_lab_tests(subject.entry->law_size));
      if (parts.size() > 3 || (parts.size() == 3 && parts[2] != "undrained"))
        refuse("only undrained may follow the test");
      if (undrained && test->undrained.empty())
        refuse(fmt::format("nothing moves in {} without change of volume", test->name));
    }
  }
  if (test == nullptr) refuse("which test? --test NAME for all curves, or FILE@PRESSURE,TEST for this one");
  const std::string file = text.substr(0, at);
  keep_input(file);
  return read_measured(file, *test, undrained, pressure);
}

Json curve_json(const Curve& curve) {
  Json columns = Json::array(), rows = Json::array(), states = Json::array();
  for (const Column& column : curve.columns)
    columns.push_back({{"name", json_text(column.name)}, {"unit", json_text(column.unit)}});
  for (std::size_t row = 0; row < curve.rows(); ++row) {
    Json values = Json::array();
    for (const Column& column : curve.columns) values.push_back(column.values[row]);
    rows.push_back(std::move(values));
    states.push_back(status_name(curve.status[row]));
  }
  return {{"name", json_text(curve.name)},
          {"failure", curve.failure.empty() ? Json(nullptr) : Json(json_text(curve.failure))},
          {"columns", std::move(columns)},
          {"rows", std::move(rows)},
          {"status", std::move(states)}};
}

// False: a curve ends early, and a message names it.  Also with --quiet, or where the table goes to standard output: the
// exit code alone does not say which curve.
bool are_whole(const std::vector<Curve>& curves) {
  bool whole = true;
  for (const Curve& curve : curves) {
    if (curve.failure.empty()) continue;
    whole = false;
    say_error("sagefe drive", fmt::format("the curve {} ends early: {}", curve.name, curve.failure), "S607");
  }
  return whole;
}

void answer_curves(const Heading& heading, const std::vector<Curve>& curves) {
  Json* json = answer();
  if (json == nullptr) return;
  (*json)["title"] = json_text(heading.title);
  (*json)["cases"] = json_list(heading.notes);
  (*json)["curves"] = Json::array();
  for (const Curve& curve : curves) (*json)["curves"].push_back(curve_json(curve));
}

void answer_fit(const FitProblem& problem, const FitResult& result) {
  Json* json = answer();
  if (json == nullptr) return;
  Json parameters = Json::array(), undetermined = Json::array();
  for (std::size_t i = 0; i < problem.free.size(); ++i)
    parameters.push_back({{"name", json_text(problem.free[i].name)},
                          {"value", result.values[i]},
                          {"standard_error", result.standard_errors[i]},
                          {"low", result.low[i]},
                          {"high", result.high[i]},
                          {"at_bound", static_cast<bool>(result.at_bound[i])}});
  for (const Undetermined& one : result.undetermined)
    undetermined.push_back({{"parameters", json_list(one.names)}, {"shares", one.shares}});
  (*json)["fit"] = {{"converged", result.converged},
                    {"rms", result.rms},
                    {"points", result.points},
                    {"parameters", std::move(parameters)},
                    {"undetermined", std::move(undetermined)}};
}

void finish(OutFile& file, std::string text) {
  file.text() = std::move(text);
  file.finish();
  answer_file(file.path());
}

// The fitted curves go where driven ones go.
int fit_law(const DriveOptions& options, const Subject& subject, const LabTest* test) {
  if (!options.path.empty()) throw UsageError("S905", "--fit goes with --test, not with --path");
  if (!options.panels.empty()) throw UsageError("S905", "--fit has its own panels: --xy goes without it");
  FitProblem problem;
  problem.subject = subject;
  problem.normal_stiffness = options.normal_stiffness;
  problem.steps = options.steps;
  for (const std::string& text : options.fits)
    problem.curves.push_back(measured_from(text, test, options.undrained, subject));
  OutFile csv, plot;
  if (!options.csv.empty() && options.csv != "-") csv = OutFile(options.csv);
  if (!options.plot.empty()) plot = OutFile(options.plot);
  FitResult result;
  with_umat_output(subject.name, [&] {
    result = of_command_line("--free: ", [&] {
      for (const std::string& text : options.free) problem.free.push_back(free_parameter_from(subject, text));
      return fit(problem);
    });
  });
  const Heading heading = heading_of(options, {result.fitted});
  fmt::print("{}",
             options.csv == "-" ? csv_text(heading, result.curves, options.digits) : fit_text(problem, result));
  const bool whole = are_whole(result.curves);
  answer_curves(heading, result.curves);
  answer_fit(problem, result);
  if (csv.open()) finish(csv, csv_text(heading, result.curves, options.digits));
  if (plot.open()) finish(plot, fit_plot(problem, result));
  return whole && result.converged ? kOk : kNotConverged;
}

// Where a user material returned what is no number, that is the reason, and no strength.
void name_not_finite(Curve& curve) {
  const std::string words = umat::take_not_finite();
  if (curve.failure.empty() || words.empty()) return;
  curve.failure = curve.failure.substr(0, curve.failure.find(": ") + 2) + words;
}

int drive_laws(const DriveOptions& options, const Catalogue& catalogue) {
  if (options.list) {
    list_tests();
    return kOk;
  }
  const std::vector<Subject> subjects = subjects_of(options, catalogue);
  const int size = subjects.front().entry->law_size;
  for (const Subject& subject : subjects) {
    if (subject.entry->law_size != size)
      throw UsageError("S905", "all cases must be of solids, or all of joints: one test drives them");
    for (const Subject& other : subjects)
      if (&other != &subject && other.name == subject.name)
        throw UsageError("S904",
                         fmt::format("two cases are called {}; NAME:LAW,... gives names", subject.name));
  }
  const LabTest* test = test_for(options, size);
  if (options.fits.empty() != options.free.empty()) throw UsageError("S905", "--fit and --free go together");
  if (!options.fits.empty()) {
    if (subjects.size() > 1) throw UsageError("S905", "--fit is for one law");
    return fit_law(options, subjects.front(), test);
  }
  OutFile csv, plot;  // opened first: an unwritable folder shows before anything is computed
  const bool to_screen = options.csv == "-";
  if (!options.csv.empty() && !to_screen) csv = OutFile(options.csv);
  if (!options.plot.empty()) plot = OutFile(options.plot);

  std::vector<Curve> curves;
  for (const Subject& subject : subjects) {
    const LawPtr law = make_law(subject);
    with_umat_output(subject.name, [&] {
      curves.push_back(of_command_line(subject.name + ": ", [&] {
        return follow(subject, reference(law), path_of(options, subject, test));
      }));
      name_not_finite(curves.back());
    });
    curves.back().name = subject.name;
  }
  const std::vector<std::string> panels =
      options.panels.empty() ? usual_panels(test, size, options.undrained) : options.panels;
  for (const std::string& panel : panels) of_command_line("--xy ", [&] { expect_columns(panel, curves); });

  const Heading heading = heading_of(options, subjects);
  fmt::print("{}",
             to_screen ? csv_text(heading, curves, options.digits) : summary_text(curves, panels.front()));
  const bool whole = are_whole(curves);
  answer_curves(heading, curves);
  if (csv.open()) finish(csv, csv_text(heading, curves, options.digits));
  if (plot.open()) finish(plot, plot_text(heading, curves, panels));
  return whole ? kOk : kNotConverged;
}

std::string finite_number(const std::string& text) {
  return number_in(-1e300, 1e300, "a finite number")(text);
}

void add_law_options(CLI::App& parser, DriveOptions& options) {
  parser.add_option("--law", options.law,
                    "a law by name or code (sagefe list materials); NAME:LAW names it (CMNAME of a UMAT)");
  parser.add_option("--deck", options.deck, "the law, parameters and units of a deck's material");
  parser
      .add_option("--material", options.material, "number of the material in the deck (default: the only one)")
      ->needs("--deck");
  parser.add_option("--layout", options.layout, "card layout of the deck: a name or a TOML file")
      ->needs("--deck");
  parser
      .add_option(
          "--set", options.settings,
          "NAME=VALUE of a parameter, as decks give it: degrees, compression positive; E, nu, c, phi and "
          "psi for short; may be repeated")
      ->allow_extra_args(false);
  parser
      .add_option(
          "--case", options.cases,
          "NAME:LAW,KEY=VALUE,... one curve of several; without LAW, the law of --law or --deck with these "
          "changes; KEY pressure sets its own start; may be repeated")
      ->allow_extra_args(false);
  parser.add_option("--cases", options.cases_file, "file with one text of --case per line");
  parser.add_option("--units", options.unit_names, "names of length, force and stress, e.g. m,kN,kPa")
      ->delimiter(',')
      ->expected(3);
  parser.add_option("--p-a", options.units.atmospheric_pressure, "atmospheric pressure, for laws that need it")
      ->check(finite_number);
  parser
      .add_option("--gamma-w", options.units.water_unit_weight, "unit weight of water, for laws that need it")
      ->check(finite_number);
}

void add_test_options(CLI::App& parser, DriveOptions& options) {
  parser.add_flag("--list", options.list, "list the tests");
  parser.add_option("--test", options.test,
                    "solids: " + known_lab_tests(4) + "; joints: " + known_lab_tests(2));
  parser.add_option("--path", options.path,
                    "CSV of stresses and strains in place of --test, one leg per row: columns stress_xx ... "
                    "strain_xy, steps, "
                    "duration (docs/manual/drive.md)");
  parser
      .add_option("--pressure", options.pressure,
                  "stress at the start: isotropic, or across a joint (default 0)")
      ->check(finite_number);
  parser.add_option("--start", options.start, "XX,YY,ZZ,XY or SHEAR,NORMAL: stress components at the start")
      ->delimiter(',')
      ->check(finite_number);
  parser
      .add_option("--to", options.turns,
                  "final value of the driven strain, displacement or stress; several values are turning points")
      ->delimiter(',')
      ->check(finite_number);
  parser.add_option("--cycles", options.cycles, "number of passes through the turning points (default 1)")
      ->check(CLI::Range(1, 10000));
  parser.add_option("--steps", options.steps, "steps per leg (default 100)")->check(CLI::Range(1, 1000000));
  parser.add_flag("--undrained", options.undrained, "no change of volume (of joints: no normal displacement)");
  parser
      .add_option("--normal-stiffness", options.normal_stiffness,
                  "stress/length of the ground that a shearing joint pushes when it dilates")
      ->check(number_in(0.0, 1e300, "a finite number that is not negative"));
}

}  // namespace

Command drive_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<DriveOptions>();
  parser.footer(
      "Example:\n"
      "  sagefe drive --law mohr_coulomb --set E=2e4 --set nu=.3 --set c=5 --set phi=30\n"
      "    --test triaxial_compression --pressure 100 --to .05 --csv mc.csv\n"
      "    --plot mc.svg\n\n"
      "Compression positive; strains as fractions. Exit code 3 if a curve is not complete.");
  add_law_options(parser, *options);
  add_test_options(parser, *options);
  parser
      .add_option("--fit", options->fits,
                  "FILE, FILE@PRESSURE or FILE@PRESSURE,TEST[,undrained]: a measured curve (CSV: what the test "
                  "drives, then "
                  "columns of --csv); finds the parameters of --free by least squares; may be repeated")
      ->allow_extra_args(false);
  parser
      .add_option("--free", options->free,
                  "NAME or NAME=LOW:HIGH,...: parameters for --fit, which starts from their values in --set")
      ->delimiter(',');
  parser.add_option("--csv", options->csv,
                    "write the curves as a table; - is standard output, in place of the summary");
  parser.add_option("--plot", options->plot, "write the curves as SVG");
  parser.add_option("--xy", options->panels, "X:Y columns of a panel of the plot; may be repeated")
      ->allow_extra_args(false);
  add_digits_option(parser, options->digits);
  return [options, &catalogue] { return drive_laws(*options, catalogue); };
}

}  // namespace sage::app

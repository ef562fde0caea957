#include "sage/app/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/plugins.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/studies.hpp"
#include "sage/app/wrap.hpp"
#include "sage/deck/printable.hpp"
#include "sage/messages/near_names.hpp"

namespace sage {
namespace app {
namespace {

constexpr const char* kDescription =
    "sagefe: 2-D geotechnical finite elements from fixed-format decks, in plane\n"
    "strain and axisymmetry.\n"
    "Try:  sagefe new deck KIND    write a deck to start from\n"
    "      sagefe run DECK         compute a deck\n"
    "      sagefe check DECK       read and validate it, compute nothing\n"
    "      sagefe list elements    elements that a deck can use\n"
    "      sagefe list decks       decks that come with the program";
constexpr const char* kNoEquilibrium = "no equilibrium, singular or out of memory";
constexpr const char* kBySignal = "interrupted (Ctrl-C, SIGTERM)";

std::string footer(const std::string& three = kNoEquilibrium, const std::string& five = kBySignal) {
  return "Signs: compression is positive for stress and strain; displacements and forces are positive along "
         "the "
         "axes.\nExit codes: 0 done; 1 command line; 2 input; 3 " +
         three + "; 4 output could not be written; 5 " + five + ".";
}

struct Entry {
  const char* name;
  const char* about;
  Command (*add_options)(CLI::App& parser, const Catalogue& catalogue);
  bool has_plugins = false;
  bool (*apart)() = nullptr;           // true: it is done by a program beside this one
  const char* three = kNoEquilibrium;  // what exit code 3 means
  const char* five = kBySignal;        // and 5
};

constexpr Entry kCommands[] = {
    {"run", "compute decks; listing, CSV and reports go to the output folder", run_command, true, nullptr,
     kNoEquilibrium, "interrupted (Ctrl-C, SIGTERM); sagefe run --restart continues"},
    {"check", "read and validate decks; compute nothing", check_command, true},
    {"echo", "show each card of a deck as it was read, under a column ruler", echo_command, true},
    {"align", "move the values of a deck into their columns, and name each move", align_command},
    {"layout", "draft a card layout for an unknown deck (guess), or show what a layout reads of a deck (check)",
     layout_command},
    {"list",
     "list the elements, materials and solvers for decks, the fields of results, or decks to start from",
     list_command, true},
    {"plot", "draw curves from tables of earlier runs, and pictures of their states", plot_command, true},
    {"report", "write one HTML page of a run, or of two side by side: fields, curves, messages, deck",
     report_command, true},
    {"conform", "run the conformance tests on a plug-in or UMAT", conform_command, true},
    {"new", "write a commented deck that runs, or a folder with a law, an element or a UMAT of your own",
     new_command},
    {"tables", "compute the source chapter's Tables 7.3 and 7.4 and compare with its numbers", tables_command},
    {"figures", "compute the source chapter's Figures 7.1 to 7.40 and check its statements about them",
     figures_command, false, [] { return !studies().figures; }},
    {"convert", "write a deck, model file or mesh as deck (.dat), model file (.sage.toml), .msh or .inp",
     convert_command, true},
    {"verify", "compare cases with closed forms, converged references and published values", verify_command,
     false, [] { return !studies().verify; }, "a row exceeds its gate"},
    {"compare", "compare two decks, or one deck with two settings: forces, stresses, lines, theory, pictures",
     compare_command, true, nullptr, "a run is not complete, or less certain than --converge requires"},
    {"drive", "run laboratory tests (triaxial, oedometer, shear, ...) on a law without a mesh; CSV and plots",
     drive_command, true, nullptr, "a path has no answer at some step, or --fit did not converge"},
    {"safety",
     "factor of safety by strength reduction: bracket with the reason for both ends, curve, mechanism",
     safety_command, true, nullptr, "the bracket is not proved, or --converge did not reach its limit"},
    {"bounds", "rigorous lower and upper bounds on a collapse load or factor of safety by limit analysis",
     bounds_command, true, nullptr,
     "a bound is missing, or --safety has no proved bracket or contradicts the bounds"},
    {"sweep", "run many cases of one deck (grids, lists, random draws of its numbers); one table and a plot",
     sweep_command, true},
    {"stress", "sweep parameters to their limits: each result must be right, or an error must name the fault",
     stress_command, false, [] { return !studies().stress; }, "a row fails"},
    {"explain", "explain a message by its code: what it means and what helps", explain_command},
    {"completion", "print the completion script for bash, zsh or fish", completion_command},
};

// Help in the columns of a terminal.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return wrapped(CLI::Formatter::make_help(app, std::move(name), mode), kHelpColumns);
  }

  // A long list of choices is part of the description, which can be broken.
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    if (const std::string list = long_list(text); !list.empty()) text.erase(text.find(list), list.size());
    return text;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    std::string list = long_list(CLI::Formatter::make_option_opts(option));
    if (list.empty()) return option->get_description();
    list = list.substr(2, list.size() - 3);
    for (std::size_t at = 0; (at = list.find(',', at)) != std::string::npos; at += 2) list.replace(at, 1, ", ");
    return option->get_description() + "; one of: " + list;
  }

 private:
  // ":{a,b,c}"; empty where it is short or there is none.
  static std::string long_list(const std::string& text) {
    constexpr std::size_t kShort = 40;
    const std::size_t begin = text.find(":{"), end = text.find('}', begin);
    if (begin == std::string::npos || end == std::string::npos || end - begin < kShort) return {};
    return text.substr(begin, end - begin + 1);
  }
};

void describe(CLI::App& root) {
  root.formatter(std::make_shared<HelpFormatter>());
  root.description(kDescription);
  root.footer(footer());
  root.require_subcommand(1);
  root.set_version_flag("--version", "sagefe " SAGE_VERSION);
}

CLI::App* add_command(CLI::App& root, const Entry& entry) {
  CLI::App* const parser = root.add_subcommand(entry.name, entry.about);
  parser->footer(footer(entry.three, entry.five));
  return parser;
}

Code code_of(const CLI::Error& error) {
  switch (static_cast<CLI::ExitCodes>(error.get_exit_code())) {
    case CLI::ExitCodes::ExtrasError:
      return "S902";
    case CLI::ExitCodes::RequiredError:
    case CLI::ExitCodes::ArgumentMismatch:
      return "S903";
    case CLI::ExitCodes::ExcludesError:
    case CLI::ExitCodes::RequiresError:
      return "S905";
    default:
      return "S904";
  }
}

// Options and subcommands of the commands that the line names.
void gather_names(const CLI::App& app, std::vector<std::string>& options, std::vector<std::string>& commands) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(below->get_name());
  for (const CLI::App* below : app.get_subcommands()) gather_names(*below, options, commands);
}

// The parser's message, and for words that it did not expect the names that are near.
std::string message_of(const CLI::App& root, const CLI::Error& error) {
  std::string text = error.what();
  std::vector<std::string> options, commands;
  gather_names(root, options, commands);
  for (const std::string& word : root.remaining(true))
    text += did_you_mean(word.substr(0, word.find('=')), word.starts_with('-') ? options : commands);
  return text;
}

std::string complaint(const CLI::App* root, const CLI::Error& error) {
  return with_code(message_of(*root, error), code_of(error)) + "\nRun with --help for more information.\n";
}

// The command that the first word which is no option names, whose options alone are made; nullptr, with a
// message, where it is none.
const Entry* find_command(const std::string& word) {
  std::string known;
  for (const Entry& entry : kCommands) {
    if (word == entry.name) return &entry;
    known += std::string(" ") + entry.name;
  }
  // The parser itself would only ask for one.
  std::vector<std::string> names;
  for (const Entry& entry : kCommands) names.emplace_back(entry.name);
  say_error("sagefe", fmt::format("unknown command {}; known:{}{}", word, known, did_you_mean(word, names)),
            "S901");
  return nullptr;
}

// Also of a command line that can't be parsed.
bool asks_for_json(int argc, char** argv) {
  return std::any_of(argv, argv + argc, [](const char* word) { return std::strcmp(word, "--json") == 0; });
}

// The parser's message, as its exit() prints it.
int say_parse_error(const CLI::App& root, const CLI::ParseError& error) {
  std::ostringstream out, err;
  const int code = root.exit(error, out, err);
  std::fputs(out.str().c_str(), stdout);  // what could not be written shows at the end
  print_stderr(err.str());
  if (code != 0)
    keep_message({Severity::error, code_of(error), {"sagefe", 0, 0, 0}, message_of(root, error), {}});
  return code == 0 ? kOk : kUsage;
}

void say_output_lost() {
  say_error("sagefe", "standard output could not be written", "S911");
}

// The document of --json; an answer that can't be written is none.
int with_answer(const std::string& command, int code, const MutedOutput& output) {
  if (output.write(printable(answer_text(command, code)))) return code;
  say_output_lost();
  return kOutput;
}

int execute_chosen(const std::string& name, const Command& execute, const ScreenOptions& options) {
  set_screen(options);
  if (!options.quiet && !options.json) return guarded("sagefe", execute);
  const MutedOutput output;
  const int code = guarded("sagefe", execute);
  return options.json ? with_answer(name, code, output) : code;
}

int refuse(const std::string& name, const std::function<int()>& say) {
  const int code = say();
  return screen().json && code != kOk ? with_answer(name, code, MutedOutput()) : code;
}

// A name of an option where another wants its value ("--write -q") is a value forgotten, not a file of that name.
void refuse_options_as_values(CLI::App& parser) {
  const auto is_option = [&parser](const std::string& value) {
    if (value.size() < 2 || value.front() != '-' || parser.get_option_no_throw(value) == nullptr)
      return std::string();
    return "wanted a value, and " + value + " is an option; a file of that name is ./" + value;
  };
  for (CLI::Option* option : parser.get_options())
    if (option->get_expected_max() > 0) option->check(is_option);
}

// A command's own and those that it shares with others.
Command add_all_options(CLI::App& parser, const Entry& entry, const Catalogue& catalogue,
                        ScreenOptions& screen) {
  if (entry.has_plugins) add_plugin_options(parser);
  Command execute = entry.add_options(parser, catalogue);
  add_screen_options(parser, screen);
  refuse_options_as_values(parser);
  return execute;
}

// All that the command can ask for, with what the command line loads.
Catalogue catalogue_for(const Entry& entry, int argc, char** argv, const AddToCatalogue& add) {
  const auto values = [&](const char* option) {
    return entry.has_plugins ? values_on(argc, argv, option) : std::vector<std::string>();
  };
  Catalogue catalogue = full_catalogue(load_umats(values("--umat")));
  if (add) add(catalogue);
  for (const std::string& file : values("--plugin")) load_plugin(file, catalogue);
  return catalogue;
}

// The command line with --help in the place of nothing, and of `help`: "sagefe help run" is "sagefe run --help".
std::vector<char*> with_help(int argc, char** argv) {
  static char help[] = "--help";
  std::vector<char*> words(argv, argv + argc);
  const bool asked = argc > 1 && std::strcmp(argv[1], "help") == 0;
  if (asked) words.erase(words.begin() + 1);
  if (asked || argc <= 1) words.push_back(help);
  words.push_back(nullptr);
  return words;
}

int run_command_line(int argc, char** argv, const AddToCatalogue& add) {
  CLI::App root("", "sagefe");
  describe(root);
  root.failure_message(complaint);
  int word = 1;
  while (word < argc && argv[word][0] == '-') ++word;  // sagefe --help run
  const bool named = word < argc;
  set_screen({.json = asks_for_json(argc, argv)});
  const Entry* chosen = named ? find_command(argv[word]) : nullptr;
  if (named && chosen == nullptr) return refuse(argv[word], [] { return kUsage; });
  Catalogue catalogue;
  try {
    if (chosen != nullptr) catalogue = catalogue_for(*chosen, argc, argv, add);
  } catch (const std::exception& error) {  // of `add` or a plug-in, such as a code that is taken
    return refuse(argv[word], [&] {
      say_error("sagefe", error);
      return kUsage;
    });
  }
  Command execute;
  ScreenOptions options;
  for (const Entry& entry : kCommands) {
    CLI::App* parser = add_command(root, entry);
    if (&entry != chosen) continue;
    execute = add_all_options(*parser, entry, catalogue, options);
  }
  try {
    root.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refuse(named ? argv[word] : "", [&] { return say_parse_error(root, error); });
  }
  if (!execute) return kUsage;
  if (chosen->apart != nullptr && chosen->apart())
    return refuse(chosen->name,
                  [&] { return guarded("sagefe", [&]() -> int { become_study(chosen->name, argv); }); });
  return execute_chosen(chosen->name, execute, options);
}

// Where the caller closed a standard stream, a file of results would take its number,
// and messages would go there.
void fill_standard_streams() {
  for (int stream : {0, 1, 2})
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) == -1) return;
}

// A write past the limit on the size of files then fails like one on a full disk, with a message, instead of
// ending the program.
void take_no_signal_for_large_files() {
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

void add_all_commands(CLI::App& root, const Catalogue& catalogue) {
  static ScreenOptions unused;  // the options outlive this function; nothing is parsed
  describe(root);
  for (const Entry& entry : kCommands) add_all_options(*add_command(root, entry), entry, catalogue, unused);
}

}  // namespace app

int sagefe(int argc, char** argv, const AddToCatalogue& add) {
  using namespace app;
  fill_standard_streams();
  take_no_signal_for_large_files();
  const PrintableOutput filter;
  int code = kOutput;
  try {
    std::vector<char*> words = with_help(argc, argv);
    code = run_command_line(static_cast<int>(words.size()) - 1, words.data(), add);
  } catch (const std::system_error&) {
    return kOutput;  // not even a message could be written
  } catch (const std::bad_alloc&) {
    std::fputs("sagefe: not enough memory [S508]\n", stderr);
    return kNotConverged;
  } catch (const std::exception& error) {
    say_error("sagefe", error);
    return kUsage;
  }
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  say_output_lost();
  return kOutput;
}

}  // namespace sage

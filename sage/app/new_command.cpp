// sagefe new: a deck that runs, or a folder with a piece of one's own, which builds against the installed package and
// passes the suites.  Both are there to be changed.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/deck/source.hpp"
#include "sage/messages/error.hpp"
#include "sage/messages/near_names.hpp"
#include "sage/platform/module.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string kind, name;
  fs::path folder;
};

// Beside an installed program, else those of the source tree.
fs::path templates() {
  std::error_code ignored;
  const fs::path beside = program_folder();
  const fs::path installed = (beside / SAGE_TEMPLATES_RELATIVE).lexically_normal();
  return !beside.empty() && fs::is_directory(installed, ignored) ? installed : fs::path(SAGE_TEMPLATES_DIR);
}

// It becomes names of files, of a class and of a Fortran routine.
std::string name_flaw(const std::string& name) {
  const bool plain =
      !name.empty() && name.size() <= 30 && std::islower(static_cast<unsigned char>(name[0])) != 0 &&
      std::ranges::all_of(
          name, [](unsigned char c) { return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_'; });
  return plain ? "" : "a name is wanted of lower-case letters, digits and _, at most 30, a letter first";
}

// Why no piece can be called so; empty = one can.  CMake and the headers need some names themselves.
std::string taken_by(const std::string& kind, const std::string& name, const Catalogue& catalogue) {
  for (const char* own : {"all", "clean", "depend", "edit_cache", "help", "install", "list_install_components",
                          "package", "package_source", "preinstall", "rebuild_cache", "test"})
    if (name == own) return "CMake has a target of this name";
  for (const char* own : {"solid", "interface", "structure"})
    if (name == own) return "the headers have a class of this name";
  const auto among = [&](const auto& entries) {
    for (const auto& [code, entry] : entries)
      if (entry.name == name) return "sagefe has " + kind + " " + std::to_string(code) + " of this name";
    return std::string();
  };
  return kind == "law"       ? among(catalogue.materials.entries())
         : kind == "element" ? among(catalogue.elements.entries())
                             : "";
}

// cam_clay: CamClay.
std::string class_name(const std::string& name) {
  std::string words;
  bool first = true;
  for (const char c : name) {
    if (c != '_') words += first ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    first = c == '_';
  }
  return words;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string filled_in(std::string text, const std::string& name) {
  text = replaced(std::move(text), "@name@", name);
  return replaced(std::move(text), "@Name@", class_name(name));
}

int write_folder(const NewOptions& options, const Catalogue& catalogue) {
  if (const std::string taken = taken_by(options.kind, options.name, catalogue); !taken.empty())
    throw UsageError("S904", options.name + ": another name is wanted, since " + taken);
  const fs::path from = templates() / options.kind;
  if (!fs::is_directory(from))
    throw OutputError("S807", "the templates are missing: no folder " + from.string());
  const fs::path folder = options.folder.empty() ? fs::path(options.name) : options.folder;
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error))
    throw UsageError("S807", folder.string() + " is there already and not empty");
  fs::create_directories(folder, error);
  if (error) throw OutputError("S601", "cannot make the folder " + folder.string() + ": " + error.message());
  for (const fs::directory_entry& file : fs::directory_iterator(from)) {
    // Sources are kept as NAME.cpp.in, which no tool takes for sources.
    const fs::path name = file.path().extension() == ".in" ? file.path().stem() : file.path().filename();
    OutFile out(folder / filled_in(name.string(), options.name));
    out.text() = filled_in(read_file(file.path().string()), options.name);
    out.finish();
    answer_file(out.path());
  }
  fmt::print("{}: {} {} that builds and conforms; {} says what to do next\n", folder.string(),
             options.kind == "element" ? "an" : "a", options.kind, (folder / "README.md").string());
  return kOk;
}

std::vector<std::string> deck_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(templates() / "deck", error))
    if (file.path().extension() == ".dat") names.push_back(file.path().stem().string());
  std::ranges::sort(names);
  return names;
}

int write_deck(const NewOptions& options) {
  const std::vector<std::string> names = deck_names();
  if (names.empty())
    throw OutputError("S807", "the templates are missing: no decks in " + (templates() / "deck").string());
  if (std::ranges::find(names, options.name) == names.end())
    throw UsageError("S904", fmt::format("there is no template {}; expected one of: {}{}", options.name,
                                         fmt::join(names, ", "), did_you_mean(options.name, names)));
  const fs::path from = templates() / "deck" / (options.name + ".dat");
  fs::path to = options.folder.empty() ? fs::path(options.name + ".dat") : options.folder;
  std::error_code error;
  if (fs::is_directory(to, error)) to /= options.name + ".dat";
  if (fs::exists(to, error)) throw UsageError("S807", to.string() + " exists already; it was not changed");
  OutFile out(to);
  // The commands in the comments of a template name its own file.
  out.text() = replaced(read_file(from.string()), from.filename().string(), to.filename().string());
  out.finish();
  answer_file(out.path());
  fmt::print("{}: a deck that runs; its first lines say what it computes and which commands to use\n",
             to.string());
  return kOk;
}

}  // namespace

Command new_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<NewOptions>();
  parser.add_option("KIND", options->kind, "deck, law, element or umat")
      ->required()
      ->check(CLI::IsMember({"deck", "law", "element", "umat"}));
  parser
      .add_option(
          "NAME", options->name,
          fmt::format("for a deck: {}; otherwise the name of the new piece: lower-case letters, digits and _",
                      fmt::join(deck_names(), ", ")))
      ->required()
      ->check(name_flaw);
  parser.add_option("-o,--output", options->folder,
                    "file of the deck (default: NAME.dat), or folder of the piece (default: NAME)");
  parser.footer(
      "Example:  sagefe new deck footing\n"
      "          sagefe run footing.dat -o out");
  return [options, &catalogue] {
    return options->kind == "deck" ? write_deck(*options) : write_folder(*options, catalogue);
  };
}

}  // namespace sage::app

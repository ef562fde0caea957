#include "sage/app/plugins.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/Option.hpp>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>

#include "sage/core/plugin.hpp"
#include "sage/platform/module.hpp"

namespace sage::app {

namespace {

static_assert(std::string_view(SAGE_HEADER_HASH) != "unknown");

// What a library gives, before any of it goes into the program's catalogue.
struct Pieces {
  Plugin plugin;
  Catalogue catalogue;
};

std::optional<std::string> field_value(const std::string& abi, const std::string& field) {
  std::istringstream parts(abi);
  for (std::string part; std::getline(parts, part, ';');)
    if (part.starts_with(field + "=")) return part.substr(field.size() + 1);
  return std::nullopt;
}

void expect_same_abi(const std::string& plugin) {
  const std::string difference = abi_difference(plugin, plugin_abi.text.data());
  if (!difference.empty())
    throw PluginError("is built for another program or by another compiler: " + difference +
                      "; build it against this program's package");
}

// Before anything of the library runs.
void expect_plugin_file(const std::string& file) {
  if (const std::string flaw = library_flaw(file); !flaw.empty()) throw PluginError(flaw);
  const std::string abi = elf_section(file, SAGE_PLUGIN_SECTION);
  if (abi.empty())
    throw PluginError("is a library, but no plug-in of sagefe: it has no section " SAGE_PLUGIN_SECTION
                      ", which the macro SAGE_PLUGIN writes (a routine UMAT is loaded by --umat)");
  expect_same_abi(abi.c_str());
}

void expect_text(const char* text, const char* what) {
  constexpr std::size_t kMost = 4096;
  if (text == nullptr) throw PluginError(std::string("gives no ") + what + " (a null pointer)");
  if (*text == '\0') throw PluginError(std::string("gives an empty ") + what);
  if (strnlen(text, kMost) == kMost)
    throw PluginError(std::string("gives a ") + what + " of more than " + std::to_string(kMost) +
                      " characters");
}

void expect_name(const std::string& name) {
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-')
      throw PluginError("is called \"" + name + "\": a name has letters, digits, _ and - only");
}

// Size and version come first: what is behind them is looked at only where they say that it is there.
const SagePlugin& checked(const SagePlugin* plugin) {
  if (plugin == nullptr) throw PluginError("gives nothing: sage_plugin_v1() returned a null pointer");
  if (plugin->struct_size < sizeof(SagePlugin))
    throw PluginError("gives a SagePlugin of " + std::to_string(plugin->struct_size) +
                      " bytes, the program's has " + std::to_string(sizeof(SagePlugin)));
  if (plugin->api != SAGE_PLUGIN_API)
    throw PluginError("has version " + std::to_string(plugin->api) +
                      " of the plug-in interface, the program has " + std::to_string(SAGE_PLUGIN_API));
  expect_text(plugin->name, "name");
  expect_text(plugin->version, "version");
  expect_text(plugin->author, "author");
  expect_text(plugin->abi, "abi");
  if (plugin->fill == nullptr) throw PluginError("has no function fill (a null pointer)");
  expect_name(plugin->name);
  expect_same_abi(plugin->abi);
  return *plugin;
}

void fill(const SagePlugin& plugin, Catalogue& catalogue) {
  std::array<char, 4096> error{};
  int code = 0;
  try {
    code = plugin.fill(catalogue, error.data(), error.size() - 1);
  } catch (const std::exception& thrown) {
    throw PluginError(std::string("threw an exception out of fill: ") + thrown.what());
  } catch (...) {
    throw PluginError("threw what is no std::exception out of fill");
  }
  if (code != 0)
    throw PluginError("can't give its pieces: " +
                      (error[0] != '\0' ? std::string(error.data()) : "error " + std::to_string(code)));
}

// Why a piece can't be used; empty = it can.
std::string flaw_of(const MaterialEntry& law) {
  if (law.law_size < 1 || law.law_size > kMostLawSize)
    return "has " + std::to_string(law.law_size) + " components";
  return law.make || law.make_for ? "" : "has no function that makes it";
}
std::string flaw_of(const ElementEntry& element) {
  if (element.nodes < 2 || element.corners < 2 || element.corners > element.nodes)
    return "has " + std::to_string(element.corners) + " corners and " + std::to_string(element.nodes) +
           " nodes";
  if (element.formulations.empty()) return "has no formulation";
  return element.make ? "" : "has no function that makes it";
}
std::string flaw_of(const SolverEntry& solver) {
  return solver.make ? "" : "has no function that makes it";
}

template <class Entry>
std::vector<int> codes_of(const Registry<Entry>& pieces, const char* kind) {
  std::vector<int> codes;
  for (const auto& [code, entry] : pieces.entries()) {
    const std::string piece = std::string(kind) + " " + std::to_string(code) + " " + entry.name;
    if (code < kFirstPluginCode)
      throw PluginError("brings " + piece + ": codes below " + std::to_string(kFirstPluginCode) +
                        " are the program's own");
    if (entry.name.empty()) throw PluginError("brings " + piece + "without a name");
    if (const std::string flaw = flaw_of(entry); !flaw.empty())
      throw PluginError("brings " + piece + ", which " + flaw);
    codes.push_back(code);
  }
  return codes;
}

// Behind those that every table has.
std::span<const FieldEntry> own_fields(const Catalogue& catalogue) {
  return catalogue.fields.rows().subspan(FieldTable().rows().size());
}

// What the library of a checked file brings.  Runs its code.
Pieces pieces_of(const std::string& file) {
  const Library library = open_library(file);
  if (library.handle == nullptr) throw PluginError("can't be loaded: " + library.error);
  using EntryPoint = const SagePlugin* (*)();
  const auto entry_point = reinterpret_cast<EntryPoint>(dlsym(library.handle, "sage_plugin_v1"));
  if (entry_point == nullptr) throw PluginError("has no function sage_plugin_v1");
  const SagePlugin& plugin = checked(entry_point());
  Pieces pieces;
  fill(plugin, pieces.catalogue);
  pieces.plugin = {plugin.name, plugin.version, plugin.author, file};
  pieces.plugin.materials = codes_of(pieces.catalogue.materials, "law");
  pieces.plugin.elements = codes_of(pieces.catalogue.elements, "element");
  pieces.plugin.solvers = codes_of(pieces.catalogue.solvers, "solver");
  for (const FieldEntry& row : own_fields(pieces.catalogue)) pieces.plugin.fields.push_back(row.name);
  return pieces;
}

// What a child process says before it ends: "+" or "-" and a message; nothing where it crashed.
[[noreturn]] void do_and_tell(const std::function<void()>& work, int to_parent) {
  constexpr unsigned kPatience = 60;  // s
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM}) std::signal(signal, SIG_DFL);
  alarm(kPatience);
  std::string answer = "+";
  try {
    work();
  } catch (const std::exception& error) {
    answer = std::string("-") + error.what();
  }
  const bool written = write(to_parent, answer.data(), answer.size()) == static_cast<ssize_t>(answer.size());
  _exit(written ? 0 : 1);
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 4096> piece;
  for (ssize_t n = 0; (n = read(from, piece.data(), piece.size())) != 0;) {
    if (n > 0) text.append(piece.data(), static_cast<std::size_t>(n));
    if (n < 0 && errno != EINTR) break;
  }
  return text;
}

std::string way_it_ended(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) return "does not end loading within a minute";
  if (WIFSIGNALED(status))
    return "crashes while it is loaded: signal " + std::to_string(WTERMSIG(status)) + " (" +
           strsignal(WTERMSIG(status)) + ")";
  return "ends the program while it is loaded, with exit code " + std::to_string(WEXITSTATUS(status));
}

// Does in a child process what runs code of others for the first time.  Throws what the child found.
void try_apart(const std::function<void()>& work) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw PluginError("can't be tried: " + std::string(std::strerror(errno)));
  const pid_t child = fork();
  if (child == 0) do_and_tell(work, ends[1]);
  close(ends[1]);
  const std::string answer = child > 0 ? read_all(ends[0]) : "";
  close(ends[0]);
  int status = 0;
  if (child < 0) throw PluginError("can't be tried: no process for it");
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (answer.starts_with('-')) throw PluginError(answer.substr(1));
  if (answer != "+") throw PluginError(way_it_ended(status));
}

// Who brought a piece, for a message.
template <class Has>
std::string owner(const Catalogue& catalogue, const Has& has) {
  for (const Plugin& plugin : catalogue.plugins)
    if (has(plugin)) return "plug-in " + plugin.name + " (" + plugin.file + ")";
  return "sagefe itself";
}

template <class Entry>
void expect_free(const Registry<Entry>& there, const Registry<Entry>& pieces, const char* kind,
                 std::vector<int> Plugin::*codes, const Catalogue& catalogue) {
  for (const auto& [code, entry] : pieces.entries())
    for (const auto& [other_code, other] : there.entries())
      if (code == other_code || entry.name == other.name)
        throw PluginError("S803", std::string("brings ") + kind + " " + std::to_string(code) + " " +
                                      entry.name + ", which clashes with " + kind + " " +
                                      std::to_string(other_code) + " " + other.name + " of " +
                                      owner(catalogue, [codes, taken = other_code](const Plugin& plugin) {
                                        const std::vector<int>& own = plugin.*codes;
                                        return std::ranges::find(own, taken) != own.end();
                                      }));
}

void expect_free_fields(const Catalogue& pieces, const Catalogue& catalogue) {
  for (const FieldEntry& row : own_fields(pieces))
    if (const std::string clash = catalogue.fields.clash(row); !clash.empty())
      throw PluginError("S803", "brings field " + row.name + ", which clashes with " +
                                    owner(catalogue,
                                          [&](const Plugin& plugin) {
                                            return std::ranges::find(plugin.fields, row.name) !=
                                                   plugin.fields.end();
                                          }) +
                                    ": " + clash);
}

void add(Pieces pieces, Catalogue& catalogue) {
  for (const Plugin& other : catalogue.plugins) {
    if (std::filesystem::equivalent(other.file, pieces.plugin.file))
      throw PluginError("S803", "is given twice");
    if (other.name == pieces.plugin.name)
      throw PluginError("S803", "is called " + other.name + ", as " + other.file + " is");
  }
  const Catalogue& from = pieces.catalogue;
  expect_free(catalogue.materials, from.materials, "law", &Plugin::materials, catalogue);
  expect_free(catalogue.elements, from.elements, "element", &Plugin::elements, catalogue);
  expect_free(catalogue.solvers, from.solvers, "solver", &Plugin::solvers, catalogue);
  expect_free_fields(from, catalogue);
  for (const auto& [code, entry] : from.materials.entries()) catalogue.materials.add(code, entry);
  for (const auto& [code, entry] : from.elements.entries()) catalogue.elements.add(code, entry);
  for (const auto& [code, entry] : from.solvers.entries()) catalogue.solvers.add(code, entry);
  for (const FieldEntry& row : own_fields(from)) catalogue.fields.add(row);
  catalogue.plugins.push_back(std::move(pieces.plugin));
}

}  // namespace

std::string abi_difference(const std::string& plugin, const std::string& program) {
  std::istringstream parts(program);
  for (std::string part; std::getline(parts, part, ';');) {
    const std::string field = part.substr(0, part.find('=')), own = part.substr(part.find('=') + 1);
    const std::optional<std::string> other = field_value(plugin, field);
    if (!other) return "it says nothing of \"" + field + "\", the program has " + own;
    if (*other != own) return field + " is " + *other + " in the plug-in and " + own + " in the program";
  }
  return {};
}

void load_plugin(const std::string& file, Catalogue& catalogue) {
  try {
    expect_plugin_file(file);
    const std::string path = std::filesystem::absolute(file).string();  // else it would be searched for
    try_apart([&] { pieces_of(path); });
    add(pieces_of(path), catalogue);
  } catch (const PluginError& error) {
    throw PluginError(error.code(), "plug-in " + file + " " + error.what());
  } catch (const std::exception& error) {
    throw PluginError("plug-in " + file + ": " + error.what());
  }
}

std::vector<umat::Binding> load_umats(const std::vector<std::string>& texts) {
  std::vector<umat::Binding> bindings;
  for (const std::string& text : texts) {
    try {
      try_apart([&] { umat::bind(text); });
      bindings.push_back(umat::bind(text));
    } catch (const std::exception& error) {
      throw PluginError("S804", "--umat " + text + ": " + error.what());
    }
    const auto same = [&](const umat::Binding& other) { return other.material == bindings.back().material; };
    if (std::ranges::count_if(bindings, same) > 1)
      throw PluginError("S804", "--umat " + text + ": its materials have a routine already");
  }
  return bindings;
}

std::vector<std::string> values_on(int argc, char** argv, std::string_view option) {
  std::vector<std::string> values;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--") break;
    if (word == option && i + 1 < argc)
      values.emplace_back(argv[++i]);
    else if (word.starts_with(option) && word.substr(option.size()).starts_with('='))
      values.emplace_back(word.substr(option.size() + 1));
  }
  return values;
}

void add_plugin_options(CLI::App& parser) {
  // They are loaded before the options are read, which depend on what there is.
  const auto nothing = [](const std::vector<std::string>&) {};
  parser
      .add_option_function<std::vector<std::string>>(
          "--plugin", nothing,
          "plug-in library to load, with laws, elements, solvers or fields; may be repeated")
      ->allow_extra_args(false);
  parser
      .add_option_function<std::vector<std::string>>("--umat", nothing,
                                                     "[MATERIAL=]LIBRARY[:SYMBOL]: routine UMAT for the "
                                                     "materials of law umat, or for that of this name; may "
                                                     "be repeated")
      ->allow_extra_args(false);
}

}  // namespace sage::app

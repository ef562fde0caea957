// sagefe conform: the suites over the pieces of a plug-in.  They are in a program beside this one, since they count
// allocations, which sagefe does not; and a piece that crashes then ends that program only.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/umat_output.hpp"
#include "sage/platform/module.hpp"
#include "sage/umat/try_routine.hpp"

namespace sage::app {

namespace {

struct ConformOptions {
  std::vector<std::string> libraries;
  std::string only;
  umat::Trial umat;
  std::vector<double> stress{0.0, 0.0, 0.0, 0.0};  // compression +
};

std::string suites_program() {
  const Module program{
      "the program of the suites", "SAGE_CONFORM_PROGRAM", SAGE_CONFORM_RELATIVE, "sagefe-conform", "", ""};
  std::string tried;
  for (const std::string& place : module_places(program)) {
    if (access(place.c_str(), X_OK) == 0 && !std::filesystem::is_directory(place)) return place;
    tried += "\n  " + place;
  }
  throw OutputError("S808",
                    "the program of the suites is not there (it is built where GoogleTest is); tried:" + tried);
}

constexpr int kNotRun = 127;

// All of a file of memory.
std::string text_in(int file) {
  std::string text;
  char buffer[4096];
  for (off_t at = 0;;) {
    const ssize_t size = pread(file, buffer, sizeof buffer, at);
    if (size <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(size));
    at += size;
  }
}

// With --json what a child writes, in memory that both processes see; else it goes where it always does.
class ChildText {
 public:
  ChildText() {
    if (answer() == nullptr) return;
    out_ = memfd_create("checks", MFD_CLOEXEC);
    err_ = memfd_create("messages", MFD_CLOEXEC);
  }
  ~ChildText() {
    for (const int file : {out_, err_})
      if (file >= 0) ::close(file);
  }
  ChildText(const ChildText&) = delete;
  ChildText& operator=(const ChildText&) = delete;

  // In the child.
  void take_output() const {
    if (out_ >= 0) dup2(out_, STDOUT_FILENO);
    if (err_ >= 0) dup2(err_, STDERR_FILENO);
  }
  // In the parent, when the child has ended: its lines, which end in a verdict, and its messages.
  void keep() const {
    if (out_ < 0 || err_ < 0) return;
    Json& lines = (*answer())["lines"];
    if (lines.is_null()) lines = Json::array();
    std::istringstream out(text_in(out_)), err(text_in(err_));
    for (std::string line; std::getline(out, line);) lines.push_back(json_text(line));
    constexpr std::string_view kWho = "sagefe: ";
    for (std::string line; std::getline(err, line);)
      if (const std::optional<Code> code = code_in(line); code && line.starts_with(kWho))
        say_error("sagefe", line.substr(kWho.size()), *code);
      else
        print_stderr(line + '\n');
  }

 private:
  int out_ = -1, err_ = -1;
};

// The exit code of what is done in a process of its own, which it may crash.
int done_apart(const std::function<int()>& work) {
  std::fflush(stdout);
  const ChildText text;
  const pid_t child = fork();
  if (child == 0) {
    text.take_output();
    _exit(work());
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == kNotRun))
    throw OutputError("S808", "the checks can't be run");
  text.keep();
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  say_error("sagefe",
            fmt::format("the checks were ended by signal {} ({}): a piece has crashed", WTERMSIG(status),
                        strsignal(WTERMSIG(status))),
            "S810");
  return kNotConverged;
}

int run_program(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return done_apart([&] {
    execv(arguments.front(), arguments.data());
    return kNotRun;
  });
}

int try_umat(const ConformOptions& options, const std::string& text) {
  umat::Trial trial = options.umat;
  const umat::Binding binding = umat::bind(text);
  trial.setup.routine = binding.routine;
  trial.setup.material = binding.material;
  if (options.stress.size() != 4 || trial.statev.size() > static_cast<std::size_t>(trial.setup.statev))
    throw UsageError("S903", "--stress has four numbers, and --initial no more than there are state variables");
  trial.stress = -Vector4(options.stress.data());
  return done_apart([&] {
    std::ostringstream answer;
    bool holds = false;
    with_umat_output(text, [&] { holds = umat::try_routine(trial, answer); });
    fmt::print("{}", answer.str());
    return std::fflush(stdout) != 0 ? kOutput : holds ? kOk : kNotConverged;
  });
}

void add_umat_options(CLI::App& parser, ConformOptions& options) {
  constexpr const char* kGroup = "Of --umat";
  parser.add_option("--props", options.umat.setup.props, "PROPS, separated by commas")
      ->delimiter(',')
      ->group(kGroup);
  parser.add_option("--statev", options.umat.setup.statev, "NSTATV (default: 0)")
      ->check(CLI::Range(0, 100000))
      ->group(kGroup);
  parser
      .add_option("--initial", options.umat.statev, "first values of STATEV, separated by commas (default: 0)")
      ->delimiter(',')
      ->group(kGroup);
  parser.add_option("--components", options.umat.setup.components, "NTENS, 4 (default) or 6")
      ->check(CLI::IsMember({4, 6}))
      ->group(kGroup);
  parser.add_flag("--symmetric", options.umat.setup.symmetric, "DDSDDE is symmetric in every state")
      ->group(kGroup);
  parser.add_option("--stress", options.stress, "xx,yy,zz,xy at the start, compression positive (default: 0)")
      ->delimiter(',')
      ->group(kGroup);
  parser.add_option("--strain", options.umat.strain, "increment of strain (default: 1e-3)")
      ->check(number_in(1e-12, 1.0, "a number from 1e-12 to 1"))
      ->group(kGroup);
}

}  // namespace

Command conform_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<ConformOptions>();
  parser.add_option("LIBRARY", options->libraries, "plug-ins to test");
  parser.add_option("--only", options->only, "run only checks whose name contains this text");
  add_umat_options(parser, *options);
  const CLI::Option* umats = parser.get_option("--umat");
  parser.footer("Exit codes: 0 all checks pass, 1 the library can't be loaded, 3 a check fails.");
  return [options, umats, &catalogue] {
    int worst = kOk;
    for (const std::string& text : umats->results()) worst = std::max(worst, try_umat(*options, text));
    if (options->libraries.empty() && umats->results().empty())
      throw UsageError("S903", "a plug-in is wanted, or --umat with a routine");
    if (options->libraries.empty()) return worst;
    std::vector<std::string> words{suites_program(), options->only};
    for (const Plugin& plugin : catalogue.plugins) words.insert(words.end(), {"--plugin", plugin.file});
    words.insert(words.end(), options->libraries.begin(), options->libraries.end());
    return std::max(worst, run_program(words));
  };
}

}  // namespace sage::app

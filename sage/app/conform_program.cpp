// sagefe-conform: the program behind `sagefe conform`.  Arguments: a text that the names of checks must have
// (empty: all), then --plugin LIBRARY for each that is only loaded, then the libraries whose pieces are tried.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <map>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/plugins.hpp"
#include "sage/app/screen.hpp"
#include "sage/conformance/suites.hpp"
#include "sage/deck/printable.hpp"

namespace sage::app {
namespace {

// What is tried; set before GoogleTest asks for it.
struct Subjects {
  Catalogue catalogue;
  std::vector<conformance::LawSubject> laws;
  std::vector<conformance::ElementSubject> elements;
  std::vector<conformance::SolverSubject> solvers;
  std::vector<std::string> untried;  // laws without trials
};
Subjects& subjects() {
  static Subjects all;
  return all;
}

using conformance::Elements;
using conformance::Laws;
using conformance::Solvers;
// A library need not have pieces of every kind.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Laws);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Elements);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Solvers);
INSTANTIATE_TEST_SUITE_P(Plugin, Laws, testing::ValuesIn(subjects().laws), conformance::name_of_law);
INSTANTIATE_TEST_SUITE_P(Plugin, Elements, testing::ValuesIn(subjects().elements),
                         conformance::name_of_elements);
INSTANTIATE_TEST_SUITE_P(Plugin, Solvers, testing::ValuesIn(subjects().solvers), conformance::name_of_solver);

// For a name of GoogleTest: letters, digits and _.
std::string plain(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

void add_laws(const Plugin& plugin, Subjects& all) {
  for (const int code : plugin.materials) {
    const MaterialEntry& entry = *all.catalogue.materials.find(code);
    int number = 0;
    for (const LawTrial& t : entry.trials)
      all.laws.push_back({&all.catalogue,
                          {fmt::format("law_{}_{}_trial_{}", code, plain(entry.name), ++number), code, t.values,
                           t.strain, t.bounded, t.reaches_strength, t.knows_directions}});
    if (entry.trials.empty()) all.untried.push_back(fmt::format("law {} {}", code, entry.name));
  }
}

void add_pieces(const Plugin& plugin, Subjects& all) {
  add_laws(plugin, all);
  for (const int code : plugin.elements)
    all.elements.push_back({fmt::format("element_{}_{}", code, plain(all.catalogue.elements.find(code)->name)),
                            &all.catalogue,
                            {code}});
  for (const int code : plugin.solvers) all.solvers.push_back({&all.catalogue, code});
}

// The check under way, for a signal's handler.
std::array<char, 256> under_way{};

void say_where(int signal) {
  constexpr std::string_view kWords = "crashed in the check: ";
  (void)!write(STDOUT_FILENO, kWords.data(), kWords.size());
  (void)!write(STDOUT_FILENO, under_way.data(), std::strlen(under_way.data()));
  (void)!write(STDOUT_FILENO, "\n", 1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

// "TangentIsTheDerivative/law_1000_clay_trial_1" as "law 1000 clay trial 1" and "tangent is the derivative".
std::string words_of(std::string_view name) {
  std::string words;
  for (const char c : name) {
    const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0;
    if (upper && !words.empty()) words += ' ';
    words += upper ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c == '_' ? ' ' : c;
  }
  return words;
}

// The verdict, piece by piece.
class Verdict final : public testing::EmptyTestEventListener {
 public:
  void OnTestStart(const testing::TestInfo& test) override {
    shown_ = 0;
    std::snprintf(under_way.data(), under_way.size(), "%s", full_name(test).c_str());
  }
  void OnTestPartResult(const testing::TestPartResult& result) override {
    constexpr int kShown = 3;
    if (!result.failed() || ++shown_ > kShown) return;
    if (shown_ == 1) fmt::print("FAILS  {}\n", under_way.data());
    std::string text = result.summary();
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 10)
      text.replace(at, 1, "\n         ");
    fmt::print("         {}\n", text);
    std::fflush(stdout);
  }
  void OnTestEnd(const testing::TestInfo& test) override {
    auto& [checks, failures] = pieces_[piece_of(test)];
    ++checks;
    failures += test.result()->Failed() ? 1 : 0;
  }
  // Whether all hold.
  bool conclude() const {
    int failing = 0;
    for (const auto& [piece, counts] : pieces_) {
      fmt::print("{}: {} checks, {}\n", piece, counts.first,
                 counts.second == 0 ? "all hold" : fmt::format("{} FAIL", counts.second));
      failing += counts.second;
    }
    return failing == 0;
  }

 private:
  static std::string piece_of(const testing::TestInfo& test) {
    const std::string name = test.name();
    const std::string_view suite = test.test_suite_name();
    return (suite.ends_with("Solvers") ? "solver " : "") + words_of(name.substr(name.find('/') + 1));
  }
  static std::string full_name(const testing::TestInfo& test) {
    const std::string name = test.name();
    return piece_of(test) + ": " + words_of(name.substr(0, name.find('/')));
  }

  std::map<std::string, std::pair<int, int>> pieces_;
  int shown_ = 0;
};

// Which of them are tried.
std::vector<std::string> load(int argc, char** argv, Subjects& all) {
  all.catalogue = full_catalogue();
  std::vector<std::string> names;
  for (int i = 2; i < argc; ++i) {
    const bool only_loaded = std::string_view(argv[i]) == "--plugin" && i + 1 < argc;
    load_plugin(argv[only_loaded ? ++i : i], all.catalogue);
    if (!only_loaded) names.push_back(all.catalogue.plugins.back().name);
  }
  for (const Plugin& plugin : all.catalogue.plugins) {
    if (std::ranges::find(names, plugin.name) == names.end()) continue;
    fmt::print("{} {} by {}: {} laws, {} elements, {} solvers, {} fields\n", plugin.name, plugin.version,
               plugin.author, plugin.materials.size(), plugin.elements.size(), plugin.solvers.size(),
               plugin.fields.size());
    add_pieces(plugin, all);
  }
  return names;
}

int try_all(const std::string& only) {
  testing::GTEST_FLAG(filter) = only.empty() ? "*" : "*" + only + "*";
  std::string program = "sagefe-conform";
  std::array<char*, 2> arguments{program.data(), nullptr};
  int count = 1;
  testing::InitGoogleTest(&count, arguments.data());
  testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
  delete listeners.Release(listeners.default_result_printer());
  auto* verdict = new Verdict;  // GoogleTest owns it
  listeners.Append(verdict);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, say_where);
  const bool green = RUN_ALL_TESTS() == 0;
  bool holds = verdict->conclude() && green;
  for (const std::string& piece : subjects().untried) {
    fmt::print("{}: not tried, its entry has no trials (parameters to try it with)\n", piece);
    holds = false;
  }
  fmt::print("verdict: {}\n", holds ? "conforms" : "does NOT conform");
  return holds ? kOk : kNotConverged;
}

int conform(int argc, char** argv) {
  const PrintableOutput filter;
  try {
    load(argc, argv, subjects());
  } catch (const std::exception& error) {
    fmt::print(stderr, "sagefe: {}\n", printable(message_of(error)));
    return kUsage;
  }
  return try_all(argc > 1 ? argv[1] : "");
}

}  // namespace
}  // namespace sage::app

int main(int argc, char** argv) {
  return sage::app::conform(argc, argv);
}

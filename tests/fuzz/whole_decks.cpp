// Whole damaged decks through the whole program, for a build with sanitizers: every deck of legacy_inputs,
// damaged in one to four places, run with options by lot.  One process prepares everything once and forks a
// child for each deck, which is the program from its command line on (sage/app/program.hpp).
//
//   whole_decks [--count N] [--first I] [--seed S] [--seconds T] [--replay I] [--scratch FOLDER]
//
// Input number I of a seed is always the same deck and the same command line, whatever N is; --replay I leaves
// it in FOLDER, prints the command and shows its output.  A child that runs for longer than T seconds (default
// 4) gets SIGTERM and must then end by itself.  What must hold for every input:
//   - no signal, no report of a sanitizer, no exit code that is not documented, an end in bounded time;
//   - a message on standard error where the exit code is not 0;
//   - no file left under a temporary name, and no inf or nan in a CSV file of a run that exits 0.
// Exit code 0: nothing found; 1: found, and the inputs are named; 2: the command line.
#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "sage/app/exit_codes.hpp"
#include "sage/app/program.hpp"

// A report ends the child with a code that the program does not use.  A model that needs too much memory is
// ended before the machine suffers, and counted apart: the sanitizers' operator new can't throw.
extern "C" const char* __asan_default_options() {
  return "exitcode=99:hard_rss_limit_mb=3000:allocator_may_return_null=1:handle_abort=1";
}
extern "C" const char* __ubsan_default_options() {
  return "print_stacktrace=1";
}

namespace {

namespace fs = std::filesystem;

constexpr int kReport = 99;       // exit code of a sanitizer's report
constexpr int kPatience = 60000;  // ms that a child may take to end after SIGTERM

struct Settings {
  int count = 2000, first = 0;
  unsigned seed = 1;
  double seconds = 4.0;
  int replay = -1;
  fs::path scratch = fs::temp_directory_path() / ("sagefe_whole_decks_" + std::to_string(::getpid()));
};

struct BaseDeck {
  std::string name, layout, text;  // layout: empty where the program finds it by itself
};

struct Input {
  std::string name, deck;
  std::vector<std::string> command;  // behind `sagefe`
};

std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Sorted by name: the order of a folder must not choose the inputs.
std::vector<BaseDeck> base_decks() {
  const fs::path inputs = SAGE_SOURCE_DIR "/legacy_inputs";
  std::vector<BaseDeck> decks;
  for (const auto& entry : fs::recursive_directory_iterator(inputs)) {
    const fs::path& path = entry.path();
    const std::string kind = path.extension().string(), stem = path.stem().string();
    if (kind != ".dat" && kind != ".cid" && kind != ".Q4I") continue;
    BaseDeck deck{fs::relative(path, inputs).string(), "", file_text(path)};
    if (path.parent_path().filename() == "smith_griffiths")
      deck.layout = "sg_" + stem.substr(0, stem.find('_'));
    decks.push_back(deck);
  }
  std::sort(decks.begin(), decks.end(), [](const BaseDeck& a, const BaseDeck& b) { return a.name < b.name; });
  return decks;
}

// ---- Damage ----

using Random = std::mt19937_64;

// From 0 to n - 1.  Not std::uniform_int_distribution: another library's would give other inputs.
std::size_t draw(Random& random, std::size_t n) {
  return n == 0 ? 0 : static_cast<std::size_t>(random() % n);
}

template <std::size_t n>
std::string pick(Random& random, const std::array<const char*, n>& of) {
  return of[draw(random, n)];
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// The characters of some word of a line that is not blank, as first and length; {0, 0} if there is none.
std::pair<std::size_t, std::size_t> some_word(Random& random, const std::string& line) {
  std::vector<std::pair<std::size_t, std::size_t>> words;
  for (std::size_t at = line.find_first_not_of(' '); at != std::string::npos;) {
    const std::size_t end = std::min(line.find(' ', at), line.size());
    words.emplace_back(at, end - at);
    at = line.find_first_not_of(' ', end);
  }
  return words.empty() ? std::pair<std::size_t, std::size_t>{0, 0} : words[draw(random, words.size())];
}

// Numbers that a program may choke on; a word keeps its last column, as a field of a card would.
void hostile_number(Random& random, std::string& line) {
  static constexpr std::array<const char*, 24> kNumbers{
      "0",          "-1",   "1",     "2",     "7",    "99999", "-99999", "123456",
      "2147483648", "1e30", "1e-30", "1e308", "-0.",  "nan",   "inf",    "-inf",
      "abc",        "",     "1.E5",  "0.5",   "-1e5", ".4999", "90.",    "1e-308"};
  const auto [at, size] = some_word(random, line);
  if (size == 0) return;
  std::string number = pick(random, kNumbers);
  if (number.size() < size) number.insert(0, size - number.size(), ' ');
  const std::size_t more = number.size() - size;  // taken from blanks before the word where there are any
  const std::size_t begin =
      more <= at && line.substr(at - more, more).find_first_not_of(' ') == std::string::npos ? at - more : at;
  line = line.substr(0, begin) + number + line.substr(at + size);
}

void other_character(Random& random, std::string& line) {
  const auto [at, size] = some_word(random, line);
  if (size > 0) line[at + draw(random, size)] = "0123456789-.eE"[draw(random, 14)];
}

// Another number of the same shape: the likeliest to be another deck that runs.
void other_digit(Random& random, std::string& line) {
  const auto [at, size] = some_word(random, line);
  std::vector<std::size_t> digits;
  for (std::size_t i = at; i < at + size; ++i)
    if (line[i] >= '0' && line[i] <= '9') digits.push_back(i);
  if (!digits.empty()) line[digits[draw(random, digits.size())]] = "0123456789"[draw(random, 10)];
}

void damage_line(Random& random, std::string& line) {
  switch (draw(random, 10)) {
    case 0:
    case 1:
      return hostile_number(random, line);
    case 2:
      return other_character(random, line);
    case 3:
      line.insert(draw(random, line.size() + 1), 1, ' ');
      return;
    case 4:
      if (!line.empty()) line.erase(draw(random, line.size()), 1);
      return;
    case 5:
      if (!line.empty()) line[draw(random, line.size())] = static_cast<char>(draw(random, 256));
      return;
    default:
      return other_digit(random, line);
  }
}

void damage_lines(Random& random, std::vector<std::string>& lines, const std::vector<std::string>& others) {
  const std::size_t at = draw(random, lines.size()), to = draw(random, lines.size());
  const auto place = [&](std::size_t i) { return lines.begin() + static_cast<std::ptrdiff_t>(i); };
  switch (draw(random, 6)) {
    case 0:
      lines.erase(place(at));
      return;
    case 1:
      lines.insert(place(to), std::string(lines[at]));
      return;
    case 2:
      std::swap(lines[at], lines[to]);
      return;
    case 3:
      if (!others.empty()) lines.insert(place(at), others[draw(random, others.size())]);
      return;
    case 4:
      if (!others.empty()) lines[at] = others[draw(random, others.size())];
      return;
    default:
      lines.resize(at + 1);
      lines.back().resize(draw(random, lines.back().size() + 1));
  }
}

std::string damaged(Random& random, const std::string& text, const std::string& other) {
  std::vector<std::string> lines = lines_of(text);
  const std::vector<std::string> others = lines_of(other);
  const std::size_t places = draw(random, 2) == 0 ? 1 : 1 + draw(random, 4);
  for (std::size_t i = 0; i < places && !lines.empty(); ++i) {
    if (draw(random, 6) == 0)
      damage_lines(random, lines, others);
    else
      damage_line(random, lines[draw(random, lines.size())]);
  }
  return joined(lines);
}

// ---- Command lines ----

void add_words(std::vector<std::string>& command, const std::string& text) {
  std::istringstream in(text);
  for (std::string word; in >> word;) command.push_back(word);
}

constexpr std::array<const char*, 30> kRunOptions{"--vtu",
                                                  "--nodes --points",
                                                  "--error",
                                                  "--condition",
                                                  "--picture stress_yy",
                                                  "--picture displacement",
                                                  "--formulation 1",
                                                  "--formulation 2",
                                                  "--element quad8",
                                                  "--element quad25",
                                                  "--refine 1",
                                                  "--grade auto:2",
                                                  "--grade 1:3",
                                                  "--geometry 1",
                                                  "--geometry 2",
                                                  "--solver umfpack",
                                                  "--solver skyline_lu",
                                                  "--solver cholmod",
                                                  "--tables all",
                                                  "--strict",
                                                  "--without all",
                                                  "--converge 1e-2 --max-dofs 3000 --max-seconds 1",
                                                  "--checkpoint 0",
                                                  "--refine-solves 2",
                                                  "--layout sage1",
                                                  "--layout sg_p61",
                                                  "--layout cande_level3",
                                                  "--restart",
                                                  "--no-listing",
                                                  "--threads 1"};

std::vector<std::string> command_line(Random& random, const BaseDeck& base) {
  std::vector<std::string> command;
  const std::size_t kind = draw(random, 20);
  if (kind == 0) {
    add_words(command, "check deck.dat");
  } else if (kind == 1) {
    add_words(command, "echo deck.dat");
  } else if (kind == 2) {
    static constexpr std::array<const char*, 3> kTargets{"out.dat", "out.msh", "out.inp"};
    add_words(command, "convert deck.dat " + pick(random, kTargets));
  } else if (kind == 3) {
    add_words(command, "compare deck.dat --both -o out");
  } else if (kind == 4) {
    add_words(command,
              draw(random, 2) == 0 ? "layout guess deck.dat -o out.toml" : "layout check sage1 deck.dat");
    return command;
  } else {
    add_words(command, "run deck.dat -o out");
    for (std::size_t n = draw(random, 4); n > 1; --n) add_words(command, pick(random, kRunOptions));
  }
  const bool has_layout = std::find(command.begin(), command.end(), "--layout") != command.end();
  if (!base.layout.empty() && !has_layout) add_words(command, "--layout " + base.layout);
  // CANDE's decks ask for more than there is and would all end there.
  if (base.name.ends_with(".cid") && kind > 1) add_words(command, "--partial");
  return command;
}

// Large decks, which are a few of many, less often: they take most of the time.
Input input_of(const std::vector<BaseDeck>& decks, unsigned seed, int number) {
  Random random(1000003ull * seed + static_cast<unsigned long long>(number));
  const BaseDeck* base = &decks[draw(random, decks.size())];
  constexpr std::size_t kLarge = 50000;
  while (base->text.size() > kLarge && draw(random, 8) != 0) base = &decks[draw(random, decks.size())];
  const BaseDeck& other = decks[draw(random, decks.size())];
  Input input{base->name, damaged(random, base->text, other.text), {}};
  input.command = command_line(random, *base);
  return input;
}

// ---- Children ----

struct Ended {
  int status = 0;
  bool asked_to_stop = false, killed = false;
  double seconds = 0.0;
};

[[noreturn]] void be_the_program(const Input& input, const fs::path& folder) {
  if (chdir(folder.c_str()) != 0) std::_Exit(98);
  const int in = open("/dev/null", O_RDONLY), out = open("stdout", O_WRONLY | O_CREAT | O_TRUNC, 0666),
            err = open("stderr", O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (in < 0 || out < 0 || err < 0) std::_Exit(98);
  for (const auto& [from, to] : {std::pair{in, 0}, {out, 1}, {err, 2}})
    if (dup2(from, to) < 0) std::_Exit(98);
  std::vector<std::string> words{"sagefe"};
  words.insert(words.end(), input.command.begin(), input.command.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::exit(sage::sagefe(static_cast<int>(words.size()), argv.data()));
}

// True if the process ended in time.
bool wait_for(pid_t child, int process, int milliseconds, int& status) {
  pollfd ended{process, POLLIN, 0};
  int ready = 0;
  do ready = poll(&ended, 1, milliseconds);
  while (ready < 0 && errno == EINTR);
  return ready > 0 && waitpid(child, &status, 0) == child;
}

Ended run_child(const Input& input, const fs::path& folder, double seconds) {
  const auto start = std::chrono::steady_clock::now();
  Ended ended;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) be_the_program(input, folder);
  const int process = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  if (child < 0 || process < 0) {
    std::perror("whole_decks: a child can't be made");
    std::exit(2);
  }
  if (!wait_for(child, process, static_cast<int>(1000.0 * seconds), ended.status)) {
    ended.asked_to_stop = true;
    kill(child, SIGTERM);
    if (!wait_for(child, process, kPatience, ended.status)) {
      ended.killed = true;
      kill(child, SIGKILL);
      waitpid(child, &ended.status, 0);
    }
  }
  close(process);
  ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return ended;
}

// ---- Judgement ----

bool has_word(const std::string& line, const std::string& word) {
  for (std::size_t at = line.find(word); at != std::string::npos; at = line.find(word, at + 1)) {
    const auto letter = [&](std::size_t i) {
      return i < line.size() && std::isalpha(static_cast<unsigned char>(line[i]));
    };
    if (!letter(at + word.size()) && (at == 0 || !letter(at - 1))) return true;
  }
  return false;
}

// A first row of a CSV file that holds inf or nan; empty if there is none.  Comments and the line of the
// columns repeat the deck's title and the names of its units, which may be such words.
std::string not_finite(const fs::path& file) {
  std::ifstream in(file);
  bool columns = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    if (columns && (has_word(line, "inf") || has_word(line, "nan"))) return line;
    columns = true;
  }
  return {};
}

bool memory_ran_out(const std::string& err) {
  for (const char* words :
       {"hard rss limit exhausted", "allocation-size-too-big", "out-of-memory", "out of memory"})
    if (err.find(words) != std::string::npos) return true;
  return false;
}

// A file that the program keeps only while it works; empty if none is left.
std::string left_behind(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored))
    if (const std::string name = entry.path().filename().string(); name.ends_with(".partial"))
      return "left " + name;
  return {};
}

// Only `run` has something to keep when SIGTERM comes: the signal ends the other commands at once, and `run`
// too before it has begun and behind its last file.
bool ended_at_once(const Input& input, const Ended& ended, const std::string& err) {
  if (!ended.asked_to_stop || !WIFSIGNALED(ended.status) || WTERMSIG(ended.status) != SIGTERM) return false;
  return input.command.front() != "run" || err.find("stops after the increment in hand") == std::string::npos;
}

// What is wrong; empty if nothing is.
std::string fault_in(const Input& input, const Ended& ended, const fs::path& folder) {
  if (ended.killed) return "does not end after SIGTERM";
  const std::string err = file_text(folder / "stderr");
  if (ended_at_once(input, ended, err)) return input.command.front() == "run" ? left_behind(folder) : "";
  if (WIFSIGNALED(ended.status)) return "ended by signal " + std::to_string(WTERMSIG(ended.status));
  const int code = WEXITSTATUS(ended.status);
  if (code == kReport && memory_ran_out(err)) return {};
  for (const char* words : {"AddressSanitizer", "LeakSanitizer", "runtime error:"})
    if (err.find(words) != std::string::npos) return std::string("a report: ") + words;
  const auto& known = sage::app::kExitCodes;
  if (std::find(std::begin(known), std::end(known), code) == std::end(known))
    return "exit code " + std::to_string(code) + " is not documented";
  if (code != 0 && err.empty()) return "exit code " + std::to_string(code) + " without a message";
  if (const std::string left = left_behind(folder); !left.empty()) return left;
  if (code != 0) return {};
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored))
    if (entry.path().extension() == ".csv")
      if (const std::string line = not_finite(entry.path()); !line.empty())
        return entry.path().filename().string() + " holds " + line;
  return {};
}

std::string shown(const Input& input) {
  std::string text = "sagefe";
  for (const std::string& word : input.command) text += " " + word;
  return text + "   (" + input.name + ")";
}

void empty_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  fs::create_directories(folder);
}

std::string fault_of(const Input& input, const Settings& settings, Ended& ended) {
  empty_folder(settings.scratch);
  std::ofstream(settings.scratch / "deck.dat", std::ios::binary) << input.deck;
  ended = run_child(input, settings.scratch, settings.seconds);
  return fault_in(input, ended, settings.scratch);
}

int replay(const std::vector<BaseDeck>& decks, const Settings& settings) {
  const Input input = input_of(decks, settings.seed, settings.replay);
  Ended ended;
  const std::string fault = fault_of(input, settings, ended);
  std::printf("%s\nin %s\n%s%s%s\n", shown(input).c_str(), settings.scratch.c_str(),
              file_text(settings.scratch / "stdout").c_str(), file_text(settings.scratch / "stderr").c_str(),
              fault.empty() ? "nothing wrong" : fault.c_str());
  return fault.empty() ? 0 : 1;
}

int run_all(const std::vector<BaseDeck>& decks, const Settings& settings) {
  std::map<std::string, int> outcomes;
  int found = 0;
  double longest = 0.0;
  for (int i = settings.first; i < settings.first + settings.count; ++i) {
    const Input input = input_of(decks, settings.seed, i);
    Ended ended;
    const std::string fault = fault_of(input, settings, ended);
    longest = std::max(longest, ended.seconds);
    const bool report = WIFEXITED(ended.status) && WEXITSTATUS(ended.status) == kReport;
    if (fault.empty()) {
      ++outcomes[WIFSIGNALED(ended.status) ? "SIGTERM"
                 : report                  ? "out of memory"
                                           : "exit code " + std::to_string(WEXITSTATUS(ended.status))];
      if (ended.asked_to_stop) ++outcomes["ended by SIGTERM after its time"];
      continue;
    }
    ++found;
    std::printf("whole_decks: input %d of seed %u: %s\n  %s\n%s\n", i, settings.seed, fault.c_str(),
                shown(input).c_str(), file_text(settings.scratch / "stderr").substr(0, 3000).c_str());
    std::fflush(stdout);
  }
  std::printf("whole_decks: seed %u, inputs %d to %d, %zu decks; longest %.1f s;", settings.seed,
              settings.first, settings.first + settings.count - 1, decks.size(), longest);
  for (const auto& [name, n] : outcomes) std::printf(" %s: %d;", name.c_str(), n);
  std::printf(" found: %d\n", found);
  empty_folder(settings.scratch);
  fs::remove(settings.scratch);
  return found > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    if (value.empty()) return std::fprintf(stderr, "whole_decks: %s needs a value\n", argv[i]), 2;
    if (name == "--count")
      settings.count = std::atoi(value.c_str());
    else if (name == "--first")
      settings.first = std::atoi(value.c_str());
    else if (name == "--seed")
      settings.seed = static_cast<unsigned>(std::atoi(value.c_str()));
    else if (name == "--seconds")
      settings.seconds = std::atof(value.c_str());
    else if (name == "--replay")
      settings.replay = std::atoi(value.c_str());
    else if (name == "--scratch")
      settings.scratch = value;
    else
      return std::fprintf(stderr, "whole_decks: unknown option %s\n", argv[i]), 2;
  }
  const std::vector<BaseDeck> decks = base_decks();
  if (decks.size() < 40) return std::fprintf(stderr, "whole_decks: only %zu decks found\n", decks.size()), 2;
  return settings.replay >= 0 ? replay(decks, settings) : run_all(decks, settings);
}

// sagefe explain: what a message means and what helps, by the code that stands behind it.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <algorithm>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/messages/messages.hpp"

namespace sage::app {

namespace {

struct ExplainOptions {
  std::vector<std::string> codes;
  std::string search;
};

// Words in lines of at most 78 characters.
void print_indented(const std::string& text) {
  constexpr std::size_t kWidth = 78;
  std::istringstream words(text);
  std::string line = "   ";
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kWidth) {
      fmt::print("{}\n", line);
      line = "   ";
    }
    line += " " + word;
  }
  fmt::print("{}\n", line);
}

// For a person and for --json, which has every text of it.
void print_line(const MessageEntry& message) {
  if (Json* json = answer())
    (*json)["codes"].push_back({{"code", to_string(message.code)},
                                {"title", message.title},
                                {"cause", message.cause},
                                {"cure", message.cure}});
  fmt::print("{}  {}\n", to_string(message.code), message.title);
}

void print_whole(const MessageEntry& message) {
  print_line(message);
  fmt::print("  cause\n");
  print_indented(message.cause);
  fmt::print("  cure\n");
  print_indented(message.cure);
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// "S501", "s501", "[S501]" or "501"; 0 for anything else.
int number_of(const std::string& text) {
  std::string digits = text;
  std::erase_if(digits, [](char c) { return c == '[' || c == ']'; });
  if (!digits.empty() && (digits[0] == 'S' || digits[0] == 's')) digits.erase(0, 1);
  const bool number =
      digits.size() == 3 && std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  return number ? std::stoi(digits) : 0;
}

// The codes that come next to the number, below and above.
std::string near_codes(int number) {
  std::vector<MessageEntry> near(messages().begin(), messages().end());
  constexpr std::ptrdiff_t kShown = 4;
  const auto distance = [number](const MessageEntry& m) { return std::abs(m.code.number() - number); };
  std::ranges::stable_sort(near, {}, distance);
  std::string text;
  for (auto at = near.begin(); at != near.begin() + kShown; ++at)
    text += fmt::format("\n  {}  {}", to_string(at->code), at->title);
  return text;
}

const MessageEntry& message_for(const std::string& text) {
  const int number = number_of(text);
  if (number == 0)
    throw UsageError(
        "S910", "\"" + text +
                    "\" is no code of a message, such as S501; to look for a word: sagefe explain --search " +
                    text);
  const MessageEntry* found = find_message(number);
  if (found == nullptr)
    throw UsageError("S910",
                     fmt::format("there is no message S{:03}; near it are{}", number, near_codes(number)));
  return *found;
}

// All texts of the message together hold the words.
bool speaks_of(const MessageEntry& message, const std::string& words) {
  const std::string text =
      lower(to_string(message.code) + " " + message.title + " " + message.cause + " " + message.cure);
  return text.find(lower(words)) != std::string::npos;
}

int search(const std::string& words) {
  int found = 0;
  for (const MessageEntry& message : messages()) {
    if (!speaks_of(message, words)) continue;
    print_line(message);
    ++found;
  }
  if (found == 0) throw UsageError("S910", "no message speaks of \"" + words + "\"; sagefe explain lists all");
  return kOk;
}

int explain(const ExplainOptions& options) {
  if (!options.search.empty()) return search(options.search);
  std::vector<MessageEntry> wanted;
  for (const std::string& code : options.codes) wanted.push_back(message_for(code));
  for (const MessageEntry& message : wanted) print_whole(message);
  if (!wanted.empty()) return kOk;
  for (const MessageEntry& message : messages()) print_line(message);
  fmt::print("sagefe explain CODE prints cause and cure; --search WORD searches all texts\n");
  return kOk;
}

}  // namespace

Command explain_command(CLI::App& parser, const Catalogue&) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::Option* codes =
      parser.add_option("CODE", options->codes, "codes of messages, such as S501; without a code, list all");
  parser.add_option("--search", options->search, "list the messages whose texts contain this word")
      ->option_text("WORD")
      ->excludes(codes);
  return [options] { return explain(*options); };
}

}  // namespace sage::app

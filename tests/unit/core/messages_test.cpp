// The table of messages and the places that make them.
#include "sage/messages/messages.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "sage/page/page.hpp"

namespace sage {
namespace {

const std::filesystem::path kSource = SAGE_SOURCE_DIR;

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Text of every source file of the program by its path, but for the table of messages itself.
std::map<std::string, std::string> sources() {
  std::map<std::string, std::string> texts;
  for (const char* folder : {"sage", "elements", "materials", "solvers"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource / folder)) {
      const std::string ending = entry.path().extension();
      if ((ending == ".cpp" || ending == ".hpp") && entry.path().filename() != "messages.cpp")
        texts[entry.path().string()] = contents(entry.path());
    }
  return texts;
}

TEST(Messages, StandInOrderAndSayCauseAndCure) {
  int before = 0;
  for (const MessageEntry& message : messages()) {
    const std::string code = to_string(message.code);
    EXPECT_GT(message.code.number(), before) << code;
    before = message.code.number();
    const std::string title = message.title, cause = message.cause, cure = message.cure;
    EXPECT_FALSE(title.empty() || title.ends_with('.')) << code;
    EXPECT_LE(title.size(), 72u) << code;
    EXPECT_GE(cause.size(), 40u) << code;
    EXPECT_TRUE(cause.ends_with('.')) << code;
    EXPECT_TRUE(cure.ends_with('.')) << code;
    EXPECT_EQ(find_message(message.code.number()), &message);
  }
  EXPECT_EQ(find_message(0), nullptr);
  EXPECT_EQ(find_message(999), nullptr);
}

// Every code that the program prints can be explained, and nothing is explained that is never printed.
TEST(Messages, AreThoseThatTheProgramMakes) {
  std::set<std::string> used, known;
  const std::regex code("\"(S[1-9][0-9]{2})\"");
  const std::regex comment("//[^\n]*");
  for (const auto& [file, text] : sources()) {
    const std::string bare = std::regex_replace(text, comment, "");
    for (std::sregex_iterator at(bare.begin(), bare.end(), code), end; at != end; ++at) used.insert((*at)[1]);
  }
  for (const MessageEntry& message : messages()) known.insert(to_string(message.code));
  for (const std::string& one : used)
    EXPECT_TRUE(known.contains(one)) << one << " has no entry in messages.cpp";
  for (const std::string& one : known) EXPECT_TRUE(used.contains(one)) << one << " is used by no message";
}

std::string manual() {
  Page page("Messages");
  page.prose(
      "This page explains every message of sagefe, for everyone who gets an error, a warning or a note. A "
      "message "
      "ends in a code, such as `[S501]`, by which you find its entry. `sagefe explain S501` prints the same "
      "entry, "
      "`sagefe explain` lists all codes, and `sagefe explain --search WORD` lists the messages whose texts "
      "contain "
      "a word. A *deck* is an input file, a *card* is one entry of it, such as a node, and a *layout* defines "
      "which columns of a card hold which value. [How sagefe checks a deck](checks.md) explains the three "
      "kinds "
      "of messages. With `--strict` a warning counts as an error, but keeps its code.");
  page.prose(
      "For developers: a test writes this page from `sage/messages/messages.cpp` "
      "(`SAGE_WRITE_MANUAL=1 test_core --gtest_filter=Messages.*`). A message with a new cause or remedy gets "
      "a "
      "new code and an entry there. The test checks that every code in the source has an entry.");
  const char* section = nullptr;
  for (const MessageEntry& message : messages()) {
    if (section_of(message) != section) page.heading(2, section = section_of(message));
    page.heading(3, to_string(message.code) + ": " + message.title);
    page.prose(message.cause);
    page.prose(std::string("*What helps:* ") + message.cure);
  }
  return page.text();
}

TEST(Messages, ManualIsWrittenFromThem) {
  const std::filesystem::path page = kSource / "docs/manual/messages.md";
  if (std::getenv("SAGE_WRITE_MANUAL") != nullptr) std::ofstream(page, std::ios::binary) << manual();
  EXPECT_EQ(contents(page), manual())
      << "SAGE_WRITE_MANUAL=1 test_core --gtest_filter=Messages.* writes it anew";
}

}  // namespace
}  // namespace sage

#include "sage/messages/error.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <type_traits>

namespace sage {
namespace {

TEST(SourcePosition, PrintsAsCompilersDo) {
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 41, 11, 20}), "a.dat:41:11-20");
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 41, 11, 11}), "a.dat:41:11");
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 41, 0, 0}), "a.dat:41");
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 0, 0, 0}), "a.dat");
}

TEST(Diagnostics, CountsBySeverity) {
  Diagnostics d;
  d.error("S117", {"a.dat", 1, 0, 0}, "one");
  d.warning("S122", {"a.dat", 2, 0, 0}, "two");
  d.note("S127", {"a.dat", 3, 0, 0}, "three");
  EXPECT_EQ(d.errors(), 1);
  EXPECT_EQ(d.warnings(), 1);
  EXPECT_EQ(d.list().size(), 3u);
}

// A fixity along a line is a card for each node.
TEST(Diagnostics, ListsTheSameMistakeOnce) {
  Diagnostics d;
  for (int node = 0; node < 3; ++node)
    for (const int column : {5, 9}) d.error("S117", {"a.dat", 3, column, column}, "one");
  d.error("S117", {"a.dat", 3, 5, 5}, "two");
  // Of a table's line, such as "x_value is left blank".
  for (int node = 0; node < 2; ++node) d.note("S234", {"a.sage.toml", 3, 0, 0}, "left blank");
  for (int node = 0; node < 2; ++node) d.error("S117", {"a.dat", 0, 0, 0}, "no place");
  EXPECT_EQ(d.errors(), 9);
  EXPECT_EQ(d.list().size(), 6u);
}

TEST(InputError, ShowsTheFirstError) {
  Diagnostics d;
  d.warning("S122", {"a.dat", 2, 0, 0}, "two");
  d.error("S117", {"a.dat", 3, 1, 5}, "three");
  EXPECT_STREQ(InputError(d).what(), "a.dat:3:1-5: error: three [S117]");
}

// No message without a code: there is none to leave out, and none that is none.
static_assert(!std::is_default_constructible_v<Code>);
static_assert(!std::is_default_constructible_v<Diagnostic>);
static_assert(!std::is_constructible_v<CodedError, std::string>);
static_assert(!std::is_constructible_v<OutputError, std::string>);
static_assert(!std::is_constructible_v<InputError, SourcePosition, std::string>);

TEST(Code, StandsAtTheEndOfTheFirstLine) {
  EXPECT_EQ(to_string(Code("S104")), "S104");
  EXPECT_EQ(with_code("no digit left", "S502"), "no digit left [S502]");
  EXPECT_EQ(with_code("not in equilibrium.\n  likely: a collapse", "S501"),
            "not in equilibrium. [S501]\n  likely: a collapse");
  EXPECT_EQ(with_code("it has one [S504]\nand a detail", "S502"), "it has one [S504]\nand a detail");
  EXPECT_EQ(code_in("no digit left [S502]\nand a detail"), Code("S502"));
  for (const char* none : {"", "no digit left", "[S502] no digit left", "x [S052]", "x [S5O2]", "x[S502]"})
    EXPECT_EQ(code_in(none), std::nullopt) << none;
}

TEST(CodedError, KeepsMessageAndCodeApart) {
  const AnalysisError error("S504", "no digit left");
  EXPECT_STREQ(error.what(), "no digit left");
  EXPECT_EQ(message_of(error), "no digit left [S504]");
  EXPECT_EQ(message_of(std::runtime_error("of a library")), "of a library [S513]");
  EXPECT_EQ(message_of(std::length_error("too large")), "too large [S508]");
  EXPECT_EQ(to_string(SingularMatrix(3, 0.0, "no pivot").code()), "S502");
  EXPECT_EQ(to_string(ParameterError(0, "E must be greater than 0").code()), "S224");
}

}  // namespace
}  // namespace sage

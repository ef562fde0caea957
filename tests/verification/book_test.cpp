// The verification book, a test a case: `sagefe verify` runs the same cases.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "sage/app/commands.hpp"
#include "tests/studies/verify/book.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::verify {
namespace {

const std::vector<Section>& sections() {
  static const std::vector<Section> all = book();
  return all;
}

std::vector<const Case*> cases() {
  std::vector<const Case*> list;
  for (const Section& section : sections())
    for (const Case& one : section.cases) list.push_back(&one);
  return list;
}

class Book : public testing::TestWithParam<const Case*> {};

TEST_P(Book, Case) {
  const CaseResult result = run_case(*GetParam(), app::make_workbench());
  EXPECT_FALSE(result.rows.empty());
  for (const Row& row : result.rows)
    EXPECT_TRUE(row.pass) << name_of(row.where) << ", " << row.what << ": " << row.computed << " against "
                          << row.reference << ", error " << row.error << ", gate " << row.gate << ", order "
                          << row.order << " against " << row.theory;
}

std::vector<const Case*> short_cases() {
  std::vector<const Case*> list = cases();
  std::erase_if(list, [](const Case* one) { return one->takes_minutes; });
  return list;
}

INSTANTIATE_TEST_SUITE_P(Verify, Book, testing::ValuesIn(short_cases()), [](const auto& one) {
  std::string name = one.param->name;
  for (char& c : name)
    if (c == '.') c = '_';
  return name;
});

TEST(BookOfCases, AtLeastFortyWithNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Case* one : cases()) {
    EXPECT_TRUE(names.insert(one->name).second) << one->name;
    EXPECT_FALSE(one->source.empty() || one->gate.empty() || one->title.empty()) << one->name;
  }
  EXPECT_GE(names.size(), 40u);
}

// docs/verification.md is written from the run: a case that is not in it was never run for it.
TEST(BookOfCases, IsWrittenDown) {
  std::ifstream in(SAGE_SOURCE_DIR "/docs/verification.md");
  std::stringstream text;
  text << in.rdbuf();
  for (const Case* one : cases())
    EXPECT_NE(text.str().find("### " + one->name + ":"), std::string::npos) << one->name;
}

// A row that misses its gate fails, one that stopped too, and neither is hidden.
TEST(BookOfCases, FailuresAreShown) {
  Section section{"section", {}};
  section.cases.push_back({"test.fails", "title", "source", Grade::exact, "gate", [](Record& r) {
                             r.near(Where::plane_strain, "good", 1.0, 1.0, 1e-9);
                             r.near(Where::plane_strain, "off", 1.1, 1.0, 0.05);
                             r.small(Where::axisymmetric, "no number", kNone, 1.0);
                             r.order(Where::point, "slow", {1.0, 0.5}, {1.0, 0.6}, 2.0);
                             throw std::runtime_error("reason");
                           }});
  const CaseResult result = run_case(section.cases[0], app::make_workbench());
  ASSERT_EQ(result.rows.size(), 5u);
  EXPECT_TRUE(result.rows[0].pass);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_FALSE(result.rows[i].pass) << i;
  EXPECT_FALSE(result.pass());
  const Chapter chapter{"section", {result}};
  for (const std::string& text : {table_text(chapter, false), table_text(chapter, true)})
    for (const char* what : {"off", "no number", "slow", "stopped: reason"})
      EXPECT_NE(text.find(what), std::string::npos) << what;
  EXPECT_NE(markdown_text({chapter}, "x").find("1 failing"), std::string::npos);
}

}  // namespace
}  // namespace sage::verify

// Every row of the stability stress test, and the judge itself: what is wrong must be called wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sage/app/commands.hpp"
#include "tests/studies/scenes/scenes.hpp"
#include "tests/studies/stress/report.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::stress {

void PrintTo(const Row& row, std::ostream* out);
void PrintTo(const Row& row, std::ostream* out) {
  *out << row.name;
}

namespace {

using namespace scenes;

const scenes::Workbench& bench() {
  static const scenes::Workbench workbench = app::make_workbench();
  return workbench;
}

class StressRow : public testing::TestWithParam<Row> {};

TEST_P(StressRow, IsRightOrSaysWhatIsWrong) {
  const RowResult result = evaluate(GetParam(), bench());
  EXPECT_TRUE(result.ok()) << row_text(GetParam(), result, false);
}

std::string label(const testing::TestParamInfo<Row>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, StressRow, testing::ValuesIn(all_rows()), label);

Row row_of(std::function<void(Sweep&)> run) {
  return {"row", "family", "title", "reference", "axis", false, std::move(run)};
}

TriaxialDeck elastic() {
  TriaxialDeck deck;
  deck.parameters = {3000.0, 0.3};
  return deck;
}

TEST(StressJudge, CallsWrongWhatIsWrong) {
  const auto verdict = [](std::function<void(Sweep&)> run) {
    return evaluate(row_of(std::move(run)), bench()).ok();
  };
  EXPECT_TRUE(verdict([](Sweep& s) { s.right("", 0, s.run(elastic().text()), 1e-10, 1e-9); }));
  EXPECT_FALSE(verdict([](Sweep& s) { s.right("", 0, s.run(elastic().text()), 1e-8, 1e-9); }));
  EXPECT_FALSE(verdict([](Sweep& s) { s.right("", 0, s.run(elastic().text()), kUnknown, 1e-9); }));
  EXPECT_FALSE(verdict([](Sweep& s) { s.right("", 0, s.run("nonsense"), 0.0, 1e-9); }));
  EXPECT_FALSE(verdict([](Sweep& s) { s.says("", 0, s.run(elastic().text()), "no such words"); }));
  EXPECT_TRUE(verdict([](Sweep& s) { s.says("", 0, s.run("nonsense"), "deck"); }));
  EXPECT_FALSE(verdict([](Sweep& s) { s.silent("", 0, s.run("nonsense"), "no such words"); }));
  EXPECT_FALSE(verdict([](Sweep& s) { s.holds("", 0, false, "", ""); }));
  EXPECT_FALSE(verdict([](Sweep&) {}));  // nothing tried
  EXPECT_FALSE(verdict([](Sweep& s) {
    s.holds("", 0, true, "", "");
    throw std::logic_error("escaped");
  }));
  EXPECT_FALSE(verdict([](Sweep& s) {
    s.holds("", 0, true, "", "");
    throw 1;
  }));
  EXPECT_FALSE(verdict([](Sweep& s) {  // a number that is none, in a run that calls itself complete
    Ran ran = s.run(elastic().text());
    ran.run->increments.back().u[0] = kUnknown;
    s.right("", 0, ran, 0.0, 1.0);
  }));
}

TEST(StressJudge, DigitsLost) {
  Trial trial;
  EXPECT_TRUE(std::isnan(trial.digits_lost()));
  trial.error = 0.0;
  EXPECT_EQ(trial.digits_lost(), 0.0);
  trial.error = 1e-8;
  EXPECT_NEAR(trial.digits_lost(), 7.954, 1e-3);
  trial.error = 1e5;
  EXPECT_EQ(trial.digits_lost(), 16.0);
}

TEST(StressReport, ShowsFailuresAndEscapesCells) {
  const Row row = row_of([](Sweep& s) {
    s.right("a, b", 1.0, s.run(elastic().text()), 1e-12, 1e-9);
    s.right("c | d", 10.0, s.run(elastic().text()), 1e-3, 1e-9);
  });
  const RowResult result = evaluate(row, bench());
  const std::string text = row_text(row, result, false), csv = to_csv({row}, {result}),
                    page = to_markdown({row}, {result}, "plots");
  EXPECT_NE(text.find("FAIL"), std::string::npos);
  EXPECT_EQ(text.find("a, b"), std::string::npos);
  EXPECT_NE(row_text(row, result, true).find("a, b"), std::string::npos);
  EXPECT_NE(csv.find("row,\"a, b\",1,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("FAIL"), std::string::npos);
  EXPECT_NE(page.find("c / d"), std::string::npos);
  EXPECT_NE(page.find("plots/row.svg"), std::string::npos);
  EXPECT_NE(page.find("**FAIL**"), std::string::npos);
  EXPECT_EQ(plot(row, result).rfind("<svg", 0), 0u);
}

}  // namespace
}  // namespace sage::stress

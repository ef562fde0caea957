#include "sage/record/summary.hpp"

#include <gtest/gtest.h>

#include "tests/support/text.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::fresh_folder;
using test::has;
using test::lines_of;
using test::Specimen;

struct Result {
  RunRecord record;
  std::string text;
};

Result run_summary(Specimen& specimen, bool fail, int increments) {
  Report report;
  report.group = 0;
  report.nodes = {4, 5};
  report.height = 2.0;
  specimen.model.reports.push_back(report);
  Reports reports(fresh_folder(fail ? "summary_fail" : "summary"), "t");
  Result result;
  result.record.on_warning({Severity::warning, "S331", {}, "odd", {}});
  for (Observer* observer : {static_cast<Observer*>(&reports), static_cast<Observer*>(&result.record)})
    fail ? specimen.run_and_fail(*observer, 0.02, increments) : specimen.run(*observer, 0.02, increments);
  result.record.seconds = 0.125;
  result.text = summary(specimen.model, result.record, &reports, {"a/t.lst", "a/t.report1.csv"});
  return result;
}

TEST(Summary, TellsTheRunOnOneScreen) {
  Specimen specimen(Geometry::axisymmetric, false);
  const Result result = run_summary(specimen, false, 10);
  EXPECT_EQ(lines_of(result.text)[0], "compressed specimen");
  for (const char* part : {"completed: every increment in equilibrium", "axisymmetric", "7 equations",
                           "1 of 1 stages, 10 increments, 20 iterations, 0 cuts", "warnings    1",
                           "a/t.report1.csv", "compression positive", "full circle"})
    EXPECT_TRUE(has(result.text, part)) << part << "\n" << result.text;
  EXPECT_FALSE(has(result.text, "NOT CONVERGED"));
  EXPECT_LE(lines_of(result.text).size(), 30u);
  for (const std::string& line : lines_of(result.text)) EXPECT_LE(line.size(), 80u) << line;
  for (const char* part : {"  scene ", "  work ", "whole run"})
    EXPECT_FALSE(has(result.text, part)) << part << "\n" << result.text;
  const std::string details = summary(specimen.model, result.record, nullptr, {}, nullptr, 0, "", true);
  for (const char* part : {"linear, symmetric", "fake", "  work ", "whole run 0.125 s"})
    EXPECT_TRUE(has(details, part)) << part << "\n" << details;
}

// Ten increments to 2 % : E e = 20 psi at the end, ratio 1.
TEST(Summary, ShowsAtMostSixRowsWithTheLast) {
  Specimen specimen(Geometry::axisymmetric, false);
  const std::string text = run_summary(specimen, false, 10).text;
  int rows = 0;
  std::string last;
  for (const std::string& line : lines_of(text))
    if (line.find("    stage 1 ") == 0) {
      ++rows;
      last = line;
    }
  EXPECT_EQ(rows, 6);
  EXPECT_TRUE(has(last, "0.02")) << last;
  EXPECT_TRUE(has(last, " 20 ")) << last;
  EXPECT_TRUE(has(last, "1.0000")) << last;
}

TEST(Summary, AFailedRunCannotLookLikeACompletedOne) {
  Specimen specimen(Geometry::axisymmetric, false);
  const std::string text = run_summary(specimen, true, 4).text;
  const std::vector<std::string> lines = lines_of(text);
  EXPECT_TRUE(has(lines[1], "NOT CONVERGED")) << text;
  EXPECT_TRUE(has(lines[2], "increment 4 of 4; last equilibrium at load factor 0.875")) << text;
  EXPECT_TRUE(has(lines.back(), "NOT CONVERGED")) << text;
  EXPECT_FALSE(has(text, "completed"));
  EXPECT_TRUE(has(text, "0 of 1 stages, 3 increments")) << text;
}

}  // namespace
}  // namespace sage

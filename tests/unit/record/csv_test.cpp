#include "sage/record/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sage/messages/error.hpp"
#include "tests/support/text.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::contents;
using test::csv_column;
using test::csv_numbers;
using test::fresh_folder;
using test::lines_of;
using test::Specimen;

constexpr CsvOptions kAll{.increments = true, .nodes = true, .points = true};

TEST(Csv, WritesOnlyWhatIsAsked) {
  Specimen specimen;
  const auto folder = fresh_folder("csv_asked");
  Csv csv(folder, "t");
  specimen.run(csv, 0.01, 2);
  EXPECT_TRUE(std::filesystem::exists(folder / "t.increments.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "t.nodes.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "t.points.csv"));
  EXPECT_EQ(csv.files().size(), 1u);
}

TEST(Csv, EveryRowHasAllColumns) {
  Specimen specimen;
  const auto folder = fresh_folder("csv_columns");
  Csv csv(folder, "t", kAll);
  specimen.run_and_fail(csv, 0.01, 2);
  EXPECT_EQ(csv.files().size(), 4u);
  for (const char* name : {"t.increments.csv", "t.nodes.csv", "t.points.csv", "t.interfaces.csv"}) {
    std::size_t columns = 0;
    for (const std::string& line : lines_of(contents(folder / name))) {
      if (line.starts_with('#')) continue;
      if (columns == 0) columns = test::split(line, ',').size();
      EXPECT_EQ(test::split(line, ',').size(), columns) << name << ": " << line;
    }
    EXPECT_GT(columns, 9u) << name;
  }
}

TEST(Csv, IncrementsHoldTheRecord) {
  Specimen specimen;
  const auto folder = fresh_folder("csv_increments");
  Csv csv(folder, "t");
  specimen.run(csv, 0.01, 4);
  const std::string text = contents(folder / "t.increments.csv");
  EXPECT_EQ(csv_column(text, "increment"), (std::vector<std::string>{"1", "2", "3", "4"}));
  EXPECT_EQ(csv_column(text, "load_factor")[2], "0.75");
  EXPECT_EQ(csv_column(text, "converged")[3], "1");
  EXPECT_EQ(csv_column(text, "relative_force")[0], "1.5e-11");
  EXPECT_EQ(csv_column(text, "worst_node")[0], "40");  // the deck's number of node index 3
  EXPECT_EQ(csv_column(text, "worst_component")[0], "y");
  EXPECT_EQ(csv_column(text, "elastic")[0], "10");  // 2 x 4 solid points, 2 interface points
  EXPECT_EQ(csv_column(text, "smallest_pivot_ratio")[0], "");
}

// Fixture in closed form: sigma_zz(axial) = 10 compressive, strain 0.01, lateral strain -0.0025 (extension).
TEST(Csv, PointsAreCompressionPositive) {
  Specimen specimen;
  const auto folder = fresh_folder("csv_points");
  Csv csv(folder, "t", kAll);
  specimen.run(csv, 0.01, 1);
  const std::string text = contents(folder / "t.points.csv");
  ASSERT_EQ(csv_numbers(text, "stress_yy").size(), 8u);
  for (double s : csv_numbers(text, "stress_yy")) EXPECT_NEAR(s, 10.0, 1e-8);
  for (double s : csv_numbers(text, "stress_xx")) EXPECT_NEAR(s, 0.0, 1e-8);
  for (double e : csv_numbers(text, "strain_yy")) EXPECT_NEAR(e, 0.01, 1e-10);
  for (double e : csv_numbers(text, "strain_zz")) EXPECT_NEAR(e, -0.0025, 1e-10);
  const std::string joint = contents(folder / "t.interfaces.csv");
  for (double s : csv_numbers(joint, "normal")) EXPECT_NEAR(s, 10.0, 1e-8);
  for (double w : csv_numbers(joint, "relative_normal")) EXPECT_NEAR(w, 0.005, 1e-10);
  EXPECT_NE(joint.find("gap[in]"), std::string::npos);
  EXPECT_NE(text.find("# x = r, y = z, zz = hoop"), std::string::npos);
}

TEST(Csv, NodesHoldReactionsOnlyWhereHeld) {
  Specimen specimen(Geometry::axisymmetric, false);
  const auto folder = fresh_folder("csv_nodes");
  Csv csv(folder, "t", kAll);
  specimen.run(csv, 0.01, 1);
  const std::string text = contents(folder / "t.nodes.csv");
  EXPECT_EQ(csv_column(text, "node"), (std::vector<std::string>{"10", "20", "30", "40", "50", "60"}));
  const std::vector<double> reaction = csv_numbers(text, "reaction_y");
  EXPECT_NEAR(reaction[0] + reaction[1], 10.0 * kPi, 1e-7);   // the base pushes up
  EXPECT_NEAR(reaction[4] + reaction[5], -10.0 * kPi, 1e-7);  // the platen pushes down
  EXPECT_TRUE(std::isnan(reaction[2]));
  EXPECT_NEAR(csv_numbers(text, "uy")[5], -0.02, 1e-10);
}

TEST(Csv, StatesFollowTheDecksOutputChoice) {
  Specimen specimen;
  specimen.model.stages[0].output_every = 2;
  const auto folder = fresh_folder("csv_every");
  Csv csv(folder, "t", kAll);
  specimen.run(csv, 0.01, 5);
  const std::vector<std::string> increments = csv_column(contents(folder / "t.interfaces.csv"), "increment");
  EXPECT_EQ(increments, (std::vector<std::string>{"2", "2", "4", "4", "5", "5"}));
}

TEST(Csv, FailedRunSaysSoInEveryFile) {
  Specimen specimen;
  const auto folder = fresh_folder("csv_fail");
  Csv csv(folder, "t", kAll);
  specimen.run_and_fail(csv, 0.01, 2);
  for (const char* name : {"t.increments.csv", "t.nodes.csv", "t.points.csv", "t.interfaces.csv"})
    EXPECT_NE(contents(folder / name).find("# NOT CONVERGED in stage 1, increment 2"), std::string::npos)
        << name;
  EXPECT_EQ(csv_column(contents(folder / "t.increments.csv"), "converged").back(), "0");
  EXPECT_NEAR(csv_numbers(contents(folder / "t.points.csv"), "stress_yy").back(), 7.5, 1e-8);
}

TEST(Csv, AKilledRunLeavesOnlyPartialFiles) {
  Specimen specimen;
  const auto folder = fresh_folder("csv_killed");
  {
    Csv csv(folder, "t", kAll);
    csv.on_start(specimen.model, specimen.scene, "fake", 7);
    csv.on_increment(specimen.model, specimen.step(1, 1), specimen.solution());
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_EQ(entry.path().extension(), ".partial") << entry.path();
}

TEST(Csv, RefusesAnUnwritableFolderAtOnce) {
  EXPECT_THROW(Csv("/dev/null/results", "t"), OutputError);
}

}  // namespace
}  // namespace sage

// A field that the program does not know, the example of docs/manual/own_field.md, in every output that reads the
// table: layered soil under 100 kPa has sigma_zz = 60 and sigma_xx = 0 (tests/install/install_and_use.cmake).
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/run_deck.hpp"
#include "tests/install/consumer/layered.hpp"
#include "tests/install/consumer/own_field.hpp"
#include "tests/support/csv_column.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Catalogue with_own_field() {
  Catalogue catalogue = app::full_catalogue();
  catalogue.materials.add(90, own::layered());
  catalogue.fields.add(own::stress_ratio());
  return catalogue;
}

app::RunRequest request_into(const std::filesystem::path& folder) {
  app::RunRequest request;
  request.deck = SAGE_SOURCE_DIR "/tests/install/consumer/own.dat";
  request.output.folder = folder;
  request.output.points = request.output.vtu = true;
  request.output.pictures = {"stress_ratio"};
  request.output.fields = {"stress_ratio", "principal_stress"};
  PointRequest point;
  point.place = {0.3, 0.7};
  request.input.build.points = {point};
  request.quiet = true;
  return request;
}

TEST(OutsideField, IsInEveryOutput) {
  const std::filesystem::path folder = test::scratch_folder("outside_field");
  const app::RunOutcome outcome = app::run_deck(request_into(folder), with_own_field());
  ASSERT_EQ(outcome.exit_code, app::kOk);
  const std::string points = read(folder / "own.points.csv");
  ASSERT_EQ(test::csv_column(points, "stress_ratio").size(), 4u);
  for (double ratio : test::csv_column(points, "stress_ratio")) EXPECT_NEAR(ratio, 0.6, 1e-9);
  const double expected[] = {100.0, 60.0, 0.0};
  for (int i = 0; i < 3; ++i)
    for (double sigma : test::csv_column(points, "principal_stress_" + std::to_string(i + 1)))
      EXPECT_NEAR(sigma, expected[i], 1e-7);
  const std::size_t last = outcome.model->reports.size() - 1;
  const std::string report = read(folder / ("own.report" + std::to_string(last + 1) + ".csv"));
  EXPECT_NEAR(test::csv_column(report, "stress_ratio").back(), 0.6, 1e-9);
  EXPECT_NEAR(test::csv_column(report, "principal_stress_2").back(), 60.0, 1e-7);
  EXPECT_NEAR(test::csv_column(report, "stress_yy").back(), 100.0, 1e-7);
  EXPECT_NE(read(folder / "own_0001.vtu").find("Name=\"stress_ratio\""), std::string::npos);
  EXPECT_NE(read(folder / "own_stage1_stress_ratio.svg").find("from 0.6 to 0.6"), std::string::npos);
  EXPECT_NE(read(folder / "own.lst").find("principal_stress_1 [kPa"), std::string::npos);
}

TEST(OutsideField, UnknownOnesAreRefusedBeforeAnythingIsComputed) {
  const std::filesystem::path folder = test::scratch_folder("no_field");
  app::RunRequest request = request_into(folder / "out");
  request.output.fields = {"stress_ratoi"};
  EXPECT_THROW(app::run_deck(request, with_own_field()), app::UsageError);
  request.output.fields.clear();
  request.output.pictures = {"iterations"};  // of increments: nothing to draw
  EXPECT_THROW(app::run_deck(request, with_own_field()), app::UsageError);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace sage

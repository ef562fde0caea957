// sagefe plot: the same pictures from a result file as from the run, and nothing but one error from files that are
// none.  Skipped where the program is built without HDF5.
#include <gtest/gtest.h>

#include <sstream>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <tuple>

#include "sage/record/csv_table.hpp"
#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

const std::string kInputs = std::string(SAGE_SOURCE_DIR) + "/legacy_inputs/";

std::map<std::string, std::string> pictures_in(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".svg") all[entry.path().filename().string()] = read(entry.path().string());
  return all;
}

bool without_module(const Finished& run) {
  return run.err.find("can't be loaded") != std::string::npos;
}

void spoil(const fs::path& file, const std::string& before, const std::string& after) {
  std::string bytes = read(file.string());
  const std::size_t at = bytes.find(before);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, before.size(), after);
  std::ofstream(file, std::ios::binary) << bytes;
}

// Deck and layout are gone when the pictures are drawn: all that they need is in the file.
TEST(Plot, PicturesFromTheFileAreThoseOfTheRun) {
  struct Case {
    const char *deck, *layout, *options;
    int exit_code = 0;
  };
  const Case cases[] = {
      {"chapter7/friction_08_nu025/deck.dat", "sage1", ""},
      {"chapter7/dp_08/deck.dat", "sage1", "--geometry 1 --element quad8 --solver skyline_lu"},
      {"chapter7/pinned_ld1_nu0333/deck.dat", "sage1",
       "--coarsen --refine 2 --grade auto:3:0.3 --formulation 2 \"--point=0.125,0.25:-a point:1\""},
      {"smith_griffiths/p69.dat", "sg_p69", "", 3},  // the embankment fails
  };
  for (const Case& c : cases) {
    const fs::path folder = empty_folder("plot");
    fs::copy_file(kInputs + c.deck, folder / "deck.dat");
    fs::copy_file(kInputs + "layouts/" + c.layout + ".toml", folder / "my.toml");
    const std::string pictures = " --picture stress_yy --picture displacement";
    const Finished run = sagefe(
        folder, std::string("run deck.dat --layout my.toml -q --no-listing --result ") + c.options + pictures);
    if (without_module(run)) GTEST_SKIP() << "built without HDF5";
    ASSERT_EQ(run.exit_code, c.exit_code) << c.deck << "\n" << run.err;
    const auto wanted = pictures_in(folder / "out");
    ASSERT_GE(wanted.size(), 2u);
    fs::remove(folder / "deck.dat");
    fs::remove(folder / "my.toml");
    const Finished plot = sagefe(folder, "plot out/deck.h5 -o drawn" + pictures);
    ASSERT_EQ(plot.exit_code, 0) << c.deck << "\n" << plot.err;
    EXPECT_EQ(plot.err.find("did not converge") != std::string::npos, c.exit_code == 3) << plot.err;
    const auto drawn = pictures_in(folder / "drawn");
    EXPECT_EQ(drawn.size(), wanted.size()) << c.deck;
    for (const auto& [name, svg] : wanted)
      EXPECT_TRUE(drawn.contains(name) && drawn.at(name) == svg) << c.deck << " " << name;
  }
}

// In the middle of a linear stage the displacement of the top, which is held, is half of that at its end.
TEST(Plot, AnyOutputIncrementCanBeDrawn) {
  const fs::path folder = empty_folder("plot_increments");
  std::string deck = read(kInputs + "chapter7/pinned_ld1_nu025/deck.dat");
  const std::string every_tenth = "\n   10    0    0    0    1", every = "\n   10    0    0    1    1";
  const std::size_t at = deck.find(every_tenth);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(folder / "deck.dat") << deck.replace(at, every.size(), every);
  const Finished run = sagefe(folder, "run deck.dat -q --result");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished plot = sagefe(folder, "plot out/deck.h5 --picture displacement_y --at 1:5 --at 1");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const std::string half = read((folder / "out/deck_stage1_increment5_displacement_y.svg").string());
  EXPECT_NE(half.find("stage 1, increment 5, load factor 0.5"), std::string::npos);
  EXPECT_NE(half.find("from -0.07 to 0"), std::string::npos) << half.substr(0, 900);
  const std::string whole = read((folder / "out/deck_stage1_displacement_y.svg").string());
  EXPECT_NE(whole.find("from -0.14 to 0"), std::string::npos) << whole.substr(0, 900);
  const Finished last = sagefe(folder, "plot out/deck.h5 --picture displacement_y --increment 5 -o last");
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(read((folder / "last/deck_stage1_increment5_displacement_y.svg").string()), half);
  const Finished none = sagefe(folder, "plot out/deck.h5 --picture displacement_y --at 1:11");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("it has 1:1 1:2 1:3"), std::string::npos) << none.err;
}

// y of the points of each line that was drawn, in px from above.
std::vector<std::vector<double>> lines_of(const std::string& svg) {
  std::vector<std::vector<double>> lines;
  const std::regex path("<path d=\"([^\"]*)\" fill=\"none\" stroke=\"#[0-9a-f]*\" stroke-width=\"2\""),
      point("[ML][-0-9.]+ ([-0-9.]+)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it) {
    const std::string points = (*it)[1];
    std::vector<double>& line = lines.emplace_back();
    for (std::sregex_iterator p(points.begin(), points.end(), point); p != end; ++p)
      line.push_back(std::stod((*p)[1]));
  }
  return lines;
}

// An elastic body with pinned ends: measured and correct deviator grow with the strain, their ratio stays.
TEST(Plot, ColumnsOfReportsAreCurves) {
  const fs::path folder = empty_folder("plot_columns");
  for (const char* name : {"pinned_ld1_nu025", "pinned_ld2_nu025"})
    ASSERT_EQ(sagefe(folder, "run " + kInputs + "chapter7/" + name + "/deck.dat -q").exit_code, 0);
  const Finished plot = sagefe(folder, "plot out/pinned_ld1_nu025.report1.csv");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  EXPECT_EQ(plot.out, "out/pinned_ld1_nu025_curves.svg\n");
  const std::string svg = read((folder / "out/pinned_ld1_nu025_curves.svg").string());
  const auto lines = lines_of(svg);
  ASSERT_EQ(lines.size(), 3u);
  const std::vector<double>&measured = lines[0], &correct = lines[1], &ratio = lines[2];
  ASSERT_GE(measured.size(), 5u);
  EXPECT_LT(measured.back(), correct.back()) << "pinned ends measure more";
  EXPECT_LT(measured.back(), measured.front());
  for (double y : ratio) EXPECT_NEAR(y, ratio.front(), 1.0);
  EXPECT_NE(svg.find("axial strain [-], compression positive"), std::string::npos);
  const Finished two =
      sagefe(folder,
             "plot out/pinned_ld1_nu025.report1.csv out/pinned_ld2_nu025.report1.csv --xy axial_strain:ratio "
             "--label stout --label slender --name both -o drawn");
  ASSERT_EQ(two.exit_code, 0) << two.err;
  const std::string both = read((folder / "drawn/both.svg").string());
  EXPECT_EQ(lines_of(both).size(), 2u);
  EXPECT_NE(both.find(">slender<"), std::string::npos);
  EXPECT_NE(both.find(">stout<"), std::string::npos);
}

TEST(Plot, ColumnsThatAreNoneAreNamed) {
  const fs::path folder = empty_folder("plot_columns_bad");
  ASSERT_EQ(sagefe(folder, "run " + kInputs + "chapter7/pinned_ld1_nu025/deck.dat -q").exit_code, 0);
  const auto expect_refused = [&](const std::string& words, int code, const std::string& message) {
    const Finished plot = sagefe(folder, "plot " + words);
    EXPECT_EQ(plot.exit_code, code) << words;
    EXPECT_NE(plot.err.find(message), std::string::npos) << plot.err;
  };
  const std::string report = "out/pinned_ld1_nu025.report1.csv";
  expect_refused(report + " --xy axial_strain:rato", 1,
                 "no column rato; it has stage, increment, axial_strain");
  expect_refused(report + " --xy axial_strain", 1, "wanted X:Y[,Y...]");
  expect_refused("out/pinned_ld1_nu025.increments.csv", 1, "which columns?");
  expect_refused("out/absent.csv", 2, "can't be opened");
}

// The deck pinned_ld1_nu025 with a state at each of its ten increments, to an axial strain of 10 %, in out/deck.h5.
Finished run_with_all_states(const fs::path& folder) {
  std::string deck = read(kInputs + "chapter7/pinned_ld1_nu025/deck.dat");
  const std::string at_end = "\n   10    0    0    0    1", each = "\n   10    0    0    1    1";
  const std::size_t at = deck.find(at_end);
  if (at == std::string::npos) throw std::runtime_error("the deck has changed");
  std::ofstream(folder / "deck.dat") << deck.replace(at, each.size(), each);
  return sagefe(folder, "run deck.dat -q --result");
}

// The numbers behind "from" and "to" above each picture.
std::vector<std::pair<double, double>> ranges_of(const std::string& svg) {
  std::vector<std::pair<double, double>> ranges;
  const std::regex range("from ([-+.0-9e]+) to ([-+.0-9e]+)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), range), end; it != end; ++it)
    ranges.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  return ranges;
}

// Of the middles of all crosses, px.
std::vector<double> from_line_of_symmetry(const std::string& svg) {
  std::smatch seam;
  if (!std::regex_search(svg, seam, std::regex("matrix\\(-1 0 0 1 ([0-9.]+) 0"))) return {};
  std::vector<double> away;
  const std::regex crosses("stroke-width=\"1.4\" d=\"([^\"]*)\""), one("M([-0-9.]+) [-0-9.]+L([-0-9.]+)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), crosses), end; it != end; ++it) {
    const std::string path = (*it)[1];
    for (std::sregex_iterator c(path.begin(), path.end(), one); c != end; ++c)
      away.push_back(0.5 * std::abs(std::stod((*c)[1]) + std::stod((*c)[2]) - std::stod(seam[1])));
  }
  EXPECT_FALSE(away.empty());
  return away;
}

// Linear, and without a cell pressure: at twice the strain every stress is twice as large.
TEST(Plot, StatesAreChosenByStrainAndShareASheet) {
  const fs::path folder = empty_folder("plot_sheet");
  const Finished run = run_with_all_states(folder);
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished plot = sagefe(folder,
                               "plot out/deck.h5 --picture dev --picture conf --at strain=.05 --at strain=.1 "
                               "--sheet --mirror both --range full --crosses --yielded --levels 6 --name s");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const std::string svg = read((folder / "out/s.svg").string());
  const auto ranges = ranges_of(svg);
  ASSERT_EQ(ranges.size(), 4u);
  for (std::size_t k = 0; k < 2; ++k) {
    const double size = std::max(std::abs(ranges[k].first), std::abs(ranges[k].second));
    EXPECT_NEAR(ranges[k + 2].first, 2.0 * ranges[k].first, 2e-3 * size) << "four digits are shown";
    EXPECT_NEAR(ranges[k + 2].second, 2.0 * ranges[k].second, 2e-3 * size);
  }
  EXPECT_NE(svg.find("axial strain 0.05<"), std::string::npos) << svg.substr(0, 900);
  for (double away : from_line_of_symmetry(svg))
    EXPECT_TRUE(away < 0.6 || away > 12.8) << away << " px: its reflection would lie on it";
  const Finished named =
      sagefe(folder, "plot out/deck.h5 --picture conf --picture principal_stress_3 -o drawn");
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_EQ(read((folder / "drawn/deck_stage1_conf.svg").string()),
            read((folder / "drawn/deck_stage1_principal_stress_3.svg").string()));
}

TEST(Plot, WrongWishesAreNamed) {
  const fs::path folder = empty_folder("plot_wishes");
  const Finished run = run_with_all_states(folder);
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  const auto expect_refused = [&](const std::string& words, const std::string& message) {
    const Finished plot = sagefe(folder, "plot out/deck.h5 " + words);
    EXPECT_EQ(plot.exit_code, 1) << words;
    EXPECT_NE(plot.err.find(message), std::string::npos) << plot.err;
  };
  expect_refused("--picture dev --at strain=.033", "its strains are 0.01 0.02 0.03");
  expect_refused("--picture dev --at strain=x", "wanted STAGE[:INCREMENT], both from 1, strain=VALUE");
  expect_refused("--picture dev --range 5:1", "wanted LOW:HIGH, full or auto");
  expect_refused("--picture devi", "unknown field devi");
  expect_refused("--picture flow_net", "flow_net is of heads, and the model has none");
  expect_refused("--picture dev --line 0,0", "wanted X,Y:X,Y");
  expect_refused("--line 0,0:1,1", "of which fields?");
  expect_refused("--interface", "the model has no interface");
}

// Along the axis u_z falls from nothing at mid-height to that of the end.
TEST(Plot, FieldsAlongALineAreCurves) {
  const fs::path folder = empty_folder("plot_line");
  const Finished run = run_with_all_states(folder);
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  const Finished plot =
      sagefe(folder, "plot out/deck.h5 --picture displacement_y --line 0,0:0,1.4 --at 1:5 --at 1");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const std::string svg = read((folder / "out/deck_line.svg").string());
  const auto lines = lines_of(svg);
  ASSERT_EQ(lines.size(), 2u);
  for (const std::vector<double>& line : lines) EXPECT_TRUE(std::ranges::is_sorted(line)) << "down";
  EXPECT_NEAR(lines[1].back() - lines[1].front(), 2.0 * (lines[0].back() - lines[0].front()), 0.05) << "px";
  EXPECT_NE(svg.find("z [in]"), std::string::npos);
}

// Elements of flow are drawn and cut as soil is.  The head below the sheet pile is 2 m by symmetry, and falls along the
// bottom to 0 at the far end; so does the velocity there.
TEST(Plot, WaterIsDrawnWhereItFlows) {
  const fs::path folder = empty_folder("plot_flow");
  const Finished run = sagefe(folder, "run " + kInputs + "seepage/sheet_pile/deck.dat -q --result");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished plot = sagefe(folder, "plot out/sheet_pile.h5 --picture flow_net --picture velocity");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  EXPECT_NE(read(folder / "out/sheet_pile_stage1_flow_net.svg").find("lines of equal head"), std::string::npos);
  EXPECT_NE(read(folder / "out/sheet_pile_stage1_velocity.svg").find("length of velocity of water"),
            std::string::npos);
  const Finished line =
      sagefe(folder, "plot out/sheet_pile.h5 --line 0,-10:50,-10 --picture head --picture velocity");
  ASSERT_EQ(line.exit_code, 0) << line.err;
  const auto lines = lines_of(read(folder / "out/sheet_pile_line.svg"));
  ASSERT_EQ(lines.size(), 2u);
  for (const std::vector<double>& one : lines) {
    EXPECT_EQ(one.size(), 201u);
    for (std::size_t i = 1; i < one.size(); ++i)  // px down; a fitted velocity may swing below what is seen
      EXPECT_GE(one[i], one[i - 1] - 0.1) << i;
    EXPECT_GT(one.back() - one.front(), 200.0) << "px";
  }
  const Finished stress = sagefe(folder, "plot out/sheet_pile.h5 --picture stress_yy");
  EXPECT_EQ(stress.exit_code, 1);
  EXPECT_NE(stress.err.find("no element that fills an area has a number of stress_yy"), std::string::npos);
  const Finished net = sagefe(folder, "plot out/sheet_pile.h5 --picture flow_net --line 0,0:1,0");
  EXPECT_NE(net.err.find("head is its field"), std::string::npos) << net.err;
}

// Excess pressures belong to corners and are linear between them.  At the drained top they are zero, and they fall with time
// everywhere; settlement over the logarithm of time is one command, too.
TEST(Plot, IsochronesAndSettlementOverTime) {
  const fs::path folder = empty_folder("plot_isochrones");
  const Finished run =
      sagefe(folder, "run " + std::string(SAGE_SOURCE_DIR) +
                         "/legacy_inputs/models/embankment_on_clay.sage.toml -q --result --states 5:12,5:16");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // Long names of columns keep blanks between them, and their values stand below.
  std::istringstream listing(read(folder / "out/embankment_on_clay.lst"));
  std::string head, values;
  while (std::getline(listing, head) && head.find("excess_pore_pressure") == std::string::npos) {
  }
  std::getline(listing, values);
  EXPECT_NE(head.find("strain  excess_pore_pressure [kPa]  water_content_change  water_displacement_x [m]"),
            std::string::npos)
      << head;
  EXPECT_EQ(head.size(), values.size());
  const Finished plot =
      sagefe(folder,
             "plot out/embankment_on_clay.h5 --picture excess_pressure --line 1,-10:1,0 --at 4 "
             "--at 5:12 --at 5:16");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const auto lines = lines_of(read(folder / "out/embankment_on_clay_line.svg"));
  ASSERT_EQ(lines.size(), 3u);
  for (const std::vector<double>& line : lines) {
    ASSERT_EQ(line.size(), 201u);
    EXPECT_NEAR(line.back(), lines[0].back(), 0.05) << "px: zero at the top";
  }
  for (std::size_t i = 0; i < 190; ++i) {  // px down
    EXPECT_LT(lines[0][i], lines[1][i]) << i;
    EXPECT_LT(lines[1][i], lines[2][i]) << i;
  }
  const Finished curve = sagefe(folder, "plot out/embankment_on_clay.report1.csv --xy time:uy --log-x");
  ASSERT_EQ(curve.exit_code, 0) << curve.err;
  const Finished refused = sagefe(folder, "plot out/embankment_on_clay.h5 --picture excess_pressure --log-x");
  EXPECT_NE(refused.err.find("--log-x is for"), std::string::npos) << refused.err;
}

// Before anything is computed: a deck of flow alone has no stress, and water has no strength.
TEST(Plot, RunRefusesPicturesThatWouldBeEmpty) {
  const fs::path folder = empty_folder("plot_empty");
  for (const char* field : {"stress_yy", "SL", "bending_moment", "displacement", "yielded"}) {
    const Finished run =
        sagefe(folder, "run " + kInputs + "seepage/sheet_pile/deck.dat -q --picture " + std::string(field));
    EXPECT_EQ(run.exit_code, 1) << field;
    EXPECT_NE(run.err.find(std::string("--picture ") + field), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("S644"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("head, "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("velocity, hydraulic_gradient"), std::string::npos) << run.err;
    const std::string there = run.err.substr(run.err.find("there are"));
    for (const char* absent : {" stress_level", " displacement", " reaction", " yielded"})
      EXPECT_EQ(there.find(absent), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "out/sheet_pile.lst"));
  }
}

// A place for each integration point of the interface.
TEST(Plot, StressesOfInterfacesAreCurves) {
  const fs::path folder = empty_folder("plot_interface");
  const Finished run = sagefe(folder, "run " + kInputs + "chapter7/friction_08_nu025/deck.dat -q --result");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished plot = sagefe(folder, "plot out/friction_08_nu025.h5 --interface --at 1");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const auto lines = lines_of(read((folder / "out/friction_08_nu025_interface.svg").string()));
  ASSERT_EQ(lines.size(), 3u);
  for (const std::vector<double>& line : lines) EXPECT_EQ(line.size(), 28u) << "14 elements of 2 points";
}

TEST(Plot, FilesThatAreNoneAreOneError) {
  const fs::path folder = empty_folder("plot_bad");
  const Finished run = sagefe(folder, "run " + kInputs + "chapter7/pinned_ld1_nu025/deck.dat -q --result -o .");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const fs::path whole = folder / "pinned_ld1_nu025.h5", spoilt = folder / "spoilt.h5";
  const auto expect_refused = [&](const std::string& file, const std::string& words) {
    const Finished plot = sagefe(folder, "plot " + file + " --picture stress_yy -o drawn");
    EXPECT_EQ(plot.exit_code, 2) << plot.err;
    EXPECT_NE(plot.err.find(words), std::string::npos) << plot.err;
    EXPECT_TRUE(!fs::exists(folder / "drawn") || pictures_in(folder / "drawn").empty());
  };
  expect_refused("absent.h5", "can't be opened");
  expect_refused(kInputs + "chapter7/pinned_ld1_nu025/deck.dat", "no whole file of HDF5");
  fs::copy_file(whole, spoilt);
  fs::resize_file(spoilt, fs::file_size(whole) / 2);
  expect_refused("spoilt.h5", "no whole file of HDF5");
  fs::copy_file(whole, spoilt, fs::copy_options::overwrite_existing);
  spoil(spoilt, "frames-2", "frames-0");
  expect_refused("spoilt.h5", "written as frames-0");
  std::ofstream(folder / "file") << "none";
  const Finished nowhere = sagefe(folder, "plot " + whole.string() + " --picture stress_yy -o file/drawn");
  EXPECT_EQ(nowhere.exit_code, 4) << nowhere.err;
  EXPECT_NE(nowhere.err.find("can't be made"), std::string::npos) << nowhere.err;
  // Another Young's modulus is another model than the one that the states are of.
  fs::copy_file(whole, spoilt, fs::copy_options::overwrite_existing);
  spoil(spoilt, "     3000.", "     4000.");
  expect_refused("spoilt.h5", "another model");
}

// Stresses as the source chapter's figures show them.  sigma_3 of each element's mean stress is computed here from
// the table of points; what a picture has are means of those, so that it can't pass them.
TEST(Plot, StressesAreMeansOfElements) {
  const fs::path folder = empty_folder("plot_means");
  const Finished run =
      sagefe(folder, "run " + kInputs + "chapter7/friction_285_nu0495/deck.dat -q --result --points");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const CsvTable points = read_csv_table(folder / "out/friction_285_nu0495.points.csv");
  const auto column = [&](const char* name) { return points.find(name)->values; };
  const std::vector<double> group = column("group"), element = column("element"), xx = column("stress_xx"),
                            yy = column("stress_yy"), zz = column("stress_zz"), xy = column("stress_xy");
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i + 3 < element.size();) {
    if (group[i] != 1.0) {
      ++i;
      continue;
    }
    double s[4] = {};
    for (std::size_t p = i; p < i + 4; ++p) {
      ASSERT_EQ(element[p], element[i]);
      s[0] += 0.25 * xx[p], s[1] += 0.25 * yy[p], s[2] += 0.25 * zz[p], s[3] += 0.25 * xy[p];
    }
    const double least = 0.5 * (s[0] + s[1]) - std::hypot(0.5 * (s[0] - s[1]), s[3]);
    low = std::min({low, least, s[2]});
    high = std::max(high, std::min(least, s[2]));
    i += 4;
  }
  const auto range = [&](const std::string& more) {
    const Finished plot = sagefe(folder, "plot out/friction_285_nu0495.h5 --picture conf --range full" + more);
    EXPECT_EQ(plot.exit_code, 0) << plot.err;
    const std::string svg = read((folder / "out/friction_285_nu0495_stage1_conf.svg").string());
    EXPECT_NE(svg.find(more.empty() ? "values: means of elements" : "values: extrapolated"), std::string::npos);
    return ranges_of(svg).at(0);
  };
  const auto [from, to] = range("");
  EXPECT_GE(from, low - 1e-3 * high) << "four digits are shown";
  EXPECT_LE(to, high * (1.0 + 1e-3));
  EXPECT_GT(to, 0.5 * high) << "but it comes near to them";
  const auto [out_from, out_to] = range(" --extrapolate");
  EXPECT_LT(out_from, low);
  EXPECT_GT(out_to, 2.0 * high) << "points of neighbours disagree";
}

// A mean of stress levels is none above 1.
TEST(Plot, StressLevelsDoNotPassOne) {
  const fs::path folder = empty_folder("plot_level");
  const Finished run = sagefe(folder, "run " + kInputs + "chapter7/dp_285/deck.dat -q --result");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(sagefe(folder, "plot out/dp_285.h5 --picture SL").exit_code, 0);
  for (const auto& [name, svg] : pictures_in(folder / "out"))
    for (const auto& [low, high] : ranges_of(svg)) EXPECT_LE(high, 1.0) << name;
}

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    all[entry.path().filename().string()] = read(entry.path().string());
  return all;
}

// The deck writes the last of its 40 increments only; listing and tables stay as they were, to the byte.
TEST(RunStates, AddWhatTheDeckDoesNotChoose) {
  const fs::path folder = empty_folder("run_states");
  const std::string deck = "run " + kInputs + "chapter7/friction_285_nu0495/deck.dat -q ";
  ASSERT_EQ(sagefe(folder, deck + "-o plain").exit_code, 0);
  const Finished run =
      sagefe(folder, deck + "--picture conf --states strain=.05,.1 --states load=.25 --states 1:30 -o out");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("--states"), std::string::npos) << "increments end at all of them";
  const auto before = files_in(folder / "plain");
  auto after = files_in(folder / "out");
  for (const char* name : {"friction_285_nu0495.report1.csv", "friction_285_nu0495.increments.csv"})
    EXPECT_TRUE(before.at(name) == after.at(name)) << name;
  for (int increment : {10, 20, 30})
    EXPECT_TRUE(
        after.contains("friction_285_nu0495_stage1_increment" + std::to_string(increment) + "_conf.svg"));
  EXPECT_TRUE(after.contains("friction_285_nu0495_stage1_conf.svg")) << "10 % is the end of the stage";
  EXPECT_EQ(pictures_in(folder / "out").size(), 4u);

  const Finished stored = sagefe(folder, deck + "--result --states strain=.05 -o stored");
  if (without_module(stored)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(stored.exit_code, 0) << stored.err;
  const Finished plot = sagefe(folder, "plot stored/friction_285_nu0495.h5 --picture conf --at strain=.05,.1");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const char* half = "friction_285_nu0495_stage1_increment20_conf.svg";
  EXPECT_TRUE(pictures_in(folder / "stored").at(half) == after.at(half));
}

TEST(RunStates, SayWhichIncrementIsNearestAndWhatThereIsNot) {
  const fs::path folder = empty_folder("run_states_bad");
  const auto expect = [&](const std::string& options, int code, const std::string& words) {
    const Finished run = sagefe(folder, "run " + kInputs + "chapter7/pinned_ld1_nu025/deck.dat " + options);
    EXPECT_EQ(run.exit_code, code) << options << "\n" << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << options << "\n" << run.err;
  };
  expect("--points --states strain=.033", 0,
         "--states strain=.033: no increment ends there; the nearest is increment 3, axial strain 0.03");
  expect("--points --states load=.5,.7", 0, "");
  expect("--points --states strain=.5", 1, "the axial strain of the last stage goes from 0.01 to 0.1");
  expect("--points --states 1:11", 1, "stage 1 has 10 increments");
  expect("--points --states 3", 1, "the deck has 1 stages");
  expect("--points --states half", 1, "--states half: wanted STAGE[:INCREMENT]");
  expect("--states 1:5", 1, "into which files?");
}

// Where the strain is not known before the run the refusal says why, and how states are named then.
TEST(RunStates, AreNoStrainsWhereNothingPrescribesThem) {
  const fs::path folder = empty_folder("run_states_loaded");
  const Finished footing =
      sagefe(folder, "run " + kInputs + "hyperbolic/strip_footing/deck.dat --points --states strain=.05");
  EXPECT_EQ(footing.exit_code, 1) << footing.err;
  EXPECT_NE(footing.err.find("no triaxial report"), std::string::npos) << footing.err;
  EXPECT_NE(footing.err.find("load=VALUE or STAGE:INCREMENT"), std::string::npos) << footing.err;
  std::string deck = read(kInputs + "hyperbolic/triaxial/deck.dat");
  const std::string moved = "    3    4    1    0    1               -0.04";
  ASSERT_NE(deck.find(moved), std::string::npos);
  deck.replace(deck.find(moved), moved.size(), "    3    4    1    0   -1");  // the end is let go
  std::ofstream(folder / "loaded.dat") << deck;
  const Finished loaded = sagefe(folder, "run loaded.dat --points --states strain=.05");
  EXPECT_EQ(loaded.exit_code, 1) << loaded.err;
  EXPECT_NE(loaded.err.find("loads the specimen's end and does not move it"), std::string::npos) << loaded.err;
  EXPECT_NE(loaded.err.find("load=VALUE"), std::string::npos) << loaded.err;
}

// Each is refused by its name, and nothing is drawn.
TEST(Plot, OptionsThatWouldMeanNothingAreRefused) {
  const fs::path folder = empty_folder("plot_options");
  const Finished run = run_with_all_states(folder);
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  const auto expect_refused = [&](const std::string& words, const std::string& message) {
    const Finished plot = sagefe(folder, "plot " + words + " -o drawn");
    EXPECT_EQ(plot.exit_code, 1) << words;
    EXPECT_NE(plot.err.find(message), std::string::npos) << words << "\n" << plot.err;
    EXPECT_FALSE(fs::exists(folder / "drawn")) << words;
  };
  for (const char* option :
       {"--at 1", "--increment 5", "--sheet", "--own-scales", "--range full", "--levels 5", "--extrapolate",
        "--no-mesh", "--deformed", "--undeformed", "--mirror left", "--yielded", "--crosses", "--arrows"}) {
    const std::string name = std::string(option).substr(0, std::string(option).find(' '));
    expect_refused("out/deck.report1.csv " + std::string(option), name + " is for");
  }
  for (const char* option : {"--range 0:1", "--levels 5", "--extrapolate", "--no-mesh", "--deformed",
                             "--mirror both", "--yielded", "--crosses", "--arrows", "--sheet", "--own-scales"})
    for (const char* mode : {"--interface ", "--line 0,0:1,1 --picture dev "}) {
      const std::string name = std::string(option).substr(0, std::string(option).find(' '));
      expect_refused(std::string("out/deck.h5 ") + mode + option, name + " is for");
    }
  const std::string h5 = "out/deck.h5 ", dev = h5 + "--picture dev ";
  expect_refused(h5 + "--line 0,0:1,1 --interface", "--line is for");
  expect_refused(dev + "--xy axial_strain:ratio", "--xy is for");
  expect_refused(dev + "--own-scales", "--own-scales is for");
  expect_refused(dev + "--name x", "--name is for");
  expect_refused(dev + "--sheet --own-scales --range 0:5", "--own-scales does not go with");
  expect_refused(h5 + "--label a --label b", "--label: 2 of them for 1 files");
  expect_refused(h5 + h5 + "--label a", "--label: 1 of them for 2 files");
  expect_refused("out/deck.report1.csv --picture dev", "is a table");
  expect_refused(h5 + "--name ../x", "wanted a file's name");
  expect_refused(h5 + h5 + "--picture dev", "would bear the same names");
}

TEST(Plot, WhatWouldBeEmptyIsAnError) {
  const fs::path folder = empty_folder("plot_empty");
  const Finished run = run_with_all_states(folder);
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  const Finished with_interface =
      sagefe(folder, "run " + kInputs + "chapter7/friction_08_nu025/deck.dat -q --result");
  ASSERT_EQ(with_interface.exit_code, 0);
  write(folder / "nan.csv", "# t\na,b,c\n1,nan,1\n2,nan,2\n");
  const auto expect_refused = [&](const std::string& words, const std::string& message) {
    const Finished plot = sagefe(folder, "plot " + words);
    EXPECT_EQ(plot.exit_code, 1) << words;
    EXPECT_NE(plot.err.find(message), std::string::npos) << words << "\n" << plot.err;
  };
  const std::string joint = "out/friction_08_nu025.h5 ";
  expect_refused("out/deck.h5 --line 5,5:6,6 --picture dev", "its mesh goes from 0,0 to 1.4,1.4");
  expect_refused("out/deck.h5 --line 0,0:1,1 --picture traction_normal",
                 "no solid has a number of traction_normal");
  expect_refused(joint + "--picture traction_normal", "it is of interfaces; --interface shows it");
  expect_refused(joint + "--line 0,0:1,1 --picture traction_shear", "--interface shows it");
  expect_refused(joint + "--interface --picture dev", "it is of solids; --picture and --line show it");
  expect_refused(joint + "--interface --picture displacement_y", "it is of nodes");
  expect_refused("nan.csv --xy a:b", "no row has a number of both a and b");
  EXPECT_EQ(sagefe(folder, "plot nan.csv --xy a:c").exit_code, 0);
}

TEST(Plot, SeveralFilesAgreeInUnitsAndSayTheirGeometry) {
  const fs::path folder = empty_folder("plot_units");
  write(folder / "a.dat", block_deck().text());
  write(folder / "b.dat", block_deck().with("units", "m       kN      kPa        101.325      9.81").text());
  ASSERT_EQ(sagefe(folder, "run a.dat -q -o ax --geometry 2").exit_code, 0);
  ASSERT_EQ(sagefe(folder, "run a.dat b.dat -q -o out").exit_code, 0);
  const Finished tables = sagefe(folder, "plot out/a.report1.csv out/b.report1.csv --xy axial_strain:force");
  EXPECT_EQ(tables.exit_code, 1);
  EXPECT_NE(tables.err.find("force of out/a.report1.csv is in lbf, force of out/b.report1.csv in kN"),
            std::string::npos)
      << tables.err;
  const Finished mixed =
      sagefe(folder, "plot out/a.report1.csv ax/a.report1.csv --xy axial_strain:force --name mixed");
  ASSERT_EQ(mixed.exit_code, 0) << mixed.err;
  const std::string note = read((folder / "out/mixed.svg").string());
  EXPECT_NE(note.find("full circle"), std::string::npos) << "forces of a ring";
  EXPECT_NE(note.find("per inch"), std::string::npos) << "and of a slice";
  const Finished run = sagefe(folder, "run a.dat b.dat -q -o out --result");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(sagefe(folder, "run a.dat -q -o ax --geometry 2 --result").exit_code, 0);
  for (const char* mode : {"--sheet", "--line 0,0:0,1"}) {
    const std::string field = std::string(" --picture stress_yy --name two ") + mode;
    const Finished units = sagefe(folder, "plot out/a.h5 out/b.h5" + field);
    EXPECT_EQ(units.exit_code, 1);
    EXPECT_NE(units.err.find("out/a.h5 is in in, lbf, psi, out/b.h5 in m, kN, kPa"), std::string::npos)
        << units.err;
    ASSERT_EQ(sagefe(folder, "plot out/a.h5 ax/a.h5" + field).exit_code, 0);
    const std::string svg = read((folder / "out/two.svg").string());
    EXPECT_NE(svg.find("out/a (plane"), std::string::npos);
    EXPECT_NE(svg.find("ax/a"), std::string::npos);
    EXPECT_NE(svg.find("(axisymmetric)"), std::string::npos);
  }
  // Pictures of files of one name get those of their folders.
  const Finished both = sagefe(folder, "plot out/a.h5 ax/a.h5 --picture stress_yy -o drawn");
  ASSERT_EQ(both.exit_code, 0) << both.err;
  EXPECT_TRUE(fs::exists(folder / "drawn/out_a_stage1_stress_yy.svg"));
  EXPECT_TRUE(fs::exists(folder / "drawn/ax_a_stage1_stress_yy.svg"));
}

// The mark of spreadsheets, line ends of another system, a control character and a title without end.
TEST(Plot, TablesOfOtherProgramsAreDrawn) {
  const fs::path folder = empty_folder("plot_foreign");
  const std::string title(400, 'w');
  write(folder / "t.csv", "\xef\xbb\xbf# a\x01" + title + "\r\nx[m],y/z[kN]\r\n0,0\r\n1,2\r\n");
  const Finished plot = sagefe(folder, "plot t.csv --xy x:y/z");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  EXPECT_EQ(plot.out, "t_y_z_x.svg\n");
  const std::string svg = read((folder / "t_y_z_x.svg").string());
  EXPECT_EQ(svg.find('\x01'), std::string::npos) << "XML has no control characters";
  EXPECT_NE(svg.find("<title>a " + title + "</title>"), std::string::npos);
  EXPECT_NE(svg.find("w...w"), std::string::npos) << "shortened to the width of the paper";
  EXPECT_EQ(sagefe(folder, "plot t.csv --xy x:y/z --name s.svg").out, "s.svg\n");
  const Finished png = sagefe(folder, "plot t.csv --xy x:y/z --name p.png");
  if (png.exit_code == 4) GTEST_SKIP() << "no rsvg-convert here";
  EXPECT_EQ(png.out, "p.svg\np.png\n");
  EXPECT_EQ(read((folder / "p.png").string()).substr(1, 3), "PNG");
}

// Two grounds of one material with a wall between them, which all of their nodes are held with: stresses stay what they
// are at the start, 100 to the left and 0 to the right.
std::string wall_deck() {
  std::string text = "Wall between two grounds\nm       kN      kPa        101.325      9.81\n";
  const auto add = [&](const std::vector<int>& integers, std::initializer_list<const char*> reals = {},
                       const std::string& words = "") {
    for (int n : integers) {
      const std::string number = std::to_string(n);
      text += card({number.c_str()});
    }
    text += card({}, reals) + words + "\n";
  };
  add({1, 0, 15, 0, 2, 3, 10, 18, 2, 1, 0});
  constexpr const char* kPlaces[] = {"0.", "1.", "2.", "3.", "4."};
  for (int n = 0; n < 15; ++n) add({n + 1, 0, 0}, {kPlaces[n % 5], kPlaces[n / 5]});
  add({1, 1, 2}, {"0."}, "soil");
  add({}, {"1000.", "0.3"});
  add({2, 36, 2}, {"0."}, "wall");
  add({}, {"1.E6", "1.E4"});
  add({1, 1, 1, 1});
  add({2, 1, 1, 1});
  add({3, 35, 1, 2});
  for (int e = 0; e < 8; ++e) {
    const int a = 1 + e % 4 + 5 * (e / 4);
    add({e + 1, e % 4 < 2 ? 1 : 2, a, a + 1, a + 6, a + 5});
  }
  add({9, 3, 3, 8});
  add({10, 3, 8, 13});
  for (int n = 1; n <= 15; ++n) add({n, 0, 0, 1, 1});
  for (int n : {3, 8, 13}) add({n, 0, 0, 1, 0}, {}, std::string(20, ' ') + "rotation");
  add({1, 0}, {"100.", "100.", "100."});
  add({2, 0}, {"0.", "0.", "0."});
  text += "Nothing moves\n";
  add({1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  return text + "END\n";
}

// Nothing is averaged across the wall, in pictures and along lines: 100 up to it, 0 behind it.
TEST(Plot, NothingIsAveragedAcrossAWall) {
  const fs::path folder = empty_folder("plot_wall");
  write(folder / "deck.dat", wall_deck());
  const Finished run = sagefe(folder, "run deck.dat -q --result");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(sagefe(folder, "plot out/deck.h5 --picture stress_xx --line 0.1,0.5:3.9,0.5").exit_code, 0);
  const auto lines = lines_of(read((folder / "out/deck_line.svg").string()));
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_EQ(lines[0].size(), 201u);
  for (std::size_t i = 0; i < 201; ++i)  // the wall is at the middle
    EXPECT_TRUE(i == 100 || lines[0][i] == lines[0][i < 100 ? 0 : 200]) << "place " << i << ": " << lines[0][i];
  EXPECT_LT(lines[0].front(), lines[0].back() - 100.0) << "px";
  ASSERT_EQ(sagefe(folder, "plot out/deck.h5 --picture stress_xx").exit_code, 0);
  const std::string svg = read((folder / "out/deck_stage1_stress_xx.svg").string());
  EXPECT_EQ(count(svg, "<path fill=\"#"), 2) << "two colours: of 100 and of 0";
}

// Serendipity shape functions and extrapolation lead out of what the points have: 1.002 and -0.082 kPa here.
TEST(Plot, LevelsAndPressuresStayWithinThoseOfThePoints) {
  const fs::path folder = empty_folder("plot_within");
  const Finished run = sagefe(
      folder, "run " + kInputs + "slopes/one_to_one_line/deck.dat -q --result --points --field pore_pressure");
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* more : {"", " --extrapolate"})
    for (const auto& [field, least, most] : {std::tuple{"SL", 0.0, 1.0}, {"pore_pressure", 0.0, HUGE_VAL}}) {
      ASSERT_EQ(
          sagefe(folder, std::string("plot out/one_to_one_line.h5 --range full --picture ") + field + more)
              .exit_code,
          0);
      const auto ranges = ranges_of(
          read((folder / "out" / (std::string("one_to_one_line_stage1_") + field + ".svg")).string()));
      ASSERT_EQ(ranges.size(), 1u);
      EXPECT_GE(ranges[0].first, least) << field << more;
      EXPECT_LE(ranges[0].second, most) << field << more;
    }
  const Finished none = sagefe(folder, "plot out/one_to_one_line.h5 --picture bending_moment");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("no structure has bending_moment"), std::string::npos) << none.err;
}

// Moments and their envelopes are the diagrams that the run draws; a curve over a line they are not.
TEST(Plot, MomentsOfStructuresAreDiagrams) {
  const fs::path folder = empty_folder("plot_moments");
  const std::string moments = " --picture bending_moment --picture bending_moment_envelope";
  const Finished run =
      sagefe(folder, "run " + kInputs + "structures/braced_cut/deck.dat -q --result" + moments);
  if (without_module(run)) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto drawn = pictures_in(folder / "out");
  const Finished plot = sagefe(folder, "plot out/braced_cut.h5 -o again" + moments);
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  const auto again = pictures_in(folder / "again");
  ASSERT_TRUE(again.contains("braced_cut_stage5_bending_moment_envelope.svg"));
  for (const auto& [name, svg] : again) EXPECT_EQ(svg, drawn.at(name)) << name;
  const Finished sheet = sagefe(folder, "plot out/braced_cut.h5 --sheet --at 4 --name sheet" + moments);
  EXPECT_EQ(sheet.exit_code, 0) << sheet.err;
  const Finished line = sagefe(folder, "plot out/braced_cut.h5 --picture bending_moment --line 0,0:1,-1");
  EXPECT_EQ(line.exit_code, 1);
  EXPECT_NE(line.err.find("it is of structures; --picture without --line"), std::string::npos) << line.err;
  const Finished at = sagefe(folder, "plot out/braced_cut.h5 --picture bending_moment_envelope --at 2");
  EXPECT_EQ(at.exit_code, 1) << "an envelope is of all stages";
}

// Units and names of columns as other programs write them; a file's name up to what a run adds to it.
TEST(Plot, NamesWithDotsAndUnitsBehindBlanks) {
  const fs::path folder = empty_folder("plot_names");
  const std::string table = "# a title\nx [m],settlement [ mm ]\n0,0\n1,";
  write(folder / "phi_28.0.report1.csv", table + "2\n");
  write(folder / "phi_28.5.report1.csv", table + "3\n");
  const Finished plot = sagefe(folder, "plot phi_28.0.report1.csv phi_28.5.report1.csv --xy x:settlement");
  ASSERT_EQ(plot.exit_code, 0) << plot.err;
  EXPECT_EQ(plot.out, "phi_28.0_settlement_x.svg\n");
  const std::string svg = read((folder / "phi_28.0_settlement_x.svg").string());
  for (const char* words : {">phi_28.0<", ">phi_28.5<", ">settlement [mm]<", ">x [m]<"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  // A deck that does not name its units.
  std::string deck = wall_deck();
  deck.replace(deck.find("m       kN      kPa"), 19, "-       -       -  ");
  write(folder / "deck.dat", deck);
  const Finished run = sagefe(folder, "run deck.dat -q --picture stress_xx");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(count(read((folder / "out/deck_stage1_stress_xx.svg").string()), "[-]"), 0);
}

// A cell that is no number is a gap in the curve, and a warning; so is a table whose last line has no end.
TEST(Plot, DamagedCellsOfTablesAreNamed) {
  const fs::path folder = empty_folder("plot_damaged");
  write(folder / "t.csv", "# t\nx[m],y[kN],z[kN]\n0,0,a\n1,1.5x,b\n2,inf,c\n3,4,d\n4,5,e");
  const Finished plot = sagefe(folder, "plot t.csv --xy x:y");
  EXPECT_EQ(plot.exit_code, 0);
  EXPECT_NE(plot.err.find(
                "t.csv:4: warning: \"1.5x\" of column y is no finite number, and 1 more cells are none: the "
                "curve has a gap [S606]"),
            std::string::npos)
      << plot.err;
  EXPECT_NE(plot.err.find("may be cut short [S609]"), std::string::npos) << plot.err;
  EXPECT_EQ(count(plot.err, "column z"), 0) << "which is not drawn";
  write(folder / "whole.csv", "# t\nx[m],y[kN]\n0,0\n1,\n2,3\n");
  EXPECT_EQ(sagefe(folder, "plot whole.csv --xy x:y").err, "") << "blank is no damage";
}

}  // namespace
}  // namespace sage::test

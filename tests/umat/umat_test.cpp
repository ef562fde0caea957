// User materials of Abaqus/Standard: own small ones, in Fortran and C, against the native laws, and ones with faults.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <thread>

#include "sage/umat/law.hpp"
#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

const std::string kUmats = SAGE_TEST_UMATS;
const std::string kCases = std::string(SAGE_SOURCE_DIR) + "/legacy_inputs/chapter7/";

std::string library(const std::string& name) {
  return kUmats + "/" + name + "_umat.so";
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << "\nin:\n" << text;
}

// Card and parameters of law umat.
std::string umat_material(const std::vector<std::string>& parameters, const std::string& name = "") {
  std::string text = card({"1", "100", std::to_string(parameters.size()).c_str()}) + "          " + name;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    text += (i % 8 == 0 ? "\n" : "") + std::string(10 - parameters[i].size(), ' ') + parameters[i];
  return text + "\n";
}

// Two elements under 100, sides held, in ten increments.
std::string column_deck(const std::string& material, const std::string& initial = "", int initials = 0) {
  return "a column\nm       kN      kPa\n" +
         card({"1", "0", "6", "0", "1", "1", "2", "3", std::to_string(initials).c_str(), "1", "1"}) +
         "\n    1                  0.        0.\n    2                  1.        0.\n    3                  "
         "0.        "
         "1.\n    4                  1.        1.\n    5                  0.        2.\n    6                  "
         "1.        "
         "2.\n" +
         material +
         "    1    1    2    1\n    1    1    1    2    4    3\n    2    1    3    4    6    5\n    1    2    "
         "1    0    "
         "1\n    1    5    2    1    0\n    2    6    2    1    0\n" +
         initial +
         "press\n   10    0    0    1    0    0    1\n    2    3                100.      100.\n    2    0    "
         "5    "
         "6    1    1\nEND\n";
}

// All numbers of a CSV file, comments and headings left out.
std::vector<double> numbers(const fs::path& file) {
  std::vector<double> found;
  std::istringstream lines(read(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#') || line.empty() || std::isalpha(static_cast<unsigned char>(line[0])) != 0)
      continue;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      std::size_t end = 0;
      try {
        const double value = std::stod(cell, &end);
        if (end == cell.size()) found.push_back(value);
      } catch (const std::exception&) {
        continue;  // a word, or blank
      }
    }
  }
  return found;
}

// Rows of a CSV file by the names of their columns without units; words are left out.
std::vector<std::map<std::string, double>> rows_of(const fs::path& file) {
  std::vector<std::string> names;
  std::vector<std::map<std::string, double>> rows;
  std::istringstream lines(read(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#') || line.empty()) continue;
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell.substr(0, cell.find('[')));
    if (names.empty()) {
      names = cells;
      continue;
    }
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i)
      if (!cells[i].empty() && std::isalpha(static_cast<unsigned char>(cells[i][0])) == 0)
        row[names[i]] = std::stod(cells[i]);
  }
  return rows;
}

// The reports of two decks of the chapter: 1e-10 of the stress, which is what rounding leaves of two orders of
// summation in 60 increments.
void expect_same_reports(const fs::path& folder, const std::string& umat_deck, const std::string& native,
                         const std::string& umat) {
  write(folder / "umat.dat", umat_deck);
  const Finished own = sagefe(folder, "run -q -o own --digits 17 " + native);
  const Finished other = sagefe(folder, "run -q -o other --digits 17 umat.dat --umat " + umat);
  ASSERT_EQ(own.exit_code, 0) << own.err;
  ASSERT_EQ(other.exit_code, 0) << other.err;
  const std::string stem = fs::path(native).parent_path().filename().string();
  const std::vector<double> expected = numbers(folder / "own" / (stem + ".report1.csv"));
  const std::vector<double> found = numbers(folder / "other" / "umat.report1.csv");
  ASSERT_EQ(expected.size(), found.size());
  ASSERT_GT(expected.size(), 20u);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-10 * std::max(1.0, std::abs(expected[i]))) << i;
}

TEST(Umat, ElasticIsTheNativeLawInTheChaptersDecks) {
  const fs::path folder = empty_folder("umat_elastic");
  const std::string native = kCases + "pinned_ld2_nu0495/deck.dat", text = read(native);
  const std::size_t card_at = text.find("\n    1    1    2") + 1,
                    end = text.find('\n', text.find("3000.", card_at)) + 1;
  for (const char* components : {"4", "6"}) {
    std::string deck = text;
    deck.replace(card_at, end - card_at, umat_material({components, "0", "1", "0", "3000.", ".495"}, "soil"));
    for (const char* routine : {"elastic", "elastic_c", "wide"})
      expect_same_reports(folder, deck, native, library(routine));
  }
}

// A model file holds the properties behind the parameters of the law; a list with a word in it is rejected where it stands.
TEST(Umat, PropertiesInModelFiles) {
  const fs::path folder = empty_folder("umat_model_file");
  const std::string umat = " --umat " + library("elastic");
  write(folder / "column.dat", column_deck(umat_material({"4", "0", "1", "0", "20000.", ".25"}, "soil")));
  const Finished converted = sagefe(folder, "convert column.dat column.sage.toml" + umat);
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const std::string model = read(folder / "column.sage.toml"), props = "props = [20000.0, 0.25]";
  expect_words(model, {"law = \"umat\"", props});
  ASSERT_EQ(sagefe(folder, "run -q -o deck column.dat" + umat).exit_code, 0);
  const Finished run = sagefe(folder, "run -q -o model column.sage.toml" + umat);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<double> expected = numbers(folder / "deck/column.report1.csv"),
                            found = numbers(folder / "model/column.report1.csv");
  EXPECT_EQ(found, expected);
  EXPECT_GT(expected.size(), 10u);
  std::string broken = model;
  broken.replace(broken.find(props), props.size(), "props = [20000, \"a\"]");
  write(folder / "broken.sage.toml", broken);
  const Finished rejected = sagefe(folder, "run -q broken.sage.toml" + umat);
  EXPECT_EQ(rejected.exit_code, 2);
  expect_words(rejected.err, {"S152"});
}

TEST(Umat, DruckerPragerIsTheNativeLawInTheChaptersDecks) {
  const fs::path folder = empty_folder("umat_dp");
  const std::string native = kCases + "dp_285/deck.dat", text = read(native);
  const std::size_t card_at = text.find("    1    3    9"), end = text.find("    2   22   10");
  for (const char* components : {"4", "6"}) {
    std::string deck = text;
    deck.replace(card_at, end - card_at,
                 umat_material({components, "0", "0", "0", "3000.", ".495", "0.", "36.87"}));
    expect_same_reports(folder, deck, native, library("drucker_prager"));
  }
}

// As the skeleton of consolidating clay: lifts, waits, and pore pressures of its own.
TEST(Umat, DruckerPragerIsTheNativeLawInConsolidatingClay) {
  const fs::path folder = empty_folder("umat_pores");
  std::string model = read(std::string(SAGE_SOURCE_DIR) + "/legacy_inputs/models/embankment_on_clay.sage.toml");
  for (const auto& [word, other] :
       {std::pair{"mohr_coulomb", "drucker_prager"}, {"dilation_angle = 0\n", ""}}) {
    const std::size_t at = model.find(word);
    ASSERT_NE(at, std::string::npos) << word;
    model.replace(at, std::string(word).size(), other);
  }
  write(folder / "native.sage.toml", model);
  fs::create_directory(folder / "native");
  const Finished converted = sagefe(folder, "convert native.sage.toml native/deck.dat");
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  std::string deck = read(folder / "native" / "deck.dat");
  const std::size_t values = deck.find("               4000."),
                    card_at = deck.rfind("\n", deck.rfind("soft clay", values)) + 1,
                    end = deck.find("*", values);
  const std::string blank(20, ' ');
  std::string umat = "         1       100         8                  6.soft clay\n";
  for (const std::string value : {"4.", "0.", "0.", "0.", "4000.", ".3", "5.", "25."})
    umat += blank.substr(value.size()) + value;
  deck.replace(card_at, end - card_at, umat + "\n");
  expect_same_reports(folder, deck, "native/deck.dat", library("drucker_prager"));
}

// Element, point, place, increment, times and size of the element as SDV1 ... SDV8, at the last increment of ten.
TEST(Umat, ContextIsTrue) {
  const fs::path folder = empty_folder("umat_context");
  write(folder / "deck.dat", column_deck(umat_material({"4", "8", "1", "0", "1000.", "0.25"})));
  const Finished run = sagefe(folder, "run deck.dat -o out --points --umat " + library("elastic"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(read(folder / "out/deck.points.csv"));
  std::string heading, line, last;
  while (std::getline(lines, line)) {
    if (line.find("SDV1") != std::string::npos) heading = line;
    if (!line.empty()) last = line;
  }
  expect_words(heading, {"SDV8", "SSE", "SPD", "SCD"});
  std::vector<std::string> names, values;
  for (auto [text, cells] : {std::pair{&heading, &names}, std::pair{&last, &values}}) {
    std::istringstream stream(*text);
    for (std::string cell; std::getline(stream, cell, ',');) cells->push_back(cell.substr(0, cell.find('[')));
  }
  const auto value = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    return std::stod(values.at(at));
  };
  EXPECT_EQ(value("SDV1"), 2.0);                 // NOEL
  EXPECT_EQ(value("SDV2"), 4.0);                 // NPT: from 1
  EXPECT_NEAR(value("SDV3"), value("x"), 1e-9);  // COORDS
  EXPECT_NEAR(value("SDV4"), value("y"), 1e-9);
  EXPECT_EQ(value("SDV5"), 10.0);         // KINC
  EXPECT_NEAR(value("SDV6"), 0.9, 1e-9);  // TIME(1), at the start of the increment
  EXPECT_NEAR(value("SDV7"), 0.1, 1e-9);  // DTIME
  EXPECT_NEAR(value("SDV8"), 1.0, 1e-9);  // CELENT: squares of 1 m
}

// CMNAME is the material's name; STATEV(1) of the routine in C is the step, where the name begins with C.
TEST(Umat, MaterialsFindTheirRoutinesByName) {
  const fs::path folder = empty_folder("umat_names");
  write(folder / "deck.dat", column_deck(umat_material({"4", "1", "1", "0", "1000.", "0.25"}, "clay")));
  const std::string c = library("elastic_c");
  const Finished run = sagefe(folder, "run deck.dat -q -o out --points --umat Clay=" + c + ":umat");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_words(read(folder / "out/deck.points.csv"), {"SDV1"});
  const Finished none = sagefe(folder, "check deck.dat --umat sand=" + c);
  EXPECT_EQ(none.exit_code, 2);
  expect_words(none.err, {"no routine is given for the material \"clay\": --umat clay=LIBRARY loads one"});
  EXPECT_EQ(sagefe(folder, "check deck.dat --umat sand=" + c + " --umat clay=" + c).exit_code, 0);
  const Finished twice = sagefe(folder, "check deck.dat --umat clay=" + c + " --umat CLAY=" + c);
  EXPECT_EQ(twice.exit_code, 1);
  expect_words(twice.err, {"its materials have a routine already"});
}

TEST(Umat, LibrariesWithoutARoutineAreRefused) {
  const fs::path folder = empty_folder("umat_libraries");
  write(folder / "deck.dat", column_deck(umat_material({"4", "0", "1", "0", "1000.", "0.25"})));
  write(folder / "text.so", "no library");
  for (const auto& [value, words] : {std::pair<std::string, std::string>{"none.so", "does not exist"},
                                     {"text.so", "no ELF file"},
                                     {library("elastic") + ":other", "has no routine other, other_"},
                                     {SAGE_TEST_UMAT_MODULE, "has no routine umat_, umat, UMAT"}}) {
    const Finished run = sagefe(folder, "check deck.dat --umat " + value);
    EXPECT_EQ(run.exit_code, 1) << run.err;
    expect_words(run.err, {"--umat " + value, words});
  }
  const Finished no_plugin = sagefe(folder, "conform " + library("elastic"));
  EXPECT_EQ(no_plugin.exit_code, 1);
  expect_words(no_plugin.err, {"no plug-in of sagefe", "a routine UMAT is loaded by --umat"});
  for (const auto& [parameters, words] :
       {std::pair<std::vector<std::string>, std::string>{{"5", "0"}, "4 or 6"},
        {{"4", "-1"}, "a whole number from 0"},
        {{"4", "0", "3"}, "a whole number from 0 to 2"},
        {{"4", "0", "0", "2"}, "a whole number from 0 to 1"}}) {
    write(folder / "bad.dat", column_deck(umat_material(parameters)));
    const Finished run = sagefe(folder, "check bad.dat --umat " + library("elastic"));
    EXPECT_EQ(run.exit_code, 2);
    expect_words(run.err, {"bad.dat:", words});
  }
}

// Ground of two elements, pressed over one of them: the mesh is far too coarse for a collapse load, and a user material
// may have one.
TEST(Umat, ACoarseFootingIsWarnedOf) {
  const fs::path folder = empty_folder("umat_coarse");
  write(folder / "deck.dat",
        "a footing\nm       kN      kPa\n" + card({"1", "0", "6", "0", "1", "1", "2", "4", "0", "1", "0"}) +
            "\n    1                  0.        0.\n    2                  1.        0.\n"
            "    3                  2.        0.\n    4                  0.        1.\n"
            "    5                  1.        1.\n    6                  2.        1.\n" +
            umat_material({"4", "0", "0", "0", "1000.", "0.25", "5.", "20."}) +
            "    1    1    2    1\n    1    1    1    2    5    4\n    2    1    2    3    6    5\n"
            "    1    3    1    1    1\n    4    0    0    1    0\n    6    0    0    1    0\n    5    0    0  "
            "  0    0\n"
            "press\n    5    0    0    1    0    0    1\n    1    3                 10.       10.\nEND\n");
  const Finished check = sagefe(folder, "check deck.dat --umat " + library("drucker_prager"));
  expect_words(check.out + check.err, {"[S334]", "the mesh is too coarse for a collapse load"});
}

Finished run_fault(const fs::path& folder, const std::string& fault, const std::string& from = "3.",
                   const std::string& statev = "1") {
  write(folder / "deck.dat", column_deck(umat_material({"4", statev, "0", "0", "1000.", "0.25", fault, from})));
  fs::remove_all(folder / "out");
  return sagefe(folder, "run deck.dat -o out --umat " + library("faults"));
}

// From the third increment on: two increments are on the disk, and the run says who, what and where.
void expect_refused_in_third(const fs::path& folder, const std::string& fault,
                             const std::vector<std::string>& words) {
  SCOPED_TRACE(fault);
  const Finished run = run_fault(folder, fault);
  EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
  expect_words(run.err, words);
  expect_words(run.err,
               {"routine umat_ of ", "faults_umat.so", " at element 1, point 1 (", "stage 1, increment 3"});
  EXPECT_EQ(numbers(folder / "out/deck.report1.csv").size() % 2, 0u);
  const std::string rows = read(folder / "out/deck.increments.csv");
  EXPECT_NE(rows.find("\n1,2,"), std::string::npos) << rows;
  EXPECT_EQ(rows.find("\n1,3,"), std::string::npos) << rows;
}

TEST(Umat, RoutinesThatWriteBeyondTheirArraysAreRefused) {
  const fs::path folder = empty_folder("umat_arrays");
  expect_refused_in_third(folder, "1.", {"wrote to DDSDDE(", "which has 16 numbers"});
  expect_refused_in_third(folder, "2.", {"wrote to STRESS(5), which has 4 numbers"});
  expect_refused_in_third(folder, "3.", {"wrote to STATEV(2), which has 1 number,"});
  expect_refused_in_third(folder, "9.", {"changed PROPS"});
  expect_refused_in_third(folder, "22.", {"wrote to TIME(3), which has 2 numbers"});
  expect_refused_in_third(folder, "23.", {"crashed (an access far beyond one of its arrays)"});
  expect_refused_in_third(folder, "24.", {"wrote to CMNAME(83), which has 80 characters"});
}

TEST(Umat, RoutinesThatEndTheProgramAreRefused) {
  const fs::path folder = empty_folder("umat_ends");
  expect_refused_in_third(folder, "4.", {"called XIT"});
  expect_refused_in_third(folder, "5.", {"executed STOP (no convergence)"});
  expect_refused_in_third(folder, "11.", {"executed STOP (12)"});
  expect_refused_in_third(folder, "13.", {"called XIT (element 1 of clay has 2.5)"});
  expect_refused_in_third(folder, "14.", {"ended the program"});
  expect_refused_in_third(folder, "26.", {"ended the program", "(_exit())"});
}

// _exit(0) runs nothing of the program: in every command it must be no success.
TEST(Umat, AnImmediateExitIsNoSuccess) {
  const fs::path folder = empty_folder("umat_immediate_exit");
  const std::string of = " --umat " + library("faults") + " ";
  const Finished drive = sagefe(
      folder, "drive --law umat" + of +
                  "--set components=4 --set state_variables=0 --set prop1=1000 --set prop2=.25 --set prop3=26 "
                  "--set prop4=0 --test oedometer --to .01");
  EXPECT_EQ(drive.exit_code, 3) << drive.out;
  expect_words(drive.out + drive.err, {"ended the program"});
  EXPECT_EQ(sagefe(folder, "conform" + of + "--props 1000,.25,26,0").exit_code, 3);
}

TEST(Umat, RoutinesThatCrashAreRefused) {
  const fs::path folder = empty_folder("umat_crashes");
  expect_refused_in_third(folder, "19.", {"crashed (Segmentation fault)"});
  expect_refused_in_third(folder, "20.", {"ended the program, by exit() or an error of its library"});
  expect_refused_in_third(folder, "21.", {"crashed (Segmentation fault)"});
}

TEST(Umat, AnExceptionIsAnErrorOfTheRun) {
  const fs::path folder = empty_folder("umat_exception");
  write(folder / "deck.dat", column_deck(umat_material({"4", "0", "0", "0"})));
  const Finished run = sagefe(folder, "run deck.dat -o out --umat " + library("throwing"));
  EXPECT_EQ(run.exit_code, 3);
  expect_words(run.err, {"routine umat of ", "threw an exception (no licence) at element 1, point 1"});
}

// kappa, lambda, M, nu; void ratio and preconsolidation pressure are STATEV.
const std::string kCamClay = "--law umat --umat " + library("cam_clay") +
                             " --set components=4 --set state_variables=2 --set prop1=.02 --set prop2=.1 --set "
                             "prop3=1.2 --set prop4=.3 --set history.SDV1=1 ";

double last_value(const fs::path& csv, const std::string& column) {
  std::istringstream lines(read(csv));
  std::string line, last, heading;
  while (std::getline(lines, line)) {
    if (line.starts_with("case,")) heading = line;
    if (!line.empty()) last = line;
  }
  std::istringstream names(heading), values(last);
  for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
    if (name.substr(0, name.find('[')) == column) return std::stod(value);
  ADD_FAILURE() << column << " in " << heading;
  return 0.0;
}

// Critical state: drained q = 3 M p0/(3 - M); undrained q = M p0 (OCR/2)^(1 - kappa/lambda).  Within 1e-4: what is
// missing at a strain of 1 or .5, and the steps.
TEST(UmatDrive, CamClayReachesItsCriticalState) {
  const fs::path folder = empty_folder("umat_cam_clay");
  for (const char* components : {"4", "6"}) {
    const std::string of =
        kCamClay + "--set components=" + components + " --pressure 100 --csv c.csv --digits 12 ";
    const Finished drained = sagefe(
        folder, "drive " + of + "--set history.SDV2=100 --test triaxial_compression --to 1 --steps 1000");
    ASSERT_EQ(drained.exit_code, 0) << drained.out << drained.err;
    EXPECT_NEAR(last_value(folder / "c.csv", "axial_deviator"), 200.0, 0.02);
    for (const double ratio : {1.0, 2.0, 4.0}) {
      const Finished undrained = sagefe(
          folder, "drive " + of +
                      "--undrained --test triaxial_compression --to .5 --steps 1000 --set history.SDV2=" +
                      std::to_string(100.0 * ratio));
      ASSERT_EQ(undrained.exit_code, 0) << undrained.out << undrained.err;
      EXPECT_NEAR(last_value(folder / "c.csv", "axial_deviator") / (120.0 * std::pow(0.5 * ratio, 0.8)), 1.0,
                  2e-3)
          << ratio;
    }
  }
}

// CMNAME: the routine is that of the material named, and sees its name.
TEST(UmatDrive, CanNameTheMaterial) {
  const fs::path folder = empty_folder("umat_drive_name");
  const auto drive = [&](const std::string& law, const std::string& umat) {
    return sagefe(folder, "drive --law " + law + " --umat " + umat + library("elastic_c") +
                              " --set components=4 --set state_variables=1 --set prop1=1000 --set prop2=.25"
                              " --test oedometer --to .01 --csv c.csv");
  };
  const Finished clay = drive("clay:umat", "clay=");
  EXPECT_EQ(clay.exit_code, 0) << clay.err;
  EXPECT_EQ(last_value(folder / "c.csv", "SDV1"), 1.0);  // the step, where CMNAME begins with C
  const Finished sand = drive("sand:umat", "");
  EXPECT_EQ(sand.exit_code, 0) << sand.err;
  EXPECT_EQ(last_value(folder / "c.csv", "SDV1"), -1.0);
  const Finished other = drive("sand:umat", "clay=");
  EXPECT_EQ(other.exit_code, 1);
  expect_words(other.err, {"no routine is given for the material \"sand\""});
}

// The native law and the routine in one table and plot, row by row.
TEST(UmatDrive, StandsBesideANativeLaw) {
  const fs::path folder = empty_folder("umat_drive");
  const Finished run =
      sagefe(folder, "drive --umat " + library("drucker_prager") +
                         " --case native:drucker_prager,E=3000,nu=.3,c=0,phi=30"
                         " --case routine:umat,components=4,state_variables=0,prop1=3000,prop2=.3,"
                         "prop3=0,prop4=30 --test triaxial_compression --pressure 50 --to .1"
                         " --csv c.csv --plot c.svg --json");
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  expect_words(run.out, {"\"command\": \"drive\"", "\"name\": \"routine\""});
  std::istringstream lines(read(folder / "c.csv"));
  std::vector<std::vector<double>> rows[2];
  for (std::string line; std::getline(lines, line);) {
    const int which = line.starts_with("native,") ? 0 : line.starts_with("routine,") ? 1 : -1;
    if (which < 0) continue;
    std::istringstream cells(line.substr(line.find(',') + 1));
    std::vector<double> row;
    for (std::string cell; row.size() < 15 && std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    rows[which].push_back(row);
  }
  ASSERT_EQ(rows[0].size(), 101u);
  ASSERT_EQ(rows[1].size(), 101u);
  for (std::size_t i = 0; i < 101; ++i)
    for (std::size_t j = 0; j < 15; ++j)
      EXPECT_NEAR(rows[1][i][j], rows[0][i][j], 1e-9 * 150.0) << i << " " << j;
}

// An elastic DDSDDE beyond yield: a path is followed all the same, to the states of the native law.
TEST(UmatDrive, FollowsARoutineWithAnElasticStiffness) {
  const fs::path folder = empty_folder("umat_drive_elastic");
  const std::string of =
      "drive --umat " + library("drucker_prager") + " --csv c.csv --digits 15 --pressure 50 ";
  for (const char* test : {"biaxial --to .05", "simple_shear --to .1"}) {
    const Finished native =
        sagefe(folder, of + "--case n:drucker_prager,E=3000,nu=.3,c=2,phi=30 --test " + test);
    ASSERT_EQ(native.exit_code, 0) << native.out << native.err;
    const double expected[] = {last_value(folder / "c.csv", "stress_yy"),
                               last_value(folder / "c.csv", "stress_xy")};
    const Finished routine =
        sagefe(folder, of +
                           "--case u:umat,components=4,state_variables=0,prop1=3000,prop2=.3,prop3=2,prop4=30,"
                           "prop5=1 --test " +
                           test);
    ASSERT_EQ(routine.exit_code, 0) << routine.out << routine.err;
    EXPECT_NEAR(last_value(folder / "c.csv", "stress_yy"), expected[0], 1e-8 * 50.0) << test;
    EXPECT_NEAR(last_value(folder / "c.csv", "stress_xy"), expected[1], 1e-8 * 50.0) << test;
  }
}

// What a routine says of itself comes through, and what it prints is no part of the table.
TEST(UmatDrive, FaultsAreNamed) {
  const fs::path folder = empty_folder("umat_drive_faults");
  const auto drive = [&](const std::string& fault) {
    return sagefe(
        folder,
        "drive --law umat --umat " + library("faults") +
            " --set components=4 --set state_variables=1 --set prop1=1000 --set prop2=.25 --set prop3=" +
            fault + " --set prop4=3 --test oedometer --to .01 --steps 10 --csv -");
  };
  const Finished xit = drive("4");
  EXPECT_EQ(xit.exit_code, 3);
  expect_words(xit.out + xit.err, {"ends in leg 1, step 3 of 10", "called XIT at element 1, point 1"});
  for (const char* fault : {"8", "28"}) {
    const Finished nan = drive(fault);
    EXPECT_EQ(nan.exit_code, 3);
    expect_words(nan.out,
                 {"ends in leg 1, step 3 of 10: routine umat_ of ", "returned what is no finite number"});
    EXPECT_EQ(nan.out.find("beyond the law's strength"), std::string::npos) << nan.out;
  }
  const Finished flood = drive("7");
  EXPECT_EQ(flood.exit_code, 0) << flood.err;
  EXPECT_EQ(flood.out.find("again and again"), std::string::npos);
  expect_words(flood.err, {"user materials printed ", "again and again"});
  EXPECT_LT(flood.err.size(), 10000u);
  const Finished unknown =
      sagefe(folder, "drive " + kCamClay + "--set history.SDV9=1 --pressure 1 --test oedometer --to .01");
  EXPECT_EQ(unknown.exit_code, 1);
  expect_words(unknown.err, {"has no history variable SDV9; it has SDV1, SDV2, SSE, SPD, SCD"});
}

TEST(Umat, OneThatReadsTheDeformationGradientAloneIsRefused) {
  const fs::path folder = empty_folder("umat_gradient");
  const Finished run = run_fault(folder, "10.", "0.");
  EXPECT_EQ(run.exit_code, 3);
  expect_words(run.err, {"answers DFGRD1 and not DSTRAN"});
}

// Steps above 0.06 are refused by the routine: every increment of 0.1 is taken in two.
TEST(Umat, ACutIsAskedForAndTaken) {
  const fs::path folder = empty_folder("umat_cut");
  const Finished run = run_fault(folder, "6.", "0.");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.find(" 0 cuts"), std::string::npos) << run.out;
  const Finished sound = run_fault(folder, "0.", "0.");
  EXPECT_EQ(sound.exit_code, 0) << sound.err;
  expect_words(sound.out, {" 0 cuts"});
}

// An elastic DDSDDE beyond yield is named, and differences of the stress lead to the same state without it: up to
// what the slow one's equilibrium leaves, 1e-7 of the load.
TEST(Umat, ADdsddeThatIsNoDerivativeIsNamed) {
  const fs::path folder = empty_folder("umat_tangent");
  std::vector<double> ends[2];
  for (const bool differences : {false, true}) {
    write(folder / "deck.dat", column_deck(umat_material({"4", "0", differences ? "2" : "0", "0", "1000.",
                                                          "0.25", "1.", "10.", "1."})));
    const Finished run =
        sagefe(folder, "run deck.dat -o out --points --digits 15 --umat " + library("drucker_prager"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("not the derivative of its stress") != std::string::npos, !differences) << run.err;
    ends[differences ? 1 : 0] = numbers(folder / "out/deck.points.csv");
  }
  ASSERT_EQ(ends[0].size(), ends[1].size());
  for (std::size_t i = 0; i < ends[0].size(); ++i) EXPECT_NEAR(ends[0][i], ends[1][i], 1e-5) << i;
}

// Two calls at once where the card says so, one after the other else.
TEST(Umat, ThreadsCallARoutineThatIsSafe) {
  setenv("SAGE_UMAT_MODULE", SAGE_TEST_UMAT_MODULE, 1);
  umat::Setup setup;
  setup.routine = umat::open_routine(library("meeting"));
  setup.statev = 1;
  setup.threads_safe = true;
  const std::unique_ptr<SolidLaw> law = umat::umat_law(setup);
  const auto call = [&](double strain) {
    const std::vector<double> start(4, 0.0);
    std::vector<double> end(4, 0.0);
    PointOut<4> out;
    out.h1 = end;
    law->update({Vector4::Zero(), Vector4::Zero(), strain * Vector4::Unit(0), start, nullptr}, out);
    return end[0];
  };
  EXPECT_EQ(call(0.001), 0.0);
  double other = 0.0;
  std::thread second([&] { other = call(0.002); });
  EXPECT_EQ(call(0.002), 1.0);
  second.join();
  EXPECT_EQ(other, 1.0);
}

// Rounding, flushing to zero and traps are the program's after each call, whatever the routine leaves: also where it is
// called by several threads.
TEST(Umat, ModesOfFloatingPointAreRestored) {
  setenv("SAGE_UMAT_MODULE", SAGE_TEST_UMAT_MODULE, 1);
  umat::Setup setup;
  setup.routine = umat::open_routine(library("modes"));
  setup.props = {1000.0};
  setup.threads_safe = true;
  const std::unique_ptr<SolidLaw> law = umat::umat_law(setup);
  const auto call = [&] {
    const std::vector<double> start(3, 0.0);
    std::vector<double> end(3, 0.0);
    PointOut<4> out;
    out.h1 = end;
    for (int i = 0; i < 2; ++i)
      law->update({Vector4::Zero(), Vector4::Zero(), 0.001 * Vector4::Unit(0), start, nullptr}, out);
    EXPECT_EQ(out.sigma[0], 1.0);
    EXPECT_EQ(fegetround(), FE_TONEAREST);
    EXPECT_EQ(fegetexcept(), 0);
    volatile double small = 3e-308;
    small = small / 16.0;
    EXPECT_GT(small, 0.0);  // not flushed
    fesetenv(FE_DFL_ENV);   // for the other tests, where it was not
  };
  call();
  std::thread(call).join();
}

// SIGINI: sigma_yy = -20 (2 - y), sigma_xx half and sigma_zz a quarter of it; SDVINI: x + 100 y and 10 element + point.
// The deck holds the sides (K0 = nu / (1 - nu) = 1/3) and presses with 100.  What of the first stress nothing holds, its
// mean over each element, is let go in proportion over the stage while the pressure grows.
TEST(Umat, FirstValuesComeFromTheLibrary) {
  const fs::path folder = empty_folder("umat_first_values");
  const std::string material = umat_material({"4", "3", "1", "0", "1000.", "0.25"});
  const auto points = [&](const std::string& initial, int initials) {
    write(folder / "deck.dat", column_deck(material, initial, initials));
    fs::remove_all(folder / "out");
    const Finished run =
        sagefe(folder, "run deck.dat -o out --points --digits 12 --umat " + library("first_values"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("does not call"), std::string::npos) << run.err;
    return rows_of(folder / "out/deck.points.csv");
  };
  const auto start = points("", 0);
  ASSERT_EQ(start.size(), 80u);  // eight points, ten increments
  const Finished check = sagefe(folder, "check deck.dat --umat " + library("first_values"));
  expect_words(check.out + check.err, {"the initial stress is out of balance by up to "});
  for (const auto& row : start) {
    const double y = row.at("y"), share = 0.1 * row.at("increment");
    const double first = 20.0 * (2.0 - y);
    EXPECT_NEAR(row.at("SDV1"), row.at("x") + 100.0 * y, 1e-9);
    EXPECT_NEAR(row.at("SDV2"), 10.0 * row.at("element") + row.at("point"), 1e-12);
    EXPECT_EQ(row.at("SDV3"), 7.0);
    const double mean = row.at("element") == 1.0 ? 30.0 : 10.0;
    EXPECT_NEAR(row.at("stress_yy"), first + share * (100.0 - mean), 1e-6);
    EXPECT_NEAR(row.at("stress_xx") - 0.5 * first, (row.at("stress_yy") - first) / 3.0, 1e-8);
    EXPECT_NEAR(row.at("stress_zz") - 0.25 * first, (row.at("stress_yy") - first) / 3.0, 1e-8);
  }
  // Cards of the deck come after them: a history of kind 4 and a uniform stress of kind 2.
  const auto stated =
      points(card({"1", "4"}, {"3.", "5."}) + "\n" + card({"1", "0"}, {"30.", "60.", "30.", "0."}) + "\n", 2);
  ASSERT_EQ(stated.size(), 80u);
  for (const auto& row : stated) {
    EXPECT_EQ(row.at("SDV3"), 5.0);
    EXPECT_NEAR(row.at("SDV2"), 10.0 * row.at("element") + row.at("point"), 1e-12);
    EXPECT_NEAR(row.at("stress_yy"), 60.0 + 4.0 * row.at("increment"), 1e-6);
  }
}

TEST(Umat, FirstValuesAreWatched) {
  const fs::path folder = empty_folder("umat_first_faults");
  write(folder / "deck.dat", column_deck(umat_material({"4", "4", "1", "0", "1000.", "0.25"})));
  const Finished run = sagefe(folder, "run deck.dat -o out --umat " + library("first_values"));
  EXPECT_EQ(run.exit_code, 3) << run.out;
  expect_words(run.err,
               {"routine SDVINI of ", "wrote to STATEV(5), which has 4 numbers", "at element 1, point 1"});
  const Finished drive =
      sagefe(folder, "drive --law umat --umat " + library("first_values") +
                         " --set components=4 --set state_variables=3 --set prop1=1000 --set prop2=.25 --set "
                         "history.SDV2=4 --test oedometer --to .01 --csv c.csv");
  EXPECT_EQ(drive.exit_code, 0) << drive.err;
  EXPECT_EQ(last_value(folder / "c.csv", "SDV3"), 7.0);
  EXPECT_EQ(last_value(folder / "c.csv", "SDV2"), 4.0);
}

TEST(Umat, NotANumberCutsTheStepAndIsNamed) {
  const fs::path folder = empty_folder("umat_nan");
  const Finished run = run_fault(folder, "8.");
  EXPECT_EQ(run.exit_code, 3) << run.out;
  expect_words(run.err, {"returned what is no finite number, first at element 1, point 1"});
}

// Unit 6 of Fortran goes to a file, of which no more is kept than anybody reads.
TEST(Umat, FloodedOutputIsCaught) {
  const fs::path folder = empty_folder("umat_flood");
  const Finished run = run_fault(folder, "7.", "0.");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.find("again and again"), std::string::npos);
  expect_words(run.err, {"deck.dat: note: user materials printed ", "deck.umat.log"});
  const std::string log = read(folder / "out/deck.umat.log");
  expect_words(log, {"called", "again and again"});
  EXPECT_LT(log.size(), std::size_t{257} << 10);
}

TEST(Umat, IntegersOfEightBytesAreFoundOut) {
  const fs::path folder = empty_folder("umat_wide");
  write(folder / "deck.dat", column_deck(umat_material({"4", "8", "1", "0", "1000.", "0.25"})));
  for (const char* name : {"elastic", "wide"}) {
    const Finished run =
        sagefe(folder, std::string("run deck.dat --points -o ") + name + " --umat " + library(name));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("integers of 8 bytes") != std::string::npos, std::string(name) == "wide") << run.err;
  }
  const std::vector<double> wide = numbers(folder / "wide/deck.points.csv"),
                            plain = numbers(folder / "elastic/deck.points.csv");
  ASSERT_EQ(wide.size(), plain.size());
  // Loops with other counters round otherwise: stresses of 100.
  for (std::size_t i = 0; i < wide.size(); ++i) EXPECT_NEAR(wide[i], plain[i], 1e-11) << i;
}

// A state variable that is counted up by every call: 5 at the start, once an increment whatever Newton asked.
TEST(Umat, StateVariablesStartFromTheDeckAndAreKept) {
  const fs::path folder = empty_folder("umat_statev");
  const std::string material = umat_material({"4", "1", "0", "0", "1000.", "0.25", "15.", "0."});
  write(folder / "deck.dat", column_deck(material, card({"1", "4"}, {"1.", "5."}) + "\n", 1));
  const Finished run = sagefe(folder, "run deck.dat -o out --points --umat " + library("faults"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string points = read(folder / "out/deck.points.csv");
  expect_words(points, {",15,"});  // 5 + 10 increments
}

TEST(UmatConform, SaysWhatIsWrong) {
  const fs::path folder = empty_folder("umat_conform");
  const auto conform = [&](const std::string& routine, const std::string& options) {
    return sagefe(folder, "conform --umat " + library(routine) + " " + options);
  };
  for (const char* components : {"4", "6"}) {
    const std::string of = std::string(" --components ") + components;
    EXPECT_EQ(conform("elastic", "--props 1e4,.3 --symmetric" + of).exit_code, 0);
    EXPECT_EQ(conform("elastic_c", "--props 1e4,.3" + of).exit_code, 0);
    const Finished dp =
        conform("drucker_prager", "--props 3000,.3,0,30 --stress 50,50,50,0 --strain 2e-3" + of);
    EXPECT_EQ(dp.exit_code, 0) << dp.out;
    expect_words(dp.out, {"verdict: conforms", "simple shear xy"});
  }
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"1", "wrote to DDSDDE("},    {"2", "wrote to STRESS(5)"},
      {"4", "called XIT"},          {"5", "executed STOP (no convergence)"},
      {"10", "answers DFGRD1"},     {"16", "wrong by a factor of 2"},
      {"17", "worst: DDSDDE(1,2)"},
  };
  for (const auto& [fault, words] : faults) {
    const Finished run = conform("faults", "--statev 1 --props 1000,.25," + fault + ",0");
    EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
    expect_words(run.out, {words, "verdict: does NOT conform"});
  }
  // A tangent that is 1e-3 off (of 1200) is slow, not wrong.
  const Finished near = conform("faults", "--statev 1 --props 1000,.25,27,0");
  EXPECT_EQ(near.exit_code, 0) << near.out;
  expect_words(near.out,
               {"holds  DDSDDE is near the derivative of the stress: within 1.0e-03 of its largest term",
                "an iteration gains about 3 digits", "verdict: conforms"});
  const Finished counts = conform("faults", "--statev 1 --props 1000,.25,15,0");
  expect_words(counts.out, {"note   state variables change under no strain"});
  const Finished unsymmetric = conform("faults", "--statev 1 --symmetric --props 1000,.25,18,0");
  expect_words(unsymmetric.out, {"unsymmetric DDSDDE, though its card says symmetric"});
}

// Uniaxial stress s: mean s / 3, Mises s.  Shear t: principal values t, 0, -t.  A turn by 90 degrees changes 11 and 22.
TEST(UmatRoutines, Invariants) {
  void* module = dlopen(SAGE_TEST_UMAT_MODULE, RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(module, nullptr);
  using Sinv = void (*)(const double*, double*, double*, const int*, const int*);
  using Sprind = void (*)(const double*, double*, double*, const int*, const int*, const int*);
  using Rotsig = void (*)(const double*, const double*, double*, const int*, const int*, const int*);
  const int three = 3, one = 1, two = 2;
  const double uniaxial[4] = {6.0, 0.0, 0.0, 0.0}, shear[4] = {0.0, 0.0, 0.0, 2.0};
  double mean = 0.0, mises = 0.0;
  reinterpret_cast<Sinv>(dlsym(module, "sinv_"))(uniaxial, &mean, &mises, &three, &one);
  EXPECT_NEAR(mean, 2.0, 1e-14);
  EXPECT_NEAR(mises, 6.0, 1e-14);
  double ps[3], an[9];
  const auto sprind = reinterpret_cast<Sprind>(dlsym(module, "sprind_"));
  sprind(shear, ps, an, &one, &three, &one);
  EXPECT_NEAR(ps[0], 2.0, 1e-14);
  EXPECT_NEAR(ps[1], 0.0, 1e-14);
  EXPECT_NEAR(ps[2], -2.0, 1e-14);
  EXPECT_NEAR(std::abs(an[0]), std::sqrt(0.5), 1e-14);  // AN(1,1)
  EXPECT_NEAR(an[0] * an[3], 0.5, 1e-14);               // AN(1,1) AN(1,2)
  sprind(shear, ps, an, &two, &three, &one);
  EXPECT_NEAR(ps[0], 1.0, 1e-14);  // of an engineering shear strain
  const double turn[9] = {0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  double turned[4];
  reinterpret_cast<Rotsig>(dlsym(module, "rotsig_"))(uniaxial, turn, turned, &one, &three, &one);
  EXPECT_NEAR(turned[0], 0.0, 1e-14);
  EXPECT_NEAR(turned[1], 6.0, 1e-14);
}

}  // namespace
}  // namespace sage::test

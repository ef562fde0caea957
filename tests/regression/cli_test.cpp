// The command line: help, exit codes, several decks in one call, and what is left behind when a run fails.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <regex>
#include <sstream>

#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in\n" << text;
}

// The cells of the first line of a table that begins with `start`.
std::vector<std::string> row(const std::string& table, const std::string& start) {
  std::stringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(start, 0) != 0) continue;
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  }
  return {};
}

TEST(CommandLine, HelpOfEverySubcommandNamesItsOptions) {
  const fs::path folder = empty_folder("help");
  const std::vector<std::pair<std::string, std::vector<const char*>>> commands = {
      {"", {"run", "check", "echo", "list", "tables", "--help", "--version", "Exit codes"}},
      {"run", {"DECK",         "--output",      "--solver", "--tables",   "--nodes",   "--points",
               "--no-listing", "--vtu",         "--msh",    "--msh-text", "--picture", "--field",
               "--result",     "--states",      "--quiet",  "--layout",   "--strict",  "--formulation",
               "--element",    "--geometry",    "--refine", "--grade",    "--error",   "--converge",
               "--max-dofs",   "--max-seconds", "--follow", "--coarsen",  "--threads", "--kernels"}},
      {"check",
       {"DECK", "--layout", "--strict", "--formulation", "--element", "--geometry", "--refine", "--grade"}},
      {"echo", {"DECK", "--layout", "--strict"}},
      {"list", {"WHAT", "elements", "materials", "solvers", "plugins", "--plugin", "--umat"}},
      {"conform",
       {"LIBRARY", "--only", "--plugin", "--umat", "--props", "--statev", "--components", "--stress"}},
      {"new", {"KIND", "deck, law, element or umat", "NAME", "footing", "--output"}},
      {"align", {"DECK", "--layout", "--output", "--in-place"}},
      {"layout", {"guess", "check"}},
      {"layout guess", {"DECK", "--out", "Example"}},
      {"layout check", {"LAYOUT", "DECK", "--strict", "Exit codes"}},
      {"tables", {"--cases", "--output", "--pinned"}},
      {"verify", {"--list", "--only", "--rows", "--csv", "--write"}},
      {"figures", {"--only", "--output", "--format", "--list"}},
      {"plot",
       {"FILE", "--xy", "--picture", "--at", "--increment", "--sheet", "--line", "--interface", "--range",
        "--levels", "--mirror", "--extrapolate", "--label", "--format", "axial_strain:ratio", "strain=.05,.1",
        "load against displacement", "sigma_1 - sigma_3"}},
      {"safety",
       {"DECK", "--stage", "--tolerance", "--start", "--smallest", "--largest", "--iterations", "--cuts",
        "--dilation", "--from", "--reduce", "--group", "--interfaces", "--structures", "--converge",
        "--max-dofs", "--output"}},
      {"report", {"RUN", "--field", "--size", "--name", "--output", "side by side"}},
      {"sweep", {"STUDY", "--collect", "--jobs", "--part", "--parallel", "--slurm", "--output", "Examples"}},
      {"bounds",
       {"DECK", "--of", "--stage", "--from", "--elements", "--gap", "--safety", "--tolerance", "--digits",
        "--output", "--layout", "--strict"}},
      {"stress", {"--list", "--only", "--details", "--csv", "--write"}},
      {"drive",
       {"--law", "--set", "--deck", "--material", "--case", "--cases", "--test", "--path", "--pressure", "--to",
        "--cycles", "--undrained", "--normal-stiffness", "--fit", "--free", "--csv", "--plot", "Exit code 3"}},
      {"compare",
       {"DECK", "--both", "--formulation", "--element", "--geometry", "--solver", "--formulation-b",
        "--element-b", "--geometry-b", "--solver-b", "--layout-b", "--line", "--point", "--picture", "--output",
        "--strict", "--threads", "--kernels"}},
  };
  for (const auto& [command, words] : commands) {
    const Finished help = sagefe(folder, command + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_EQ(help.err, "");
    for (const char* word : words) expect_words(help.out, {word});
    EXPECT_EQ(sagefe(folder, "--help " + command).out, help.out);
  }
}

// Curves of two laws in a table and a plot; a stress beyond the strength ends in exit code 3 with the curve written;
// mistakes of the command line in 1, of a file in 2.
TEST(CommandLine, DriveTakesLawsAlongPaths) {
  const fs::path folder = empty_folder("drive");
  const std::string law = "drive --law mohr_coulomb --set E=2e4 --set nu=.3 --set c=0 --set phi=30 ";
  const Finished run =
      sagefe(folder, law +
                         "--case a: --case b:,phi=35 --test triaxial_compression --pressure 100 "
                         "--to .1 --csv out/c.csv --plot out/c.svg");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_words(run.out, {"a: 101 rows", "end      axial_deviator = 200 at strain_yy = 0.1, yielded"});
  expect_words(read(folder / "out/c.csv"), {"compression positive", ",axial_deviator[-],", "\nb,1,100,"});
  expect_words(read(folder / "out/c.svg"), {"axial deviator", "volume strain"});
  write(folder / "path.csv", "stress_xx,stress_yy,stress_zz\n100,400,100\n");
  const Finished beyond = sagefe(folder, law + "--path path.csv --pressure 100 --csv -");
  EXPECT_EQ(beyond.exit_code, 3);
  expect_words(beyond.out, {"ends in leg 1, step 67 of 100", "\nmohr_coulomb,1,67,"});
  EXPECT_EQ(sagefe(folder, law + "--test oedometer").exit_code, 1);
  EXPECT_EQ(sagefe(folder, law + "--test oedometer --to .1 --undrained").exit_code, 1);
  EXPECT_EQ(sagefe(folder, law + "--path nothing.csv").exit_code, 2);
  EXPECT_EQ(sagefe(folder, law + "--path path.csv --csv path.csv").exit_code, 1);
  write(folder / "cases.txt", "# two\na:linear_elastic,E=1,nu=.2\nb:linear_elastic,E=1\n");
  const Finished wrong = sagefe(folder, "drive --cases cases.txt --test oedometer --to .1");
  EXPECT_EQ(wrong.exit_code, 2);
  expect_words(wrong.err, {"cases.txt:3: error: b (linear_elastic): not set: poissons_ratio"});
  expect_words(sagefe(folder, "drive --list").out, {"simple_shear", "closure"});
}

// Parameters from a curve of known ones, and what one pressure can't tell apart.
TEST(CommandLine, DriveFitsMeasuredCurves) {
  const fs::path folder = empty_folder("drive_fit");
  // E = 2e4; q_f = 200 for c = 0, phi = 30 at 100.
  write(folder / "cd.csv", "strain_yy,axial_deviator\n.002,40\n.004,80\n.008,160\n.012,200\n.02,200\n");
  const std::string law =
      "drive --law mohr_coulomb --set E=1e4 --set nu=.3 --set c=0 --set phi=25 "
      "--test triaxial_compression --pressure 100 --fit cd.csv ";
  const Finished run = sagefe(folder, law + "--free E,phi --plot fit.svg --csv fit.csv");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_words(run.out, {"youngs_modulus                  10000          20000", "friction_angle",
                         "             30 ", "5 values, 2 parameters"});
  expect_words(read(folder / "fit.svg"), {"fitted less measured"});
  expect_words(read(folder / "fit.csv"), {"\ncd,5,"});
  expect_words(sagefe(folder, law + "--free c,phi").out, {"can't tell apart: cohesion", "friction_angle"});
  EXPECT_EQ(sagefe(folder, law).exit_code, 1);
  EXPECT_EQ(sagefe(folder, law + "--free nothing").exit_code, 1);
  EXPECT_EQ(sagefe(folder, law + "--free E --to .1").exit_code, 1);
  EXPECT_EQ(sagefe(folder, law + "--free E,nu,c,phi,psi").exit_code, 1);
  write(folder / "cd.csv", "strain_yy,axial_deviator\n.002,much\n");
  const Finished wrong = sagefe(folder, law + "--free E");
  EXPECT_EQ(wrong.exit_code, 2);
  expect_words(wrong.err, {"cd.csv:2: error: column axial_deviator: much is no number"});
}

// Strength that falls makes results depend on the mesh: check and run say so, and the deck runs.
TEST(CommandLine, SofteningIsWarnedOf) {
  const fs::path folder = empty_folder("softening");
  const DeckText deck =
      block_deck()
          .with("material", card({"1", "8", "9"}, {""}) + "clay")
          .with("parameters",
                card({}, {"3000.", ".25", "50.", "30.", "0.", ".01", "20.", "30."}) + "\n" + card({}, {"0."}));
  write(folder / "deck.dat", deck.text());
  const Finished check = sagefe(folder, "check deck.dat");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  expect_words(check.err, {"warning", "loads after the peak depend on the mesh"});
  const Finished run = sagefe(folder, "run deck.dat -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_words(read(folder / "out/deck.lst"), {"loads after the peak depend on the mesh"});
}

// The chapter's specimen: its law from the deck gives q = 150 psi at the strength of sin phi = .6, sigma_3 = 50.
TEST(CommandLine, DriveTakesADecksMaterial) {
  const fs::path folder = empty_folder("drive_deck");
  const Finished run =
      sagefe(folder, std::string("drive --deck " SAGE_SOURCE_DIR "/legacy_inputs/chapter7/dp_285/deck.dat") +
                         " --material 1 --test triaxial_compression --pressure 50 --to .15");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_words(run.out, {"Drucker-Prager: 101 rows", "end      axial_deviator = 150"});
}

// What follows a value are decks, the first of several too.
TEST(CommandLine, OptionsThatMayBeRepeatedTakeOneValueEach) {
  const fs::path folder = empty_folder("one_value_each");
  for (const char* deck : {"a.dat", "b.dat"}) write(folder / deck, block_deck().text());
  for (const char* options :
       {"--field mean_stress --field deviator", "--picture mean_stress --picture stress_yy", "--without all",
        "--converge 0.4 --follow report1.ratio"}) {
    const Finished run = sagefe(folder, std::string("run -q -o out ") + options + " a.dat b.dat");
    EXPECT_EQ(run.exit_code, 0) << options << "\n" << run.err;
  }
}

TEST(CommandLine, AFieldWithoutAColumnIsAWarning) {
  const fs::path folder = empty_folder("field_in_vain");
  write(folder / "deck.dat", block_deck().text());
  const char* kIn = "no output that is asked for has a column for it";
  const Finished vain = sagefe(folder, "run deck.dat -q --tables none --field mean_stress --field deviator");
  EXPECT_EQ(vain.exit_code, 0);
  expect_words(vain.err, {"--field mean_stress, deviator: ", kIn, "--points"});
  for (const char* more : {"--points", "--tables stage", "--point 0.5,0.5", "--vtu"}) {
    const Finished shown =
        sagefe(folder, std::string("run deck.dat -q --field mean_stress ") +
                           (std::string(more) == "--tables stage" ? "" : "--tables none ") + more);
    EXPECT_EQ(shown.err.find(kIn), std::string::npos) << more;
  }
  const Finished compared = sagefe(folder, "compare deck.dat --both --field mean_stress");
  expect_words(compared.err, {"--field mean_stress: ", kIn, "--line"});
}

// As --picture does.
TEST(CommandLine, AComponentStandsForItsField) {
  const fs::path folder = empty_folder("component");
  write(folder / "deck.dat", block_deck().text());
  const std::string run = "run deck.dat -q --points --tables none ";
  ASSERT_EQ(sagefe(folder, run + "--field principal_stress -o whole").exit_code, 0);
  const Finished one = sagefe(folder, run + "--field principal_stress_1 --field principal_stress_2 -o one");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const std::string points = read(folder / "one" / "deck.points.csv");
  EXPECT_NE(points.find(",principal_stress_1["), std::string::npos);
  EXPECT_EQ(points, read(folder / "whole" / "deck.points.csv"));
}

#ifdef SAGE_HAVE_HDF5
// The page has both runs under names of their own, and the result files stay.
TEST(CommandLine, CompareWritesOnePageOfBothRuns) {
  const fs::path folder = empty_folder("compare_page");
  write(folder / "block.dat", block_deck().text());
  const Finished run = sagefe(folder, "compare block.dat --both --report pair -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* file : {"pair.html", "out/block.a.h5", "out/block.b.h5"}) {
    EXPECT_TRUE(fs::exists(folder / file)) << file;
    EXPECT_NE(run.out.find(file), std::string::npos) << run.out;
  }
  // The same bytes as sagefe report makes of these files.
  ASSERT_EQ(sagefe(folder, "report out/block.a.h5 out/block.b.h5 --name same -o .").exit_code, 0);
  EXPECT_EQ(read(folder / "pair.html"), read(folder / "same.html"));
  const Finished both = sagefe(folder, "compare block.dat --both --converge 1e-2 --report pair.html -o out3");
  EXPECT_EQ(both.exit_code, 1);
  expect_words(both.err, {"--report", "--converge", "S905"});
}
#endif

// The same default that build_model gives: enhanced for quad4 with a law that dilates.
TEST(CommandLine, ListOfElementsNamesTheDefaultOfLawsThatDilate) {
  const std::string list = sagefe(empty_folder("list_elements"), "list elements").out;
  EXPECT_EQ(list.find("code 0 on a group card = the first)"), std::string::npos) << list;
  std::istringstream lines(list);
  std::string element;
  int dilating = 0, yielding = 0;
  for (std::string line; std::getline(lines, line);) {
    if (const std::size_t colon = line.find(": "); line.rfind("      ", 0) != 0 && colon != std::string::npos)
      element = line.substr(6, colon - 6);
    if (line.find("(code 0 for a law that dilates)") != std::string::npos) {
      EXPECT_EQ(element, "quad4");
      EXPECT_NE(line.find(" enhanced: "), std::string::npos) << line;
      ++dilating;
    }
    if (line.find("(every law that is not linear gets it)") != std::string::npos) {
      EXPECT_EQ(element.rfind("beam3", 0), 0u) << element;
      ++yielding;
    }
  }
  EXPECT_EQ(dilating, 1) << list;
  EXPECT_GE(yielding, 1) << list;
}

// /dev/full accepts an open and refuses every write, as a full disk does.
TEST(CommandLine, StandardOutputThatCantBeWrittenIsExitCode4) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const fs::path folder = empty_folder("full_output");
  write(folder / "deck.dat", block_deck().text());
  for (const char* arguments :
       {"run --help", "list elements", "check deck.dat", "echo deck.dat", "run deck.dat"}) {
    const Finished run = sagefe(folder, arguments, R"(timeout 60 sh -c '"$0" "$@" > /dev/full')");
    EXPECT_EQ(run.exit_code, 4) << arguments;
    expect_words(run.err, {"standard output could not be written"});
  }
  const Finished mute = sagefe(folder, "run none.dat", R"(timeout 60 sh -c '"$0" "$@" 2> /dev/full')");
  EXPECT_EQ(mute.exit_code, 4);
}

// The listing would be the next file to get the number of a closed stream, and the deck's messages would go
// into it.
TEST(CommandLine, ClosedStandardStreamsChangeNoFile) {
  const fs::path folder = empty_folder("closed_streams");
  write(folder / "deck.dat", block_deck().text());
  EXPECT_EQ(sagefe(folder, "run deck.dat -o open --grade 1").exit_code, 0);
  const Finished closed =
      sagefe(folder, "run deck.dat -o closed --grade 1", R"(timeout 60 sh -c '"$0" "$@" <&- >&- 2>&-')");
  EXPECT_EQ(closed.exit_code, 0);
  for (const char* name : {"closed_streams.lst", "closed_streams.increments.csv"})
    EXPECT_EQ(read(folder / "closed" / name), read(folder / "open" / name)) << name;
}

// `ccx deck` would write its results to deck.dat.
TEST(CommandLine, ConvertWarnsWhereCalculixWouldOverwriteTheDeck) {
  const fs::path folder = empty_folder("convert_beside");
  write(folder / "deck.dat", block_deck().text());
  const Finished beside = sagefe(folder, "convert deck.dat deck.inp");
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  expect_words(beside.err, {"CalculiX would write its results over deck.dat", "deck_ccx.inp"});
  EXPECT_EQ(sagefe(folder, "convert deck.dat deck_ccx.inp").err.find("over deck"), std::string::npos);
}

TEST(CommandLine, ConvertNeverReplacesTheDeckThatItReads) {
  const fs::path folder = empty_folder("convert_itself");
  const std::string deck = block_deck().text();
  write(folder / "deck.dat", deck);
  EXPECT_EQ(sagefe(folder, "convert deck.dat ./deck.dat").exit_code, 1);
  EXPECT_EQ(read(folder / "deck.dat"), deck);
}

// No file stays behind, under any name.
TEST(CommandLine, ConvertThatIsRefusedLeavesNoFile) {
  const fs::path folder = empty_folder("convert_refused");
  std::string deck = block_deck().text();
  deck.replace(deck.rfind("END"), 3, "FIN");
  write(folder / "deck.dat", deck);
  const Finished refused = sagefe(folder, "convert deck.dat other.dat");
  EXPECT_EQ(refused.exit_code, 2);
  expect_words(refused.err, {"END"});
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_EQ(entry.path().filename().string().find("other"), std::string::npos) << entry.path();
}

// One side that can't be read: the other is reported, and the shell hears of it.
TEST(CommandLine, CompareReportsTheSideThatRuns) {
  const fs::path folder = empty_folder("compare");
  write(folder / "deck.dat", block_deck().text());
  write(folder / "bad.dat", "nothing\n");
  const Finished both = sagefe(folder, "compare deck.dat --both --point 0.5,0.5 --picture stress_yy");
  EXPECT_EQ(both.exit_code, 0) << both.err;
  expect_words(both.out, {"A: deck.dat, plane strain", "B: deck.dat, axisymmetric", "forces per ",
                          "forces for the full circle", "compression positive", "point"});
  EXPECT_TRUE(fs::exists(folder / "out" / "deck.compare.csv"));
  EXPECT_TRUE(fs::exists(folder / "out" / "deck.compare_stress_yy.svg"));
  std::istringstream page(both.out);
  for (std::string line; std::getline(page, line);) EXPECT_LE(line.size(), 80u) << line;
  for (const char* decks : {"deck.dat bad.dat", "bad.dat deck.dat"}) {
    const Finished half = sagefe(folder, std::string("compare ") + decks);
    EXPECT_EQ(half.exit_code, 2);
    expect_words(half.out, {"completed", "NO RESULTS", "mean normal stress"});
  }
  EXPECT_EQ(sagefe(folder, "compare bad.dat --both").exit_code, 2);
}

// The numbers of a row of STEM.compare.csv, A and B.
std::pair<double, double> compared(const std::string& csv, const std::string& row) {
  const std::size_t at = csv.find(row + ",");
  if (at == std::string::npos) return {NAN, NAN};
  double a = NAN, b = NAN;
  std::sscanf(csv.c_str() + at + row.size(), ",%lf,%lf", &a, &b);
  return {a, b};
}

// Forces for a unit of thickness and for the full circle: what the reports end with stands over the area, which gives
// the mean stress of the side; N, Q and M of structures are for a unit of width in both.
TEST(CommandLine, CompareOfBothGeometriesComparesForcesPerArea) {
  const fs::path folder = empty_folder("compare_both");
  write(folder / "deck.dat", block_deck().with("report", card({"2", "", "7", "9", "1", "1"})).text());
  const Finished both = sagefe(folder, "compare deck.dat --both");
  ASSERT_EQ(both.exit_code, 0) << both.err;
  const std::string csv = read(folder / "out/deck.compare.csv");
  const auto per_area = compared(csv, "reported at the end,report1.fy / area,psi");
  const auto stress = compared(csv, "\"sides, end of stage 1\",top: mean normal stress,psi");
  EXPECT_NEAR(-per_area.first, stress.first, 1e-6) << both.out;
  EXPECT_NEAR(-per_area.second, stress.second, 1e-6) << both.out;
  const auto shear = compared(csv, "reported at the end,report1.fx / area,psi");
  const auto mean_shear = compared(csv, "\"sides, end of stage 1\",top: mean shear stress,psi");
  EXPECT_NEAR(shear.first, mean_shear.first, 1e-6) << both.out;
  EXPECT_NEAR(shear.second, mean_shear.second, 1e-6) << both.out;
  EXPECT_EQ(count(csv, "report1.fy,lbf"), 0);
  expect_words(csv, {"\"forces, end of stage 1\",reactions along y (z),lbf,"});
  EXPECT_TRUE(std::regex_search(csv, std::regex("reactions along y \\(z\\),lbf,[-0-9.e]+,[-0-9.e]+,,,")))
      << csv;

  const Finished raft = sagefe(folder, "compare --both " SAGE_SOURCE_DIR
                                       "/legacy_inputs/structures/raft/deck.dat --picture bending_moment");
  ASSERT_EQ(raft.exit_code, 0) << raft.err;
  const auto moment = compared(read(folder / "out/raft.compare.csv"),
                               "\"structure 5 raft, end of the run\",\"bending_moment, least\",kN m");
  EXPECT_NEAR(moment.first, -6.27, 0.01) << "docs/manual/structures.md";
  EXPECT_LT(moment.second, 0.0);
  const std::string svg = read(folder / "out/raft.compare_bending_moment.svg");
  EXPECT_EQ(count(svg, "deformation"), 0);
  EXPECT_EQ(count(svg, "one scale for both: of the diagrams"), 1);
}

// What B has instead of A is read as A's own options are.
TEST(CommandLine, CompareReadsElementsOfBAsThoseOfA) {
  const fs::path folder = empty_folder("compare_element_b");
  write(folder / "deck.dat", block_deck().text());
  for (const char* element : {"quad8", "2"}) {
    const Finished done = sagefe(folder, std::string("compare deck.dat --element-b ") + element);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_NE(done.out.find("B: deck.dat, plane strain, quad8"), std::string::npos) << done.out;
    EXPECT_NE(done.out.find("A: deck.dat, plane strain, quad4"), std::string::npos) << done.out;
  }
  for (const char* option : {"--element", "--element-b"}) {
    const Finished unknown = sagefe(folder, std::string("compare deck.dat --both ") + option + " quad7");
    EXPECT_EQ(unknown.exit_code, 1);
    expect_words(unknown.err, {option, "unknown element quad7; known: "});
    expect_words(sagefe(folder, std::string("compare deck.dat --both ") + option + " tri6").err,
                 {option, "can't take the place of a quadrilateral"});
  }
  for (const char* option : {"--formulation", "--formulation-b"})
    expect_words(sagefe(folder, std::string("compare deck.dat --both ") + option + " -1").err,
                 {option, "range"});
}

// Input of both kinds is judged as `run` judges it: a solver that can't take the law's matrix is no failed run.
TEST(CommandLine, CompareTakesSolverAndThreadsAsRunDoes) {
  const fs::path folder = empty_folder("compare_solver");
  const std::string deck = SAGE_SOURCE_DIR "/legacy_inputs/chapter7/dp_285/deck.dat";
  const Finished half = sagefe(folder, "compare " + deck + " --threads 2 --solver-b cholmod");
  EXPECT_EQ(half.exit_code, 2);
  expect_words(half.err, {"cholmod is for symmetric matrices only"});
  EXPECT_EQ(sagefe(folder, "run " + deck + " --solver cholmod").exit_code, 2);
}

TEST(CommandLine, StressWritesItsPageAndPlots) {
  const fs::path folder = empty_folder("stress");
  const Finished run =
      sagefe(folder, "stress --only poisson-refused distortion --csv s.csv --write docs/stress.md");
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  expect_words(run.out, {"poisson-refused", "distortion", "2 rows, 0 failed"});
  EXPECT_TRUE(fs::exists(folder / "s.csv"));
  EXPECT_TRUE(fs::exists(folder / "docs" / "stress.md"));
  EXPECT_TRUE(fs::exists(folder / "docs" / "stress" / "distortion.svg"));
}

TEST(CommandLine, VersionIsThreeNumbers) {
  const Finished version = sagefe(empty_folder("version"), "--version");
  EXPECT_EQ(version.exit_code, 0);
  int a = -1, b = -1, c = -1;
  EXPECT_EQ(std::sscanf(version.out.c_str(), "sagefe %d.%d.%d", &a, &b, &c), 3) << version.out;
}

TEST(CommandLine, VerifyListsRunsAndWritesRows) {
  const fs::path folder = empty_folder("verify");
  const Finished list = sagefe(folder, "verify --list");
  EXPECT_EQ(list.exit_code, 0);
  expect_words(list.out, {"lame.two_rings", "closed form"});
  const Finished run = sagefe(folder, "verify --only interface.p5 --rows --csv rows.csv");
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_EQ(run.err, "");  // progress on a terminal only
  expect_words(run.out,
               {"interface4 row-sum, r1 = 0", "pass", "1 cases, 12 rows, 0 failing", "compression positive"});
  EXPECT_GE(row(read(folder / "rows.csv"), "\"Patch tests of interfaces\"").size(), 15u);
  EXPECT_EQ(sagefe(folder, "verify --only nothing").exit_code, 1);
  EXPECT_EQ(sagefe(folder, "verify --only interface.p5 --write").exit_code, 1);
}

TEST(CommandLine, FiguresComputesOneWithItsPage) {
  const fs::path folder = empty_folder("figures");
  const Finished list = sagefe(folder, "figures --list --only 7.16");
  EXPECT_EQ(list.exit_code, 0);
  expect_words(list.out, {"7.16", "approximately half of those for the pinned end case", "0.4 to 0.6"});
  const Finished run = sagefe(folder, "figures --only 7.16 -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  expect_words(run.out,
               {"out/figure_7_16.svg", "4 checks", "6 runs"});  // two scenes, full and B-bar, and two to swap
  expect_words(read(folder / "out/figure_7_16.svg"),
               {"Figure 7.16", "Deviator stress, full 4-node", "B-bar", "psi"});
  expect_words(read(folder / "out/figures.md"),
               {"![Figure 7.16](figure_7_16.svg)", "E = 3000 psi", "What the words mean"});
  expect_words(read(folder / "out/figures.csv"), {"\n7.16,\"approximately half", ",does not hold,\"itself\""});
  const Finished wrong = sagefe(folder, "figures --only 7.41");
  EXPECT_EQ(wrong.exit_code, 1);
  expect_words(wrong.err, {"7.41", "from 7.1 to 7.40"});
  write(folder / "file", "");
  EXPECT_EQ(sagefe(folder, "figures --only 7.1 -o file/out").exit_code, 4);
}

// "--write -q": a value was forgotten.  Nothing is written into a file of an option's name.
TEST(CommandLine, NamesOfOptionsAreNoValues) {
  const fs::path folder = empty_folder("option_as_value");
  for (const char* words :
       {"run none.dat -o -q", "plot none.csv --title -q", "drive --law linear_elastic --csv --plot"}) {
    const Finished run = sagefe(folder, words);
    EXPECT_EQ(run.exit_code, 1) << words;
    expect_words(run.err, {"is an option; a file of that name is ./-"});
  }
  EXPECT_EQ(sagefe(folder, "plot none.csv --xy=-uy:-fy").err.find("is an option"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "-q"));
  const Finished page = sagefe(folder, "stress --only units --write -q");
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_TRUE(fs::exists(folder / "docs/stress.md"));
}

// Without rsvg-convert: what is missing, before anything is computed.
TEST(CommandLine, FiguresSaysWhatAnotherFormatNeeds) {
  const fs::path folder = empty_folder("figures_format");
  const char* path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  fs::create_directory(folder / "bin");
  fs::create_symlink("/usr/bin/timeout", folder / "bin/timeout");  // of the test itself
  setenv("PATH", (folder / "bin").c_str(), 1);
  const Finished run = sagefe(folder, "figures --only 7.1 -o out --format png");
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(run.exit_code, 4);
  expect_words(run.err, {"rsvg-convert"});
  EXPECT_FALSE(fs::exists(folder / "out"));
}

// A deck under a layout that is guessed: echo and layout check take the draft, check and run refuse it.
TEST(CommandLine, LayoutGuessWritesADraftThatReadsTheDeck) {
  const fs::path folder = empty_folder("layout_guess");
  write(folder / "old.dat", block_deck().text());
  const Finished guess = sagefe(folder, "layout guess old.dat -o old.toml");
  EXPECT_EQ(guess.exit_code, 0) << guess.err;
  expect_words(guess.out, {"old.toml", "kinds of cards", "sagefe layout check old.toml old.dat"});
  // Printed, it is the same, named after the deck as the file is; a name that is built in is left to that layout.
  EXPECT_EQ(sagefe(folder, "layout guess old.dat").out, read(folder / "old.toml"));
  write(folder / "stap.dat", block_deck().text());
  expect_words(sagefe(folder, "layout guess stap.dat").out, {"name = \"stap_guessed\""});
  EXPECT_EQ(sagefe(folder, "echo old.dat --layout ./old.toml").exit_code, 0);
  const Finished check = sagefe(folder, "layout check old.toml old.dat");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  expect_words(check.out, {"(a draft)", " 0 under no card", "used by nothing", "....+....1"});
  for (const char* command : {"check old.dat --layout ./old.toml", "run old.dat --layout ./old.toml -o out"}) {
    const Finished refused = sagefe(folder, command);
    EXPECT_EQ(refused.exit_code, 2) << command;
    expect_words(refused.err, {"is a draft", "draft = true"});
  }
}

TEST(CommandLine, LayoutCheckEndsAsCheckDoes) {
  const fs::path folder = empty_folder("layout_check");
  write(folder / "deck.dat", block_deck().text());
  write(folder / "cut.dat", block_deck().text().substr(0, 200));
  write(folder / "binary.dat", std::string("1 2\0 3", 6));
  const Finished good = sagefe(folder, "layout check sage1 deck.dat");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  expect_words(good.out, {"layout sage1", "used by the program"});
  const Finished cut = sagefe(folder, "layout check sage1 cut.dat");
  EXPECT_EQ(cut.exit_code, 2);
  expect_words(cut.err, {"error"});
  expect_words(cut.out, {"title", "Cards of the layout that the deck doesn't have"});
  EXPECT_EQ(sagefe(folder, "layout check no_layout deck.dat").exit_code, 2);
  const Finished swapped = sagefe(folder, "layout check deck.dat sage1");
  EXPECT_EQ(swapped.exit_code, 2);
  expect_words(swapped.err, {"deck.dat: error: this is no layout, but sage1 is",
                             "the layout comes first, sagefe layout check sage1 deck.dat"});
  EXPECT_EQ(swapped.err.find("parsing"), std::string::npos) << swapped.err;
  expect_words(sagefe(folder, "layout check deck.dat cut.dat").err,
               {"it was read as the layout", "LAYOUT DECK"});
  EXPECT_EQ(sagefe(folder, "layout guess binary.dat").exit_code, 2);
  EXPECT_EQ(sagefe(folder, "layout guess no_file.dat").exit_code, 2);
  EXPECT_EQ(sagefe(folder, "layout").exit_code, 1);
  EXPECT_EQ(sagefe(folder, "layout guess deck.dat -o deck.dat/y.toml").exit_code, 4);
  EXPECT_EQ(sagefe(folder, "layout guess deck.dat -o deck.dat").exit_code, 1);  // never over the deck
}

// Alone and with `help` the program shows its help, and that of a command.
TEST(CommandLine, HelpWithoutDashes) {
  const fs::path folder = empty_folder("help_words");
  const std::string help = sagefe(folder, "--help").out;
  for (const char* call : {"", "help", "help --help"}) {
    const Finished run = sagefe(folder, call);
    EXPECT_EQ(run.exit_code, 0) << call;
    EXPECT_EQ(run.out, help) << call;
  }
  EXPECT_EQ(sagefe(folder, "help check").out, sagefe(folder, "check --help").out);
  EXPECT_EQ(sagefe(folder, "help frobnicate").exit_code, 1);
  for (const char* command : {"", "run", "plot", "safety", "drive", "compare", "new", "layout guess"}) {
    std::istringstream lines(sagefe(folder, std::string(command) + " --help").out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
  }
}

TEST(CommandLine, MistakesGiveExitCode1AndNameTheWord) {
  const fs::path folder = empty_folder("usage");
  write(folder / "deck.dat", block_deck().text());
  const std::pair<const char*, const char*> calls[] = {
      {"frobnicate", "frobnicate"},
      {"run", "DECK"},
      {"run deck.dat --frobnicate", "--frobnicate"},
      {"run deck.dat --solver nonsense", "unknown solver nonsense"},
      {"run deck.dat --tables nonsense", "nonsense"},
      {"run deck.dat --picture nonsense", "nonsense"},
      {"run deck.dat --geometry two", "two"},
      {"run deck.dat --element quad26", "quad26"},
      {"run deck.dat --refine 13", "13"},
      {"run deck.dat --formulation -1", "--formulation"},
      {"run deck.dat --grade corner", "corner"},
      {"run deck.dat --converge 0", "--converge"},
      {"run deck.dat --converge nan", "a relative error from 1e-10 to 0.5 is wanted, not \"nan\""},
      {"run deck.dat --max-seconds inf", "a number of seconds"},
      {"run deck.dat --checkpoint nan", "a number of seconds"},
      {"convert deck.dat other.dat --young -1", "a positive number below 1e99 is wanted, not \"-1\""},
      {"list nonsense", "nonsense"},
      {"stress --only nonsense", "nonsense"},
      {"compare deck.dat", "--both"},
      {"compare deck.dat --both --geometry-b 1", "--geometry-b"},
      {"compare deck.dat --both --line 1,2,3", "has 3 numbers"},
      {"compare deck.dat --both --picture nonsense", "nonsense"},
      {"compare deck.dat deck.dat deck.dat", "At Most 2"},
      {"check", "DECK"},
      {"echo deck.dat another.dat", "another.dat"},
  };
  for (const auto& [call, word] : calls) {
    const Finished run = sagefe(folder, call);
    EXPECT_EQ(run.exit_code, 1) << call << "\n" << run.err;
    expect_words(run.err, {word});
    EXPECT_FALSE(fs::exists(folder / "out")) << call;
  }
}

TEST(CommandLine, ListsWhatDecksCanAskFor) {
  const fs::path folder = empty_folder("list");
  const auto list = [&](const char* what) {
    const Finished run = sagefe(folder, std::string("list ") + what);
    EXPECT_EQ(run.exit_code, 0);
    return run.out;
  };
  expect_words(list("elements"), {"   1  quad4", "b-bar", "  11  interface4", "Newton-Cotes"});
  expect_words(list("materials"),
               {"   1  linear_elastic (solid)", "youngs_modulus [stress]", "; required",
                "  21  goodman (interface)", "shear_stiffness [stress/length]", "blank = 0"});
  expect_words(list("solvers"), {"skyline_lu (unsymmetric)", "skyline_ldlt (symmetric)", "umfpack"});
}

TEST(CommandLine, EchoShowsEachCardUnderARuler) {
  const fs::path folder = empty_folder("echo");
  write(folder / "deck.dat", block_deck().text());
  const Finished echo = sagefe(folder, "echo deck.dat");
  EXPECT_EQ(echo.exit_code, 0) << echo.err;
  expect_words(echo.out, {"....+....1....+....2", "    8 |     1    2    1    2    3", "fill  (5I5,2F10.0)",
                          "first = 1  columns = 2  column_step = 1  rows = 2  row_step = 3", "\"psi\""});
}

// A block starts at 100 under a pressure of 10: before the run by check, with the run in the
// listing and on the screen.
TEST(CommandLine, InitialStressOutOfBalanceIsNamedByCheckAndRun) {
  const fs::path folder = empty_folder("unbalanced");
  write(folder / "good.dat", block_deck().text());
  write(folder / "deck.dat", block_deck().with("initial", card({"1", "0"}, {"100.", "100.", "100."})).text());
  constexpr const char* kNote = "stage 1: the initial stress is out of balance by up to ";
  const Finished check = sagefe(folder, "check deck.dat");
  EXPECT_EQ(check.exit_code, 0);
  expect_words(check.err, {kNote, "note: "});
  EXPECT_EQ(sagefe(folder, "check good.dat").err.find(kNote), std::string::npos);
  const Finished run = sagefe(folder, "run deck.dat -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_words(run.out, {kNote, "% of the largest force that it puts on a node) at node "});
  // Without a summary it stands where the messages about the deck do.
  const Finished quiet = sagefe(folder, "run -q deck.dat -o out");
  EXPECT_EQ(quiet.out, "");
  expect_words(quiet.err, {"deck.dat: note: ", kNote});
  EXPECT_EQ(sagefe(folder, "run -q good.dat -o out").err.find(kNote), std::string::npos);
}

TEST(CommandLine, ABadDeckDoesNotKeepTheNextFromRunning) {
  const fs::path folder = empty_folder("two_decks");
  write(folder / "bad.dat", block_deck().with("parameters", card({}, {"-1.", ".3"})).text());
  write(folder / "good.dat", block_deck().text());
  write(folder / "weak.dat", collapse_deck().text());
  const Finished run = sagefe(folder, "run bad.dat good.dat -o out");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(fs::exists(folder / "out" / "good.lst"));
  EXPECT_FALSE(fs::exists(folder / "out" / "bad.lst"));
  // The worst code is the answer, whatever the order.
  EXPECT_EQ(sagefe(folder, "run weak.dat bad.dat good.dat -o out").exit_code, 3);
  EXPECT_EQ(sagefe(folder, "run good.dat -o out").exit_code, 0);
  EXPECT_EQ(sagefe(folder, "check bad.dat good.dat").exit_code, 2);
}

// Files, messages and exit code of several decks are those of one after the other; a deck's summary holds times, so
// that only its first line is compared.
TEST(CommandLine, SeveralDecksAtATimeAreAsOneAfterTheOther) {
  const fs::path folder = empty_folder("decks_beside");
  write(folder / "bad.dat", block_deck().with("parameters", card({}, {"-1.", ".3"})).text());
  write(folder / "good.dat", block_deck().text());
  write(folder / "weak.dat", collapse_deck().text());
  write(folder / "joint.dat", joint_deck().text());
  const std::string decks = "run weak.dat bad.dat good.dat missing.dat joint.dat --nodes --points -o ";
  const Finished one = sagefe(folder, decks + "one"), beside = sagefe(folder, decks + "beside --jobs 3");
  EXPECT_EQ(one.exit_code, 3);
  EXPECT_EQ(beside.exit_code, one.exit_code);
  std::string err = beside.err;
  for (std::size_t at = 0; (at = err.find("beside/")) != std::string::npos;) err.replace(at, 7, "one/");
  EXPECT_EQ(err, one.err);
  std::size_t last = 0;
  for (const char* deck : {"weak", "good", "joint"}) {
    for (const char* end : {".lst", ".nodes.csv", ".points.csv"}) {
      const std::string file = std::string(deck) + end;
      std::string a = read(folder / "one" / file), b = read(folder / "beside" / file);
      EXPECT_FALSE(a.empty()) << file;
      EXPECT_EQ(a, b) << file;
    }
    const std::size_t at = beside.out.find(std::string("beside/") + deck + ".lst");
    ASSERT_NE(at, std::string::npos) << beside.out;
    EXPECT_GT(at, last) << "in the order of the decks";
    last = at;
  }
}

// Every phase of the tree is there; how long they take is nobody's business here.
TEST(CommandLine, ProfileIsATableAndAFile) {
  const fs::path folder = empty_folder("profile");
  write(folder / "deck.dat", collapse_deck().text());
  write(folder / "good.dat", block_deck().text());
  const Finished run = sagefe(folder, "run good.dat --profile -o out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* phase : {"whole run", "reading the deck", "building the model", "opening and closing files",
                            "analysis", "start of stages", "numbering", "iteration", "factorisation",
                            "solution", "assembly", "output", "checks"}) {
    EXPECT_NE(run.out.find(std::string(" ") + phase + " "), std::string::npos) << phase << "\n" << run.out;
    EXPECT_NE(read(folder / "out/good.profile.json").find(std::string("\"phase\": \"") + phase + "\""),
              std::string::npos)
        << phase;
  }
  // The name of a deck may be no UTF-8, which JSON is.
  write(folder / "caf\xe9.dat", block_deck().text());
  EXPECT_EQ(sagefe(folder, "run caf*.dat --profile -q -o out").exit_code, 0);
  EXPECT_NE(read(folder / "out/caf\xe9.profile.json").find("\"case\": \"caf\xc3\xa9\""), std::string::npos);
  // A run that found no equilibrium has one too.
  EXPECT_EQ(sagefe(folder, "run deck.dat --profile -o out").exit_code, 3);
  EXPECT_NE(read(folder / "out/deck.profile.json").find("\"phase\": \"iteration\""), std::string::npos);
}

// Two elements of ground and the joint between them: the start stress has none for the joint, whose sides would part.
TEST(CommandLine, StartStressOfInterfacesIsRefused) {
  const fs::path folder = empty_folder("start_stress_of_interfaces");
  std::string layout = read(fs::path(SAGE_SOURCE_DIR) / "legacy_inputs/layouts/sage1.toml");
  const std::string start =
      "[[card]]\nname = \"start_stress\"\nformat = \"(2F10.0)\"\n"
      "fields = [{ name = \"level\" }, { name = \"k0\" }]\n\n";
  layout.insert(layout.rfind("[[card]]", layout.find("block = \"stages\"")), start);
  layout.replace(layout.find("name = \"sage1\""), 14, "name = \"own\"");
  write(folder / "own.toml", layout);
  const DeckText joint =
      joint_deck()
          .with("control", card({"1", "0", "8", "0", "2", "3", "3", "1", "0", "1", "0", "8", "3"}))
          .with("material_soil", card({"1", "1", "2"}, {"20."}) + "soil")
          .without("initial_bottom")
          .with("initial_joint", card({}, {"2.", ".5"}));
  write(folder / "joint.dat", joint.text());
  const Finished check = sagefe(folder, "check --layout own.toml joint.dat");
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_NE(check.err.find("group 2 holds interfaces"), std::string::npos) << check.err;
}

TEST(CommandLine, ADeckMayComeThroughAPipe) {
  const auto folder = empty_folder("piped_deck");
  write(folder / "deck.dat", block_deck().text());
  const Finished run = sagefe(folder, "run /dev/stdin -o out", "cat deck.dat | timeout 60");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "stdin.lst"));
  // These read their deck again.
  for (const char* command : {"run /dev/stdin --converge 1e-2", "compare /dev/stdin --both"}) {
    const Finished again = sagefe(folder, command, "cat deck.dat | timeout 60");
    EXPECT_EQ(again.exit_code, 2);
    expect_words(again.err, {"/dev/stdin: error", "not a pipe"});
  }
}

TEST(CommandLine, DecksThatWouldOverwriteEachOtherAreRefused) {
  const fs::path folder = empty_folder("same_names");
  for (const char* part : {"a", "b"}) {
    fs::create_directories(folder / part);
    write(folder / part / "one.dat", block_deck().text());
  }
  const Finished run = sagefe(folder, "run a/one.dat b/one.dat -o out");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(CommandLine, AFolderThatCantBeMadeIsExitCode4) {
  const fs::path folder = empty_folder("no_folder");
  write(folder / "deck.dat", block_deck().text());
  write(folder / "file", "not a folder");
  for (const char* out : {"file", "file/out"}) {
    const Finished run = sagefe(folder, std::string("run deck.dat -o ") + out);
    EXPECT_EQ(run.exit_code, 4) << run.err;
    expect_words(run.err, {out});
  }
  EXPECT_EQ(read(folder / "file"), "not a folder");
}

// The top is pushed, then let go in four increments: the force of the first stage stands in proportion until
// the end, though neither a load nor a support puts it there.  Linear, so exactly in proportion.
TEST(Reports, RowsThatHoldReleaseForcesSaySo) {
  const fs::path folder = empty_folder("release");
  const DeckText deck =
      block_deck()
          .with("control", card({"1", "0", "4", "1", "1", "1", "1", "2", "0", "2", "1", "9", "4"}))
          .without("initial")
          .with("stage", card({"1", "0", "0", "0", "1", "0", "0", "0", "0", "0"}))
          .without("load")
          .without("pressure")
          .behind("stage_fixity", "release_title", "The top is let go")
          .behind("release_title", "release", card({"4", "0", "0", "0", "1", "0", "0", "0", "0", "0"}))
          .behind("release", "release_fixity", card({"7", "9", "1", "0", "-1"}))
          .with("report", card({"2", "1", "7", "9", "1", "1"}));
  write(folder / "deck.dat", deck.text());
  const Finished run = sagefe(folder, "run deck.dat");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string table = read(folder / "out" / "deck.report1.csv");
  const double pushed = std::stod(row(table, "1,1,").at(5));
  EXPECT_LT(pushed, -1.0);
  for (int i = 1; i <= 4; ++i)
    EXPECT_NEAR(std::stod(row(table, "2," + std::to_string(i) + ",").at(5)), pushed * (1.0 - 0.25 * i),
                1e-9 * std::abs(pushed));
  EXPECT_EQ(count(table, "are let go over the stage"), 1) << table;
  EXPECT_LT(table.find("# stage 2: forces on these nodes that nothing bears"), table.find("\n2,1,"));
  const std::string listing = read(folder / "out" / "deck.lst");  // the frame of its title ends in stars too
  for (const std::string& text : {run.out, listing.substr(listing.find("== UNITS"))}) {
    EXPECT_EQ(count(text, " *\n"), 3) << "the last row is free of it\n" << text;
    EXPECT_EQ(count(text, "borne by no load and no support"), 1) << text;
  }
  expect_words(run.out, {"nodes 1", "u-y [in]", "force-y [lbf]", "stage 2"});
}

// c = 10, phi = 0: the limit of the pressure is 2 c = 20, two thirds of the 30 that the deck asks for.
TEST(FailedRuns, CollapseKeepsTheLastStateInEquilibrium) {
  const fs::path folder = empty_folder("collapse");
  write(folder / "deck.dat", collapse_deck().text());
  const Finished run = sagefe(folder, "run deck.dat -o out");
  EXPECT_EQ(run.exit_code, 3);
  expect_words(run.err, {"stage 1, increment 7", "limit load: between 0.666"});
  expect_words(run.out, {"NOT CONVERGED"});
  expect_words(read(folder / "out" / "deck.lst"), {"NOT CONVERGED", "the run ended before its last stage"});
  const std::string table = read(folder / "out" / "deck.increments.csv");
  EXPECT_EQ(row(table, "1,6,").at(3), "1") << "increment 6, at 18, is in equilibrium";
  const std::vector<std::string> last = row(table, "1,7,");
  EXPECT_EQ(last.at(3), "0");
  // Twelve cuts of a tenth: the last factor reached is within 0.1 / 2^12 below 2/3, and so within 5e-5 of it.
  EXPECT_NEAR(std::stod(last.at(2)), 2.0 / 3.0, 1e-4);
  EXPECT_LT(std::stod(last.at(2)), 2.0 / 3.0);
  expect_words(table, {"# NOT CONVERGED in stage 1, increment 7"});
}

// The upper element stands on a joint without shear stiffness: nothing resists the push in x.
TEST(FailedRuns, FrictionlessBlockIsSingularAndNamed) {
  const fs::path folder = empty_folder("loose");
  write(folder / "deck.dat", joint_deck().with("parameters_joint", card({}, {"0.", "1.E6"})).text());
  EXPECT_EQ(sagefe(folder, "check deck.dat").exit_code, 0) << "supports alone look sufficient";
  for (const char* solver : {"skyline_ldlt", "skyline_lu", "cholmod", "umfpack", "frontal", "frontal_ldlt"}) {
    const Finished run = sagefe(folder, std::string("run deck.dat -o out --solver ") + solver);
    EXPECT_EQ(run.exit_code, 3) << solver;
    expect_words(run.err, {"deck.dat: stage 1, increment 1: the stiffness matrix is singular at node ",
                           ", direction x", solver, "3 (quad4", "interface without stiffness"});
    const std::string printed =
        run.err.substr(std::min(run.err.size(), run.err.find("singular at node ") + 17), 1);
    EXPECT_NE(std::string("5678").find(printed), std::string::npos)
        << "not a node of the loose element: " << printed;
    expect_words(read(folder / "out" / "deck.lst"), {"NOT CONVERGED", "singular"});
  }
}

// What a terminal obeys: controls but for ends of lines and tabs, C1 as bytes or as UTF-8, marks of direction, and
// bytes that are no UTF-8.
std::string first_that_steers(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const std::string_view rest = std::string_view(text).substr(i);
    const bool control = (c < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
    const bool c1 = rest.starts_with("\xc2") && rest.size() > 1 && static_cast<unsigned char>(rest[1]) < 0xa0;
    const bool bidi =
        rest.starts_with("\xe2\x80\xae") || rest.starts_with("\xe2\x81\xa6") || rest.starts_with("\xd8\x9c");
    if (control || c1 || bidi || c == 0x9b) return "at " + std::to_string(i) + ": " + text.substr(i, 4);
  }
  return "";
}

// Decks, names of groups, points and files with ESC, CSI (as UTF-8 and as a byte), and marks that turn the direction of
// writing.
TEST(CommandLine, NothingSteersTheTerminal) {
  const fs::path folder = empty_folder("steering");
  const std::string evil =
      "\x1b[31m \xc2\x9b"
      "5m \xe2\x80\xae \xe2\x81\xa6 \x07\x7f\r \xd8\x9c";
  std::string deck = block_deck().text();
  deck.replace(0, deck.find('\n'), "title " + evil + " \x9b");
  const std::string name =
      "a\x1b[2J\xe2\x80\xae"
      "b.dat";
  write(folder / name, deck);
  write(folder / "bad.dat", deck + evil + "\n");
  write(folder / "l.toml", read(std::string(SAGE_SOURCE_DIR) + "/legacy_inputs/layouts/sage1.toml"));
  write(folder / "t.csv", "# " + evil + "\nx" + evil + ",y\n0,1\n1,2\n");
  const std::string file = "\"" + name + "\"";
  const std::string commands[] = {"echo " + file,
                                  "check " + file,
                                  "run " + file,
                                  "run " + file + " --json",
                                  "run " + file + " --point \"0.5,0.5:" + evil + "\"",
                                  "layout check l.toml " + file,
                                  "layout guess " + file,
                                  "echo bad.dat",
                                  "check bad.dat",
                                  "convert " + file + " --to out.msh",
                                  "compare " + file + " --formulation-b 2",
                                  "plot t.csv --xy " + std::string("\"y:") + evil + "\"",
                                  "plot " + file + " --xy x:y",
                                  "run \"no" + evil + "\"",
                                  "\"" + evil + "\"",
                                  "run " + file + " --\"" + evil + "\""};
  for (const std::string& command : commands) {
    const Finished done = sagefe(folder, command);
    EXPECT_EQ(first_that_steers(done.out), "") << command;
    EXPECT_EQ(first_that_steers(done.err), "") << command;
    EXPECT_NE(done.exit_code, 139) << command;
  }
  // Other letters stay as they are.
  deck.replace(0, deck.find('\n'), "B\xc3\xb6schung \xe6\x96\x9c\xe9\x9d\xa2");
  write(folder / "good.dat", deck);
  EXPECT_NE(sagefe(folder, "run good.dat").out.find("B\xc3\xb6schung \xe6\x96\x9c\xe9\x9d\xa2"),
            std::string::npos);
}

// Digits as the chapter prints them: four in Table 7.3, three in Table 7.4; the joints' rule by name; no -0.
TEST(CommandLine, TablesNameTheJointsRuleAndShowPublishedDigits) {
  const fs::path folder = empty_folder("tables");
  const Finished tables = sagefe(folder, "tables");
  ASSERT_EQ(tables.exit_code, 0) << tables.err;
  const std::size_t second = tables.out.find("Table 7.4"), foot = tables.out.find("Compression positive");
  ASSERT_NE(second, std::string::npos);
  ASSERT_NE(foot, std::string::npos);
  const std::string of_7_4 = tables.out.substr(second, foot - second);
  EXPECT_FALSE(std::regex_search(of_7_4, std::regex("[0-9]\\.[0-9]{4}"))) << of_7_4;
  EXPECT_NE(of_7_4.find(" 1.167 "), std::string::npos) << of_7_4;
  EXPECT_FALSE(std::regex_search(tables.out, std::regex("-0\\.0+[ %\n]"))) << tables.out;
  EXPECT_NE(tables.out.find("Joints: interface4 row-sum, k_s in the middle of each increment (shear_rule 1)"),
            std::string::npos)
      << tables.out;
  EXPECT_EQ(tables.out.find("as the chapter ran it"), std::string::npos);
}

// The exit code alone does not say which curve ended where.
TEST(CommandLine, DriveSaysWhichCurveEndsEarlyAlsoWhenQuiet) {
  const fs::path folder = empty_folder("drive_quiet");
  const std::string law = "drive -q --law mohr_coulomb --set E=1e4 --set nu=.3 --set c=1 --set phi=30 ";
  const Finished stops = sagefe(folder, law + "--test isotropic --pressure 10 --to -100 --steps 10");
  EXPECT_EQ(stops.exit_code, 3) << stops.err;
  EXPECT_EQ(stops.out, "");
  EXPECT_NE(stops.err.find("mohr_coulomb ends early: "), std::string::npos) << stops.err;
  EXPECT_NE(stops.err.find("[S607]"), std::string::npos) << stops.err;
}

}  // namespace
}  // namespace sage::test

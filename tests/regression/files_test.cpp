// What a run does to the files of a folder, and what others may do to them meanwhile: its own deck, links and
// folders in the way, a second run, results of an earlier one.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <set>

#include "tests/regression/program.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names(const fs::path& folder) {
  std::set<std::string> found;
  for (const fs::directory_entry& file : fs::directory_iterator(folder)) found.insert(file.path().filename());
  return found;
}

std::string block() {
  return block_deck().text();
}

// So many elements across and along the specimen, one increment.
std::string specimen(int columns, int rows) {
  scenes::SpecimenDeck deck;
  deck.columns = columns;
  deck.rows = rows;
  deck.increments = 1;
  return deck.text();
}

// A run of some seconds at least: it is stopped before its end.
std::string long_deck() {
  scenes::SpecimenDeck deck;
  deck.columns = 30;
  deck.rows = 60;
  deck.increments = 2000;
  deck.output_every = 1;
  deck.drucker_prager = true;
  return deck.text();
}

// --- its own deck ---

TEST(Files, ADeckThatAResultWouldReplaceIsRefused) {
  for (const char* name : {"x.lst", "x.restart", "x.pvd", "x.files"}) {
    const fs::path folder = empty_folder("own_deck");
    fs::create_directory(folder / "r");
    write(folder / "r" / name, block());
    const Finished run = sagefe(folder, std::string("run r/") + name + " -o r --vtu");
    EXPECT_EQ(run.exit_code, 1) << name << run.err;
    EXPECT_NE(run.err.find(std::string("r/") + name), std::string::npos) << run.err;
    EXPECT_EQ(read(folder / "r" / name), block()) << name;
    EXPECT_EQ(names(folder / "r").count(std::string(name)), 1u);
  }
}

TEST(Files, ADeckBehindALinkOrOfALaterRunIsKept) {
  const fs::path folder = empty_folder("own_deck_link");
  fs::create_directory(folder / "r");
  write(folder / "x.dat", block());
  fs::create_symlink("../x.dat", folder / "r/x.lst");
  EXPECT_EQ(sagefe(folder, "run x.dat -o r").exit_code, 1);
  EXPECT_EQ(read(folder / "x.dat"), block());
  fs::remove(folder / "r/x.lst");
  write(folder / "r/x.increments.csv", block());
  EXPECT_EQ(sagefe(folder, "run x.dat r/x.increments.csv -o r -q").exit_code, 1);
  EXPECT_EQ(read(folder / "r/x.increments.csv"), block());
  write(folder / "r/x.convergence.csv", block());
  EXPECT_NE(sagefe(folder, "run x.dat r/x.convergence.csv --converge 0.1 -o r -q").exit_code, 0);
  EXPECT_EQ(read(folder / "r/x.convergence.csv"), block());
  write(folder / "r/x_y.compare.csv", block());
  fs::copy(folder / "x.dat", folder / "y.dat");
  fs::create_directory(folder / "s");
  fs::create_hard_link(folder / "y.dat", folder / "s/x_y.compare.csv");
  EXPECT_EQ(sagefe(folder, "compare x.dat y.dat -o s").exit_code, 1);
  EXPECT_EQ(read(folder / "y.dat"), block());
}

// --- links and folders in the way ---

TEST(Files, ALinkInThePlaceOfAPartialFileIsNotFollowed) {
  for (const char* name : {"x.lst", "x.increments.csv", "x.files", "x.restart"}) {
    const fs::path folder = empty_folder("planted");
    fs::create_directory(folder / "r");
    write(folder / "x.dat", block());
    write(folder / "victim", "precious");
    fs::create_symlink("../victim", folder / "r" / (std::string(name) + ".partial"));
    const Finished run = sagefe(folder, "run x.dat -o r --checkpoint 0");
    EXPECT_EQ(run.exit_code, 4) << name << run.err;
    EXPECT_NE(run.err.find(std::string(name) + ".partial"), std::string::npos) << run.err;
    EXPECT_EQ(read(folder / "victim"), "precious") << name;
  }
}

TEST(Files, AHardLinkInThePlaceOfAPartialFileIsNotWritten) {
  const fs::path folder = empty_folder("planted_hard");
  fs::create_directory(folder / "r");
  write(folder / "x.dat", block());
  write(folder / "victim", "precious");
  fs::create_hard_link(folder / "victim", folder / "r/x.lst.partial");
  EXPECT_EQ(sagefe(folder, "run x.dat -o r").exit_code, 4);
  EXPECT_EQ(read(folder / "victim"), "precious");
}

// Before the computation: no other result has got its name.
TEST(Files, AFolderNamedLikeAResultIsFoundBeforeTheComputation) {
  for (const char* name : {"x.lst", "x.lst.partial", "x.increments.csv", "x.report1.csv", "x.pvd", "x_0001.vtu",
                           "x_stage1_stress_yy.svg", "x.restart", "x.files", "x.files.partial"}) {
    const fs::path folder = empty_folder("folder_in_the_way");
    write(folder / "x.dat", block());
    fs::create_directories(folder / "r" / name / "inside");
    const Finished run = sagefe(folder, "run x.dat -o r --vtu --picture stress_yy");
    EXPECT_EQ(run.exit_code, 4) << name << run.err;
    EXPECT_NE(run.err.find(std::string("r/") + name), std::string::npos) << run.err;
    EXPECT_EQ(count(run.err, "\n"), 1) << run.err;
    for (const std::string& found : names(folder / "r"))
      EXPECT_TRUE(found == name || found.ends_with(".partial") || found == "x.lst" ||
                  found == "x.increments.csv" || found == "x.pvd" || found == "x.files")
          << name << ": " << found;
    EXPECT_FALSE(fs::exists(folder / "r/x_0002.vtu"));
  }
}

TEST(Files, ALinkLoopAsOutputFolder) {
  const fs::path folder = empty_folder("loop");
  write(folder / "x.dat", block());
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  const Finished run = sagefe(folder, "run x.dat -o a");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("the folder a can't be made: Too many levels of symbolic links"), std::string::npos)
      << run.err;
}

// Every command makes a folder that is missing, and says in the same words what keeps it from that.
TEST(Files, FoldersAreMadeOrNamedByAllCommandsAlike) {
  const fs::path folder = empty_folder("folders");
  write(folder / "x.dat", block());
  write(folder / "file", "");
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  const std::pair<std::string, std::string> commands[] = {
      {"run x.dat -o ", ""}, {"convert x.dat ", "/y.dat"}, {"layout guess x.dat -o ", "/y.toml"}};
  for (const auto& [command, file] : commands) {
    const std::string made = "made" + std::to_string(command.size()) + "/inside";
    EXPECT_EQ(sagefe(folder, command + made + file).exit_code, 0) << command;
    EXPECT_TRUE(fs::is_directory(folder / made)) << command;
    for (const std::string in_the_way : {"file/inside", "a/inside"}) {
      const Finished run = sagefe(folder, command + in_the_way + file);
      EXPECT_EQ(run.exit_code, 4) << command << run.err;
      EXPECT_NE(run.err.find("the folder " + in_the_way + " can't be made: "), std::string::npos) << run.err;
    }
  }
}

// The folder goes while the run computes: it stops within the next increments, long before its end.
TEST(Files, AnOutputFolderThatIsRemovedEndsTheRun) {
  for (const char* how : {"rm -rf out", "mv out elsewhere"}) {
    const fs::path folder = empty_folder("removed");
    write(folder / "two.dat", long_deck());
    const std::string script =
        std::string(
            "bash -c '\"$0\" \"$@\" & run=$!; for i in $(seq 500); do test -e out/two.lst.partial "
            "&& break; sleep 0.02; done; sleep 0.3; ") +
        how +
        "; for i in $(seq 500); do kill -0 $run 2>/dev/null || break; sleep 0.02; done; kill -KILL $run "
        "2>/dev/null; wait $run'";
    const Finished run = sagefe(folder, "run two.dat -q -o out", script);
    EXPECT_EQ(run.exit_code, 4) << how << run.err;
    EXPECT_NE(run.err.find("it was removed or renamed while the run was writing it"), std::string::npos)
        << run.err;
  }
}

// --- two runs ---

// While a run holds its results, every other command that would write them refuses and names it; one that has
// been killed holds nothing.
TEST(Files, ASecondRunIntoTheSameResultsRefuses) {
  const fs::path folder = empty_folder("two");
  write(folder / "two.dat", long_deck());
  fs::create_directory(folder / "other");
  write(folder / "other/two.dat", block());
  const std::string script =
      "bash -c '\"$0\" run two.dat -q -o out & first=$!; echo $first > first.txt; for i in $(seq 500); do "
      "test "
      "-e out/two.lst.partial && break; sleep 0.02; done; \"$0\" \"$@\"; code=$?; kill -0 $first || code=99; "
      "kill -KILL $first; wait $first 2>/dev/null; exit $code'";
  for (const std::string command : {"run other/two.dat -o out", "run two.dat -o out --restart",
                                    "run other/two.dat -o out --converge 0.1"}) {
    fs::remove_all(folder / "out");
    const Finished second = sagefe(folder, command, script);
    EXPECT_EQ(second.exit_code, 4) << command << second.err;
    const std::string process = read(folder / "first.txt");
    EXPECT_NE(second.err.find("process " + process.substr(0, process.find('\n')) + ","), std::string::npos)
        << second.err;
    EXPECT_NE(second.err.find("deck " + (folder / "two.dat").string()), std::string::npos) << second.err;
    EXPECT_FALSE(fs::exists(folder / "out/two.lst"));
    EXPECT_EQ(sagefe(folder, "run other/two.dat -o out -q").exit_code, 0) << "the lock outlived its process";
  }
}

// Another name in the same folder is no collision.
TEST(Files, RunsOfOtherNamesShareAFolder) {
  const fs::path folder = empty_folder("neighbours");
  write(folder / "two.dat", long_deck());
  write(folder / "other.dat", block());
  const std::string script =
      "bash -c '\"$0\" run two.dat -q -o out & first=$!; for i in $(seq 500); do test -e "
      "out/two.lst.partial && break; sleep 0.02; done; \"$0\" \"$@\"; code=$?; kill -KILL $first; wait "
      "$first 2>/dev/null; exit $code'";
  EXPECT_EQ(sagefe(folder, "run other.dat -o out -q", script).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/other.lst"));
}

// --- results of an earlier run ---

TEST(Files, ResultsOfAnEarlierRunDoNotStay) {
  const fs::path folder = empty_folder("earlier");
  write(folder / "x.dat", joint_deck().text());
  write(folder / "bystander", "");
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --points --nodes --vtu --picture stress_yy").exit_code, 0);
  for (const char* name : {"x.interfaces.csv", "x.points.csv", "x.nodes.csv", "x_0001.vtu", "x.pvd"})
    EXPECT_TRUE(fs::exists(folder / "r" / name)) << name;
  // Of others, or of the user: the same stem, but no run has written them.
  for (const char* name : {"x.notes.txt", "x_0007.vtu", "x.points.csv.bak", "y.lst"})
    write(folder / "r" / name, "mine");
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q").exit_code, 0);
  EXPECT_EQ(names(folder / "r"), (std::set<std::string>{"x.files", "x.lst", "x.increments.csv", "x.notes.txt",
                                                        "x_0007.vtu", "x.points.csv.bak", "y.lst"}));
}

// What the user has changed or put in its place is his.
TEST(Files, AResultThatTheUserHasChangedStays) {
  const fs::path folder = empty_folder("changed");
  write(folder / "x.dat", joint_deck().text());
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --points --nodes").exit_code, 0);
  std::string edited = read(folder / "r/x.points.csv");
  edited[edited.size() / 2] ^= 1;  // the same length
  write(folder / "r/x.points.csv", edited);
  write(folder / "kept", "precious");
  fs::remove(folder / "r/x.nodes.csv");
  fs::create_symlink("../kept", folder / "r/x.nodes.csv");
  const Finished run = sagefe(folder, "run x.dat -o r -q");
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_NE(run.err.find("r/x.points.csv is of an earlier run, but has been changed since: it stays"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(read(folder / "r/x.points.csv"), edited);
  EXPECT_TRUE(fs::is_symlink(folder / "r/x.nodes.csv"));
  EXPECT_EQ(read(folder / "kept"), "precious");
  EXPECT_FALSE(fs::exists(folder / "r/x.interfaces.csv"));
}

// A list that somebody has spoilt, or that names files elsewhere, removes nothing.
TEST(Files, ASpoiltListRemovesNothing) {
  const fs::path folder = empty_folder("spoilt");
  write(folder / "x.dat", block());
  write(folder / "victim", "precious");
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --nodes").exit_code, 0);
  const std::string good = read(folder / "r/x.files");
  std::string line = good.substr(good.find("\nrun ") + 1);
  line = line.substr(0, line.find(" x."));
  write(folder / "r/x.files",
        good + line + " ../victim\n" + "run - - ../victim\nrun zz 1 x.dat\nrun\n\n" + line);
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q").exit_code, 0);
  EXPECT_EQ(read(folder / "victim"), "precious");
  EXPECT_FALSE(fs::exists(folder / "r/x.nodes.csv"));
}

// What such a list should have named is named as what it may be.
TEST(Files, ADamagedListIsAWarningThatNamesWhatStays) {
  const fs::path folder = empty_folder("cut_list");
  write(folder / "x.dat", block());
  write(folder / "x_other.dat", block());
  ASSERT_EQ(sagefe(folder, "run x_other.dat -o r -q").exit_code, 0);
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --nodes").exit_code, 0);
  const std::string good = read(folder / "r/x.files");
  const std::size_t nodes = good.find(" x.nodes.csv");
  const std::size_t begin = good.rfind('\n', nodes) + 1, end = good.find('\n', nodes) + 1;
  for (const std::string& bad :
       {good.substr(0, begin) + good.substr(end), good.substr(0, nodes), std::string()}) {
    write(folder / "r/x.nodes.csv", "old");
    write(folder / "r/x.files", bad);
    const Finished run = sagefe(folder, "run x.dat -o r");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("was damaged: these may be of that run, and stay: r/x.nodes.csv"), std::string::npos)
        << bad << "\n"
        << run.err;
    EXPECT_EQ(count(run.err, "x_other"), 0) << run.err;
  }
  EXPECT_EQ(count(sagefe(folder, "run x.dat -o r").err, "damaged"), 0);
}

// Neither a run that finds no equilibrium nor one that is killed hides from the next one.
TEST(Files, ResultsOfFailedAndKilledRunsDoNotStay) {
  const fs::path folder = empty_folder("failed");
  write(folder / "x.dat", collapse_deck().text());
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --picture stress_yy --vtu").exit_code, 3);
  EXPECT_TRUE(fs::exists(folder / "r/x_stage1_failed_stress_yy.svg"));
  write(folder / "x.dat", block());
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q").exit_code, 0);
  EXPECT_EQ(names(folder / "r"),
            (std::set<std::string>{"x.files", "x.lst", "x.increments.csv", "x.report1.csv"}));

  write(folder / "failed.dat", long_deck());
  const Finished run = sagefe(folder, "run failed.dat -o k -q --vtu --points --checkpoint -1",
                              killed_once_there_is("k/failed_0001.vtu"));
  ASSERT_EQ(run.exit_code, 137);
  write(folder / "failed.dat", block());
  ASSERT_EQ(sagefe(folder, "run failed.dat -o k -q").exit_code, 0);
  EXPECT_EQ(names(folder / "k"), (std::set<std::string>{"failed.files", "failed.lst", "failed.increments.csv",
                                                        "failed.report1.csv"}));
}

// The table of --converge and the results of a run live side by side while they are of the same deck.
TEST(Files, TheTableOfConvergenceStaysWithItsDeck) {
  const fs::path folder = empty_folder("table");
  std::string deck = read(SAGE_SOURCE_DIR "/legacy_inputs/chapter7/pinned_ld1_nu025/deck.dat");
  write(folder / "x.dat", deck);
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --nodes").exit_code, 0);
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q --converge 0.2").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "r/x.convergence.csv"));
  EXPECT_TRUE(fs::exists(folder / "r/x.nodes.csv"));
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "r/x.convergence.csv"));
  EXPECT_FALSE(fs::exists(folder / "r/x.nodes.csv"));
  deck[0] = 'Q';  // of the title
  write(folder / "x.dat", deck);
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "r/x.convergence.csv"));
}

TEST(Files, AComparisonRemovesWhatItsForerunnerWrote) {
  const fs::path folder = empty_folder("compared");
  write(folder / "x.dat", block());
  write(folder / "r/keep", "");
  ASSERT_EQ(sagefe(folder, "run x.dat -o r -q").exit_code, 0);
  ASSERT_EQ(sagefe(folder, "compare x.dat --formulation-b 2 -o r --picture stress_yy").exit_code, 0);
  ASSERT_TRUE(fs::exists(folder / "r/x.compare_stress_yy.svg"));
  ASSERT_EQ(sagefe(folder, "compare x.dat --formulation-b 2 -o r").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "r/x.compare_stress_yy.svg"));
  EXPECT_TRUE(fs::exists(folder / "r/x.compare.csv"));
  EXPECT_TRUE(fs::exists(folder / "r/x.lst"));
}

// --- limits of the system ---

TEST(Files, AFilePastTheLimitOnSizesIsAFullDisk) {
  const fs::path folder = empty_folder("xfsz");
  write(folder / "x.dat", joint_deck().text());
  const Finished run = sagefe(folder, "run x.dat -q", "bash -c 'ulimit -f 1; exec \"$0\" \"$@\"'");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("cannot write"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("File too large"), std::string::npos) << run.err;
}

// At every limit the run ends as it should or with one line and a documented code.
TEST(Files, OutOfMemoryIsOneLineAndACode) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer reserves more than any limit";
#endif
  const fs::path folder = empty_folder("memory");
  write(folder / "x.dat", specimen(120, 240));
  int refused = 0;
  for (const std::string solver : {"skyline_lu", "frontal", "umfpack"})
    for (int megabytes : {20, 40, 60, 80, 100, 140, 200}) {
      const Finished run =
          sagefe(folder, "run x.dat -q --threads 2 --solver " + solver,
                 "bash -c 'ulimit -v " + std::to_string(1024 * megabytes) + "; exec timeout 60 \"$0\" \"$@\"'");
      if (run.exit_code == 0) continue;
      ++refused;
      EXPECT_EQ(run.exit_code, 3) << solver << " " << megabytes << "\n" << run.err;
      EXPECT_NE(run.err.find("memory"), std::string::npos) << solver << " " << megabytes << "\n" << run.err;
    }
  EXPECT_GE(refused, 6);
}

// The deck that runs out of memory is named, those around it are complete: the limit is one on each.
// HDF5 crashes where an allocation fails, anywhere in its code.
TEST(Files, OutOfMemoryUnderAResultFileIsNoCrash) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer reserves more than any limit";
#endif
  const fs::path folder = empty_folder("memory_result");
  write(folder / "x.dat", joint_deck().text());
  if (sagefe(folder, "run x.dat -q --result").err.find("can't be loaded") != std::string::npos)
    GTEST_SKIP() << "built without HDF5";
  int failed = 0;
  for (int limit = 1000; limit <= 16000; limit += 500) {
    const std::string under =
        "bash -c 'ulimit -c 0; ulimit -d " + std::to_string(limit) + "; exec \"$0\" \"$@\"'";
    const Finished run = sagefe(folder, "run x.dat -q --result", under);
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 3 || run.exit_code == 4)
        << limit << ": " << run.exit_code;
    EXPECT_TRUE(run.exit_code == 0 || !run.err.empty()) << limit;
    failed += run.exit_code != 0 ? 1 : 0;
  }
  EXPECT_GT(failed, 5) << "limits that were not enough";
}

TEST(Files, ADeckWithoutMemoryHarmsNoOtherOfTheCall) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer reserves more than any limit";
#endif
  const fs::path folder = empty_folder("memory_of_jobs");
  scenes::SpecimenDeck deck;
  deck.increments = 1;
  for (const char* name : {"a.dat", "c.dat", "d.dat"}) write(folder / name, deck.text());
  write(folder / "b.dat", specimen(120, 240));
  const Finished run = sagefe(folder, "run a.dat b.dat c.dat d.dat -q --solver skyline_lu --jobs 2",
                              "bash -c 'ulimit -v 81920; exec timeout 60 \"$0\" \"$@\"'");
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("b.dat: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("memory"), std::string::npos) << run.err;
  for (const char* name : {"a.lst", "c.lst", "d.lst"}) EXPECT_TRUE(fs::exists(folder / "out" / name)) << name;
}

// Every kernel writes the same files, byte for byte: of a linear, a plastic and a condensed scene, small and large.
TEST(Files, KernelsChangeNoByte) {
  const fs::path folder = empty_folder("kernels");
  if (const Finished wide = sagefe(folder, "run --kernels avx512 none");
      wide.err.find("--kernels") != wide.err.npos)
    GTEST_SKIP() << wide.err;
  const fs::path decks = fs::path(SAGE_SOURCE_DIR) / "legacy_inputs/chapter7";
  for (const char* run :
       {"pinned_ld2_nu0333/deck.dat", "pinned_ld2_nu0333/deck.dat --refine 2", "dp_285/deck.dat",
        "dp_285/deck.dat --solver frontal", "friction_285_nu0495/deck.dat --refine 2"}) {
    const std::string command =
        "run " + (decks / run).string() + " --nodes --points --digits 17 --tables all -o ";
    for (const char* kernels : {"avx2", "avx512"})
      ASSERT_EQ(sagefe(folder, command + kernels + " --kernels " + kernels).exit_code, 0) << run;
    for (const fs::directory_entry& file : fs::directory_iterator(folder / "avx2"))
      EXPECT_TRUE(read(file.path()) == read(folder / "avx512" / file.path().filename()))
          << run << ": " << file.path().filename();
  }
}

// A name of bytes that are no UTF-8: what XML names exists, and the XML is well formed.
TEST(Files, AnyFileNameGivesAPvdThatReadersTake) {
  const fs::path folder = empty_folder("names");
  const std::string stem = "caf\xe9 & \x01<1>";
  write(folder / (stem + ".dat"), block());
  const Finished run = sagefe(folder, "run '" + stem + ".dat' -q -o r --vtu");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string pvd = read(folder / "r" / (stem + ".pvd"));
  EXPECT_NE(pvd.find("file=\"caf%E9 &amp; %01&lt;1&gt;_0001.vtu\""), std::string::npos) << pvd;
  EXPECT_TRUE(fs::exists(folder / "r/caf%E9 & %01<1>_0001.vtu"));
  for (const char byte : pvd) EXPECT_TRUE((byte >= ' ' && byte < 127) || byte == '\n');
  ASSERT_EQ(sagefe(folder, "run '" + stem + ".dat' -q -o r").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "r/caf%E9 & %01<1>_0001.vtu"));
}

// A group that no element belongs to has tables without lines.
TEST(Files, ResultOfAGroupWithoutElements) {
  const fs::path folder = empty_folder("files_empty_group");
  write(folder / "x.dat",
        block_deck()
            .with("control", card({"1", "0", "4", "1", "1", "2", "1", "2", "1", "1", "1", "9", "4"}))
            .behind("group", "empty", card({"2", "1", "1", "1"}) + "nothing")
            .text());
  const Finished run = sagefe(folder, "run x.dat -q --result -o r", "timeout 60");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished picture = sagefe(folder, "plot r/x.h5 --picture stress_yy -o p", "timeout 60");
  EXPECT_EQ(picture.exit_code, 0) << picture.err;
}

// 10 400 elements: their states, tables and pictures are made on all threads.
TEST(Files, OfALargeModelHaveTheSameBytesOnAnyNumberOfThreads) {
  const fs::path folder = empty_folder("files_threads");
  write(folder / "x.dat", specimen(80, 130));
  std::map<std::string, std::string> first;
  for (const std::string threads : {"1", "2", "3"}) {
    const Finished run =
        sagefe(folder, "run x.dat -q --result --vtu --msh --points --picture conf --picture SL -o on" +
                           threads + " --threads " + threads);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    int files = 0;
    for (const auto& entry : fs::directory_iterator(folder / ("on" + threads))) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".files")) continue;  // has the number of the process
      ++files;
      const std::string bytes = read(entry.path());
      const auto [same, added] = first.emplace(name, bytes);
      EXPECT_TRUE(same->second == bytes) << name << " on " << threads << " threads";
    }
    EXPECT_GE(files, 8);
  }
}

}  // namespace
}  // namespace sage::test

// Runs that are killed, that find the disk full or the folder closed: outputs are whole or absent, and a
// restart ends with the same bytes as a run that nothing disturbed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "tests/regression/program.hpp"
#include "tests/studies/scenes/specimen_deck.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

#ifdef SAGE_HAVE_HDF5
constexpr const char* kOptions =
    "--nodes --points --vtu --msh --result --picture stress_yy --tables all --checkpoint 0";
#else
constexpr const char* kOptions = "--nodes --points --vtu --msh --picture stress_yy --tables all --checkpoint 0";
#endif

// A plastic specimen on a sliding interface, with a report.
std::string deck_text(int increments = 30) {
  scenes::SpecimenDeck deck;
  deck.columns = 4;
  deck.rows = 6;
  deck.increments = increments;
  deck.output_every = 1;
  deck.drucker_prager = true;
  return deck.text();
}

// Names and bytes of the finished results.
std::map<std::string, std::string> results(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const fs::directory_entry& file : fs::directory_iterator(folder))
    if (file.path().extension() != ".partial" && file.path().extension() != ".restart")
      found[file.path().filename()] = read(file.path());
  return found;
}

std::map<std::string, std::string> undisturbed(const fs::path& folder) {
  const Finished run = sagefe(folder, std::string("run deck.dat -o whole ") + kOptions);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(fs::exists(folder / "whole/deck.restart"));
  return results(folder / "whole");
}

void expect_equal(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a) {
    ASSERT_TRUE(b.contains(name)) << name;
    EXPECT_TRUE(bytes == b.at(name)) << name << " differs";
  }
}

fs::path folder_with_deck(const std::string& name) {
  const fs::path folder = empty_folder(name);
  write(folder / "deck.dat", deck_text());
  return folder;
}

double seconds_of_a_run(const fs::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(sagefe(folder, std::string("run deck.dat -q -o timed ") + kOptions).exit_code, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What a killed run leaves under a final name must be a whole file of the undisturbed run: VTU files and
// pictures of increments that were done.
void expect_whole_or_absent(const fs::path& folder, const std::map<std::string, std::string>& whole) {
  if (!fs::exists(folder)) return;
  for (const auto& [name, bytes] : results(folder)) {
    ASSERT_TRUE(whole.contains(name)) << name;
    EXPECT_TRUE(bytes == whole.at(name)) << name << " is not whole";
  }
}

TEST(Fault, KilledAtRandomMomentsAndRestarted) {
  const fs::path folder = folder_with_deck("killed");
  const auto whole = undisturbed(folder);
  std::mt19937 random(20240611);
  std::uniform_real_distribution<double> moment(0.1,
                                                0.8);  // of the time of a whole run; later attempts get longer
  const double whole_time = std::min(seconds_of_a_run(folder), seconds_of_a_run(folder));
  int killed = 0, resumed = 0;
  for (int trial = 0; trial < 60 && (killed < 12 || resumed < 6); ++trial) {
    fs::remove_all(folder / "out");
    Finished run;
    run.exit_code = 137;
    for (int attempt = 0; run.exit_code == 137; ++attempt) {
      ASSERT_LT(attempt, 60) << "never comes to its end";
      const bool had_checkpoint = fs::exists(folder / "out/deck.restart");
      const double limit = whole_time * moment(random) * (1 + attempt);
      run = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions, killed_after(limit));
      if (run.exit_code == 137) {
        ++killed;
        expect_whole_or_absent(folder / "out", whole);
      }
      resumed += had_checkpoint ? 1 : 0;
    }
    ASSERT_EQ(run.exit_code, 0) << run.err;
    expect_equal(results(folder / "out"), whole);
  }
  EXPECT_GE(killed, 12);
  EXPECT_GE(resumed, 6);
}

#ifdef SAGE_HAVE_HDF5
// The program gets the signal once it has saved a checkpoint.
std::string ended_after_a_checkpoint(const std::string& signal) {
  return R"(sh -c 'last=$(stat -c %y out/deck.restart 2>/dev/null); "$0" "$@" & run=$!; for i in $(seq 1000); do )"
         R"(now=$(stat -c %y out/deck.restart 2>/dev/null); test "$now" != "$last" && break; sleep 0.01; done; )"
         "kill -" +
         signal + R"( $run; wait $run; exit $?')";
}

// States that a killed run has begun and a stopped one goes on with belong to the restart, not to what was left over.
TEST(Fault, KilledThenStoppedAndRestarted) {
  const fs::path folder = empty_folder("killed_then_stopped");
  write(folder / "deck.dat", deck_text(300));
  const std::string run = "run deck.dat -q --points --result --checkpoint 0";
  ASSERT_EQ(sagefe(folder, run + " -o whole").exit_code, 0);
  for (const char* signal : {"KILL", "TERM", "KILL", "TERM"})
    ASSERT_NE(sagefe(folder, run + " --restart", ended_after_a_checkpoint(signal)).exit_code, 0) << signal;
  const Finished last = sagefe(folder, run + " --restart");
  ASSERT_EQ(last.exit_code, 0) << last.err;
  expect_equal(results(folder / "out"), results(folder / "whole"));
}
#endif

// A limit on the size of files stands for the disk: the write that passes it fails in the same way.
TEST(Fault, FullDiskAndRestart) {
  const fs::path folder = folder_with_deck("full_disk");
  const auto whole = undisturbed(folder);
  for (int blocks : {1, 16, 64, 256}) {  // of 1024 bytes
    fs::remove_all(folder / "out");
    const std::string limit =
        "bash -c 'trap \"\" XFSZ; ulimit -f " + std::to_string(blocks) + "; exec \"$@\"' -";
    const Finished full = sagefe(folder, std::string("run deck.dat -q ") + kOptions, limit);
    EXPECT_EQ(full.exit_code, 4) << blocks << "\n" << full.err;
    EXPECT_NE(full.err.find("cannot write"), std::string::npos) << full.err;
    const Finished again = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions);
    ASSERT_EQ(again.exit_code, 0) << again.err;
    expect_equal(results(folder / "out"), whole);
  }
}

// The result file is written last and by a library that must not end the program in its own way.
TEST(Fault, FullDiskUnderAResultFile) {
  const fs::path folder = empty_folder("full_disk_result");
  fs::copy_file(fs::path(SAGE_SOURCE_DIR) / "legacy_inputs/chapter7/friction_08_nu025/deck.dat",
                folder / "deck.dat");
  const Finished whole = sagefe(folder, "run deck.dat -q --result");
  if (whole.err.find("can't be loaded") != std::string::npos) GTEST_SKIP() << "built without HDF5";
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  for (const int blocks : {100, 200, 300}) {  // of 1024 bytes
    fs::remove_all(folder / "out");
    const Finished full =
        sagefe(folder, "run deck.dat -q --result",
               "bash -c 'trap \"\" XFSZ; ulimit -f " + std::to_string(blocks) + "; exec \"$@\"' -");
    EXPECT_EQ(full.exit_code, 4) << blocks << "\n" << full.err;
    EXPECT_EQ(full.err.find("HDF5-DIAG"), std::string::npos) << full.err;
    EXPECT_FALSE(fs::exists(folder / "out/deck.h5"));
    EXPECT_FALSE(fs::exists(folder / "out/deck.h5.partial"));
    EXPECT_FALSE(fs::exists(folder / "out/deck.h5.states.partial")) << "no checkpoint names it";
  }
}

// Found missing before any file is begun.  A copy of the program that looks in a folder that is not there.
TEST(Fault, MissingModuleOfResultFilesLeavesNothing) {
  const fs::path folder = folder_with_deck("no_module");
  const Finished none =
      sagefe(folder, "run deck.dat -q --result",
             "timeout 60 sh -c 'sed s,/sage/record,/sage/absent,g \"$0\" > other; chmod +x other; "
             "exec ./other \"$@\"'");
  EXPECT_EQ(none.exit_code, 4) << none.err;
  EXPECT_NE(none.err.find("can't be loaded"), std::string::npos) << none.err;
  EXPECT_TRUE(!fs::exists(folder / "out") || fs::is_empty(folder / "out"));
}

TEST(Fault, UnwritableFolderAndRestart) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const fs::path folder = folder_with_deck("unwritable");
  const auto whole = undisturbed(folder);
  fs::create_directories(folder / "out");
  fs::permissions(folder / "out", fs::perms::owner_read | fs::perms::owner_exec);
  const Finished closed = sagefe(folder, std::string("run deck.dat -q ") + kOptions);
  fs::permissions(folder / "out", fs::perms::owner_all);
  EXPECT_EQ(closed.exit_code, 4) << closed.err;
  ASSERT_EQ(sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions).exit_code, 0);
  expect_equal(results(folder / "out"), whole);
}

TEST(Fault, AFileInThePlaceOfTheFolder) {
  const fs::path folder = folder_with_deck("no_folder");
  write(folder / "out", "");
  const Finished run = sagefe(folder, "run deck.dat");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("out"), std::string::npos) << run.err;
}

TEST(Fault, AReadOnlyDeckIsEnough) {
  const fs::path folder = folder_with_deck("read_only");
  fs::permissions(folder / "deck.dat", fs::perms::owner_read);
  EXPECT_EQ(sagefe(folder, "run deck.dat -q").exit_code, 0);
}

TEST(Fault, ACheckpointOfAnotherRunIsRefused) {
  const fs::path folder = folder_with_deck("other");
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 256; exec \"$@\"' -";
  sagefe(folder, std::string("run deck.dat -q ") + kOptions, killed);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  const std::string before = read(folder / "out/deck.restart");

  const Finished other_output = sagefe(folder, "run deck.dat -q --restart");
  EXPECT_EQ(other_output.exit_code, 2);
  EXPECT_NE(other_output.err.find("belongs to another run"), std::string::npos) << other_output.err;
  EXPECT_EQ(read(folder / "out/deck.restart"), before);

  for (const std::string other : {" --without elements", " --without all", " --condition", " --digits 9",
                                  " --refine-solves 1", " --error"})
    EXPECT_EQ(sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions + other).exit_code, 2)
        << other;
  write(folder / "deck.dat", deck_text(31));
  EXPECT_EQ(sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions).exit_code, 2);

  for (const std::string& damaged :
       {before.substr(0, before.size() / 2), before + "x", std::string("nonsense")}) {
    write(folder / "out/deck.restart", damaged);
    const Finished run = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find("deck.restart"), std::string::npos) << run.err;
  }
}

// A checkpoint of one machine's kernels goes on with another's, to the same bytes.
TEST(Fault, RestartGoesOnWithOtherKernels) {
  const fs::path folder = folder_with_deck("kernels");
  if (const Finished wide = sagefe(folder, "run --kernels avx512 none");
      wide.err.find("--kernels") != wide.err.npos)
    GTEST_SKIP() << wide.err;
  const std::map<std::string, std::string> whole = undisturbed(folder);
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 256; exec \"$@\"' -";
  sagefe(folder, std::string("run deck.dat -q --kernels avx2 ") + kOptions, killed);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  const Finished run = sagefe(folder, std::string("run deck.dat --restart --kernels avx512 ") + kOptions);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("was computed with kernels avx2; the digits are the same"), std::string::npos)
      << run.err;
  EXPECT_NE(run.out.find(", kernels avx512"), std::string::npos) << run.out;
  expect_equal(results(folder / "out"), whole);
}

// Nothing is touched by a restart that is refused: the right one still ends as if nothing had happened.
TEST(Fault, ARefusedRestartLeavesTheResultsAlone) {
  const fs::path folder = folder_with_deck("refused");
  const std::map<std::string, std::string> whole = undisturbed(folder);
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 256; exec \"$@\"' -";
  sagefe(folder, std::string("run deck.dat -q ") + kOptions, killed);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  fs::copy(folder / "out", folder / "before");
  EXPECT_EQ(sagefe(folder, std::string("run deck.dat -q --restart --without all ") + kOptions).exit_code, 2);

  const fs::path csv = fs::exists(folder / "out/deck.increments.csv")
                           ? folder / "out/deck.increments.csv"
                           : folder / "out/deck.increments.csv.partial";
  const std::string text = read(csv);
  write(csv, text.substr(0, 10));
  const Finished run = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("shorter than it was"), std::string::npos) << run.err;
  write(csv, text);
  for (const fs::directory_entry& file : fs::directory_iterator(folder / "before"))
    EXPECT_TRUE(read(file.path()) == read(folder / "out" / file.path().filename())) << file.path();

  EXPECT_EQ(sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions).exit_code, 0);
  expect_equal(results(folder / "out"), whole);
}

// A restart takes nothing on trust: of every kind of file that it builds on, one with a changed byte, with 4
// KiB of zeros, or gone, is refused by name.
TEST(Fault, WhatARestartBuildsOnIsCompared) {
  const fs::path folder = folder_with_deck("compared");
  const std::map<std::string, std::string> whole = undisturbed(folder);
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 256; exec \"$@\"' -";
  sagefe(folder, std::string("run deck.dat -q ") + kOptions, killed);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  ASSERT_TRUE(fs::exists(folder / "out/deck_0002.vtu"));
  std::vector<fs::path> files{"deck_0001.vtu", "deck_0002.vtu"};
  for (const char* name : {"deck.lst", "deck.increments.csv", "deck.points.csv", "deck.interfaces.csv",
                           "deck.nodes.csv", "deck.pvd"})
    files.emplace_back(fs::exists(folder / "out" / name) ? std::string(name) : std::string(name) + ".partial");
  for (const fs::path& name : files) {
    const fs::path file = folder / "out" / name;
    const std::string text = read(file);
    ASSERT_GT(text.size(), 20u) << name;
    std::string changed = text, zeros = text;
    changed[20] ^= 1;
    zeros.replace(0, std::min<std::size_t>(4096, zeros.size()), std::min<std::size_t>(4096, zeros.size()),
                  '\0');
    std::vector<std::string> faults{changed, zeros, std::string()};
    // A killed run may have gone on behind its checkpoint, an ended file can't.
    if (name.extension() != ".partial") faults.push_back(text + "a remark of mine\n");
    for (const std::string& damaged : faults) {
      write(file, damaged);
      if (damaged.empty()) fs::remove(file);
      const Finished run = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions);
      EXPECT_EQ(run.exit_code, 2) << name;
      EXPECT_NE(run.err.find(name.stem().string()), std::string::npos) << run.err;
      EXPECT_NE(run.err.find("run again without --restart"), std::string::npos) << run.err;
      write(file, text);
    }
  }
  const fs::path half = folder / "out/deck.points.csv.partial";
  const bool is_half = fs::exists(half);
  if (is_half) write(half, read(half) + "a remark of mine\n");
  const Finished run = sagefe(folder, std::string("run deck.dat --restart ") + kOptions);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err.find("deck.points.csv.partial goes on from its checkpoint: the ") != std::string::npos,
            is_half)
      << run.err;
  expect_equal(results(folder / "out"), whole);
}

// The program's own file is its build: one byte more behind its end makes another build.
TEST(Fault, ACheckpointOfAnotherBuildIsRefused) {
  const fs::path folder = folder_with_deck("build");
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 256; exec \"$@\"' -";
  sagefe(folder, std::string("run deck.dat -q ") + kOptions, killed);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  const Finished run = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions,
                              "bash -c 'cp \"$0\" other && printf x >> other && exec ./other \"$@\"'");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("was written by another build"), std::string::npos) << run.err;
  EXPECT_EQ(sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions).exit_code, 0);
}

// The leak sanitizer can't look at a program that is being traced.
const std::string kStrace = "env ASAN_OPTIONS=detect_leaks=0 strace -o trace.txt ";

// The system calls of a run with a checkpoint an increment: no checkpoint gets its name before the results it
// builds on, and itself, are on the disk; no result gets its name before its bytes are.
TEST(Fault, ResultsReachTheDiskBeforeTheCheckpointThatBuildsOnThem) {
  if (std::system("strace -o /dev/null true > /dev/null 2>&1") != 0) GTEST_SKIP() << "no strace here";
  const fs::path folder = folder_with_deck("order");
  const Finished run = sagefe(folder, std::string("run deck.dat -q ") + kOptions,
                              kStrace + "-y -e trace=write,pwrite64,fsync,rename,ftruncate,unlink");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream trace(read(folder / "trace.txt"));
  std::set<std::string> unsynced;  // files with bytes that are not on the disk
  bool names_unsynced = false;
  int checkpoints = 0, results = 0;
  const std::regex written("^p?write(?:64)?\\(\\d+<([^>]*/out/[^>]*)>"), synced("^fsync\\(\\d+<([^>]*)>"),
      renamed("^rename\\(\"([^\"]*)\", \"([^\"]*)\""), removed("^unlink\\(\"([^\"]*)\"");
  for (std::string line; std::getline(trace, line);) {
    std::smatch part;
    if (line.find("deck.files") != std::string::npos) continue;  // the list itself: the checkpoint has its own
    if (std::regex_search(line, part, written)) unsynced.insert(part[1]);
    if (std::regex_search(line, part, synced)) {
      unsynced.erase(part[1]);
      if (part[1].str().ends_with("/out")) names_unsynced = false;
    }
    if (std::regex_search(line, part, removed)) unsynced.erase((folder / part[1].str()).string());
    if (!std::regex_search(line, part, renamed)) continue;
    const std::string from = (folder / part[1].str()).string(), to = (folder / part[2].str()).string();
    if (to.ends_with("deck.restart")) {
      ++checkpoints;
      EXPECT_TRUE(unsynced.empty()) << *unsynced.begin() << " is written, but not on the disk";
      EXPECT_FALSE(names_unsynced) << "a result has its name, but that is not on the disk";
      continue;
    }
    ++results;
    names_unsynced = true;
    if (unsynced.erase(from) > 0) unsynced.insert(to);
    const bool gone_on_with = to.ends_with(".lst") || to.ends_with(".csv") || to.ends_with(".pvd");
    EXPECT_FALSE(gone_on_with && unsynced.contains(to))
        << to << " has its name before its bytes are on the disk";
  }
  EXPECT_GE(checkpoints, 10);
  EXPECT_GE(results, 30);
  EXPECT_TRUE(unsynced.empty()) << *unsynced.begin() << " has its name for good, but is not on the disk";
}

// A run shorter than the time between checkpoints waits for no disk.
TEST(Fault, ShortRunsDoNotWaitForTheDisk) {
  if (std::system("strace -o /dev/null true > /dev/null 2>&1") != 0) GTEST_SKIP() << "no strace here";
  const fs::path folder = folder_with_deck("short");
  ASSERT_EQ(sagefe(folder, "run deck.dat -q --vtu", kStrace + "-e trace=fsync,fdatasync,sync").exit_code, 0);
  EXPECT_EQ(read(folder / "trace.txt").find("sync("), std::string::npos);
}

// A deck named deck.2 in the same folder is none of its business.
TEST(Fault, FilesOfAnotherRunAreNotMissed) {
  const fs::path folder = folder_with_deck("neighbour");
  const std::map<std::string, std::string> whole = undisturbed(folder);
  fs::create_directory(folder / "out");
  write(folder / "out/deck.2.lst.partial", "a neighbour's listing");
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 256; exec \"$@\"' -";
  sagefe(folder, std::string("run deck.dat -q ") + kOptions, killed);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  fs::remove(folder / "out/deck.2.lst.partial");
  const Finished run = sagefe(folder, std::string("run deck.dat -q --restart ") + kOptions);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_equal(results(folder / "out"), whole);
}

// Ctrl-C as a shell sends it, and what a queue sends: the increment in hand is finished, a checkpoint is left,
// and the decks behind are not begun.
TEST(Fault, InterruptedAndRestarted) {
  const fs::path folder = empty_folder("interrupted");
  write(folder / "deck.dat", deck_text(300));
  write(folder / "next.dat", deck_text());
  const std::string options = "--nodes --points --picture stress_yy --tables all";
  ASSERT_EQ(sagefe(folder, "run deck.dat -q -o whole " + options).exit_code, 0);
  const auto whole = results(folder / "whole");
  for (const char* name : {"INT", "TERM"}) {
    SCOPED_TRACE(name);
    Finished run;
    // As soon as the first deck has begun to write; again where a busy machine delayed the signal beyond its end.
    // set -m: without it a shell's child ignores SIGINT.
    for (int attempt = 0; attempt < 5 && run.err.find("\ndeck.dat: interrupted") == std::string::npos;
         ++attempt) {
      fs::remove_all(folder / "out");
      run = sagefe(folder, "run deck.dat next.dat " + options,
                   fmt::format(R"(timeout 120 bash -c 'set -m; "$0" "$@" & child=$!
                                 while [ ! -e out/deck.lst.partial ]; do sleep 0.005; done
                                 kill -{} $child; wait $child')",
                               name));
    }
    ASSERT_EQ(run.exit_code, 5) << run.err;
    EXPECT_NE(run.err.find("deck.dat: interrupted: stopped as asked, with 0 of 1 stages and "),
              std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("the same command with --restart goes on from out/deck.restart"), std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("next.dat: not run"), std::string::npos) << run.err;
    EXPECT_TRUE(fs::exists(folder / "out/deck.restart"));
    EXPECT_FALSE(fs::exists(folder / "out/next.lst"));
    ASSERT_EQ(sagefe(folder, "run deck.dat -q --restart " + options).exit_code, 0);
    expect_equal(results(folder / "out"), whole);
  }
}

// Both decks under way have checkpoints, the third is named; one signal reaches each once.
TEST(Fault, SeveralDecksAtATimeAreInterruptedToo) {
  const fs::path folder = empty_folder("interrupted_jobs");
  for (const char* name : {"a.dat", "b.dat", "c.dat"}) write(folder / name, deck_text(99999));
  const Finished run = sagefe(folder, "run a.dat b.dat c.dat --jobs 2",
                              R"(timeout 120 bash -c 'set -m; "$0" "$@" & child=$!
                                 while [ ! -e out/a.lst.partial -o ! -e out/b.lst.partial ]; do sleep 0.02; done
                                 kill -INT $child; wait $child')");
  EXPECT_EQ(run.exit_code, 5) << run.err;
  for (const char* deck : {"a", "b"}) {
    EXPECT_NE(run.err.find(fmt::format("the same command with --restart goes on from out/{}.restart", deck)),
              std::string::npos)
        << run.err;
    EXPECT_TRUE(fs::exists(folder / fmt::format("out/{}.restart", deck)));
  }
  EXPECT_NE(run.err.find("c.dat: not run, interrupted before"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "out/c.lst"));
}

// The decks under way end with it, with their checkpoints.
TEST(Fault, SeveralDecksAtATimeEndWithAProcessThatIsKilled) {
  const fs::path folder = empty_folder("killed_jobs");
  for (const char* name : {"a.dat", "b.dat"}) write(folder / name, deck_text(99999));
  sagefe(folder, "run a.dat b.dat --jobs 2",
         R"(timeout 120 bash -c '"$0" "$@" & child=$!
            while [ ! -e out/a.lst.partial -o ! -e out/b.lst.partial ]; do sleep 0.02; done
            kill -KILL $child; wait $child
            while [ -e out/a.lst.partial -o -e out/b.lst.partial ]; do sleep 0.02; done')");
  for (const char* deck : {"a", "b"}) {
    EXPECT_TRUE(fs::exists(folder / fmt::format("out/{}.restart", deck)));
    EXPECT_NE(read(folder / fmt::format("out/{}.lst", deck)).find("RUN STOPPED, NOT COMPLETE"),
              std::string::npos);
  }
}

// What is complete is compared, and nothing stays behind under a temporary name, the deck's reports neither.
TEST(Fault, ComparisonsAreInterruptedToo) {
  const fs::path folder = empty_folder("interrupted_comparison");
  std::string deck = read(fs::path(SAGE_SOURCE_DIR) / "legacy_inputs/hyperbolic/strip_footing/deck.dat");
  const std::string increments = "   40    0    0   10";
  ASSERT_NE(deck.find(increments), std::string::npos);
  deck.replace(deck.find(increments), increments.size(), "99999    0    0    0");
  write(folder / "deck.dat", deck);
  const Finished run = sagefe(folder, "compare deck.dat --both",
                              R"(timeout 120 sh -c '"$0" "$@" & child=$!
                                 while ! ls out/deck.a.*.partial > /dev/null 2>&1; do sleep 0.02; done
                                 sleep 0.2; kill -TERM $child; wait $child')");
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("sagefe compare: interrupted"), std::string::npos) << run.err;
  for (const auto& entry : fs::directory_iterator(folder / "out"))
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
  EXPECT_NE(read(folder / "out/deck.a.report1.csv").find("RUN STOPPED, NOT COMPLETE"), std::string::npos);
  EXPECT_NE(run.out.find("not run, interrupted before"), std::string::npos) << run.out;
}

// Nothing that could go on is left, and a message says so.
TEST(Fault, InterruptedWithoutCheckpoints) {
  const fs::path folder = empty_folder("interrupted_without");
  write(folder / "deck.dat", deck_text(99999));
  // As soon as the run has begun to write: on a slow machine too it then knows what to do with the signal.
  const Finished run = sagefe(folder, "run deck.dat --checkpoint -1",
                              R"(timeout 120 sh -c '"$0" "$@" & child=$!
                                 while [ ! -e out/deck.lst.partial ]; do sleep 0.02; done
                                 kill -TERM $child; wait $child')");
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("there is no checkpoint"), std::string::npos) << run.err;
  EXPECT_NE(read(folder / "out/deck.lst").find("RUN STOPPED, NOT COMPLETE"), std::string::npos);
}

TEST(Fault, WithoutACheckpointARestartIsARun) {
  const fs::path folder = folder_with_deck("nothing_to_restart");
  const Finished run = sagefe(folder, "run deck.dat --restart");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.err.find("no checkpoint"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace sage::test

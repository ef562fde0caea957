// Plug-ins: what one brings works as if it were the program's own, and what is none, or a wrong one, is refused
// with a line that says why.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sstream>

#include "sage/app/plugins.hpp"
#include "sage/core/plugin.hpp"
#include "tests/regression/program.hpp"

namespace sage::test {
namespace {

namespace fs = std::filesystem;

const std::string kPlugins = SAGE_TEST_PLUGINS;
const std::string kOwn = kPlugins + "/own_plugin.so";
const std::string kWrong = kPlugins + "/wrong_plugin.so";

// A square of layered soil, pressed by 100: see install_and_use.cmake for the numbers.
std::string layered_deck(const std::string& head = "") {
  return head + R"(layered soil, pressed across its layers
m       kN      kPa
    1    0    4    0    1    1    1    2    0    1    1
    1                  0.        0.
    2                  1.        0.
    3                  0.        1.
    4                  1.        1.
    1 1000    5
     2000.     1000.       0.2       0.3      400.
    1    1    0    1
    1    1    1    2    4    3
    1    2    1    0    1
    1    3    2    1    0
press
    2    0    0    0    0    0    1
    1    3                100.      100.
    2    0    4    4    1    1
END
)";
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << "\nin:\n" << text;
}

// Exit code 1, one line that begins as told and has these words; nothing on standard output.
void expect_refused(const fs::path& folder, const std::string& file, const std::vector<std::string>& words,
                    const std::string& fault = "", const std::string& before = "") {
  SCOPED_TRACE(fault.empty() ? file : fault);
  const std::string under = fault.empty() ? "timeout 300" : "env 'SAGE_TEST_FAULT=" + fault + "' timeout 300";
  const Finished run = sagefe(folder, "list materials " + before + " --plugin '" + file + "'", under);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(run.err.starts_with("sagefe: plug-in " + file + " ")) << run.err;
  EXPECT_EQ(count(run.err, "\n"), 1) << run.err;
  expect_words(run.err, words);
}

std::string patched(std::string bytes, const std::string& from, const std::string& to) {
  EXPECT_EQ(from.size(), to.size());
  EXPECT_NE(bytes.find(from), std::string::npos) << from;
  for (std::size_t at = 0; (at = bytes.find(from, at)) != std::string::npos; at += to.size())
    bytes.replace(at, to.size(), to);
  return bytes;
}

TEST(Plugins, PiecesAreListedAndRun) {
  const fs::path folder = empty_folder("plugin_run");
  const auto list = [&](const std::string& what) {
    return sagefe(folder, "list " + what + " --plugin " + kOwn).out;
  };
  expect_words(list("materials"), {"1000  layered (solid)", "   1  linear_elastic"});
  expect_words(list("elements"), {"1040  tri10"});
  expect_words(list("solvers"), {"1090  sparse_lu"});
  expect_words(list("fields"), {"stress_ratio [-] sigma_zz / sigma_yy"});
  expect_words(list("plugins"),
               {"own 1.0 by the tests; materials 1000; elements 1040; solvers 1090; fields stress_ratio"});
  write(folder / "deck.dat", layered_deck());
  const Finished run = sagefe(
      folder, "run deck.dat -o out --plugin " + kOwn + " --solver sparse_lu --field stress_ratio --points");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_words(run.out, {"-0.082 ", "solver      sparse_lu"});
  expect_words(read(folder / "out/deck.points.csv"), {",stress_ratio[-]", ",0.6\n"});
  for (const char* command : {"check deck.dat", "echo deck.dat", "convert deck.dat out/again.dat",
                              "compare --both deck.dat -o out"}) {
    const Finished other = sagefe(folder, std::string(command) + " --plugin=" + kOwn);
    EXPECT_EQ(other.exit_code, 0) << command << other.err;
  }
}

TEST(Plugins, DecksBesideEachOther) {
  const fs::path folder = empty_folder("plugin_jobs");
  std::string decks;
  for (const char* name : {"a.dat", "b.dat", "c.dat"}) {
    write(folder / name, layered_deck());
    decks += std::string(" ") + name;
  }
  const Finished run = sagefe(folder, "run --jobs 3 -o out --plugin " + kOwn + decks);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(count(run.out, "-0.082 "), 3) << run.out;
}

TEST(Plugins, ADeckNamesWhatItNeedsAndLoadsNothing) {
  const fs::path folder = empty_folder("plugin_named");
  write(folder / "deck.dat", layered_deck("* a comment\n* plugin: own\n"));
  const Finished without = sagefe(folder, "check deck.dat");
  EXPECT_EQ(without.exit_code, 2);
  expect_words(without.err, {"deck.dat:2:11-13: error: the deck needs the plug-in own", "--plugin"});
  EXPECT_EQ(sagefe(folder, "check deck.dat --plugin " + kOwn).exit_code, 0);
  EXPECT_EQ(sagefe(folder, "convert deck.dat again.dat --plugin " + kOwn).exit_code, 0);
  expect_words(read(folder / "again.dat"), {"* plugin: own\n"});
  write(folder / "plain.dat", layered_deck());
  expect_words(sagefe(folder, "check plain.dat").err,
               {"law 1000 is unknown", "codes from 1000 are of plug-ins, which --plugin LIBRARY loads"});
  write(folder / "blank.dat", layered_deck("* plugin:\n"));
  expect_words(sagefe(folder, "check blank.dat").err, {"blank.dat:1:", "the name of a plug-in is missing"});
}

// A checkpoint goes on with the plug-in that it was computed with, and with no other.
TEST(Plugins, ACheckpointNamesThem) {
  const fs::path folder = empty_folder("plugin_restart");
  write(folder / "deck.dat", patched(layered_deck(), "press\n    2", "press\n 2000"));
  fs::copy_file(kOwn, folder / "own.so");
  const std::string command = "run deck.dat -q -o out --no-listing --checkpoint 0 --plugin ./own.so";
  // The table of increments reaches the limit on a file's size.
  const std::string killed = "bash -c 'trap \"\" XFSZ; ulimit -f 32; exec \"$@\"' -";
  EXPECT_EQ(sagefe(folder, command, killed).exit_code, 4);
  ASSERT_TRUE(fs::exists(folder / "out/deck.restart"));
  write(folder / "own.so", read(kOwn) + "built anew");
  const Finished other = sagefe(folder, command + " --restart");
  EXPECT_EQ(other.exit_code, 2) << other.err;
  expect_words(other.err, {"belongs to another run", "a plug-in"});
  write(folder / "own.so", read(kOwn));
  EXPECT_EQ(sagefe(folder, command + " --restart").exit_code, 0);
}

TEST(Plugins, ConformRunsTheSuites) {
  const fs::path folder = empty_folder("plugin_conform");
  const Finished good = sagefe(folder, "conform --only Trial --plugin " + kWrong + " " + kOwn, "timeout 900");
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  const Finished sound = sagefe(folder, "conform " + kWrong);
  EXPECT_EQ(sound.exit_code, 3) << sound.out << sound.err;
  expect_words(sound.out, {"wrong 0.1 by the tests: 1 laws, 0 elements, 0 solvers, 0 fields",
                           "FAILS  law 1001 rigid trial 1: no hidden units", "verdict: does NOT conform"});
}

// One source, in the program and in a library of its own.
TEST(Plugins, ALawOfTheProgramAsAPlugin) {
  const fs::path folder = empty_folder("plugin_cam_clay");
  const std::string library = kPlugins + "/cam_clay_plugin.so";
  const Finished conform = sagefe(folder, "conform " + library);
  EXPECT_EQ(conform.exit_code, 0) << conform.out << conform.err;
  expect_words(conform.out,
               {"trial 1: 17 checks, all hold", "trial 2: 17 checks, all hold", "verdict: conforms"});
  const auto curve = [&](const std::string& law) {
    return sagefe(folder,
                  "drive --law NAME:" + law +
                      " --set M=1.2 --set lambda=.2 --set kappa=.04 --set specific_volume=2 --set nu=.3"
                      " --set ocr=8 --test triaxial_compression --pressure 100 --to .1 --csv - --plugin " +
                      library)
        .out;
  };
  const auto rows = [](const std::string& text) {
    return text.substr(std::min(text.find("case,"), text.size()));
  };
  const std::string own = rows(curve("modified_cam_clay"));
  EXPECT_FALSE(own.empty());
  EXPECT_EQ(rows(curve("cam_clay")), own);
}

TEST(Plugins, ConformSaysWhereAPieceCrashesAndWhatIsNotTried) {
  const fs::path folder = empty_folder("plugin_crash");
  const Finished crash = sagefe(folder, "conform " + kWrong, "env 'SAGE_TEST_FAULT=crash in a law'");
  EXPECT_NE(crash.exit_code, 0);
  expect_words(crash.out, {"crashed in the check: law 1001 rigid trial 1: "});
  const Finished untried = sagefe(folder, "conform " + kWrong, "env 'SAGE_TEST_FAULT=no trials'");
  EXPECT_EQ(untried.exit_code, 3);
  expect_words(untried.out, {"law 1001 rigid: not tried", "verdict: does NOT conform"});
}

TEST(WrongPlugins, FilesThatAreNoPlugin) {
  const fs::path folder = empty_folder("plugin_files");
  const std::string good = read(kWrong);
  expect_refused(folder, "none.so", {"does not exist"});
  fs::create_directory(folder / "folder.so");
  expect_refused(folder, "folder.so", {"is a folder"});
  write(folder / "empty.so", "");
  expect_refused(folder, "empty.so", {"is empty"});
  write(folder / "text.so", "to be, or not to be");
  expect_refused(folder, "text.so", {"no ELF file"});
  mkfifo((folder / "pipe.so").c_str(), 0600);
  expect_refused(folder, "pipe.so", {"is no file"});
  fs::create_symlink("loop.so", folder / "loop.so");
  expect_refused(folder, "loop.so", {"can't be opened: Too many levels of symbolic links"});
  write(folder / "half.so", good.substr(0, good.size() / 2));
  expect_refused(folder, "half.so", {"is cut short"});
  write(folder / "start.so", good.substr(0, 40));
  expect_refused(folder, "start.so", {"is cut short"});
  write(folder / "page.so", good.substr(0, 4096));
  expect_refused(folder, "page.so", {"is cut short"});
  expect_refused(folder, SAGE_EXECUTABLE, {"section .sage_plugin"});
  if (geteuid() != 0) {
    write(folder / "closed.so", good);
    chmod((folder / "closed.so").c_str(), 0);
    expect_refused(folder, "closed.so", {"can't be opened: Permission denied"});
  }
  const auto with_byte = [&](std::size_t at, char value, const char* words) {
    std::string bytes = good;
    bytes[at] = value;
    write(folder / "header.so", bytes);
    expect_refused(folder, "header.so", {words});
  };
  with_byte(4, 1, "of 32 bits");                           // EI_CLASS
  with_byte(5, 2, "another kind of processor");            // EI_DATA
  with_byte(18, static_cast<char>(0xb7), "another kind");  // e_machine: AArch64
  with_byte(16, 1, "no shared library");                   // e_type: an object
}

TEST(WrongPlugins, LibrariesThatLackSomething) {
  const fs::path folder = empty_folder("plugin_lacks");
  const std::string good = read(kWrong);
  write(folder / "section.so", patched(good, ".sage_plugin", ".sage_pluggy"));
  expect_refused(folder, "section.so", {"section .sage_plugin"});
  write(folder / "entry.so", patched(good, "sage_plugin_v1", "sage_plugin_v9"));
  expect_refused(folder, "entry.so", {"has no function sage_plugin_v1"});
  write(folder / "needs.so", patched(good, "libstdc++.so.6", "libstdc++.so.x"));
  expect_refused(folder, "needs.so", {"can't be loaded", "libstdc++.so.x"});
  write(folder / "symbol.so", patched(good, "__cxa_throw", "__cxa_thrOw"));
  expect_refused(folder, "symbol.so", {"can't be loaded", "__cxa_thrOw"});
}

// Every field of the text: the refusal names it and both values, before anything of the library runs.
TEST(WrongPlugins, OfAnotherBuild) {
  const fs::path folder = empty_folder("plugin_abi");
  const std::string good = read(kWrong);
  std::istringstream parts{std::string(plugin_abi.text.data())};
  int fields = 0;
  for (std::string part; std::getline(parts, part, ';'); ++fields) {
    const std::string name = part.substr(0, part.find('=')), value = part.substr(part.find('=') + 1);
    std::string other = value;
    other.back() = other.back() == '7' ? '8' : '7';
    write(folder / "other.so", patched(good, part + ";", name + "=" + other + ";"));
    expect_refused(folder, "other.so",
                   {name + " is " + other + " in the plug-in and " + value + " in the program"},
                   "crash in a constructor");
  }
  EXPECT_GE(fields, 20);
  write(folder / "less.so", patched(good, "sanitizer=", "sanitized="));
  expect_refused(folder, "less.so", {"it says nothing of \"sanitizer\", the program has "});
  expect_refused(folder, kPlugins + "/old_strings_plugin.so",
                 {"strings is before C++11 in the plug-in and C++11 in the program"});
  expect_refused(folder, kPlugins + "/other_language_plugin.so",
                 {"C++ is 2", " in the plug-in and 202002 in the program"});
  // One virtual function more in Law changes no size.
  expect_refused(
      folder, kPlugins + "/more_virtuals_plugin.so",
      {"hash of the headers in sage/core is ", " in the plug-in and " SAGE_HEADER_HASH " in the program"});
}

TEST(WrongPlugins, WhatTheyGive) {
  const fs::path folder = empty_folder("plugin_gives");
  const std::vector<std::pair<std::string, std::vector<std::string>>> faults = {
      {"null", {"sage_plugin_v1() returned a null pointer"}},
      {"throws in a constructor", {"out of a constructor"}},
      {"throws at once", {"out of the entry point"}},
      {"throws a number at once", {"while it is loaded"}},
      {"short", {"of 16 bytes, the program's has 56"}},
      {"other api", {"version 99 of the plug-in interface, the program has 1"}},
      {"no name", {"gives no name"}},
      {"empty name", {"gives an empty name"}},
      {"name of two words", {"\"two words\"", "letters, digits"}},
      {"no version", {"gives no version"}},
      {"no author", {"gives no author"}},
      {"no abi", {"gives no abi"}},
      {"other abi", {"compiler ABI"}},
      {"no fill", {"no function fill"}},
      {"throws", {"threw an exception out of fill: out of fill"}},
      {"throws a number", {"threw what is no std::exception"}},
      {"error text", {"can't give its pieces: no licence today"}},
      {"error without a text", {"can't give its pieces: error 7"}},
      {"the same twice", {"1001 rigid_too clashes with 1001 rigid"}},
      {"code of the program", {"law 3 rigid: codes below 1000 are the program's own"}},
      {"name of the program",
       {"law 1001 drucker_prager, which clashes with law 3 drucker_prager of sagefe itself"}},
      {"field of the program", {"field stress is taken"}},
      {"law without a maker", {"law 1001 rigid, which has no function that makes it"}},
  };
  for (const auto& [fault, words] : faults) expect_refused(folder, kWrong, words, fault);
}

TEST(WrongPlugins, OnesThatClashWithEachOther) {
  const fs::path folder = empty_folder("plugin_clash");
  const std::string own = "--plugin " + kOwn;
  EXPECT_EQ(sagefe(folder, "list materials " + own + " --plugin " + kWrong).exit_code, 0);
  expect_refused(folder, kWrong,
                 {"law 1000 rigid, which clashes with law 1000 layered of plug-in own (", "own_plugin.so)"},
                 "code of the other", own);
  expect_refused(folder, kWrong, {"field stress_ratio, which clashes with plug-in own ("}, "field of the other",
                 own);
  expect_refused(folder, kWrong, {"is called own, as ", "own_plugin.so is"}, "name of the other", own);
  expect_refused(folder, kOwn, {"is given twice"}, "", own);
}

// In a process of their own: the program lives on to say so.
TEST(WrongPlugins, OnesThatCrash) {
  const fs::path folder = empty_folder("plugin_crashes");
  // A sanitizer ends a crashed process with an exit code of its own.
  for (const char* fault : {"crash in a constructor", "abort in a constructor", "crash in fill"})
    expect_refused(folder, kWrong, {"while it is loaded"}, fault);
  expect_refused(folder, kWrong, {"ends the program while it is loaded, with exit code 4"},
                 "exit in a constructor");
}

// With --json a refusal is a document, too.
TEST(WrongPlugins, AreRefusedInJson) {
  const fs::path folder = empty_folder("plugin_json");
  for (const char* command : {"run deck.dat --json --plugin none.so", "list materials --umat none.so --json"}) {
    const Finished run = sagefe(folder, command);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_TRUE(run.out.starts_with("{\n")) << run.out;
    expect_words(run.out, {"\"exit_code\": 1", "none.so", "does not exist"});
  }
}

TEST(New, NamesAndFoldersThatCantBe) {
  const fs::path folder = empty_folder("new_names");
  const auto refuse = [&](const std::string& arguments, const std::string& words, int code = 1) {
    const Finished run = sagefe(folder, "new " + arguments);
    EXPECT_EQ(run.exit_code, code) << arguments;
    EXPECT_EQ(run.out, "");
    expect_words(run.err, {words});
  };
  for (const char* name :
       {"''", "Clay", "1clay", "a/b", "../clay", "'my clay'", "a_name_of_more_than_thirty_letters"})
    refuse(std::string("law ") + name, "lower-case letters, digits and _");
  refuse("law test", "CMake has a target of this name");
  refuse("umat all", "CMake has a target of this name");
  refuse("law solid", "the headers have a class of this name");
  refuse("law mohr_coulomb", "sagefe has law 4 of this name");
  refuse("element quad4", "of this name");
  refuse("solver mine", "law,element,umat");
  fs::create_directory(folder / "there");
  write(folder / "there/file", "");
  write(folder / "file", "");
  refuse("law there", "there is there already and not empty");
  refuse("law clay -o file", "file", 4);
  EXPECT_EQ(sagefe(folder, "new umat mohr_coulomb").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "mohr_coulomb/mohr_coulomb.f"));
}

TEST(PluginOption, IsReadBeforeTheOthers) {
  const auto files = [](std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    return app::values_on(static_cast<int>(arguments.size()), arguments.data(), "--plugin");
  };
  EXPECT_EQ(files({"sagefe", "run", "--plugin", "a.so", "deck", "--plugin=b.so"}),
            (std::vector<std::string>{"a.so", "b.so"}));
  EXPECT_EQ(files({"sagefe", "run", "--", "--plugin", "a.so"}), std::vector<std::string>{});
  EXPECT_EQ(files({"sagefe", "run", "--plugin"}), std::vector<std::string>{});
  EXPECT_EQ(files({"sagefe", "run", "--plugins", "a.so"}), std::vector<std::string>{});
}

}  // namespace
}  // namespace sage::test

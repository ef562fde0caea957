// The module of library solvers is found where it may be, and nothing else is taken for it.
#include "solvers/library_module.hpp"

#include <elf.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "sage/messages/error.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage {
namespace {

constexpr char kNowhere[] = "/nowhere/libsage_library_solvers.so";
const std::string kNoLibrary = __FILE__;

TEST(LibraryModule, RefusesANameItDoesNotKnow) {
  EXPECT_THROW(make_library_solver("pardiso"), AnalysisError);
}

TEST(LibraryModule, ThePlaceThatTheUserNamesComesFirst) {
  unsetenv("SAGE_SOLVER_MODULE");
  const std::vector<std::string> usual = solver_module_places();
  EXPECT_GE(usual.size(), 2u);
  setenv("SAGE_SOLVER_MODULE", kNowhere, 1);
  std::vector<std::string> places = solver_module_places();
  unsetenv("SAGE_SOLVER_MODULE");
  EXPECT_EQ(places.front(), kNowhere);
  places.erase(places.begin());
  EXPECT_EQ(places, usual);
}

// A file that is not there, one that is no library, libraries without one or both of the functions, and a
// module of another version stand before the right one.
TEST(LibraryModule, PassesOverWhatIsNotTheModule) {
  std::vector<std::string> places{kNowhere, kNoLibrary, OTHER_VERSION, NO_VERSION, NO_MAKER};
  const std::vector<std::string> usual = solver_module_places();
  places.insert(places.end(), usual.begin(), usual.end());
  const std::unique_ptr<LinearSolver> solver(load_solver_module(places)("umfpack"));
  ASSERT_NE(solver, nullptr);
  EXPECT_EQ(solver->traits().name, "umfpack");
}

// The version is read in the file: nothing of a module that does not belong here runs.
TEST(LibraryModule, RunsNothingOfAForeignModule) {
  unsetenv("SAGE_FOREIGN_MODULE_RAN");
  EXPECT_THROW(load_solver_module({OTHER_VERSION, NO_VERSION}), AnalysisError);
  EXPECT_EQ(std::getenv("SAGE_FOREIGN_MODULE_RAN"), nullptr);
}

TEST(LibraryModule, ListsWhatItTriedAndWhyItWasRefused) {
  try {
    load_solver_module({kNowhere, kNoLibrary, OTHER_VERSION, NO_VERSION, NO_MAKER});
    FAIL() << "loaded";
  } catch (const AnalysisError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(std::string("\n  ") + kNowhere + "\n"), std::string::npos) << text;
    for (const std::string& other : {kNoLibrary, std::string(OTHER_VERSION), std::string(NO_VERSION)})
      EXPECT_NE(text.find("\n  " + other + ": belongs to another version"), std::string::npos) << text;
    EXPECT_NE(text.find(std::string("\n  ") + NO_MAKER + ": has no sage_make_library_solver"),
              std::string::npos)
        << text;
  }
}

// The section that the tests look for, in a module whose section headers end the file and whose names are the last.
struct WholeModule {
  std::string bytes;
  Elf64_Ehdr head;
  std::uint16_t place = 0;  // of the section

  WholeModule() {
    std::ifstream in(OTHER_VERSION, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
    std::memcpy(&head, bytes.data(), sizeof head);
    const std::uint64_t names = section(head.e_shstrndx).sh_offset;
    while (std::string(bytes.data() + names + section(place).sh_name) != SAGE_SOLVER_MODULE_SECTION) ++place;
  }
  Elf64_Shdr section(std::size_t i) const {
    Elf64_Shdr one;
    std::memcpy(&one, bytes.data() + head.e_shoff + i * sizeof one, sizeof one);
    return one;
  }
};

class DamagedModule : public testing::Test {
 protected:
  std::string section_of(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary) << bytes;
    return elf_section(file_, SAGE_SOLVER_MODULE_SECTION);
  }
  std::string section_of(const Elf64_Ehdr& head) const {
    std::string bytes = whole_.bytes;
    std::memcpy(bytes.data(), &head, sizeof head);
    return section_of(bytes);
  }

  const WholeModule whole_;
  const std::string mark_{"sage-solvers-0\0", 15};
  const std::filesystem::path file_ = test::scratch_folder("elf") / "damaged.so";
  std::mt19937_64 random_{7};
};

TEST_F(DamagedModule, WholeHasItsSectionAndNoOther) {
  EXPECT_EQ(section_of(whole_.bytes), mark_);
  EXPECT_EQ(elf_section(file_, ".no_such_section"), "");
  ASSERT_EQ(whole_.head.e_shoff + whole_.head.e_shnum * sizeof(Elf64_Shdr), whole_.bytes.size());
  ASSERT_EQ(whole_.head.e_shstrndx + 1, whole_.head.e_shnum);
}

// The header of the names ends the file: no file that is cut short has a section.
TEST_F(DamagedModule, CutShortHasNoSections) {
  for (int trial = 0; trial < 150; ++trial) {
    const std::size_t size = trial == 0 ? whole_.bytes.size() - 1 : random_() % whole_.bytes.size();
    EXPECT_EQ(section_of(whole_.bytes.substr(0, size)), "") << size;
  }
}

// Of the fields of the header, one at a time: tables that lie elsewhere, fewer sections, and what nobody reads.
TEST_F(DamagedModule, FieldsOfTheHeader) {
  for (int trial = 0; trial < 50; ++trial) {
    Elf64_Ehdr elsewhere = whole_.head, other_names = whole_.head, fewer = whole_.head, not_read = whole_.head;
    elsewhere.e_shoff = std::max<std::uint64_t>(random_(), whole_.bytes.size());
    EXPECT_EQ(section_of(elsewhere), "") << elsewhere.e_shoff;
    other_names.e_shstrndx = static_cast<std::uint16_t>(whole_.head.e_shnum + random_() % 1000);
    EXPECT_EQ(section_of(other_names), "") << other_names.e_shstrndx;
    fewer.e_shnum = static_cast<std::uint16_t>(random_() % (whole_.head.e_shnum + 1u));
    EXPECT_EQ(section_of(fewer), fewer.e_shnum > whole_.place ? mark_ : "") << fewer.e_shnum;
    not_read.e_type = static_cast<std::uint16_t>(random_());
    not_read.e_entry = random_();
    not_read.e_phoff = random_();
    not_read.e_phnum = static_cast<std::uint16_t>(random_());
    EXPECT_EQ(section_of(not_read), mark_) << trial;
  }
}

// No ELF file of 64 bits.
TEST_F(DamagedModule, AnotherMarkHasNoSections) {
  for (const std::size_t at : {0u, 1u, 2u, 3u, 4u}) {
    std::string other = whole_.bytes;
    other[at] = static_cast<char>(other[at] + 1);
    EXPECT_EQ(section_of(other), "") << at;
  }
}

}  // namespace
}  // namespace sage

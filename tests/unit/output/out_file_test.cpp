#include "sage/output/out_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "sage/core/error.hpp"
#include "tests/unit/output/specimen.hpp"

namespace sage {
namespace {

using std::filesystem::exists;
using test::contents;
using test::fresh_folder;

TEST(OutFile, BearsItsNameOnlyWhenComplete) {
  const auto folder = fresh_folder("rename");
  OutFile file(folder / "a.txt");
  file.text() += "first\n";
  EXPECT_TRUE(exists(folder / "a.txt.partial"));
  EXPECT_FALSE(exists(folder / "a.txt"));
  file.finish();
  EXPECT_FALSE(exists(folder / "a.txt.partial"));
  EXPECT_EQ(contents(folder / "a.txt"), "first\n");
  EXPECT_FALSE(file.open());
}

TEST(OutFile, LeavesThePartialFileWhenNeverFinished) {
  const auto folder = fresh_folder("left");
  { OutFile(folder / "a.txt").text() += "half\n"; }
  EXPECT_FALSE(exists(folder / "a.txt"));
  EXPECT_EQ(contents(folder / "a.txt.partial"), "half\n");
}

TEST(OutFile, KeepsTheOldFileUntilTheNewOneIsComplete) {
  const auto folder = fresh_folder("old");
  write_file(folder / "a.txt", "old\n");
  OutFile file(folder / "a.txt");
  file.text() += "new\n";
  EXPECT_EQ(contents(folder / "a.txt"), "old\n");
  file.finish();
  EXPECT_EQ(contents(folder / "a.txt"), "new\n");
}

TEST(OutFile, WritesMuchAtACheckpoint) {
  const auto folder = fresh_folder("checkpoint");
  OutFile file(folder / "a.txt");
  file.text().assign(300000, 'x');
  file.checkpoint();
  EXPECT_TRUE(file.text().empty());
  EXPECT_EQ(std::filesystem::file_size(folder / "a.txt.partial"), 300000u);
}

TEST(OutFile, FollowsALink) {
  const auto folder = fresh_folder("link");
  write_file(folder / "target.txt", "old\n");
  std::filesystem::create_symlink("target.txt", folder / "a.txt");
  write_file(folder / "a.txt", "new\n");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.txt"));
  EXPECT_EQ(contents(folder / "target.txt"), "new\n");
}

TEST(OutFile, WritesIntoAPipe) {
  const auto pipe = fresh_folder("pipe") / "a.txt";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_file(pipe, "text\n");
  char text[16] = {};
  EXPECT_EQ(read(reader, text, sizeof text), 5);
  EXPECT_STREQ(text, "text\n");
  close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(OutFile, MakesMissingFolders) {
  const auto folder = fresh_folder("missing");
  write_file(folder / "b" / "c" / "a.txt", "deep\n");
  EXPECT_EQ(contents(folder / "b" / "c" / "a.txt"), "deep\n");
}

TEST(OutFile, RefusesAFolderThatIsAFile) {
  const auto folder = fresh_folder("file");
  std::ofstream(folder / "plain") << "x";
  try {
    OutFile file(folder / "plain" / "a.txt");
    FAIL() << "no exception";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot write"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("plain"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Not a directory"), std::string::npos) << error.what();
  }
}

// /dev/full accepts an open and refuses every write, as a full disk does.
TEST(OutFile, ReportsAFullDisk) {
  if (!exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const auto folder = fresh_folder("full");
  std::filesystem::create_symlink("/dev/full", folder / "a.txt.partial");
  OutFile file(folder / "a.txt");
  file.text() += "lost\n";
  try {
    file.finish();
    FAIL() << "no exception";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(exists(folder / "a.txt"));
  EXPECT_NO_THROW(file.finish());  // nothing more is tried
}

TEST(OutFile, ReportsATargetThatCannotBeReplaced) {
  const auto folder = fresh_folder("target");
  std::filesystem::create_directories(folder / "a.txt" / "inside");
  EXPECT_THROW(write_file(folder / "a.txt", "x"), OutputError);
}

}  // namespace
}  // namespace sage

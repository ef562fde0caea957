#include "sage/record/out_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <random>
#include <set>
#include <thread>

#include "sage/core/archive.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/values.hpp"
#include "tests/unit/record/specimen.hpp"

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
    EXPECT_NE(std::string(error.what()).find("plain can't be made"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Not a directory"), std::string::npos) << error.what();
  }
}

// /dev/full accepts an open and refuses every write, as a full disk does.
TEST(OutFile, ReportsAFullDisk) {
  if (!exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const auto folder = fresh_folder("full");
  std::filesystem::create_symlink("/dev/full", folder / "a.txt");
  OutFile file(folder / "a.txt");
  file.text() += "lost\n";
  try {
    file.finish();
    FAIL() << "no exception";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(file.finish());  // nothing more is tried
}

// Before anything is computed.
TEST(OutFile, RefusesAFolderInItsPlace) {
  const auto folder = fresh_folder("target");
  std::filesystem::create_directories(folder / "a.txt" / "inside");
  EXPECT_THROW(OutFile(folder / "a.txt"), OutputError);
  std::filesystem::create_directories(folder / "b.txt.partial");
  EXPECT_THROW(OutFile(folder / "b.txt"), OutputError);
}

TEST(OutFile, FollowsNoLinkThatBearsThePartialName) {
  const auto folder = fresh_folder("planted");
  write_file(folder / "victim", "precious");
  std::filesystem::create_symlink("victim", folder / "a.txt.partial");
  EXPECT_THROW(OutFile(folder / "a.txt"), OutputError);
  std::filesystem::create_symlink("nothing", folder / "b.txt.partial");
  EXPECT_THROW(OutFile(folder / "b.txt"), OutputError);
  EXPECT_FALSE(exists(folder / "nothing"));
  std::filesystem::create_hard_link(folder / "victim", folder / "c.txt.partial");
  EXPECT_THROW(OutFile(folder / "c.txt"), OutputError);
  ASSERT_EQ(mkfifo((folder / "d.txt.partial").c_str(), 0600), 0);
  EXPECT_THROW(OutFile(folder / "d.txt"), OutputError);
  EXPECT_EQ(contents(folder / "victim"), "precious");
}

TEST(OutFile, TakesNoInputsPlace) {
  const auto folder = fresh_folder("input");
  write_file(folder / "deck", "cards");
  std::filesystem::create_symlink("deck", folder / "a.txt");
  keep_input(folder / "deck");
  EXPECT_THROW(OutFile(folder / "deck"), OverInput);
  EXPECT_THROW(OutFile(folder / "a.txt"), OverInput);
  EXPECT_NO_THROW(OutFile(folder / "b.txt"));
  EXPECT_EQ(contents(folder / "deck"), "cards");
}

TEST(OutFile, NoticesThatItWasRemovedOrRenamed) {
  for (const bool renamed : {false, true}) {
    const auto folder = fresh_folder("gone") / "out";
    OutFile file(folder / "a.txt");
    file.text() = "text\n";
    if (renamed)
      std::filesystem::rename(folder, folder.parent_path() / "elsewhere");
    else
      std::filesystem::remove_all(folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    EXPECT_THROW(file.checkpoint(), OutputError);
    EXPECT_FALSE(file.open());
  }
}

// What a checkpoint goes on from is compared by its bytes, not by its length.
// As where the file system has no locks: neither gets the name for what both have written.
TEST(OutFile, NoticesThatAnotherHasWrittenIntoIt) {
  const std::filesystem::path file = fresh_folder("out_file_mixed") / "results.csv";
  OutFile one(file), other(file);
  one.text() = "of one\n";
  one.flush();
  other.text() = "of another, which is longer\n";
  other.flush();
  one.text() = "the rest\n";
  EXPECT_THROW(one.finish(), OutputError);
  EXPECT_THROW(other.finish(), OutputError);
  EXPECT_FALSE(exists(file));
}

TEST(OutFile, GoesOnOnlyFromWhatWasWritten) {
  const auto folder = fresh_folder("resumed");
  Archive saved;
  {
    OutFile file(folder / "a.txt");
    file.text() = "first line\n";
    file.exchange(saved);
    file.text() = "lost\n";
  }
  const auto resume = [&] {
    OutFile file(folder / "a.txt");
    Archive archive(saved.bytes());
    file.exchange(archive);
    file.text() = "second line\n";
    file.finish();
  };
  ASSERT_EQ(contents(folder / "a.txt.partial"), "first line\nlost\n");
  std::ofstream(folder / "a.txt.partial") << "First line\nlost\n";
  EXPECT_THROW(resume(), InputError);
  std::ofstream(folder / "a.txt.partial") << "first line\nlost\n";
  resume();
  EXPECT_EQ(contents(folder / "a.txt"), "first line\nsecond line\n");
  // A run that an error stopped has ended its file, and another has spoilt the other one since.
  std::ofstream(folder / "a.txt.partial") << "something else and longer\n";
  resume();
  EXPECT_EQ(contents(folder / "a.txt"), "first line\nsecond line\n");
}

// Small and large values, past the length of which an archive sums at once.
TEST(Archive, SumsWhatItWouldKeep) {
  Archive bytes, sum = Archive::for_sum();
  for (int i = 0; i < 40; ++i) {
    std::vector<double> list(static_cast<std::size_t>(i % 7 == 0 ? 9000 : 5 * i), 0.5 * i);
    std::string text(static_cast<std::size_t>(i), 'a');
    for (Archive* archive : {&bytes, &sum}) {
      (*archive)(i);
      (*archive)(list);
      (*archive)(text);
    }
    EXPECT_EQ(sum.sum(), checksum(bytes.bytes())) << i;
  }
  EXPECT_LT(sum.bytes().size(), bytes.bytes().size() / 4);
}

TEST(Checksum, DoesNotDependOnThePieces) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += static_cast<char>(i * i % 251);
  const std::uint64_t whole = checksum(text);
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    Checksum sum;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t piece = std::min<std::size_t>(random() % 20, text.size() - at);
      sum.add(std::string_view(text).substr(at, piece));
      at += piece;
    }
    EXPECT_EQ(sum.value(), whole);
    EXPECT_EQ(sum.bytes(), text.size());
  }
}

// Every change of one byte, zeros at the end, and exchanged words are seen.
TEST(Checksum, SeesEveryChangedByte) {
  const std::string text(100, '\0');
  std::set<std::uint64_t> sums{checksum(text)};
  for (std::size_t at = 0; at < text.size(); ++at)
    for (int byte = 1; byte < 256; ++byte) {
      std::string changed = text;
      changed[at] = static_cast<char>(byte);
      EXPECT_TRUE(sums.insert(checksum(changed)).second) << at << " " << byte;
    }
  for (std::size_t size = 0; size < 100; ++size)
    EXPECT_TRUE(sums.insert(checksum(text.substr(0, size))).second);
}

TEST(Names, PlainNamesAreUtf8AndLeadBack) {
  EXPECT_EQ(plain_name("caf\xc3\xa9 1"), "caf\xc3\xa9 1");
  EXPECT_EQ(plain_name("caf\xe9\n%"), "caf%E9%0A%25");
  EXPECT_EQ(plain_name("100%", ""), "100%");
  // Too long a form, half a pair, beyond the last character, cut short, no character.
  for (const std::string bad :
       {"\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\xef\xbf\xbf", "\x80"})
    EXPECT_EQ(plain_name(bad).size(), 3 * bad.size()) << bad;
  std::string all;
  for (int byte = 1; byte < 256; ++byte) all += static_cast<char>(byte);
  EXPECT_EQ(name_from_plain(plain_name(all)), all);
  for (const char* spoilt : {"a%", "a%4", "a%4x"}) EXPECT_FALSE(name_from_plain(spoilt)) << spoilt;
}

}  // namespace
}  // namespace sage

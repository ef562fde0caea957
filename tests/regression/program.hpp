// The program as a user meets it: decks made of labelled cards, and sagefe run as a child process.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace sage::test {

// Integers in fields of five columns, then reals in fields of ten; "" is a blank field.
std::string card(std::initializer_list<const char*> integers, std::initializer_list<const char*> reals = {});

// A deck whose cards have labels, so that a test can spoil one of them and ask for its line.
class DeckText {
 public:
  DeckText(std::initializer_list<std::pair<std::string, std::string>> cards) : cards_(cards) {}

  // Each returns the changed deck.
  DeckText with(const std::string& label, const std::string& text) const;
  DeckText behind(const std::string& label, const std::string& new_label, const std::string& text) const;
  DeckText without(const std::string& label) const;
  DeckText cut_before(const std::string& label) const;

  int line(const std::string& label) const;  // from 1
  std::vector<std::string> labels() const;
  std::string text(const std::string& line_end = "\n") const;

 private:
  std::size_t index(const std::string& label) const;
  std::vector<std::pair<std::string, std::string>> cards_;
};

// A square of 2 x 2 elements in plane strain, pressed down by its top: units in, lbf, psi.
DeckText block_deck();
// Two square elements, one above the other, with an interface (goodman) between them.
DeckText joint_deck();
// One Mohr-Coulomb element (c = 10, phi = 0) pressed down by 30 per unit length in ten increments; its limit
// is 20.
DeckText collapse_deck();

struct Finished {
  int exit_code = 0;  // 124: did not end within the time that hangs are given
  std::string out, err;
};

// Runs sagefe in a folder, so that messages name the files as they stand in `arguments`.  `under`: a command
// that runs it, e.g. one that kills it.
Finished sagefe(const std::filesystem::path& folder, const std::string& arguments,
                const std::string& under = "timeout 300");

// For `under`: SIGKILL after so many seconds, exit code 137 then.  Ends when the program is gone, and its locks
// with it; `timeout -s KILL` doesn't wait for that.
std::string killed_after(double seconds);
// The same as soon as a file of the folder exists, or after 5 minutes.
std::string killed_once_there_is(const std::string& file);

// An empty folder of the test's own.
std::filesystem::path empty_folder(const std::string& name);
void write(const std::filesystem::path& file, const std::string& text);
std::string read(const std::filesystem::path& file);
// How often `what` stands in `text`.
int count(const std::string& text, const std::string& what);

}  // namespace sage::test

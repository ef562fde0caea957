// From a file to a Deck.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/layout.hpp"

namespace sage {

// A line whose values were moved into their columns.
struct AlignedLine {
  int line = 0;
  std::string text;  // the whole line as it reads then
  std::string
      moves;  // what was moved where, for the user; empty = the line is doubtful and there is not one way alone
  std::string card;  // label of the card
};

struct ReadOptions {
  bool strict = false;  // warnings become errors
  bool whole = true;  // numbers that no card reads are errors; false: warnings, while a layout is being written
  int shown = 50;     // errors (and as many warnings, and notes) that are listed; the rest are counted
  std::vector<AlignedLine>* aligned = nullptr;  // cards beside their columns are moved, and go here
};

// Reads a whole deck, once: the file may be a pipe.  Throws InputError with every mistake found in one pass.
// Without a layout it is the one that the deck names or looks like.
Deck read_deck(const std::string& path, const ReadOptions& options = {});
Deck read_deck(const std::string& path, const Layout& layout, const ReadOptions& options = {});
Deck read_deck_text(std::string text, const std::string& name, const Layout& layout,
                    const ReadOptions& options = {});

// A model as a TOML file (docs/manual/model_file.md) is told by its name.  read_deck() takes its text as it stands, without
// cards: what it says is read when the model is built.
inline constexpr std::string_view kModelFile = "model file";  // Deck::layout
bool is_model_file(std::string_view path);
inline bool is_model_file(const Deck& deck) {
  return deck.layout == kModelFile;
}
Deck read_model_file_text(std::string text, const std::string& name);

// The cards that can be read of a deck with mistakes, which go into `problems`.  Throws InputError only for what
// is no text.
Deck read_what_can_be(std::string text, const std::string& name, const Layout& layout,
                      const ReadOptions& options, Diagnostics& problems);

// Every card as it was read: column ruler, the card, and its fields as name = value.
void echo(const Deck& deck, std::ostream& out);
std::string echo(const Deck& deck);

}  // namespace sage

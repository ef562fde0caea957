// From a file to a Deck.
#pragma once

#include <iosfwd>
#include <string>

#include "sage/deck/deck.hpp"
#include "sage/deck/layout.hpp"

namespace sage {

struct ReadOptions {
  bool strict = false;  // warnings become errors
  int shown = 50;       // errors (and as many warnings, and notes) that are listed; the rest are counted
};

// Reads a whole deck.  Throws InputError with every mistake found in one pass.
Deck read_deck(const std::string& path, const Layout& layout, const ReadOptions& options = {});
Deck read_deck_text(std::string text, const std::string& name, const Layout& layout,
                    const ReadOptions& options = {});

// The layout that the deck in this file names or looks like.  Throws InputError if the file can't be read.
Layout layout_for(const std::string& path);

// Every card as it was read: column ruler, the card, and its fields as name = value.
void echo(const Deck& deck, std::ostream& out);
std::string echo(const Deck& deck);

}  // namespace sage

// What a layout reads of a deck: which columns of which lines, and what it leaves.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/layout.hpp"

namespace sage {

struct FieldCoverage {
  int first_column = 0, last_column = 0;  // of the file, 1-based; 0 = never on a line
  std::size_t filled = 0;                 // values that are not blank
};

// All cards of one kind.
struct CardCoverage {
  std::size_t cards = 0;
  std::size_t lines = 0;
  int first_line = 0, last_line = 0;
  int sample = 0;                     // a line that shows the most: unread characters, else the longest
  std::vector<FieldCoverage> fields;  // one a field of the layout
  std::vector<std::size_t> unread;    // by column: lines that hold a character there which no field reads
  std::size_t unread_lines = 0;
};

struct Coverage {
  std::vector<CardCoverage> cards;  // one a card of the layout
  std::vector<int> no_card;         // lines with characters that no card, heading or comment takes
  std::size_t card_lines = 0, headings = 0, comments = 0, blanks = 0;
};

Coverage find_coverage(const Layout& layout, const Deck& deck);

// The report of `sagefe layout check`.
void print_coverage(const Layout& layout, const Deck& deck, const Coverage& coverage, std::ostream& out);

}  // namespace sage

// What a layout reads of a deck: which columns of which lines, and what it leaves.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/layout.hpp"

namespace sage {

struct FieldColumns {
  std::size_t field = 0;    // of the layout's card
  int first = 0, last = 0;  // columns of the file, 1-based
};

// What is read of one record of all cards of a kind.  A list-directed card has its values anywhere: of its kind
// these are the lines of the first card.
struct RecordCoverage {
  int sample = 0;                    // a line that shows the most: unread characters, else the longest
  std::vector<FieldColumns> fields;  // that stand on it, in the layout's order
  std::vector<std::size_t> unread;   // by column: lines that hold a character there which no field reads
  std::size_t unread_lines = 0;
};

// All cards of one kind.
struct CardCoverage {
  std::size_t cards = 0;
  std::size_t lines = 0;
  int first_line = 0, last_line = 0;    // of the record that a made card comes from
  std::vector<std::size_t> filled;      // one a field of the layout: values that are not blank
  std::vector<RecordCoverage> records;  // of a card that takes several; the last stands for those behind it too
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

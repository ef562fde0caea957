// Cards read once more, for the places and characters of their fields: a deck keeps its numbers only.
#pragma once

#include <cstddef>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/format.hpp"
#include "sage/deck/record.hpp"

namespace sage {

// What it takes beside the deck itself.
struct CardFormats {
  RecordRules records;
  std::vector<Format> formats;  // one a spec; empty for list-directed cards
  std::vector<char> lists;      // one a spec: its last field repeats
};

// The first `count` values of a formatted card, as they were read.
std::vector<FieldValue> read_again(const Deck& deck, const Card& card, std::size_t count);

}  // namespace sage

// Decks with one mistake each, and what the program should say about it.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "tests/regression/program.hpp"

namespace sage::test {

struct BadDeck {
  std::string name;
  DeckText deck;
  std::string at;  // "LABEL:16-25", "LABEL:20", "LABEL", or "" for a message about the file
  std::vector<std::string> says;
  int errors = 1;  // more than one only where one mistake spoils several cards
};

inline void PrintTo(const BadDeck& bad, std::ostream* out) {
  *out << bad.name;
}

std::vector<BadDeck> bad_decks();

}  // namespace sage::test

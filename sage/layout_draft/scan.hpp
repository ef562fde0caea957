// The lines of a deck that nobody knows, as words and numbers with their columns, and what holds for all of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sage/deck/source.hpp"

namespace sage::layout_draft {

enum class Kind : std::uint8_t { integer, real, text };

// Columns are 1-based, inclusive, and count from the beginning of the record (behind a card's name).
struct Token {
  int first = 0, last = 0;
  Kind kind = Kind::text;
  bool quoted = false;
  double value = 0.0;
};

enum class Sort : std::uint8_t { blank, comment, words, numbers };

struct Line {
  int number = 0;  // of the file
  Sort sort = Sort::blank;
  std::string_view record;  // without card name and sequence columns
  std::string_view name;    // of the card, for decks whose cards bear names
  std::vector<Token> tokens;
};

struct Facts {
  char comment = '\0';
  std::string separator;  // between a card's name and its record
  int name_columns = 0;
  bool sequence = false;  // columns 73-80 hold ascending numbers
  bool listed = false;    // numbers stand in no columns
  bool grid = false;      // integers end at multiples of five columns
  int integer_width = 5, real_width = 10;
  std::vector<std::string> reasons;  // a sentence for each
};

struct Scan {
  Facts facts;
  std::vector<Line> lines;
};

Scan scan(const SourceText& source);

// Takes numbers that touch ("1.39931.4") apart where fields end, if that makes numbers of all pieces.
struct Columns {
  int first = 0, last = 0;
};
void split_packed(Line& line, const std::vector<Columns>& fields);

inline bool is_number(const Token& token) {
  return token.kind != Kind::text;
}

}  // namespace sage::layout_draft

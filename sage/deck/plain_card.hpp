// Cards as nearly all of a large deck are: under a FORMAT of fields side by side, with plain numbers in them.
// They are read without format control, without positions, without anything to report.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "sage/deck/layout.hpp"

namespace sage {

// The fields of such a card, in the order of their columns.
struct PlainCard {
  struct Field {
    std::size_t start = 0, end = 0;  // columns, 0-based; the end is behind the last
    int decimals = 0;
    FieldKind kind = FieldKind::real;
    bool required = false;
    bool joined = false;  // begins where the field before it ends
  };
  std::vector<Field> fields;
  std::size_t end = 0;  // column behind the last field
};

// Nothing for a card that takes more: repeating fields, codes to look up, a second record, blanks that count as
// zeros, scale factors, columns read twice.
std::optional<PlainCard> plain_card(const CardRule& rule, const RecordRules& records);

// Appends the card's numbers, without the blanks at its end.  False, with `numbers` as it was, unless every field
// reads without a remark: then the card is to be read in full.  Looks at the columns before `end` only, and at
// the one behind them.
bool read_plain(const PlainCard& card, std::string_view record, std::vector<double>& numbers);

}  // namespace sage

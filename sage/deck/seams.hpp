// Numbers that the end of a field cuts in two, and numbers that a slip moved into the next field.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/record.hpp"

namespace sage {

enum class Slip : std::uint8_t {
  cut,        // digits on both sides of a field's end, in fields that are not packed full
  cut_word,   // a text that goes on in the next field
  cut_text,   // a name or title that goes on in the next field
  lost_end,   // digits behind a field that nothing reads
  lost_head,  // digits before a field that nothing reads
  moved       // a lone digit in the first column of a field, and the field before is blank
};

struct SlipFound {
  Slip slip = Slip::cut;
  int value = 0;  // index into the card's values: the field to blame
  int line = 0;
  int first_column = 0, last_column = 0;  // 1-based, of the whole word
  int end_column = 0;                     // last column before the cut
};

struct SequenceColumns {
  int first = 0, last = 0;  // 1-based; 0 = the layout has none
};

// A name, a title, a remark: any characters are right there.
bool is_free_text(const FieldSpec& spec);

// The first slip of a card with these values; nothing if its fields are packed as programs write them: each
// full, or all of them left-justified.  `seams` in the order of reading.
std::optional<SlipFound> find_slip(const SourceText& source, const CardSpec& spec,
                                   std::span<const FieldValue> values, std::vector<Seam>& seams,
                                   SequenceColumns sequence);

}  // namespace sage

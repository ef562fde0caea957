#include "sage/deck/card_formats.hpp"

#include <algorithm>

namespace sage {

std::vector<FieldValue> read_again(const Deck& deck, const Card& card, std::size_t count) {
  const auto spec = static_cast<std::size_t>(card.spec);
  const std::vector<FieldSpec>& fields = deck.specs[spec].fields;
  RecordSource records(deck.source, deck.formats->records);
  records.rewind_to(card.line);
  FormattedRead read(records, deck.formats->formats[spec]);
  std::vector<FieldValue> values;
  std::vector<FieldFlaw> flaws;
  ReadEnd end = read.begin();
  while (end == ReadEnd::complete && values.size() < count)
    end = read.read(fields[std::min(values.size(), fields.size() - 1)].kind, values, flaws);
  values.resize(count);
  return values;
}

}  // namespace sage

#include "sage/deck/wide_layout.hpp"

#include <charconv>

#include "sage/deck/text.hpp"

namespace sage {

std::string wide_format(std::string_view format) {
  std::string wide;
  for (std::size_t i = 0; i < format.size();) {
    const bool number = std::string_view("IFEDG").find(format[i]) != std::string_view::npos;
    wide += format[i++];
    const std::size_t first = i;
    while (i < format.size() && is_digit(format[i])) ++i;
    int width = 0;
    std::from_chars(format.data() + first, format.data() + i, width);
    wide += number && width > 0 ? std::to_string(2 * width) : std::string(format.substr(first, i - first));
  }
  return wide;
}

Layout wide_layout(Layout layout) {
  layout.title += ", with wide fields";
  layout.name += "_wide";
  layout.records.record_length *= 2;
  layout.first_sequence_column = layout.last_sequence_column = 0;
  layout.marks.clear();
  layout.example.clear();  // its columns are those of the narrow fields
  for (CardRule& card : layout.cards) {
    if (card.spec.format.empty()) continue;
    card.spec.format = wide_format(card.spec.format);
    card.format = compile_format(card.spec.format);
  }
  return layout;
}

}  // namespace sage

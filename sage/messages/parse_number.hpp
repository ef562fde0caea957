// Numbers in words of decks, files and command lines.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace sage {

// The number that the whole text is; "inf" and "nan" are numbers of type double.  Nothing: it is none, or too large.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace sage

// Small helpers for characters of cards.
#pragma once

#include <array>
#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>

namespace sage {

inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Without blanks and tabs at both ends.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Nothing to read: blanks, tabs, and the mark that old systems put at the end of a file.
inline bool all_blank(std::string_view text) {
  return text.find_first_not_of(" \t\x1a") == std::string_view::npos;
}

inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

// Shortest digits that give the same number back: "-4", "0.25".
inline std::string number_text(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

// So many significant digits: "0.3333".
inline std::string rounded_text(double value, int digits = 4) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

// A text that every output can hold: valid UTF-8 without characters that steer a terminal (printable.hpp).
struct WellFormed {
  std::string text;
  bool latin1 = false;  // bytes that are no UTF-8 were read as Latin-1, or replaced by '?' where that has none
  bool controls = false;  // such characters were replaced by '?', tabs by blanks
};

// `after`: what follows in the file.  A character that the end of `text` cuts in two is left out.
WellFormed well_formed(std::string_view text, std::string_view after = {});

}  // namespace sage

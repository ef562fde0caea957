#include "sage/deck/text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "sage/deck/printable.hpp"

namespace sage {

namespace {

unsigned byte(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

struct Character {
  std::size_t length = 0;  // bytes; 0 = none begins here
  std::uint32_t code = 0;
};

// Bytes that the first one of a character promises; 0 where none can begin with it.
std::size_t promised_length(unsigned lead) {
  if (lead < 0x80) return 1;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  return lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
}

// The UTF-8 character that begins at `i`.  Only what XML can hold: no surrogates, no U+FFFE and U+FFFF.
Character character_at(std::string_view text, std::size_t i) {
  const unsigned lead = byte(text, i);
  const std::size_t length = promised_length(lead);
  if (length < 2) return {length, lead};
  std::uint32_t code = lead & (0x7fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(text, i + k) & 0xc0u) != 0x80u) return {};
    code = code << 6 | (byte(text, i + k) & 0x3fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool none = (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff || code > 0x10ffff;
  return overlong || none ? Character{} : Character{length, code};
}

// Controls (Unicode's class Cc), separators of lines, and what reorders or marks the direction of writing.
bool steers_terminal(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x61c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

// What the text begins but does not end of a character: its last one to three bytes, or none.
std::size_t unfinished(std::string_view text) {
  for (std::size_t back = 1; back <= std::min<std::size_t>(3, text.size()); ++back) {
    const unsigned lead = byte(text, text.size() - back);
    if ((lead & 0xc0u) != 0x80u) return promised_length(lead) > back ? back : 0;
  }
  return 0;
}

std::string hexadecimal(char kind, std::uint32_t value, int digits) {
  std::array<char, 12> text{};
  std::snprintf(text.data(), text.size(), "\\%c%0*x", kind, digits, static_cast<unsigned>(value));
  return text.data();
}

}  // namespace

WellFormed well_formed(std::string_view text, std::string_view after) {
  WellFormed result;
  const std::string whole = std::string(text) + std::string(after.substr(0, 3));
  for (std::size_t i = 0; i < text.size();) {
    const unsigned c = byte(text, i);
    const auto [length, code] = character_at(whole, i);
    if (i + length > text.size()) break;
    if (length > 0 && steers_terminal(code)) {
      result.text += c == '\t' ? ' ' : '?';
      result.controls = true;
    } else if (length > 0) {
      result.text += text.substr(i, length);
    } else {
      result.latin1 = true;
      if (c >= 0xa0) {
        result.text += static_cast<char>(0xc0u | c >> 6);
        result.text += static_cast<char>(0x80u | (c & 0x3fu));
      } else {
        result.text += '?';
      }
    }
    i += std::max<std::size_t>(length, 1);
  }
  return result;
}

std::string printable(std::string_view text, std::string* cut) {
  if (cut != nullptr) {
    const std::size_t left_out = unfinished(text);
    *cut = text.substr(text.size() - left_out);
    text.remove_suffix(left_out);
  }
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto [length, code] = character_at(text, i);
    if (length == 0)
      out += hexadecimal('x', byte(text, i), 2);
    else if (steers_terminal(code) && code != '\n' && code != '\t')
      out += hexadecimal('u', code, 4);
    else
      out += text.substr(i, length);
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

}  // namespace sage

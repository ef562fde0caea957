#include "sage/deck/text.hpp"

#include <algorithm>
#include <cstdint>

namespace sage {

namespace {

unsigned byte(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

// Bytes of the UTF-8 character that begins at `i`, 0 where none does.  Only what XML can hold: no surrogates,
// no U+FFFE and U+FFFF.
std::size_t character_length(std::string_view text, std::size_t i) {
  const unsigned lead = byte(text, i);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  std::uint32_t code = lead & (0x7fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(text, i + k) & 0xc0u) != 0x80u) return 0;
    code = code << 6 | (byte(text, i + k) & 0x3fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool none = (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff || code > 0x10ffff;
  return overlong || none ? 0 : length;
}

}  // namespace

WellFormed well_formed(std::string_view text, std::string_view after) {
  WellFormed result;
  const std::string whole = std::string(text) + std::string(after.substr(0, 3));
  for (std::size_t i = 0; i < text.size();) {
    const unsigned c = byte(text, i);
    const std::size_t length = character_length(whole, i);
    if (i + length > text.size()) break;
    if (c < 0x20 || c == 0x7f) {
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

}  // namespace sage

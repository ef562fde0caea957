#include "sage/app/wrap.hpp"

#include <algorithm>
#include <cstddef>

namespace sage::app {

namespace {

// Columns of the screen: neither the bytes that go on in a character of UTF-8 nor colours.
std::size_t columns_in(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\033')
      i = std::min(text.find('m', i), text.size());
    else if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80)
      ++count;
  }
  return count;
}

bool is_card(std::string_view line) {
  const std::size_t bar = line.find_first_not_of(" 0123456789");
  return bar != std::string_view::npos && bar >= 5 && bar <= 8 && line[bar] == '|';
}

// Where what is carried over begins.
std::size_t indent_of(std::string_view line, std::size_t columns) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", first);
  const std::size_t behind = gap == std::string_view::npos ? gap : line.find_first_not_of(' ', gap);
  if (behind != std::string_view::npos && behind <= columns / 2) return behind;
  if (first > columns / 2) return 0;
  return first + (first > 0 && first < columns / 4 ? 2 : 0);
}

void wrap_line(std::string_view line, std::size_t columns, std::string& out) {
  if (columns_in(line) <= columns || is_card(line)) {
    out += line;
    return;
  }
  const std::size_t indent = indent_of(line, columns);
  std::size_t at = std::min(line.find_first_not_of(' '), line.size());
  std::size_t used = at;
  out.append(at, ' ');
  while (at < line.size()) {
    const std::size_t end = std::min(line.find(' ', at), line.size());
    const std::string_view word = line.substr(at, end - at);
    const std::size_t next = std::min(line.find_first_not_of(' ', end), line.size());
    out += word;
    used += columns_in(word);
    if (next == line.size()) return;
    const std::size_t blanks = next - end;
    const std::size_t next_end = std::min(line.find(' ', next), line.size());
    const std::size_t width = columns_in(line.substr(next, next_end - next));
    // A word that is too long for a line of its own stays where it is.
    if (used + blanks + width > columns && used > indent && indent + width <= columns) {
      out += '\n';
      out.append(indent, ' ');
      used = indent;
    } else {
      out.append(blanks, ' ');
      used += blanks;
    }
    at = next;
  }
}

}  // namespace

std::string wrapped(std::string_view text, int columns) {
  std::string out;
  const auto most = static_cast<std::size_t>(std::max(columns, 20));
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    wrap_line(text.substr(at, end - at), most, out);
    if (end < text.size()) out += '\n';
    at = end + 1;
  }
  return out;
}

}  // namespace sage::app

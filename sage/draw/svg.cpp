#include "sage/draw/svg.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <sstream>

#include "sage/record/number.hpp"
#include "sage/record/values.hpp"

namespace sage::svg {

std::string open(int width, int height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{0}\" "
      "height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" fill=\"#222222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      width, height);
}

namespace {

// One character of UTF-8 at the beginning of a text that is not empty.
std::string_view first_letter(std::string_view text) {
  std::size_t length = 1;
  while (length < text.size() && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) ++length;
  return text.substr(0, length);
}

// Of DejaVu Sans, in parts of the font's size, rounded up.
double letter_width(std::string_view letter) {
  if (letter.size() > 1) return 0.65 + (static_cast<unsigned char>(letter[0]) >= 0xe0 ? 0.4 : 0.0);
  const char c = letter[0];
  constexpr std::string_view narrow = " ijl.,:;|'!I()[]ft/r-", wide = "mMwW%@";
  if (narrow.find(c) != std::string_view::npos) return c == 'r' || c == 't' || c == ' ' ? 0.42 : 0.4;
  if (wide.find(c) != std::string_view::npos) return 1.0;
  if ((c >= 'A' && c <= 'Z') || c == '=' || c == '+' || c == '<' || c == '>' || c == '#') return 0.8;
  return 0.64;
}

void append_text(std::string& out, double x, double y, std::string_view words, int size,
                 std::string_view anchor, std::string_view more, std::string_view whole) {
  fmt::format_to(std::back_inserter(out),
                 "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\" {}>", x, y, size, anchor,
                 more);
  if (!whole.empty()) out += "<title>" + xml_text(whole) + "</title>";
  out += xml_text(words) + "</text>\n";
}

}  // namespace

void text(std::string& out, double x, double y, std::string_view words, int size, std::string_view anchor,
          std::string_view more) {
  append_text(out, x, y, words, size, anchor, more, "");
}

void text_within(std::string& out, double x, double y, const std::string& words, int size, double room,
                 std::string_view anchor, std::string_view more) {
  const std::string shown = shortened(words, size, room);
  append_text(out, x, y, shown, size, anchor, more, shown == words ? "" : words);
}

void line(std::string& out, double x1, double y1, double x2, double y2, std::string_view colour, double width,
          std::string_view more) {
  fmt::format_to(std::back_inserter(out),
                 "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" "
                 "stroke-width=\"{:.2g}\" {}/>\n",
                 x1, y1, x2, y2, colour, width, more);
}

void number(std::string& out, double value) {
  append_plain(out, std::round(100.0 * value) / 100.0, 8);
}

double text_width(std::string_view words, int size, bool bold) {
  double width = 0.0;
  while (!words.empty()) {
    const std::string_view letter = first_letter(words);
    width += letter_width(letter);
    words.remove_prefix(letter.size());
  }
  return width * size * (bold ? 1.12 : 1.0);
}

std::vector<std::string> wrapped(const std::string& words, int size, double room, bool bold) {
  std::vector<std::string> lines{""};
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    if (!lines.back().empty() && text_width(lines.back() + " " + word, size, bold) <= room) {
      lines.back() += " " + word;
      continue;
    }
    if (!lines.back().empty()) lines.emplace_back();
    for (std::string_view rest = word; !rest.empty();) {
      const std::string_view letter = first_letter(rest);
      if (!lines.back().empty() && text_width(lines.back() + std::string(letter), size, bold) > room)
        lines.emplace_back();
      lines.back() += letter;
      rest.remove_prefix(letter.size());
    }
  }
  return lines;
}

std::string shortened(const std::string& words, int size, double room) {
  if (text_width(words, size) <= room) return words;
  std::vector<std::string_view> letters;
  for (std::string_view rest = words; !rest.empty(); rest.remove_prefix(letters.back().size()))
    letters.push_back(first_letter(rest));
  // What tells long names apart may be at either end.
  constexpr std::string_view kDots = "...";
  std::size_t front = 0, back = letters.size();
  double width = text_width(kDots, size);
  for (std::size_t taken = 0; front < back; ++taken) {
    const bool at_back = taken % 3 == 2;
    width += text_width(letters[at_back ? back - 1 : front], size);
    if (width > room) break;
    if (at_back)
      --back;
    else
      ++front;
  }
  std::string result;
  for (std::size_t i = 0; i < front; ++i) result += letters[i];
  result += kDots;
  for (std::size_t i = back; i < letters.size(); ++i) result += letters[i];
  return result;
}

}  // namespace sage::svg

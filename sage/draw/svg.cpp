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

void text(std::string& out, double x, double y, std::string_view words, int size, std::string_view anchor,
          std::string_view more) {
  fmt::format_to(std::back_inserter(out),
                 "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\" {}>{}</text>\n", x, y,
                 size, anchor, more, xml_text(words));
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

std::vector<std::string> wrapped(const std::string& words, double width_of_one, double room) {
  std::vector<std::string> lines{""};
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    std::string& line = lines.back();
    if (line.empty())
      line = word;
    else if (width_of_one * (static_cast<double>(line.size() + 1 + word.size())) <= room)
      line += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

}  // namespace sage::svg

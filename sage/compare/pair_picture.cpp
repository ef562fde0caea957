#include "sage/compare/pair_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "sage/draw/svg.hpp"

namespace sage::compare {

namespace {

struct Size {
  int width = 360, height = 200;
};

// Of a picture, from its first line.
Size size_of(const std::string& svg) {
  Size size;
  const std::size_t at = svg.find("width=\"");
  if (at != std::string::npos)
    std::sscanf(svg.c_str() + at, "width=\"%d\" height=\"%d\"", &size.width, &size.height);
  return size;
}

// A history variable may be of the laws of one side only.
bool shows(const Side& side, std::string_view field) {
  return side.has_state() && fields_of(side.model()).choose(field).has_value();
}

}  // namespace

std::string pair_svg(const Side& a, const Side& b, std::string_view field) {
  constexpr int kTop = 44, kGap = 16, kBottom = 30;
  PictureOptions options;
  options.width = 560;
  FieldRange range;
  for (const Side* side : {&a, &b}) {
    if (!shows(*side, field)) continue;
    const FieldRange one = field_range(side->model(), side->last(), field, options);
    range.low = std::min(range.low, one.low);
    range.high = std::max(range.high, one.high);
  }
  if (range.low <= range.high) {
    options.low = range.low;
    options.high = range.high;
  }
  std::string drawings[2];
  Size sizes[2];
  const Side* sides[2] = {&a, &b};
  for (std::size_t k = 0; k < 2; ++k) {
    if (!shows(*sides[k], field)) continue;
    options.state = sides[k]->error().empty() ? "end of the run" : "NOT COMPLETE, last equilibrium";
    options.title = (k == 0 ? "A: " : "B: ") + sides[k]->model().title;
    drawings[k] = field_svg(sides[k]->model(), sides[k]->last(), field, options);
    sizes[k] = size_of(drawings[k]);
  }
  const int width = sizes[0].width + kGap + sizes[1].width;
  const int height = kTop + std::max(sizes[0].height, sizes[1].height) + kBottom;
  std::string out = svg::open(width, height);
  svg::text_within(out, 8.0, 18.0, a.label(), svg::kFont, width - 16.0, "start");
  svg::text_within(out, 8.0, 38.0, b.label(), svg::kFont, width - 16.0, "start");
  for (std::size_t k = 0; k < 2; ++k) {
    const int left = k == 0 ? 0 : sizes[0].width + kGap;
    if (drawings[k].empty()) {
      svg::text(out, left + 8.0, kTop + 40.0, std::string(k == 0 ? "A" : "B") + " has no results", 16, "start",
                "font-weight=\"bold\"");
      continue;
    }
    out += fmt::format("<g transform=\"translate({} {})\">\n{}</g>\n", left, kTop, drawings[k]);
  }
  svg::text(out, 8.0, height - 10.0, "one scale of colours for both", 13, "start");
  return out + std::string(svg::kClose);
}

}  // namespace sage::compare

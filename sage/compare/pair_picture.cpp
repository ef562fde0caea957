#include "sage/compare/pair_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "sage/draw/diagram.hpp"
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

// The smaller scale of lengths of the two, for both.
void set_common_scales(PictureOptions& options, const Side& a, const Side& b, std::string_view field) {
  for (const Side* side : {&a, &b}) {
    if (!shows(*side, field)) continue;
    const double paper = scales_of(side->model(), side->last(), field, options).paper;
    if (paper > 0.0) options.paper = options.paper > 0.0 ? std::min(options.paper, paper) : paper;
  }
}

}  // namespace

std::string pair_svg(const Side& a, const Side& b, std::string_view field) {
  constexpr int kTop = 44, kBottom = 30;
  PictureOptions options;
  options.width = 560;
  set_common_scales(options, a, b, field);
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
  FieldSheet sheet;
  sheet.columns = 2;
  sheet.look = options;
  std::string missing;
  for (const Side* side : {&a, &b}) {
    const std::string name = side == &a ? "A" : "B";
    if (!shows(*side, field)) {
      missing += name + " has no results";
      continue;
    }
    FieldPanel& panel = sheet.panels.emplace_back(FieldPanel{&side->model(), side->last(), std::string(field)});
    panel.title = name + ": " + side->model().title;
    panel.state = side->error().empty() ? "end of the run" : "NOT COMPLETE, last equilibrium";
  }
  const std::string drawing = sheet.panels.empty() ? "" : sheet_svg(sheet);
  const Size size = size_of(drawing);
  const int top = missing.empty() ? kTop : kTop + 24, height = top + size.height + kBottom;
  std::string out = svg::open(size.width, height);
  svg::text_within(out, 8.0, 18.0, a.label(), svg::kFont, size.width - 16.0, "start");
  svg::text_within(out, 8.0, 38.0, b.label(), svg::kFont, size.width - 16.0, "start");
  if (!missing.empty()) svg::text(out, 8.0, kTop + 16.0, missing, 16, "start", "font-weight=\"bold\"");
  out += fmt::format("<g transform=\"translate(0 {})\">\n{}</g>\n", top, drawing);
  svg::text(out, 8.0, height - 10.0,
            diagram_of(field) >= 0 ? "one scale for both: of the diagrams and of lengths"
                                   : "one scale for both: of colours and of lengths",
            13, "start");
  return out + std::string(svg::kClose);
}

}  // namespace sage::compare

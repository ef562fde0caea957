#include "sage/draw/diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "sage/draw/svg.hpp"
#include "sage/math/rounding.hpp"

namespace sage {

namespace {

constexpr const char* kColour = "#d94801";

bool is_moment(const Diagram& diagram) {
  const auto q = static_cast<std::size_t>(diagram.quantity);
  return q == kBendingMoment || q == kHoopMoment;
}

// Moments are drawn on the side that they pull, the right of the way where they are positive; all else on the left.
double sense(const Diagram& diagram) {
  return is_moment(diagram) ? -1.0 : 1.0;
}

// Pipes and linings: sides that look towards the middle of a curved group are turned outwards.
void turn_outwards(std::span<DiagramElement> group) {
  constexpr double kCurved = 0.05;  // of what a ring has; a straight wall has none
  Vector2 middle = Vector2::Zero();
  double length = 0.0;
  const auto length_of = [](const DiagramElement& e) { return (e.at[1] - e.at[0]).norm(); };
  for (const DiagramElement& e : group) {
    middle += length_of(e) * 0.5 * (e.at[0] + e.at[1]);
    length += length_of(e);
  }
  if (!(length > 0.0)) return;
  middle /= length;
  double outwards = 0.0, distance = 0.0;
  for (const DiagramElement& e : group) {
    const Vector2 arm = 0.5 * (e.at[0] + e.at[1]) - middle;
    outwards += length_of(e) * e.side[0].dot(arm);
    distance += length_of(e) * arm.norm();
  }
  if (outwards > -kCurved * distance) return;
  for (DiagramElement& e : group)
    for (Vector2& side : e.side) side = -side;
}

void append(std::string& path, const char* command, const Vector2& at) {
  fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", command, at.x(), at.y());
}

// On the paper y points down: what is to the left of t there.
Vector2 left_of(const Vector2& along) {
  return {-along.y(), -along.x()};
}

void take(Diagram& diagram, const Scenery& scenery, const ElementEnd& end, double low, double high) {
  if (end.end == 1) diagram.elements.emplace_back();
  DiagramElement& element = diagram.elements.back();
  const int i = end.end - 1;
  element.at[i] = scenery.moved(end.node, scenery.view.deformation);
  element.side[i] = left_of(end.along);
  element.low[i] = low;
  element.high[i] = high;
}

// What is rounding beside the largest is zero.
void drop_rounding(Diagram& diagram) {
  constexpr double kRoundOff = rounding::kText;
  double most = 0.0;
  for (const DiagramElement& e : diagram.elements)
    for (int i = 0; i < 2; ++i) most = std::max({most, std::abs(e.low[i]), std::abs(e.high[i])});
  for (DiagramElement& e : diagram.elements)
    for (int i = 0; i < 2; ++i)
      for (double* value : {&e.low[i], &e.high[i]})
        if (std::abs(*value) < kRoundOff * most) *value = 0.0;
}

void draw_label(std::string& out, const Vector2& at, const Vector2& offset, double value) {
  const double away = offset.x() < 0.0 ? -1.0 : 1.0;
  svg::text(out, at.x() + offset.x() + 5.0 * away, at.y() + offset.y() + 4.0, fmt::format("{:.4g}", value),
            svg::kFont, away < 0.0 ? "end" : "start", "fill=\"#7f2704\"");
}

// The places of the least and the largest value.
void draw_labels(std::string& out, const Diagram& diagram, double scale) {
  const double pixels = sense(diagram) * scale;
  bool least = false, largest = diagram.largest == diagram.least;
  for (const DiagramElement& element : diagram.elements)
    for (int i = 0; i < 2; ++i) {
      if (!largest && element.high[i] == diagram.largest) {
        draw_label(out, element.at[i], pixels * element.high[i] * element.side[i], element.high[i]);
        largest = true;
      }
      if (!least && element.low[i] == diagram.least) {
        draw_label(out, element.at[i], pixels * element.low[i] * element.side[i], element.low[i]);
        least = true;
      }
    }
}

}  // namespace

bool is_envelope(std::string_view picture) {
  return picture.ends_with(kEnvelopePicture) && diagram_of(picture) >= 0;
}

int diagram_of(std::string_view picture) {
  if (picture.ends_with(kEnvelopePicture)) picture.remove_suffix(kEnvelopePicture.size());
  return end_quantity(picture);
}

Diagram make_diagram(const Scenery& scenery, std::string_view picture, const std::vector<EnvelopeEnd>* ends) {
  Diagram diagram;
  diagram.quantity = diagram_of(picture);
  if (diagram.quantity < 0) return diagram;
  const auto q = static_cast<std::size_t>(diagram.quantity);
  diagram.envelope = is_envelope(picture) && ends != nullptr;
  const Model& model = scenery.model;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (!scenery.draws(g, ElementKind::structure) || model.groups[g].entry->corners < 2) continue;
    const std::vector<ElementEnd> now = element_ends(model, scenery.solution, g);
    const EnvelopeEnd* row = nullptr;
    if (diagram.envelope)
      for (auto at = ends->rbegin(); at != ends->rend(); ++at)
        if (at->group == static_cast<std::int64_t>(g)) row = &*at;  // the first of the group
    const std::size_t first = diagram.elements.size();
    for (const ElementEnd& end : now) {
      if (!std::isnan(end.value[q]))
        take(diagram, scenery, end, row != nullptr ? row->low[q] : end.value[q],
             row != nullptr ? row->high[q] : end.value[q]);
      if (row != nullptr) ++row;
    }
    if (!is_moment(diagram)) turn_outwards(std::span(diagram.elements).subspan(first));
  }
  if (diagram.elements.empty()) return diagram;
  drop_rounding(diagram);
  diagram.least = diagram.elements.front().low[0];
  diagram.largest = diagram.elements.front().high[0];
  for (const DiagramElement& element : diagram.elements)
    for (int i = 0; i < 2; ++i) {
      diagram.least = std::min(diagram.least, element.low[i]);
      diagram.largest = std::max(diagram.largest, element.high[i]);
    }
  diagram.most = std::max(std::abs(diagram.least), std::abs(diagram.largest));
  return diagram;
}

std::string draw_diagram(std::string& out, const Scenery& scenery, const Diagram& diagram) {
  const double most = diagram.most;
  if (diagram.elements.empty()) return "no structure of this state has that force";
  if (!(most > 0.0)) return "diagram: nothing but zeros";
  const View& view = scenery.view;
  const double scale = kDiagramShare * view.scale * (view.high - view.low).maxCoeff() / most;
  const double pixels = sense(diagram) * scale;
  std::string area, high, low;
  for (const DiagramElement& e : diagram.elements) {
    const auto at = [&](int i, const double* value) -> Vector2 {
      return e.at[i] + pixels * value[i] * e.side[i];
    };
    const double none[2] = {};
    append(area, "M", at(0, diagram.envelope ? e.low : none));
    append(area, "L", at(1, diagram.envelope ? e.low : none));
    append(area, "L", at(1, e.high));
    append(area, "L", at(0, e.high));
    area += 'z';
    append(high, "M", diagram.envelope ? at(0, e.high) : e.at[0]);
    append(high, "L", at(0, e.high));
    append(high, "L", at(1, e.high));
    if (!diagram.envelope) append(high, "L", e.at[1]);
    if (!diagram.envelope) continue;
    append(low, "M", at(0, e.low));
    append(low, "L", at(1, e.low));
  }
  fmt::format_to(std::back_inserter(out), "<path fill=\"{}\" fill-opacity=\"0.25\" d=\"{}\"/>\n", kColour,
                 area);
  fmt::format_to(std::back_inserter(out), "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" d=\"{}\"/>\n",
                 kColour, high);
  if (!low.empty())
    fmt::format_to(
        std::back_inserter(out),
        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" stroke-dasharray=\"6 3\" d=\"{}\"/>\n", kColour,
        low);
  draw_labels(out, diagram, scale);
  std::string words = diagram.envelope ? "envelope: largest of all stages full, least dashed; " : "diagram: ";
  words += sense(diagram) < 0.0 ? "on the side that is pulled"
                                : "positive to the left of the way from node 1 to node 2, of curved "
                                  "structures outwards";
  return words;
}

}  // namespace sage

// A slope on a foundation whose cells are made by rule (Smith and Griffiths, program 6.4).
#include <array>

#include "sage/exchange/translate_body.hpp"

namespace sage::translate {

namespace {

constexpr int kMostSlopeCells = 5'000'000;

struct Slope {
  double crest, slope, toe, height, depth;  // widths along x; heights of slope and foundation
  int columns, toe_columns, rows, foundation_rows;

  int all_rows() const { return rows + foundation_rows; }
  int all_columns() const { return columns + toe_columns; }
  bool exists(int column, int row) const { return column < columns || row >= rows; }
  // Of the corner (i, j): i columns from the left, j rows from the top.
  Vector2 corner(int i, int j) const {
    const double face = crest + slope * std::min(j, rows) / rows;
    const double x = i <= columns ? face * i / columns : face + toe * (i - columns) / toe_columns;
    const double y = j <= rows ? -height * j / rows : -height - depth * (j - rows) / foundation_rows;
    return {x, y};
  }
  // Nodes before the line of corners i, which runs down from its uppermost node.
  int before(int i) const {
    const int left = std::min(i, columns), right = i - left;
    return left * (3 * all_rows() + 2) + (right > 0 ? 2 * rows + right * (3 * foundation_rows + 2) : 0);
  }
  // First row of the cells right of the line i; of those on both sides for its own nodes.
  int top(int column) const { return column < columns ? 0 : rows; }
  // j2 = 2 j at corners of row j, odd between.
  int on_line(int i, int j2) const { return before(i) + j2 - (i > columns ? 2 * rows : 0) + 1; }
  // Between the lines of `column`, at the level of corners of row j.
  int between(int column, int j) const {
    const int line = column < columns ? 2 * all_rows() + 1 : 2 * foundation_rows + 1;
    const int first = column < columns ? before(column) : before_right(column);
    return first + line + j - top(column) + 1;
  }
  // The line of the toe is as long as the slope is high: what is right of it counts from its lower part.
  int before_right(int column) const {
    return columns * (3 * all_rows() + 2) + 2 * rows + (column - columns) * (3 * foundation_rows + 2);
  }
};

Slope read_slope(const Body& body) {
  const CardView& card = body.card;
  Slope s{card.real("crest"),          card.real("slope"),   card.real("toe"),
          card.real("height"),         card.real("depth"),   card.integer("columns"),
          card.integer("toe_columns"), card.integer("rows"), card.integer("foundation_rows")};
  for (const char* field : {"columns", "rows"})
    if (card.integer(field) < 1) refuse(body, card, field, "the slope needs columns and rows of 1 or more");
  for (const auto& [count, length] : {std::pair{"toe_columns", "toe"}, std::pair{"foundation_rows", "depth"}}) {
    if (card.integer(count) < 0)
      refuse(body, card, count, "the " + card.label(count) + " must not be negative");
    if (card.integer(count) > 0 && !(card.real(length) > 0.0))
      refuse(body, card, length, "the " + card.label(length) + " must be above zero where it has cells");
  }
  if (s.toe_columns > 0 && s.foundation_rows == 0)
    refuse(body, card, "foundation_rows", "there are cells beyond the toe, but no rows below it");
  for (const char* field : {"crest", "slope"})
    if (!(card.real(field) >= 0.0))
      refuse(body, card, field, "the " + card.label(field) + " must not be negative");
  if (!(s.crest + s.slope > 0.0) || !(s.height > 0.0))
    refuse(body, card, "height", "the slope needs a width and a height above zero");
  if (static_cast<std::int64_t>(s.all_columns()) * s.all_rows() > kMostSlopeCells)
    refuse(body, card, "columns", "the slope may have at most 5000000 cells");
  return s;
}

void number_mesh(Body& body, const Slope& s) {
  const SourcePosition where = body.card.where();
  for (int i = 0; i <= s.all_columns(); ++i) {
    const int first = i <= s.columns ? 0 : s.rows;
    for (int j2 = 2 * first; j2 <= 2 * s.all_rows(); ++j2) {
      const Vector2 above = s.corner(i, j2 / 2), below = s.corner(i, (j2 + 1) / 2);
      body.nodes.push_back({s.on_line(i, j2), 0.5 * (above + below), where});
    }
    if (i == s.all_columns()) break;
    for (int j = s.top(i); j <= s.all_rows(); ++j)
      body.nodes.push_back({s.between(i, j), 0.5 * (s.corner(i, j) + s.corner(i + 1, j)), where});
  }
  for (int j = 0; j < s.all_rows(); ++j)
    for (int i = 0; i < s.all_columns(); ++i) {
      if (!s.exists(i, j)) continue;
      const int left = s.on_line(i, 2 * j), right = s.on_line(i + 1, 2 * j);
      body.elements.push_back(
          {{left + 2, right + 2, right, left, s.between(i, j + 1), right + 1, s.between(i, j), left + 1},
           where});
    }
}

// The base is held; rollers stand left, and right below the level of the toe.
void add_fixities(const Body& body, const Slope& s, CardWriter& out) {
  const auto hold = [&](int node, bool base) {
    out.add("fixity", body.card.where(),
            {{"first", static_cast<double>(node)}, {"x_code", 1.0}, {"y_code", base ? 1.0 : 0.0}});
  };
  const int base = 2 * s.all_rows(), last = s.all_columns();
  for (int j2 = 0; j2 < base; ++j2) hold(s.on_line(0, j2), false);
  for (int j2 = 2 * s.rows; j2 < base; ++j2) hold(s.on_line(last, j2), false);
  for (int i = 0; i <= last; ++i) {
    hold(s.on_line(i, base), true);
    if (i < last) hold(s.between(i, s.all_rows()), true);
  }
}

}  // namespace

Deck slope_deck(const Deck& deck, const Catalogue& catalogue) {
  Body body{deck, catalogue, deck.one("slope")};
  const Slope slope = read_slope(body);
  number_mesh(body, slope);
  CardWriter out(deck);
  add_body(body, element_materials(body), "slope numbered by rule", out);
  add_fixities(body, slope, out);
  add_loading(body, out);
  return out.take();
}

}  // namespace sage::translate

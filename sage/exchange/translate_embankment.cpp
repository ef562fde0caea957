// Embankments built in lifts on a foundation (Smith and Griffiths, program 6.9): the mesh that the program
// numbers by rule, one group of elements a lift, one stage a lift.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "sage/exchange/translate.hpp"

namespace sage::translate {

namespace {

constexpr int kMostElements = 1'000'000;

[[noreturn]] void refuse(const Deck& deck, const CardView& card, std::string_view field,
                         const std::string& message) {
  Diagnostics problems;
  problems.add(card_diagnostic(deck, Severity::error, "S701", card.where(field), message));
  throw InputError(problems);
}

// Rising coordinates: the mesh is built from the bottom and from the left.
std::vector<double> rising(const Deck& deck, std::string_view card_name, std::string_view field) {
  const CardView card = deck.one(card_name);
  std::vector<double> at;
  for (const FieldValue& value : card.list(field)) at.push_back(value.number);
  if (at.size() < 2) refuse(deck, card, field, "two or more coordinates " + std::string(field) + " are needed");
  for (std::size_t i = 1; i < at.size(); ++i)
    if (!(at[i] > at[i - 1]))
      refuse(deck, card, field, "the coordinates " + std::string(field) + " must rise all along");
  return at;
}

struct Element {
  std::vector<int> nodes;  // corners counter-clockwise, then mid-side nodes
  int lift = 0;            // 0: the foundation
};

// Eight nodes of an element, clockwise from the lower left corner, as that program counts them.
using Eight = std::array<int, 8>;

struct Mesh {
  std::map<int, Vector2> nodes;
  std::vector<Element> elements;

  void place(int node, double x, double y) { nodes.insert_or_assign(node, Vector2(x, y)); }
  void add_quad(const Eight& n, double x0, double x1, double y0, double y1, int lift) {
    const double xm = 0.5 * (x0 + x1), ym = 0.5 * (y0 + y1);
    place(n[0], x0, y0);
    place(n[1], x0, ym);
    place(n[2], x0, y1);
    place(n[3], xm, y1);
    place(n[4], x1, y1);
    place(n[5], x1, ym);
    place(n[6], x1, y0);
    place(n[7], xm, y0);
    elements.push_back({{n[0], n[6], n[4], n[2], n[7], n[5], n[3], n[1]}, lift});
  }
  // The element under the slope: its lower left, lower right and upper right corners.  What stands on
  // the slope between the first and the last is its middle node; that program has five nodes there,
  // all on one straight line.
  void add_slope(const Eight& n, int middle, double x0, double x1, double y0, double y1, int lift) {
    place(n[0], x0, y0);
    place(n[6], x1, y0);
    place(n[4], x1, y1);
    place(n[7], 0.5 * (x0 + x1), y0);
    place(n[5], x1, 0.5 * (y0 + y1));
    place(middle, 0.5 * (x0 + x1), 0.5 * (y0 + y1));
    elements.push_back({{n[0], n[6], n[4], n[7], n[5], middle}, lift});
  }
};

// Nodes are numbered row by row from the bottom, each along x: 2 n + 1 on lines through
// corners, n + 1 between them.
Mesh embankment_mesh(const Deck& deck) {
  const CardView foundation = deck.one("foundation"), embankment = deck.one("embankment");
  const int columns = foundation.integer("columns"), rows = foundation.integer("rows");
  const int lifts = embankment.integer("lifts"), wide = embankment.integer("columns");
  const int slope = embankment.integer("slope", 1);
  if (columns < 1 || rows < 1 || static_cast<std::int64_t>(columns) * rows > kMostElements)
    refuse(deck, foundation, "columns",
           "the foundation needs columns and rows of 1 or more, at most 1000000 elements");
  if (lifts < 1 || lifts - 1 > embankment.integer("rows"))
    refuse(deck, embankment, "lifts",
           "there must be 1 to " + std::to_string(embankment.integer("rows") + 1) +
               " lifts: the foundation, then one a row of the embankment");
  if (wide < lifts - 1 || wide > columns)
    refuse(deck, embankment, "columns",
           "the embankment must have " + std::to_string(lifts - 1) + " to " + std::to_string(columns) +
               " columns: each lift is one shorter than that below");
  const std::vector<double> x = rising(deck, "foundation_x", "x"), y = rising(deck, "foundation_y", "y");
  const std::vector<double> ex = rising(deck, "embankment_x", "x"), ey = rising(deck, "embankment_y", "y");
  const double size = x.back() - x.front();
  const auto same = [size](double a, double b) { return std::abs(a - b) <= 1e-9 * size; };
  for (int i = 0; i <= wide; ++i)
    if (!same(ex[i], x[columns - wide + i]))
      refuse(deck, deck.one("embankment_x"), "x",
             "the embankment stands on the last columns of the foundation: its x must "
             "be theirs");
  if (!same(ey.front(), y.back()))
    refuse(deck, deck.one("embankment_y"), "y", "the embankment begins where the foundation ends");
  const int across = 3 * columns + 2;
  Mesh mesh;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < columns; ++i) {
      const int low = row * across + 2 * i + 1, mid = row * across + 2 * columns + 1 + i + 1;
      const int high = (row + 1) * across + 2 * i + 1;
      const auto iu = static_cast<std::size_t>(i), ru = static_cast<std::size_t>(row);
      mesh.add_quad({low, mid, high, high + 1, high + 2, mid + 1, low + 2, low + 1}, x[iu], x[iu + 1], y[ru],
                    y[ru + 1], 0);
    }
  int last = rows * across + 2 * columns + 1;
  for (int lift = 1; lift < lifts; ++lift) {
    const int n = wide - lift + 1;  // elements of this lift
    for (int i = 0; i < n; ++i) {
      const int low = last - 2 * n + 2 * i, mid = last + 1 + i, high = last + n + 2 + 2 * i;
      const Eight eight{low, mid, high, high + 1, high + 2, mid + 1, low + 2, low + 1};
      const auto iu = static_cast<std::size_t>(lift - 1 + i), lu = static_cast<std::size_t>(lift);
      if (i > 0)
        mesh.add_quad(eight, ex[iu], ex[iu + 1], ey[lu - 1], ey[lu], lift);
      else
        mesh.add_slope(eight, slope == 1 ? high : mid, ex[iu], ex[iu + 1], ey[lu - 1], ey[lu], lift);
    }
    last += n + 1 + 2 * n + 1;
  }
  return mesh;
}

void add_materials(const Deck& deck, const Catalogue& catalogue, CardWriter& out) {
  int number = 0;
  for (const CardView& row : deck.all("material_values")) {
    const int card = out.add("material", row.where(),
                             {{"number", static_cast<double>(++number)},
                              {"law", static_cast<double>(law_code(catalogue, "mohr_coulomb"))},
                              take(row, "unit_weight"),
                              {"name", 0.0, {}, number == 1 ? "foundation" : "embankment"}});
    out.add("parameters", row.where(),
            {take(row, "youngs_modulus", "values"), take(row, "poissons_ratio", "values"),
             take(row, "cohesion", "values"), take(row, "friction_angle", "values"),
             take(row, "dilation_angle", "values")},
            card);
  }
}

// Of the deck's elements: triangles have six nodes, quadrilaterals eight.
bool is_triangle(const Element& element) {
  return element.nodes.size() == 6;
}

// Group 1 is the foundation; lift k has 2 k (quadrilaterals) and 2 k + 1 (the triangle under the slope).
int group_of(const Element& element) {
  if (element.lift == 0) return 1;
  return 2 * element.lift + (is_triangle(element) ? 1 : 0);
}

int element_code(const Catalogue& catalogue, const Element& element) {
  return solid_code(catalogue, is_triangle(element) ? ParentShape::triangle : ParentShape::square,
                    static_cast<int>(element.nodes.size()));
}

void add_elements(const Mesh& mesh, const CardView& where, const Catalogue& catalogue, CardWriter& out) {
  std::map<int, const Element*> first_of;
  for (const Element& e : mesh.elements) first_of.try_emplace(group_of(e), &e);
  for (const auto& [group, e] : first_of)
    out.add("group", where.where(),
            {{"number", static_cast<double>(group)},
             {"element", static_cast<double>(element_code(catalogue, *e))},
             {"formulation", 1.0},
             {"material", e->lift == 0 ? 1.0 : 2.0},
             {"name", 0.0, {}, e->lift == 0 ? "foundation" : "lift " + std::to_string(e->lift + 1)}});
  int number = 0;
  for (const Element& e : mesh.elements) {
    std::vector<NewField> fields{{"number", static_cast<double>(++number)},
                                 {"group", static_cast<double>(group_of(e))}};
    int n = 0;
    for (const int node : e.nodes) fields.push_back({"n" + std::to_string(++n), static_cast<double>(node)});
    out.add("element", where.where(), fields);
  }
}

// The foundation under its own weight and K0; then lift after lift, whose weight comes in equal steps.
void add_stages(const Deck& deck, const Mesh& mesh, CardWriter& out) {
  const CardView foundation = deck.one("foundation"), embankment = deck.one("embankment");
  const double increments = std::max(1, foundation.integer("increments"));
  const CardView soil = deck.all("material_values").front();
  double top = -1e300;
  for (const FieldValue& value : deck.one("foundation_y").list("y")) top = std::max(top, value.number);
  out.add("initial", embankment.where("pressure_at_rest"),
          {{"group", 1.0},
           {"kind", 1.0},
           {"v1", top},
           take(soil, "unit_weight", "v2"),
           take(embankment, "pressure_at_rest", "v3"),
           {"v4", 0.0}});
  for (int lift = 0; lift < embankment.integer("lifts"); ++lift) {
    out.add("stage_title", foundation.where(),
            {{"title", 0.0, {}, lift == 0 ? "weight of the foundation" : "lift " + std::to_string(lift + 1)}});
    const int stage = out.add("stage", foundation.where(),
                              {{"increments", lift == 0 ? 1.0 : increments},
                               {"output_every", 1.0},
                               {"gravity_y", lift == 0 ? -1.0 : 0.0}});
    std::vector<NewField> births;
    for (const int group : {2 * lift, 2 * lift + 1})
      if (lift > 0 && std::any_of(mesh.elements.begin(), mesh.elements.end(),
                                  [&](const Element& e) { return group_of(e) == group; }))
        births.push_back({"groups", static_cast<double>(group)});
    if (!births.empty()) out.add("birth", foundation.where(), births, stage);
  }
}

}  // namespace

Deck embankment_deck(const Deck& deck, const Catalogue& catalogue) {
  const CardView foundation = deck.one("foundation");
  const Mesh mesh = embankment_mesh(deck);
  CardWriter out(deck);
  out.add("title", foundation.where(), {{"title", 0.0, {}, deck.layout + " deck, embankment in lifts"}});
  out.add("control", foundation.where(), {{"geometry", 1.0}});
  for (const auto& [number, x] : mesh.nodes)
    out.add("node", foundation.where(), {{"number", static_cast<double>(number)}, {"x", x.x()}, {"y", x.y()}});
  add_materials(deck, catalogue, out);
  add_elements(mesh, foundation, catalogue, out);
  out.copy("fixity");
  add_stages(deck, mesh, out);
  if (deck.one("embankment").integer("lifts") > 1)
    out.note("S704", foundation.where(),
             "the elements under the slope become 6-node triangles: five of their eight nodes lie on "
             "one straight line");
  return out.take();
}

}  // namespace sage::translate

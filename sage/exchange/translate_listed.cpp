// Meshes whose nodes and elements are listed without numbers: a node's number is its place in the list of
// coordinates, an element's that in the list of nodes (Smith and Griffiths, programs 5.4 and 6.10).
#include <algorithm>
#include <array>
#include <cmath>

#include "sage/exchange/translate_body.hpp"

namespace sage::translate {

namespace {

constexpr int kMostListed = 5'000'000;  // nodes, elements

[[noreturn]] void refuse_at(const Body& body, const SourcePosition& where, const std::string& message) {
  Diagnostics problems;
  problems.add(card_diagnostic(body.deck, Severity::error, "S701", where, message));
  throw InputError(problems);
}

// Intervals along a side; 0 = an element that doesn't exist.
int intervals(const Body& body) {
  const int n = body.nodes_per_element;
  if (body.triangles) return n == 3 ? 1 : n == 6 ? 2 : n == 15 ? 4 : 0;
  return n == 4 ? 1 : n == 8 || n == 9 ? 2 : 0;
}

void read_kind(Body& body) {
  const CardView& card = body.card;
  const int shape = card.integer("shape", 2);
  if (shape > 2 || card.integer("dimensions", 2) == 3)
    refuse(body, card, shape > 2 ? "shape" : "dimensions",
           "a body of three dimensions (hexahedra or tetrahedra) is outside of what this program does: "
           "it solves plane strain and axisymmetry");
  if (card.integer("dimensions", 2) != 2) refuse(body, card, "dimensions", "the mesh must have two dimensions");
  body.triangles = shape == 1;
  body.nodes_per_element = card.integer("nodes_per_element", 8);
  body.axisymmetric = card.integer("geometry", 1) == 2;
  if (intervals(body) == 0)
    refuse(body, card, "nodes_per_element",
           "no " + std::string(body.triangles ? "triangle" : "quadrilateral") + " with " +
               std::to_string(body.nodes_per_element) +
               " nodes: triangles have 3, 6 or 15, quadrilaterals 4, 8 or 9");
}

// Values of a list in a list's card, which must have so many.
ValueList whole_list(const Body& body, const char* card_name, const char* field, std::int64_t wanted) {
  const CardView card = body.deck.one(card_name);
  ValueList list = card.list(field);
  if (static_cast<std::int64_t>(list.size()) != wanted)
    refuse(body, card, field,
           std::to_string(wanted) + " numbers are needed, and the card has " + std::to_string(list.size()));
  return list;
}

int count_of(const Body& body, const char* field) {
  const int n = body.card.integer(field);
  if (n < 1 || n > kMostListed)
    refuse(body, body.card, field, "the " + body.card.label(field) + " must be between 1 and 5000000");
  return n;
}

void read_nodes(Body& body) {
  const int nodes = count_of(body, "nodes");
  const CardView card = body.deck.one("mesh_nodes");
  const auto list = whole_list(body, "mesh_nodes", "coordinates", 2 * std::int64_t{nodes});
  for (int i = 0; i < nodes; ++i) {
    const FieldValue& x = list[2 * i];
    body.nodes.push_back({i + 1, {x.number, list[2 * i + 1].number}, card.where(x)});
  }
}

double area(const Body& body, const std::vector<int>& corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2& a = body.nodes[corners[i] - 1].x;
    const Vector2& z = body.nodes[corners[(i + 1) % corners.size()] - 1].x;
    twice += a.x() * z.y() - z.x() * a.y();
  }
  return 0.5 * twice;
}

// Inner nodes of a 15-node triangle in the order (1/4, 1/4), (1/2, 1/4), (1/4, 1/2): by where they are.
void order_inner(const Body& body, const std::vector<int>& corners, std::vector<int>& inner) {
  const auto at = [&](int node) { return body.nodes[node - 1].x; };
  const Vector2 a = at(corners[0]), b = at(corners[1]), c = at(corners[2]);
  const std::array<Vector2, 3> places{a + 0.25 * (b - a) + 0.25 * (c - a), a + 0.5 * (b - a) + 0.25 * (c - a),
                                      a + 0.25 * (b - a) + 0.5 * (c - a)};
  for (std::size_t i = 0; i < 3; ++i)
    std::iter_swap(
        inner.begin() + static_cast<std::ptrdiff_t>(i),
        std::min_element(inner.begin() + static_cast<std::ptrdiff_t>(i), inner.end(), [&](int m, int n) {
          return (at(m) - places[i]).norm() < (at(n) - places[i]).norm();
        }));
}

// Around the element from a corner, mid-side nodes between corners, in either sense; inner nodes behind.
std::vector<int> turned(const Body& body, const std::vector<int>& listed, const SourcePosition& where,
                        int number) {
  const auto k = static_cast<std::size_t>(intervals(body));
  const std::size_t sides = body.triangles ? 3 : 4, around = sides * k;
  std::vector<int> ring(listed.begin(), listed.begin() + static_cast<std::ptrdiff_t>(around));
  std::vector<int> corners;
  const auto take_corners = [&] {
    corners.clear();
    for (std::size_t i = 0; i < sides; ++i) corners.push_back(ring[i * k]);
    return area(body, corners);
  };
  double size = take_corners();
  if (size < 0.0) {
    std::reverse(ring.begin() + 1, ring.end());
    size = take_corners();
  }
  if (!(size > 0.0))
    refuse_at(body, where,
              "element " + std::to_string(number) + ": its corners, every " +
                  (k == 1   ? "node"
                   : k == 2 ? "second node"
                            : "fourth node") +
                  " listed, enclose no area");
  std::vector<int> nodes = corners;
  for (std::size_t i = 0; i < sides; ++i)
    nodes.insert(nodes.end(), ring.begin() + static_cast<std::ptrdiff_t>(i * k + 1),
                 ring.begin() + static_cast<std::ptrdiff_t>(i * k + k));
  std::vector<int> inner(listed.begin() + static_cast<std::ptrdiff_t>(around), listed.end());
  if (inner.size() == 3) order_inner(body, corners, inner);
  nodes.insert(nodes.end(), inner.begin(), inner.end());
  return nodes;
}

void read_elements(Body& body) {
  const int elements = count_of(body, "elements");
  const CardView card = body.deck.one("mesh_elements");
  const auto per_element = static_cast<std::size_t>(body.nodes_per_element);
  const auto list = whole_list(body, "mesh_elements", "nodes", std::int64_t{elements} * body.nodes_per_element);
  std::vector<int> listed(per_element);
  for (int e = 0; e < elements; ++e) {
    for (std::size_t i = 0; i < per_element; ++i) {
      const FieldValue& value = list[static_cast<std::size_t>(e) * per_element + i];
      if (!(value.number >= 1.0 && value.number <= static_cast<double>(body.nodes.size())))
        refuse_at(body, card.where(value),
                  "element " + std::to_string(e + 1) + ": node " +
                      std::to_string(static_cast<std::int64_t>(value.number)) + " is none of the " +
                      std::to_string(body.nodes.size()) + " nodes");
      listed[i] = static_cast<int>(value.number);
    }
    const SourcePosition where = card.where(list[static_cast<std::size_t>(e) * per_element]);
    body.elements.push_back({turned(body, listed, where, e + 1), where});
  }
}

}  // namespace

Deck listed_deck(const Deck& deck, const Catalogue& catalogue) {
  Body body{deck, catalogue, deck.one("mesh")};
  read_kind(body);
  read_nodes(body);
  read_elements(body);
  CardWriter out(deck);
  add_body(body, element_materials(body), "mesh listed by order", out);
  out.copy("fixity");
  add_loading(body, out);
  return out.take();
}

}  // namespace sage::translate

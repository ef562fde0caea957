// Edge loads that name the nodes of the edge, as many programs have them.
#include <array>
#include <cmath>

#include "sage/build/builder.hpp"
#include "sage/core/types.hpp"

namespace sage::build {

namespace {

const Group& group_of(const Builder& b, const DirectedEdge& edge) {
  return b.model.groups[static_cast<std::size_t>(edge.group)];
}

int node_of(const Builder& b, const DirectedEdge& edge, int local) {
  const Group& group = group_of(b, edge);
  return group.nodes[static_cast<std::size_t>(edge.element * group.entry->nodes + local)];
}

int number_of(const Builder& b, const DirectedEdge& edge) {
  return group_of(b, edge).element_numbers[static_cast<std::size_t>(edge.element)];
}

// Every edge of a solid by its end nodes, in the counter-clockwise sense of the element.
void index_edges(Builder& b) {
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (!group.element || !group.solid()) continue;
    const auto& edges = group.element->edges();
    for (int e = 0; e < group.elements(); ++e)
      for (std::size_t k = 0; k < edges.size(); ++k) {
        const DirectedEdge edge{static_cast<int>(g), e, static_cast<int>(k)};
        b.edges.try_emplace({node_of(b, edge, edges[k][0]), node_of(b, edge, edges[k][1])}, edge);
      }
  }
}

std::string nodes_text(const CardView& card, const char* first, const char* last) {
  return std::to_string(card.integer(first)) + "-" + std::to_string(card.integer(last));
}

// The edge from the first node to the last; false, and an error, where no solid has it.
bool find_edge(Builder& b, const CardView& card, int first, int last, const char* last_field,
               DirectedEdge& edge) {
  if (b.edges.empty()) index_edges(b);
  const std::string name = "edge " + nodes_text(card, "n1", last_field);
  const auto found = b.edges.find({first, last});
  if (found == b.edges.end()) {
    const auto back = b.edges.find({last, first});
    if (b.elements_known)
      b.error(card.where("n1"), back == b.edges.end()
                                    ? name + ": no solid element has an edge between these nodes"
                                    : name + ": the nodes run clockwise around element " +
                                          std::to_string(number_of(b, back->second)) +
                                          ", whose edge it is; list them counter-clockwise");
    return false;
  }
  edge = found->second;
  const int wanted = card.integer("element");
  if (wanted == 0 || wanted == number_of(b, edge)) return true;
  b.error(card.where("element"), name + " belongs to element " + std::to_string(number_of(b, edge)) + ", not " +
                                     std::to_string(wanted));
  return false;
}

// Forces of the part of a pressure by which its middle value differs from the mean of the ends:
// p = bulge (1 - s^2), s from -1 to 1 along the parabola through the three nodes.
void add_bulge(const Builder& b, const std::array<int, 3>& nodes, double normal, double shear, int line,
               std::vector<NodalLoad>& out) {
  constexpr std::array<double, 4> at{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                     0.8611363115940526};
  constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  std::array<NodalLoad, 3> forces;
  for (std::size_t i = 0; i < 3; ++i) forces[i] = {nodes[i], Vector2::Zero(), line};
  for (std::size_t q = 0; q < 4; ++q) {
    const double s = at[q];
    const std::array<double, 3> shape{s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2},
        slope{s - 0.5, -2 * s, s + 0.5};
    Vector2 tangent = Vector2::Zero(), place = Vector2::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      tangent += slope[i] * b.model.mesh.x.col(nodes[i]);
      place += shape[i] * b.model.mesh.x.col(nodes[i]);
    }
    const double measure = b.model.geometry == Geometry::axisymmetric ? 2.0 * kPi * place.x() : 1.0;
    const Vector2 inward(-tangent.y(), tangent.x());  // the element is to the left of its edge
    const Vector2 traction = weight[q] * measure * (1 - s * s) * (normal * inward + shear * tangent);
    for (std::size_t i = 0; i < 3; ++i) forces[i].force += shape[i] * traction;
  }
  out.insert(out.end(), forces.begin(), forces.end());
}

}  // namespace

void read_edge_load(Builder& b, const CardView& card, std::vector<EdgeLoad>& out,
                    std::vector<NodalLoad>& forces) {
  for (const char* field : {"normal1", "normal2", "normal3", "shear1", "shear2", "shear3"})
    if (!b.usable(card, field, card.real(field))) return;
  const bool middle = card.integer("n3") != 0;
  const char* last_field = middle ? "n3" : "n2";
  const int first = b.node(card, "n1", card.integer("n1"));
  const int last = b.node(card, last_field, card.integer(last_field));
  if (first < 0 || last < 0) return;
  DirectedEdge edge;
  if (!find_edge(b, card, first, last, last_field, edge)) return;
  EdgeLoad load;
  load.group = edge.group;
  load.element = edge.element;
  load.edge = edge.edge;
  load.line = card.card().line;
  load.normal = {card.real("normal1"), card.real(middle ? "normal3" : "normal2")};
  load.shear = {card.real("shear1"), card.real(middle ? "shear3" : "shear2")};
  out.push_back(load);
  if (!middle) return;
  const int local = middle_of(group_of(b, edge).element->edges()[static_cast<std::size_t>(edge.edge)]);
  const int node = b.node(card, "n2", card.integer("n2"));
  if (node < 0) return;
  if (local < 0 || node_of(b, edge, local) != node)
    return b.error(card.where("n2"), "node " + std::to_string(card.integer("n2")) +
                                         " is not the middle node of edge " + nodes_text(card, "n1", "n3") +
                                         " of element " + std::to_string(number_of(b, edge)));
  const double normal = card.real("normal2") - load.normal.mean(),
               shear = card.real("shear2") - load.shear.mean();
  const double size =
      std::abs(card.real("normal2")) + std::abs(card.real("shear2")) + load.normal.norm() + load.shear.norm();
  if (std::abs(normal) + std::abs(shear) > 1e-14 * size)
    add_bulge(b, {first, node, last}, normal, shear, load.line, forces);
}

}  // namespace sage::build

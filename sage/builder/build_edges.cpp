// Edge loads that name the nodes of the edge, as many programs have them.
#include <array>
#include <cmath>

#include "sage/builder/builder.hpp"
#include "sage/core/types.hpp"
#include "sage/deck/text.hpp"

namespace sage::builder {

namespace {

const Group& group_of(const Builder& b, const DirectedEdge& edge) {
  return b.model.groups[edge.group];
}

int node_of(const Builder& b, const DirectedEdge& edge, int local) {
  const Group& group = group_of(b, edge);
  return group.nodes[edge.element * group.entry->nodes + local];
}

int number_of(const Builder& b, const DirectedEdge& edge) {
  return group_of(b, edge).element_numbers[edge.element];
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

// How the nodes of an edge are listed, and where its pressure pushes.
enum class Sense {
  counter_clockwise = 1,  // around the element, into which the pressure pushes
  clockwise = 2,          // likewise
  either = 3,             // likewise
  to_the_left = 4,        // either; the pressure pushes to the left of the way from the first node to the last
};

// An edge_load card.  Node indices and values in the order of the card, the middle node's in the middle.
struct ListedEdge {
  int first = -1, middle = -1, last = -1;  // middle: -1 without one
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), shear = Eigen::Vector3d::Zero();
  Sense sense = Sense::counter_clockwise;
};

// "edge 3-2-1", as the card has it.
std::string edge_name(const CardView& card) {
  std::string text = "edge " + std::to_string(card.integer("n1")) + "-" + std::to_string(card.integer("n2"));
  if (card.integer("n3") != 0) text += "-" + std::to_string(card.integer("n3"));
  return text;
}

// Puts the edge into the counter-clockwise order of its element.
void turn(ListedEdge& listed) {
  std::swap(listed.first, listed.last);
  listed.normal.reverseInPlace();
  listed.shear = -listed.shear.reverse().eval();
  if (listed.sense == Sense::to_the_left) listed.normal = -listed.normal;
}

void refuse_order(Builder& b, const CardView& card, const DirectedEdge& edge, bool clockwise) {
  b.error("S231", card.where("n1"),
          edge_name(card) + ": its nodes, listed in this order, run " +
              (clockwise ? "clockwise" : "counter-clockwise") + " around element " +
              std::to_string(number_of(b, edge)) + ", whose edge it is; list them " +
              (clockwise ? "counter-clockwise" : "clockwise") +
              ", or let the layout give its edge_load card a field sense: 1 counter-clockwise, "
              "2 clockwise, 3 either, 4 either with the pressure to the left of the way");
}

// The edge of the element that takes the load, and whether its nodes are listed clockwise; false after an error.
bool find_edge(Builder& b, const CardView& card, const ListedEdge& listed, DirectedEdge& edge,
               bool& clockwise) {
  if (b.edges.empty()) index_edges(b);
  const auto found = [&](int from, int to) {
    const auto at = b.edges.find({from, to});
    return at == b.edges.end() ? nullptr : &at->second;
  };
  const DirectedEdge* const along = found(listed.first, listed.last);
  const DirectedEdge* const back = found(listed.last, listed.first);
  const bool either = listed.sense == Sense::either || listed.sense == Sense::to_the_left;
  const int wanted = card.integer("element");
  const DirectedEdge* best = listed.sense == Sense::clockwise ? back : along;
  if (best == nullptr) best = along != nullptr ? along : back;
  if (wanted != 0)
    for (const DirectedEdge* one : {along, back})
      if (one != nullptr && number_of(b, *one) == wanted) best = one;
  if (best == nullptr) {
    if (b.elements_known)
      b.error("S230", card.where("n1"), edge_name(card) + ": no solid element has an edge between these nodes");
    return false;
  }
  edge = *best;
  clockwise = best == back;
  if (wanted != 0 && wanted != number_of(b, edge)) {
    b.error("S230", card.where("element"),
            edge_name(card) + " belongs to element " + std::to_string(number_of(b, edge)) + ", not " +
                std::to_string(wanted));
    return false;
  }
  if (listed.sense == Sense::either && wanted == 0 && along != nullptr && back != nullptr) {
    b.error("S230", card.where("n1"),
            edge_name(card) + " lies between elements " + std::to_string(number_of(b, *along)) + " and " +
                std::to_string(number_of(b, *back)) +
                ": field element must say which of them the pressure pushes into");
    return false;
  }
  if (either || clockwise == (listed.sense == Sense::clockwise)) return true;
  refuse_order(b, card, edge, clockwise);
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

// False after an error.
bool read_listed(Builder& b, const CardView& card, ListedEdge& listed) {
  for (const char* field : {"normal1", "normal2", "normal3", "shear1", "shear2", "shear3"})
    if (!b.usable(card, field, card.real(field))) return false;
  const int sense = card.integer("sense", 1);
  if (sense < 1 || sense > 4) {
    b.error("S210", card.where("sense"),
            "sense " + std::to_string(sense) +
                " of an edge is unknown; 1 counter-clockwise around its element, 2 clockwise, "
                "3 either, 4 either with the pressure to the left of the way");
    return false;
  }
  listed.sense = static_cast<Sense>(sense);
  const bool middle = card.integer("n3") != 0;
  for (const char* field : {"normal3", "shear3"})
    if (!middle && card.real(field) != 0.0) {
      b.error("S232", card.where(field),
              edge_name(card) + ": the " + card.label(field) + " is " + rounded_text(card.real(field)) +
                  ", but the card has no third node");
      return false;
    }
  listed.first = b.node(card, "n1", card.integer("n1"));
  const int second = b.node(card, "n2", card.integer("n2"));
  listed.last = middle ? b.node(card, "n3", card.integer("n3")) : second;
  listed.middle = middle ? second : -1;
  if (listed.first < 0 || second < 0 || listed.last < 0) return false;
  if (middle) {
    listed.normal = {card.real("normal1"), card.real("normal2"), card.real("normal3")};
    listed.shear = {card.real("shear1"), card.real("shear2"), card.real("shear3")};
  } else {
    listed.normal = {card.real("normal1"), 0.0, card.real("normal2")};
    listed.shear = {card.real("shear1"), 0.0, card.real("shear2")};
  }
  return true;
}

}  // namespace

void read_edge_load(Builder& b, const CardView& card, std::vector<EdgeLoad>& out,
                    std::vector<NodalLoad>& forces) {
  ListedEdge listed;
  DirectedEdge edge;
  bool clockwise = false;
  if (!read_listed(b, card, listed) || !find_edge(b, card, listed, edge, clockwise)) return;
  if (clockwise) turn(listed);
  EdgeLoad load;
  load.group = edge.group;
  load.element = edge.element;
  load.edge = edge.edge;
  load.line = card.card().line;
  load.normal = {listed.normal[0], listed.normal[2]};
  load.shear = {listed.shear[0], listed.shear[2]};
  out.push_back(load);
  if (listed.middle < 0) return;
  const int local = middle_of(group_of(b, edge).element->edges()[edge.edge]);
  if (local < 0 || node_of(b, edge, local) != listed.middle)
    return b.error("S232", card.where("n2"),
                   "node " + std::to_string(card.integer("n2")) + " is not the middle node of edge " +
                       std::to_string(card.integer("n1")) + "-" + std::to_string(card.integer("n3")) +
                       " of element " + std::to_string(number_of(b, edge)));
  const double normal = listed.normal[1] - load.normal.mean(), shear = listed.shear[1] - load.shear.mean();
  const double size = listed.normal.lpNorm<1>() + listed.shear.lpNorm<1>();
  if (std::abs(normal) + std::abs(shear) > 1e-14 * size)
    add_bulge(b, {listed.first, listed.middle, listed.last}, normal, shear, load.line, forces);
}

}  // namespace sage::builder

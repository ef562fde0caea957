// What the parts of CANDE's translation share.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "sage/core/types.hpp"
#include "sage/exchange/translate.hpp"

namespace sage::translate {

constexpr double kCandeWaterWeight = 0.036111;  // lbf/in^3, of the units card

inline bool is_soil(const CardView& element) {
  return element.integer("n3") != 0 && element.integer("class") == 0;
}
inline bool is_beam(const CardView& element) {
  return element.integer("n3") == 0 && element.integer("class") == 0;
}
inline int birth_of(const CardView& element) {
  return std::max(1, element.integer("birth"));
}

// Throws InputError S702 at a field of that deck.
[[noreturn]] void refuse_field(const Deck& deck, const SourcePosition& where, const std::string& message);

// Largest moduli of a deck's soils; 0: it has none of the kind.
struct SoilStiffness {
  double elastic = 0.0, hyperbolic = 0.0;
};

// Interfaces (class 1) and links (class 8 and 9).  Each joins two nodes at one place and names a third of its own.
// It becomes an interface4 of length 2 across the normal: one pair is the two nodes, with the length 1 for its part, so
// that tractions are CANDE's forces on a unit of the pipe's length; the other pair, the third node and a new one, is held.
// The normal of an interface points from its first node to its second.
class CandeJoints {
 public:
  CandeJoints(const Deck& deck, CardWriter& out);

  // Of a link that can't be: it is left out already, with its reason.
  bool takes(const CardView& element) const { return known_.contains(element.integer("number")); }
  // The node that stands for this one: links of fixed beams join two nodes for good.
  int node(int number) const;
  // Third nodes of joints: add_nodes places them elsewhere.
  bool moves(int node) const { return moved_.contains(node); }

  void add_nodes(CardWriter& out) const;
  // Materials from `material` + 1, groups from `group` + 1, elements and supports.  stiffest_wall: the largest E A of
  // beams.
  void add(const Catalogue& catalogue, const SoilStiffness& soils, double stiffest_wall, int material,
           int group, CardWriter& out);
  // What is open at the start, so without a bond: the history of the groups born in this step, on the stage's card;
  // stage -1: before the stages.
  void add_gaps(int step, int stage, CardWriter& out) const;
  int last_step() const { return last_step_; }
  int highest_node() const { return highest_node_; }

  struct Law {
    double friction, tension, gap;
    bool bonded;
    auto operator<=>(const Law&) const = default;
  };
  struct Group {
    Law law;
    int birth, death, number;
    SourcePosition where;
  };
  const std::vector<Group>& groups() const { return groups_; }

 private:
  struct Joint {
    CardView card;
    Law law;
    int first, second, third, fourth;
    Vector2 far;  // place of the third and fourth node
  };
  struct Material {
    SourcePosition where;  // of the angle
    double angle;
    Law law;
  };
  struct Around {                    // of a node
    Vector2 soil = Vector2::Zero();  // sum of the middles of its soil elements
    int soils = 0, uses = 0, birth = 0;
    bool beam = false, held = false;
  };

  void look_around(const Deck& deck);
  void read_materials(const Deck& deck);
  Joint start(const Deck& deck, const CardView& element, const char* what);
  void add_interface(const Deck& deck, const CardView& element);
  void add_link(const Deck& deck, const CardView& element, CardWriter& out);
  double towards_soil(const Joint& joint, const Vector2& normal) const;

  std::map<int, Vector2> nodes_;
  std::map<int, Around> around_;
  std::map<int, int> joined_;
  std::map<int, Material> materials_;
  std::vector<Joint> joints_;
  std::set<int> known_, moved_;
  std::vector<Group> groups_;
  int last_step_ = 0, highest_node_ = 0, turned_ = 0, along_ = 0;
  SourcePosition first_turned_, first_along_;
};

}  // namespace sage::translate

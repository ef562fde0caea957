// Displacement, strain and stress at any place.  What the place needs of the solution is found once for a set
// of active groups: a value is then a short sum over nodes or integration points.
//
// Displacement: the element's shape functions.  Stress and strain: within one zone (zones_of), a polynomial
// fitted to the places where they are most accurate (Element::point_to_sample) in the elements around each
// corner of the element that holds the place, the corners' polynomials blended by the place's distance from
// them (Zienkiewicz & Zhu 1992); quadrilaterals of degree 4 and more by the polynomial through their own such
// places. docs/theory/accuracy.md.
#pragma once

#include "sage/analysis/observer.hpp"
#include "sage/analysis/patch_fit.hpp"
#include "sage/model/locate.hpp"

namespace sage {

struct Probe {
  struct Node {
    int node = 0;
    double weight = 0.0;
  };
  struct Point {
    std::size_t group = 0, point = 0;  // in Assembly::groups and its state store
    double weight = 0.0;
  };
  int group = -1, element = -1;  // that hold the place; -1 = no active one does
  std::vector<Node> nodes;
  std::vector<Point> points;

  bool active() const { return group >= 0; }
};

// Tension positive.
struct ProbeValue {
  Vector2 u = Vector2::Zero();
  Vector4 strain = Vector4::Zero(), stress = Vector4::Zero();
};

// All zero for an inactive probe.
ProbeValue read_probe(const Probe& probe, const Solution& solution);

class ProbeMaker {
 public:
  // Of the solids, or of the elements of flow.  The model must outlive it.  `active`: by group.
  ProbeMaker(const Model& model, const std::vector<char>& active, ElementKind kind = ElementKind::solid);

  // Where several elements of one body meet, the mean of their answers; where bodies meet (zones, sides of an
  // interface), the first group of the deck answers, or `group` where it is not negative.
  Probe at(const Vector2& place, int group = -1) const;
  // The same with the stress that each element has by itself: between the places where it is most accurate, without its
  // neighbours.
  Probe own_at(const Vector2& place, int group = -1) const;
  // Whether a corner of the probe's element has elements of its zone all around.  A body of one row of elements has none, and
  // its patches can't hold a stress that changes across the row at a rate that changes along it: there the elements' own
  // stress is the better one.
  bool is_surrounded(const Probe& probe) const;
  // Whether both are the same in elements of this group.
  static bool uses_own_stress(const Group& group);

 private:
  Probe blank_at(const Vector2& place, int group, std::vector<Location>& found) const;
  void add_stress(Probe& probe, const Location& location, double part) const;
  void add_own(Probe& probe, const Location& location, double part) const;
  void add_sampled(Probe& probe, const Location& location, double part) const;
  void add_patch(Probe& probe, std::span<const std::size_t> patch, const Vector2& place, double part) const;
  const Patches& patches(int zone) const;

  const Model* model_;
  std::vector<char> active_;
  std::vector<int> zone_;  // of each group
  Locator locator_;
  std::vector<ElementRef> elements_;        // active ones
  mutable std::map<int, Patches> patches_;  // by zone, computed at the first use
};

}  // namespace sage

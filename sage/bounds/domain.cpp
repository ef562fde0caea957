#include "sage/bounds/domain.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace sage::bounds {

namespace {

std::pair<int, int> pair_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// Longest-edge bisection after Rivara (1984): the chain of triangles with ever longer edges ends, because edges are
// compared by length and then by their nodes.
class Bisection {
 public:
  explicit Bisection(Domain& domain) : d_(domain), parents_(domain.triangles.size()) {
    std::iota(parents_.begin(), parents_.end(), 0);
    for (std::size_t t = 0; t < d_.triangles.size(); ++t) enter(static_cast<int>(t));
    for (std::size_t i = 0; i < d_.boundary.size(); ++i)
      boundary_[pair_of(d_.boundary[i].a, d_.boundary[i].b)] = static_cast<int>(i);
    for (std::size_t i = 0; i < d_.joints.size(); ++i)
      for (const auto* side : {&d_.joints[i].first, &d_.joints[i].second})
        joint_[pair_of((*side)[0], (*side)[1])] = static_cast<int>(i);
  }

  void divide(int t) {
    const auto edge = longest(t);
    for (;;) {
      const int other = neighbour(t, edge);
      if (other < 0 || longest(other) == edge) break;
      divide(other);
    }
    split(edge);
  }

  // Halves the angle of a triangle at a node.
  void halve_angle(int t, int node) {
    const auto& n = d_.triangles[at(t)].node;
    for (int i = 0; i < 3; ++i)
      if (n[at(i)] == node) {
        const Key edge = key(t, (i + 1) % 3);
        if (!joint_.contains(edge)) split_side(edge);
        return;
      }
  }

  // By triangle: the one that it was a part of.
  std::vector<int> parents() const { return parents_; }

 private:
  using Key = std::pair<int, int>;

  void enter(int t) {
    for (int i = 0; i < 3; ++i) {
      auto& both = owners_.try_emplace(key(t, i), std::array<int, 2>{-1, -1}).first->second;
      both[both[0] < 0 ? 0 : 1] = t;
    }
  }
  void leave(int t) {
    for (int i = 0; i < 3; ++i) {
      auto& both = owners_.at(key(t, i));
      both[both[0] == t ? 0 : 1] = -1;
    }
  }
  Key key(int t, int i) const {
    const auto& node = d_.triangles[at(t)].node;
    return pair_of(node[at(i)], node[at((i + 1) % 3)]);
  }
  int neighbour(int t, const Key& edge) const {
    const auto& both = owners_.at(edge);
    return both[0] == t ? both[1] : both[0];
  }
  // Lengths that differ by rounding count as equal, so that meshes of equal squares are divided alike.
  Key longest(int t) const {
    Key best = key(t, 0);
    double length = length_of(best);
    for (int i = 1; i < 3; ++i) {
      const Key other = key(t, i);
      const double size = length_of(other);
      if (size > length * (1.0 + 1e-9) || (size > length * (1.0 - 1e-9) && other > best)) {
        length = size;
        best = other;
      }
    }
    return best;
  }
  double length_of(const Key& edge) const { return (d_.x[at(edge.first)] - d_.x[at(edge.second)]).norm(); }

  void split(const Key& edge) {
    const auto joint = joint_.find(edge);
    if (joint == joint_.end()) {
      split_side(edge);
      return;
    }
    const int index = joint->second;
    const Joint old = d_.joints[at(index)];
    const int first = split_both(old.first), second = split_both(old.second);
    d_.joints[at(index)].first[1] = first;
    d_.joints[at(index)].second[1] = second;
    Joint rest = old;
    rest.first[0] = first;
    rest.second[0] = second;
    d_.joints.push_back(rest);
    for (const auto* side : {&old.first, &old.second}) joint_.erase(pair_of((*side)[0], (*side)[1]));
    for (const int i : {index, static_cast<int>(d_.joints.size()) - 1})
      for (const auto* side : {&d_.joints[at(i)].first, &d_.joints[at(i)].second})
        joint_[pair_of((*side)[0], (*side)[1])] = i;
  }
  // One side of a joint: its triangle is divided there, after longer edges of its own.
  int split_both(const std::array<int, 2>& side) {
    const Key edge = pair_of(side[0], side[1]);
    for (;;) {
      const auto& both = owners_.at(edge);
      const int t = both[0] >= 0 ? both[0] : both[1];
      if (t < 0 || longest(t) == edge) break;
      divide(t);
    }
    return split_side(edge);
  }
  // Where the line between the nodes opposite to an edge crosses it, if near the middle: four edges nearly on two lines
  // would give equations that nearly depend on others; on two lines, one of them depends and is left out.
  double share_at(const Key& edge, const std::array<int, 2>& both) const {
    constexpr double kNear = 0.2;
    if (both[0] < 0 || both[1] < 0) return 0.5;
    const Vector2 a = d_.x[at(edge.first)], r = d_.x[at(edge.second)] - a,
                  p = d_.x[at(opposite(both[0], edge))], q = d_.x[at(opposite(both[1], edge))] - p;
    const double turn = r.x() * q.y() - r.y() * q.x();
    const double share = ((p - a).x() * q.y() - (p - a).y() * q.x()) / turn;
    return std::abs(share - 0.5) < kNear ? share : 0.5;
  }
  int opposite(int t, const Key& edge) const {
    for (const int node : d_.triangles[at(t)].node)
      if (node != edge.first && node != edge.second) return node;
    return -1;
  }
  int split_side(const Key& edge) {
    const int middle = static_cast<int>(d_.x.size());
    const std::array<int, 2> both = owners_.at(edge);
    d_.x.push_back(d_.x[at(edge.first)] +
                   share_at(edge, both) * (d_.x[at(edge.second)] - d_.x[at(edge.first)]));
    for (const int t : both)
      if (t >= 0) split_triangle(t, edge, middle);
    split_boundary(edge, middle);
    return middle;
  }
  void split_triangle(int t, const Key& edge, int middle) {
    leave(t);
    Triangle one = d_.triangles[at(t)], two = one;
    for (int i = 0; i < 3; ++i)
      if (key(t, i) == edge) {
        one.node[at((i + 1) % 3)] = middle;
        two.node[at(i)] = middle;
      }
    d_.triangles[at(t)] = one;
    d_.triangles.push_back(two);
    parents_.push_back(parents_[at(t)]);
    enter(t);
    enter(static_cast<int>(d_.triangles.size()) - 1);
  }
  void split_boundary(const Key& edge, int middle) {
    const auto found = boundary_.find(edge);
    if (found == boundary_.end()) return;
    const int index = found->second;
    boundary_.erase(found);
    Boundary one = d_.boundary[at(index)], two = one;
    one.b = two.a = middle;
    for (auto list : {&Boundary::motion, &Boundary::fixed, &Boundary::live}) {
      const Vector2 mean = 0.5 * ((one.*list)[0] + (one.*list)[1]);
      (one.*list)[1] = (two.*list)[0] = mean;
    }
    d_.boundary[at(index)] = one;
    d_.boundary.push_back(two);
    boundary_[pair_of(one.a, one.b)] = index;
    boundary_[pair_of(two.a, two.b)] = static_cast<int>(d_.boundary.size()) - 1;
  }

  Domain& d_;
  std::vector<int> parents_;
  std::map<Key, std::array<int, 2>> owners_;
  std::map<Key, int> boundary_, joint_;
};

// What acts on an edge at one of its nodes, or how it is held.
struct EdgeState {
  Vector2 along = Vector2::Zero(), fixed = Vector2::Zero(), live = Vector2::Zero();
  std::array<bool, 2> held{};
  bool moved = false;
};

bool differ(const EdgeState& one, const EdgeState& other) {
  const double size = 1e-6 * (one.fixed.norm() + other.fixed.norm() + one.live.norm() + other.live.norm());
  return one.held != other.held || one.moved != other.moved || (one.fixed - other.fixed).norm() > size ||
         (one.live - other.live).norm() > size;
}

// Nodes where two free edges go on in about the same direction and what acts on them differs.
std::vector<int> singular_nodes(const Domain& domain) {
  std::map<int, std::vector<EdgeState>> at_node;
  for (const Edge& edge : edges_of(domain).all) {
    if (edge.triangle[1] >= 0 || edge.joint >= 0) continue;
    for (const int node : {edge.a, edge.b}) {
      EdgeState state;
      state.along = (domain.x[at(node == edge.a ? edge.b : edge.a)] - domain.x[at(node)]).normalized();
      if (edge.boundary >= 0) {
        const Boundary& b = domain.boundary[at(edge.boundary)];
        const std::size_t end = b.a == node ? 0 : 1;
        state.fixed = b.fixed[end];
        state.live = b.live[end];
        state.held = b.held;
        state.moved = !b.motion[end].isZero(0.0);
      }
      at_node[node].push_back(state);
    }
  }
  std::vector<int> nodes;
  for (const auto& [node, states] : at_node)
    if (states.size() == 2 && states[0].along.dot(states[1].along) < -0.7 && differ(states[0], states[1]))
      nodes.push_back(node);
  return nodes;
}

}  // namespace

void fan_out(Domain& domain, int times) {
  const std::vector<int> nodes = singular_nodes(domain);
  for (int turn = 0; turn < times; ++turn)
    for (const int node : nodes) {
      Bisection bisection(domain);
      const int count = static_cast<int>(domain.triangles.size());
      for (int t = 0; t < count; ++t) bisection.halve_angle(t, node);
    }
}

// With t = sigma_zz - p chosen for the least sqrt(J2) + alpha I1 - k, the cone leaves
// R sqrt(1 - 3 alpha^2) + 3 alpha p <= k for the radius R of Mohr's circle in the plane and its centre p.
Strength Strength::in_plane() const {
  if (yield == Yield::mohr_coulomb) return *this;
  const double s = std::sin(friction), c = cohesion * std::cos(friction);
  double alpha = s / 3.0, k = c;
  if (yield == Yield::cone_compression || yield == Yield::cone_extension) {
    const double below = std::numbers::sqrt3 * (yield == Yield::cone_compression ? 3.0 - s : 3.0 + s);
    alpha = 2.0 * s / below;
    k = 6.0 * c / below;
  } else if (yield != Yield::cone_deviatoric) {
    const double t = std::tan(friction), root = std::sqrt(9.0 + 12.0 * t * t);
    alpha = t / root;
    k = 3.0 * cohesion / root;
  }
  const double root = std::sqrt(1.0 - 3.0 * alpha * alpha), sine = 3.0 * alpha / root;
  if (sine >= 1.0) return {cohesion, 0.5 * std::numbers::pi, Yield::mohr_coulomb};
  const double phi = std::asin(sine);
  return {k / root / std::cos(phi), phi, Yield::mohr_coulomb};
}

Strength Strength::reduced(double factor) const {
  return {cohesion / factor, std::atan(std::tan(friction) / factor), yield};
}

double Domain::area(const Triangle& t) const {
  const Vector2 a = x[at(t.node[1])] - x[at(t.node[0])], b = x[at(t.node[2])] - x[at(t.node[0])];
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

bool Domain::moved() const {
  return std::ranges::any_of(boundary, [](const Boundary& edge) {
    return edge.motion[0].squaredNorm() > 0.0 || edge.motion[1].squaredNorm() > 0.0;
  });
}

Edges edges_of(const Domain& domain) {
  Edges edges;
  std::map<std::pair<int, int>, int> found;
  edges.of.resize(domain.triangles.size());
  for (std::size_t t = 0; t < domain.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto& node = domain.triangles[t].node;
      const auto key = pair_of(node[at(i)], node[at((i + 1) % 3)]);
      const auto [place, made] = found.try_emplace(key, static_cast<int>(edges.all.size()));
      if (made) edges.all.push_back({.a = key.first, .b = key.second});
      Edge& edge = edges.all[at(place->second)];
      const std::size_t side = edge.triangle[0] < 0 ? 0 : 1;
      edge.triangle[side] = static_cast<int>(t);
      edge.local[side] = i;
      edges.of[t][at(i)] = place->second;
    }
  for (std::size_t i = 0; i < domain.boundary.size(); ++i) {
    const auto place = found.find(pair_of(domain.boundary[i].a, domain.boundary[i].b));
    if (place != found.end()) edges.all[at(place->second)].boundary = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < domain.joints.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      const auto& nodes = side == 0 ? domain.joints[i].first : domain.joints[i].second;
      const auto place = found.find(pair_of(nodes[0], nodes[1]));
      if (place == found.end()) continue;
      edges.all[at(place->second)].joint = static_cast<int>(i);
      edges.all[at(place->second)].side = side;
    }
  return edges;
}

std::vector<int> refine(Domain& domain, const std::vector<char>& marked) {
  // A marked triangle may have been divided before its turn comes: its first half keeps its place in the list.
  std::vector<Triangle> before = domain.triangles;
  Bisection bisection(domain);
  for (std::size_t t = 0; t < marked.size(); ++t)
    if (marked[t] && domain.triangles[t].node == before[t].node) bisection.divide(static_cast<int>(t));
  return bisection.parents();
}

}  // namespace sage::bounds

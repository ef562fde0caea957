#include "sage/bounds/programs.hpp"

#include <algorithm>
#include <cmath>

#include "sage/bounds/dependent_equations.hpp"

namespace sage::bounds {

namespace {

constexpr int kHeld = -1;

// Where a row of a part goes: an equation, times a factor.
struct Row {
  int equation = kHeld;
  double factor = 1.0;
};

Cone cone_of(const Strength& strength, Quantity quantity, double stress) {
  Cone cone;
  const Strength s = strength.in_plane();
  const double sine = std::sin(s.friction);
  cone.h0[0] = 2.0 * s.cohesion / stress * std::cos(s.friction);
  cone.G << sine, sine, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -2.0;
  if (quantity == Quantity::strength) cone.h1[0] = -2.0;
  return cone;
}

Cone joint_cone(const Strength& s, Quantity quantity, double stress) {
  Cone cone;
  cone.h0[0] = s.cohesion / stress;
  cone.G(0, 0) = std::tan(s.friction);
  cone.G(1, 1) = -1.0;
  if (quantity == Quantity::strength) cone.h1[0] = -1.0;
  return cone;
}

// Gradients of the barycentric coordinates, and twice the area.
struct TriangleShape {
  std::array<Vector2, 3> gradient;
  double area = 0.0;
  Vector2 middle = Vector2::Zero();

  TriangleShape(const Domain& domain, const Triangle& t, double length) {
    std::array<Vector2, 3> x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = domain.x[at(t.node[i])] / length;
    const Vector2 a = x[1] - x[0], b = x[2] - x[0];
    const double twice = a.x() * b.y() - a.y() * b.x();
    area = 0.5 * twice;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector2 side = x[(i + 2) % 3] - x[(i + 1) % 3];
      gradient[i] = Vector2(-side.y(), side.x()) / twice;
      middle += x[i] / 3.0;
    }
  }
};

// Outward normal of a triangle's edge times its length.
Vector2 outward(const Domain& domain, const Triangle& t, int local, double length) {
  const Vector2 side = (domain.x[at(t.node[at((local + 1) % 3)])] - domain.x[at(t.node[at(local)])]) / length;
  return {side.y(), -side.x()};
}

Units units_of(const Domain& domain, Quantity quantity) {
  Units units;
  Vector2 low = Vector2::Constant(1e300), high = -low;
  for (const Vector2& x : domain.x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  units.length = (high - low).norm();
  double strength = 0.0, area = 0.0, weight = 0.0, traction = 0.0, live = 0.0;
  for (const Triangle& t : domain.triangles) {
    const Soil& soil = domain.soils[at(t.soil)];
    const double a = domain.area(t);
    strength += a * soil.strength.cohesion * std::cos(soil.strength.friction);
    weight += a * (soil.weight_fixed.norm() + (quantity == Quantity::strength ? soil.weight_live.norm() : 0.0));
    live = std::max(live, soil.weight_live.norm() * units.length);
    area += a;
  }
  for (const Boundary& edge : domain.boundary)
    for (std::size_t i = 0; i < 2; ++i) {
      traction = std::max(traction, edge.fixed[i].norm());
      live = std::max(live, edge.live[i].norm());
    }
  if (quantity == Quantity::strength) traction = std::max(traction, live);
  units.stress = strength / area + 0.1 * weight / area * units.length + traction;
  if (!(units.stress > 0.0)) units.stress = 1.0;
  if (quantity == Quantity::strength)
    units.tau = units.stress;
  else if (domain.moved())
    units.tau = units.stress * units.length;
  else
    units.tau = live > 0.0 ? units.stress / live : 1.0;
  return units;
}

// Collects parts and loads; rows that share an equation become one.
class Builder {
 public:
  Builder(const Domain& domain, Quantity quantity)
      : domain_(domain), quantity_(quantity), units_(units_of(domain, quantity)) {}

  void add_part(int first_point, int points, const std::vector<Row>& rows, const Eigen::MatrixXd& A,
                const Vector2& place) {
    Part part{first_point, points, {}, {}, place};
    std::vector<Eigen::Index> target(rows.size(), -1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].equation == kHeld) continue;
      const auto found = std::ranges::find(part.equations, rows[i].equation);
      target[i] = found - part.equations.begin();
      if (found == part.equations.end()) part.equations.push_back(rows[i].equation);
    }
    part.A.setZero(static_cast<Eigen::Index>(part.equations.size()), A.cols());
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (target[i] >= 0) part.A.row(target[i]) += rows[i].factor * A.row(static_cast<Eigen::Index>(i));
    result_.program.parts.push_back(std::move(part));
  }
  void add_load(const Row& row, double fixed, double live) {
    if (row.equation == kHeld) return;
    const auto e = row.equation;
    if (quantity_ == Quantity::strength) {
      result_.program.b0[e] += row.factor * (fixed + live);
    } else {
      result_.program.b0[e] += row.factor * fixed;
      result_.program.b1[e] += row.factor * live;
    }
  }
  void size_equations(int equations) {
    result_.program.b0.setZero(equations);
    result_.program.b1.setZero(equations);
  }
  void add_cone(const Strength& strength, bool joint) {
    result_.program.cones.push_back(joint ? joint_cone(strength, quantity_, units_.stress)
                                          : cone_of(strength, quantity_, units_.stress));
  }
  // Of a stress that is known to be zero.
  void add_idle_cone() {
    Cone cone;
    cone.h0[0] = 1.0;
    cone.G(1, 1) = cone.G(2, 2) = 1.0;
    result_.program.cones.push_back(cone);
  }
  // The equation of the edges that move together.
  void add_motion(int equation) {
    if (equation >= 0) result_.program.b1[equation] = 1.0;
  }
  bool moves() const { return quantity_ == Quantity::load && domain_.moved(); }
  double largest_motion() const {
    double size = 0.0;
    for (const Boundary& edge : domain_.boundary)
      for (const Vector2& v : edge.motion) size = std::max(size, v.cwiseAbs().maxCoeff());
    return size;
  }

  // In the program's units.
  Vector2 body(const Vector2& density) const { return density * (units_.length / units_.stress); }
  Vector2 traction_fixed(const Boundary& edge, std::size_t i) const { return edge.fixed[i] / units_.stress; }
  Vector2 traction_live(const Boundary& edge, std::size_t i) const {
    return live_factor() * edge.live[i] / units_.stress;
  }
  double live_factor() const { return quantity_ == Quantity::load && !domain_.moved() ? units_.tau : 1.0; }
  double pressure(const Triangle& t, int corner) const { return domain_.pressure(t, corner) / units_.stress; }
  double length() const { return units_.length; }

  BoundProgram finish() {
    result_.units = units_;
    return std::move(result_);
  }
  BoundProgram result_;

 private:
  const Domain& domain_;
  Quantity quantity_;
  Units units_;
};

// ---- lower bound

class Lower {
 public:
  Lower(const Domain& domain, const Edges& edges, Quantity quantity)
      : d_(domain), edges_(edges), build_(domain, quantity) {}

  BoundProgram make() {
    number();
    find_stress_free();
    for (std::size_t t = 0; t < d_.triangles.size(); ++t) add_triangle(static_cast<int>(t));
    add_joints();
    for (const Edge& edge : edges_.all)
      if (edge.boundary >= 0) add_tractions(edge);
    build_.add_motion(motion_);
    build_.result_.stress_free = free_;
    build_.result_.stress_free.resize(build_.result_.program.cones.size(), 0);
    build_.result_.program.dependent = dependent_equations(build_.result_.program, nodes_of_equations());
    return build_.finish();
  }

 private:
  // Rows of an edge: x and y at its node a, x and y at b.
  std::array<Row, 4>& rows(int edge) { return rows_[at(edge)]; }

  void number() {
    int next = 2 * static_cast<int>(d_.triangles.size());
    if (build_.moves()) motion_ = next++;
    const double unit = build_.largest_motion();
    rows_.resize(edges_.all.size());
    for (std::size_t e = 0; e < edges_.all.size(); ++e) {
      const Boundary* boundary =
          edges_.all[e].boundary >= 0 ? &d_.boundary[at(edges_.all[e].boundary)] : nullptr;
      for (std::size_t end = 0; end < 2; ++end)
        for (std::size_t axis = 0; axis < 2; ++axis) {
          Row& row = rows_[e][2 * end + axis];
          if (boundary == nullptr || !boundary->held[axis]) {
            row = {next++, 1.0};
          } else if (build_.moves()) {
            const bool swapped = boundary->a != edges_.all[e].a;
            const auto axis_at = static_cast<Eigen::Index>(axis);
            const double here = boundary->motion[swapped ? 1 - end : end][axis_at],
                         there = boundary->motion[swapped ? end : 1 - end][axis_at];
            const double factor = (2.0 * here + there) / (6.0 * unit);
            if (factor != 0.0) row = {motion_, factor};
          }
        }
    }
    build_.size_equations(next);
  }

  std::vector<int> nodes_of_equations() const {
    std::vector<int> nodes(at(build_.result_.program.equations()), -1);
    for (std::size_t e = 0; e < edges_.all.size(); ++e)
      for (std::size_t i = 0; i < 4; ++i)
        if (const int equation = rows_[e][i].equation; equation != kHeld && equation != motion_)
          nodes[at(equation)] = i < 2 ? edges_.all[e].a : edges_.all[e].b;
    return nodes;
  }

  // Without cohesion a corner on a surface free of traction has no stress at all, nor has its neighbour across an edge
  // at that node.  Such corners would leave the program without an interior point.
  void find_stress_free() {
    free_.assign(3 * d_.triangles.size(), 0);
    std::vector<std::pair<int, int>> found;  // triangle and corner
    const auto take = [&](int t, int corner) {
      if (d_.soils[at(d_.triangles[at(t)].soil)].strength.cohesion > 0.0 || free_[at(3 * t + corner)]) return;
      free_[at(3 * t + corner)] = 1;
      found.emplace_back(t, corner);
    };
    for (const Edge& edge : edges_.all) {
      if (edge.triangle[1] >= 0 || edge.joint >= 0 || !unloaded(edge)) continue;
      take(edge.triangle[0], edge.local[0]);
      take(edge.triangle[0], (edge.local[0] + 1) % 3);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto [t, corner] = found[i];
      const int node = d_.triangles[at(t)].node[at(corner)];
      for (const int local : {corner, (corner + 2) % 3}) {
        const Edge& edge = edges_.all[at(edges_.of[at(t)][at(local)])];
        const int other = edge.triangle[edge.triangle[0] == t ? 1 : 0];
        if (other < 0) continue;
        for (int k = 0; k < 3; ++k)
          if (d_.triangles[at(other)].node[at(k)] == node) take(other, k);
      }
    }
  }
  bool unloaded(const Edge& edge) const {
    if (edge.boundary < 0) return true;
    const Boundary& b = d_.boundary[at(edge.boundary)];
    double size = 0.0;
    for (std::size_t i = 0; i < 2; ++i) size += b.fixed[i].norm() + b.live[i].norm();
    return !b.held[0] && !b.held[1] && b.water && size == 0.0;
  }

  void add_triangle(int index) {
    const Triangle& t = d_.triangles[at(index)];
    const TriangleShape g(d_, t, build_.length());
    const Soil& soil = d_.soils[at(t.soil)];
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(14, 9);
    std::vector<Row> rows{{2 * index}, {2 * index + 1}};
    Vector2 pull = Vector2::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vector2 b = g.area * g.gradient[at(i)];
      A(0, 3 * i) = A(1, 3 * i + 2) = -b.x();
      A(0, 3 * i + 2) = A(1, 3 * i + 1) = -b.y();
      pull += build_.pressure(t, i) * b;
      if (free_[at(3 * index + i)])
        build_.add_idle_cone();
      else
        build_.add_cone(soil.strength, false);
    }
    const Vector2 fixed = g.area * build_.body(soil.weight_fixed) - pull,
                  live = g.area * build_.live_factor() * build_.body(soil.weight_live);
    for (int axis = 0; axis < 2; ++axis) build_.add_load(rows[at(axis)], fixed[axis], live[axis]);
    for (int i = 0; i < 3; ++i) {
      const int e = edges_.of[at(index)][at(i)];
      const Edge& edge = edges_.all[at(e)];
      const Vector2 n = outward(d_, t, i, build_.length());
      for (int end = 0; end < 2; ++end) {
        const int corner = (t.node[at(i)] == (end == 0 ? edge.a : edge.b)) ? i : (i + 1) % 3;
        const Eigen::Index row = 2 + 4 * i + 2 * end;
        A(row, 3 * corner) = A(row + 1, 3 * corner + 2) = n.x();
        A(row, 3 * corner + 2) = A(row + 1, 3 * corner + 1) = n.y();
        const Vector2 water = pressure_on(edge, t, corner) * n;
        for (int axis = 0; axis < 2; ++axis) {
          const Row& one = this->rows(e)[at(2 * end + axis)];
          rows.push_back(one);
          build_.add_load(one, water[axis], 0.0);
        }
      }
    }
    for (int i = 0; i < 3; ++i)
      if (free_[at(3 * index + i)]) A.middleCols(3 * i, 3).setZero();
    build_.add_part(3 * index, 3, rows, A, g.middle);
  }

  // What the pore pressure adds to the effective traction that an edge's equations hold.
  double pressure_on(const Edge& edge, const Triangle& t, int corner) const {
    if (edge.joint >= 0 ||
        (edge.triangle[1] < 0 && (edge.boundary < 0 || d_.boundary[at(edge.boundary)].water)))
      return 0.0;
    return build_.pressure(t, corner);
  }

  void add_tractions(const Edge& edge) {
    const Boundary& boundary = d_.boundary[at(edge.boundary)];
    const double length = (d_.x[at(edge.a)] - d_.x[at(edge.b)]).norm() / build_.length();
    const int e = static_cast<int>(&edge - edges_.all.data());
    for (std::size_t end = 0; end < 2; ++end) {
      const std::size_t i = boundary.a == edge.a ? end : 1 - end;
      for (int axis = 0; axis < 2; ++axis)
        if (!boundary.held[at(axis)])
          build_.add_load(rows(e)[2 * end + at(axis)], length * build_.traction_fixed(boundary, i)[axis],
                          length * build_.traction_live(boundary, i)[axis]);
    }
  }

  void add_joints() {
    std::vector<std::array<int, 2>> sides(d_.joints.size(), {-1, -1});
    for (std::size_t e = 0; e < edges_.all.size(); ++e)
      if (edges_.all[e].joint >= 0)
        sides[at(edges_.all[e].joint)][at(edges_.all[e].side)] = static_cast<int>(e);
    int point = 3 * static_cast<int>(d_.triangles.size());
    for (std::size_t j = 0; j < d_.joints.size(); ++j) {
      const Joint& joint = d_.joints[j];
      const Edge& first = edges_.all[at(sides[j][0])];
      const Vector2 n = outward(d_, d_.triangles[at(first.triangle[0])], first.local[0], build_.length());
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(8, 6);
      std::vector<Row> rows;
      for (int side = 0; side < 2; ++side)
        for (int end = 0; end < 2; ++end) {
          const Edge& edge = edges_.all[at(sides[j][at(side)])];
          const int node = side == 0 ? joint.first[at(end)] : joint.second[at(end)];
          const int place = edge.a == node ? 0 : 2;
          const double sign = side == 0 ? -1.0 : 1.0;
          const auto row = static_cast<Eigen::Index>(rows.size());
          A(row, 3 * end) = sign * n.x();
          A(row + 1, 3 * end) = sign * n.y();
          A(row, 3 * end + 1) = -sign * n.y();
          A(row + 1, 3 * end + 1) = sign * n.x();
          for (int axis = 0; axis < 2; ++axis) rows.push_back(this->rows(sides[j][at(side)])[at(place + axis)]);
        }
      for (int end = 0; end < 2; ++end) build_.add_cone({joint.lower_cohesion, joint.strength.friction}, true);
      build_.add_part(point, 2, rows, A, 0.5 * (d_.x[at(first.a)] + d_.x[at(first.b)]) / build_.length());
      point += 2;
    }
  }

  const Domain& d_;
  const Edges& edges_;
  Builder build_;
  std::vector<std::array<Row, 4>> rows_;
  std::vector<char> free_;  // by point: BoundProgram::stress_free
  int motion_ = kHeld;
};

// ---- upper bound

class Upper {
 public:
  Upper(const Domain& domain, const Edges& edges, Quantity quantity)
      : d_(domain), edges_(edges), build_(domain, quantity) {}

  BoundProgram make() {
    number();
    for (std::size_t t = 0; t < d_.triangles.size(); ++t) add_triangle(static_cast<int>(t));
    add_joints();
    for (const Edge& edge : edges_.all)
      if (edge.triangle[1] < 0) add_tractions(edge);
    build_.add_motion(motion_);
    for (const Row& row : rows_) {
      build_.result_.velocity.push_back(row.equation);
      build_.result_.share.push_back(row.equation == kHeld ? 0.0 : row.factor);
    }
    return build_.finish();
  }

 private:
  int middle(int edge) const { return static_cast<int>(d_.x.size()) + edge; }
  Row row(int node, int axis) const { return rows_[at(2 * node + axis)]; }

  void number() {
    const std::size_t nodes = d_.x.size() + edges_.all.size();
    std::vector<std::array<char, 2>> held(nodes, {0, 0});
    std::vector<Vector2> motion(nodes, Vector2::Zero());
    std::vector<char> used(nodes, 0);
    for (const Triangle& t : d_.triangles)
      for (const int n : t.node) used[at(n)] = 1;
    for (std::size_t e = 0; e < edges_.all.size(); ++e) used[d_.x.size() + e] = 1;
    for (std::size_t e = 0; e < edges_.all.size(); ++e) {
      if (edges_.all[e].boundary < 0) continue;
      const Boundary& boundary = d_.boundary[at(edges_.all[e].boundary)];
      const std::array<std::pair<int, Vector2>, 3> three{
          {{boundary.a, boundary.motion[0]},
           {boundary.b, boundary.motion[1]},
           {middle(static_cast<int>(e)), 0.5 * (boundary.motion[0] + boundary.motion[1])}}};
      for (const auto& [node, v] : three)
        for (int axis = 0; axis < 2; ++axis) {
          if (!boundary.held[at(axis)]) continue;
          held[at(node)][at(axis)] = 1;
          if (v[axis] != 0.0) motion[at(node)][axis] = v[axis];
        }
    }
    int next = 0;
    if (build_.moves()) motion_ = next++;
    const double unit = build_.largest_motion();
    rows_.resize(2 * nodes);
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double v = motion[n][axis];
        if (!used[n]) continue;
        if (!held[n][axis])
          rows_[2 * n + axis] = {next++, 1.0};
        else if (build_.moves() && v != 0.0)
          rows_[2 * n + axis] = {motion_, v / unit};
      }
    build_.size_equations(next);
  }

  void add_triangle(int index) {
    const Triangle& t = d_.triangles[at(index)];
    const TriangleShape g(d_, t, build_.length());
    const Soil& soil = d_.soils[at(t.soil)];
    std::array<int, 6> node{};
    for (std::size_t i = 0; i < 3; ++i) {
      node[i] = t.node[i];
      node[3 + i] = middle(edges_.of[at(index)][i]);
      build_.add_cone(soil.strength, false);
    }
    const Vector2 fixed = g.area / 3.0 * build_.body(soil.weight_fixed),
                  live = g.area / 3.0 * build_.live_factor() * build_.body(soil.weight_live);
    double pressures = 0.0;
    for (int i = 0; i < 3; ++i) pressures += build_.pressure(t, i);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(12, 9);
    std::vector<Row> rows;
    for (std::size_t k = 0; k < 6; ++k) {
      for (int axis = 0; axis < 2; ++axis) rows.push_back(row(node[k], axis));
      const auto r = static_cast<Eigen::Index>(2 * k);
      for (int corner = 0; corner < 3; ++corner) {
        const Vector2 slope = slope_at(g, static_cast<int>(k), corner), b = g.area / 3.0 * slope;
        A(r, 3 * corner) = A(r + 1, 3 * corner + 2) = b.x();
        A(r, 3 * corner + 2) = A(r + 1, 3 * corner + 1) = b.y();
        const Vector2 water = g.area / 12.0 * (pressures + build_.pressure(t, corner)) * slope;
        for (int axis = 0; axis < 2; ++axis) build_.add_load(rows[2 * k + at(axis)], water[axis], 0.0);
      }
      if (k >= 3)
        for (int axis = 0; axis < 2; ++axis) build_.add_load(rows[2 * k + at(axis)], fixed[axis], live[axis]);
    }
    build_.add_part(3 * index, 3, rows, A, g.middle);
  }

  // Gradient of the shape function of node k (3 ...: of the edge from corner k - 3) at a corner.
  static Vector2 slope_at(const TriangleShape& g, int k, int corner) {
    if (k < 3) return (k == corner ? 3.0 : -1.0) * g.gradient[at(k)];
    const int a = k - 3, b = (a + 1) % 3;
    if (corner == a) return 4.0 * g.gradient[at(b)];
    if (corner == b) return 4.0 * g.gradient[at(a)];
    return Vector2::Zero();
  }

  void add_tractions(const Edge& edge) {
    const int e = static_cast<int>(&edge - edges_.all.data());
    const double length = (d_.x[at(edge.a)] - d_.x[at(edge.b)]).norm() / build_.length();
    std::array<Vector2, 2> fixed{Vector2::Zero(), Vector2::Zero()}, live = fixed;
    const Boundary* boundary = edge.boundary >= 0 ? &d_.boundary[at(edge.boundary)] : nullptr;
    if (boundary != nullptr)
      for (std::size_t end = 0; end < 2; ++end) {
        const std::size_t i = boundary->a == edge.a ? end : 1 - end;
        fixed[end] = build_.traction_fixed(*boundary, i);
        live[end] = build_.traction_live(*boundary, i);
      }
    if (edge.joint < 0 && (boundary == nullptr || boundary->water)) {
      const Triangle& t = d_.triangles[at(edge.triangle[0])];
      const Vector2 n = outward(d_, t, edge.local[0], build_.length()).normalized();
      for (int i = 0; i < 2; ++i) {
        const int corner = (edge.local[0] + i) % 3;
        fixed[t.node[at(corner)] == edge.a ? 0 : 1] -= build_.pressure(t, corner) * n;
      }
    }
    const Vector2 both_fixed = fixed[0] + fixed[1], both_live = live[0] + live[1];
    for (int axis = 0; axis < 2; ++axis) {
      // What acts on a held side goes into its support: the force at supports that move is that of the ground on them.
      if (boundary != nullptr && boundary->held[at(axis)]) continue;
      build_.add_load(row(edge.a, axis), length / 6.0 * fixed[0][axis], length / 6.0 * live[0][axis]);
      build_.add_load(row(edge.b, axis), length / 6.0 * fixed[1][axis], length / 6.0 * live[1][axis]);
      build_.add_load(row(middle(e), axis), length / 3.0 * both_fixed[axis], length / 3.0 * both_live[axis]);
    }
  }

  void add_joints() {
    std::vector<std::array<int, 2>> sides(d_.joints.size(), {-1, -1});
    for (std::size_t e = 0; e < edges_.all.size(); ++e)
      if (edges_.all[e].joint >= 0)
        sides[at(edges_.all[e].joint)][at(edges_.all[e].side)] = static_cast<int>(e);
    int point = 3 * static_cast<int>(d_.triangles.size());
    for (std::size_t j = 0; j < d_.joints.size(); ++j) {
      add_joint(d_.joints[j], sides[j], point);
      point += 3;
    }
  }

  // The jump in Bernstein's form: what holds at its three control points holds along the edge.
  void add_joint(const Joint& joint, const std::array<int, 2>& sides, int point) {
    const Edge& first = edges_.all[at(sides[0])];
    const Triangle& t = d_.triangles[at(first.triangle[0])];
    const Vector2 n = outward(d_, t, first.local[0], build_.length()) / 3.0, along(-n.y(), n.x());
    static constexpr double kControl[3][3] = {{1.0, 0.0, 0.0}, {-0.5, -0.5, 2.0}, {0.0, 1.0, 0.0}};
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(12, 9);
    std::vector<Row> rows;
    for (int side = 0; side < 2; ++side) {
      const std::array<int, 2>& ends = side == 0 ? joint.first : joint.second;
      const std::array<int, 3> nodes{ends[0], ends[1], middle(sides[at(side)])};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto r = static_cast<Eigen::Index>(rows.size());
        for (int axis = 0; axis < 2; ++axis) rows.push_back(row(nodes[k], axis));
        for (int control = 0; control < 3; ++control) {
          const double share = (side == 0 ? -1.0 : 1.0) * kControl[control][k];
          A(r, 3 * control) = share * n.x();
          A(r + 1, 3 * control) = share * n.y();
          A(r, 3 * control + 1) = share * along.x();
          A(r + 1, 3 * control + 1) = share * along.y();
        }
      }
    }
    for (int control = 0; control < 3; ++control) build_.add_cone(joint.strength, true);
    add_joint_water(joint, first, rows, n * 3.0);
    build_.add_part(point, 3, rows, A, 0.5 * (d_.x[at(first.a)] + d_.x[at(first.b)]) / build_.length());
  }

  // Water in the joint, at the pressure of the first side, pushes both sides apart.  rows: those of add_joint.
  void add_joint_water(const Joint& joint, const Edge& first, const std::vector<Row>& rows,
                       const Vector2& normal) {
    const Triangle& t = d_.triangles[at(first.triangle[0])];
    std::array<double, 2> u{};
    for (int i = 0; i < 2; ++i) {
      const int corner = (first.local[0] + i) % 3;
      u[t.node[at(corner)] == joint.first[0] ? 0 : 1] = build_.pressure(t, corner);
    }
    const std::array<double, 3> share{u[0] / 6.0, u[1] / 6.0, (u[0] + u[1]) / 3.0};
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t k = 0; k < 3; ++k)
        for (int axis = 0; axis < 2; ++axis)
          build_.add_load(rows[6 * side + 2 * k + at(axis)], (side == 0 ? -1.0 : 1.0) * share[k] * normal[axis],
                          0.0);
  }

  const Domain& d_;
  const Edges& edges_;
  Builder build_;
  std::vector<Row> rows_;  // by node and axis
  int motion_ = kHeld;
};

}  // namespace

BoundProgram lower_program(const Domain& domain, const Edges& edges, Quantity quantity) {
  return Lower(domain, edges, quantity).make();
}
BoundProgram upper_program(const Domain& domain, const Edges& edges, Quantity quantity) {
  return Upper(domain, edges, quantity).make();
}

}  // namespace sage::bounds

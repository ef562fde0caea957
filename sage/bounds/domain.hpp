// The ground as limit analysis sees it: straight-sided triangles with a strength, supports, loads and joints.
// Tension positive, radians.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

namespace sage::bounds {

// Of lists that are counted in int.
inline std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

using Vector2 = Eigen::Vector2d;

// The law that cohesion and friction belong to: Mohr-Coulomb, or a Drucker-Prager cone by the number of its match
// (materials/drucker_prager.hpp).
enum class Yield {
  mohr_coulomb = 0,
  cone_compression = 1,
  cone_extension = 2,
  cone_plane_strain = 3,
  cone_deviatoric = 4,
  cone_inner = 5,
};

struct Strength {
  double cohesion = 0.0, friction = 0.0;  // stress, radians
  Yield yield = Yield::mohr_coulomb;

  // Of Mohr-Coulomb with the same limit to stresses in the plane, whatever the stress out of it; friction pi/2 where
  // there is no limit.
  Strength in_plane() const;
  // With c / F and tan(phi) / F.
  Strength reduced(double factor) const;
};

struct Soil {
  Strength strength;
  Vector2 weight_fixed = Vector2::Zero(), weight_live = Vector2::Zero();  // force per volume
};

struct Triangle {
  std::array<int, 3> node{};  // counter-clockwise
  int soil = 0;
  int origin = 0;  // element of the deck that it was made from
};

// What acts on an edge that no other triangle has, or how it is supported.  `a` and `b` in the order in which
// its triangle has them.
struct Boundary {
  int a = 0, b = 0;
  std::array<bool, 2> held{};                                       // in x and y
  std::array<Vector2, 2> motion{Vector2::Zero(), Vector2::Zero()};  // of what is held, at a and b
  std::array<Vector2, 2> fixed{Vector2::Zero(), Vector2::Zero()};   // tractions at a and b
  std::array<Vector2, 2> live{Vector2::Zero(), Vector2::Zero()};
  bool water = true;  // water balances the pore pressure behind it
};

// Two edges in the same place, between which slip and opening are possible.
struct Joint {
  std::array<int, 2> first{}, second{};  // nodes; first[i] lies on second[i]
  Strength strength;
  // What the lower bound may count on: less where the joint opens before adhesion is used up.
  double lower_cohesion = 0.0;
};

struct Domain {
  std::vector<Vector2> x;
  std::vector<Triangle> triangles;
  std::vector<Soil> soils;
  std::vector<Boundary> boundary;  // edges without an entry are free of traction
  std::vector<Joint> joints;
  // Pore pressure, compression positive, of a triangle at a place in it; empty = dry.
  std::function<double(const Triangle&, const Vector2&)> pore_pressure;

  double area(const Triangle& t) const;
  double pressure(const Triangle& t, int corner) const {
    return pore_pressure ? pore_pressure(t, x[t.node[corner]]) : 0.0;
  }
  // Some held edge moves: the load is the force that moves it.
  bool moved() const;
};

// An edge of the triangulation with the one or two triangles that have it.
struct Edge {
  int a = 0, b = 0;  // a < b
  std::array<int, 2> triangle{-1, -1};
  std::array<int, 2> local{};  // its place in them: from corner i to corner i + 1
  int boundary = -1;           // place in Domain::boundary
  int joint = -1, side = 0;    // place in Domain::joints, 0 = first side
};
struct Edges {
  std::vector<Edge> all;
  std::vector<std::array<int, 3>> of;  // by triangle and local edge
};
Edges edges_of(const Domain& domain);

// Divides the marked triangles by their longest edges, and others as far as no node hangs.  Returns for each triangle of
// the new mesh the index of the old one that it is a part of.
std::vector<int> refine(Domain& domain, const std::vector<char>& marked);

// Where tractions or supports change along a side, stresses turn about a node.  Bisection by longest edges leaves such a
// node the few triangles that it has; here their angles are halved, so many times.
void fan_out(Domain& domain, int times);

}  // namespace sage::bounds

// Lame's thick cylinder and sphere under internal pressure, and the cylinder as two rings with an interface
// between them: decks and closed forms.  a = 1, b = 2, p = E = 1; u_z = 0 in the cylinder.
#pragma once

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::scenes {

// The cylinder as a 90-degree sector in plane strain or as a strip of the ring in axisymmetry; the sphere as a
// quadrant of the (r, z) plane with nodes on the axis.
enum class LameBody { sector, strip, sphere };

// Radial displacement and stresses (tension +) at a radius; axial: sigma_z of the cylinder, 0 for the sphere.
struct Lame {
  double u = 0.0, radial = 0.0, hoop = 0.0, axial = 0.0;
};
Lame lame(LameBody body, double nu, double r);
// The same at a point of the mesh: displacement, and stress [xx yy zz xy].
Vector2 lame_displacement(LameBody body, double nu, const Vector2& x);
Vector4 lame_stress(LameBody body, double nu, const Vector2& x);
// Error of a run's displacements at all nodes, root of the sum of squares over that of the closed form.
double lame_error(const WholeRun& run, LameBody body, double nu);

struct LameDeck {
  LameBody body = LameBody::strip;
  Cell cell = Cell::quad8;
  int formulation = 1, n = 4;  // n: cells along r; as many around, half as many up the strip
  double nu = 0.3;
  int code = 0;  // of an element that reads the cell's cards; 0 = the cell's own

  DeckWriter deck() const;
  std::string text() const { return deck().text(); }
};

// Sector or strip of two rings of quad8, nu = .3, that meet at r = 1.5 in an interface of stiffness kn.
struct TwoRingDeck {
  double kn = 1.0;
  bool sector = false;

  DeckWriter deck() const;
  std::string text() const { return deck().text(); }
  static constexpr int inner_node = 1;     // on the inner face, y = 0
  static constexpr std::size_t joint = 1;  // the interface's group
};
struct TwoRingAnswer {
  double contact = 0.0, u_a = 0.0;  // pressure between the rings, displacement of the inner face
};
TwoRingAnswer two_ring_answer(double kn);
// Largest relative error of the contact pressure in the interface's points.
double contact_error(const WholeRun& run, const TwoRingAnswer& exact);

}  // namespace sage::scenes

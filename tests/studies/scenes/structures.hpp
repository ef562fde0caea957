// Scenes of beams, shells and linings, with the closed forms that belong to them.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::scenes {

// Codes of the catalogue.
inline constexpr int kInterface4 = 11, kInterface6 = 12, kBar2 = 31, kRing1 = 34, kBeam2 = 35, kBeam3 = 36;
inline constexpr int kGoodman = 21, kAxial = 31, kPlate = 35, kSection = 36, kSectionPlastic = 37;
// Rows of a beam's results.
inline constexpr int kAxialForce = 0, kHoopForce = 1, kShearForce = 2, kMoment = 3;

// Card of fixity: a node that can't turn.
std::string rotation_held(int node);

// Rotation of a deck node at the end of a run.
double rotation_of(const WholeRun& run, int node);

// A row of beams of one law from a to z: their nodes are the deck's first, group and material are number 1.
struct BeamRow {
  int elements, order;
  DeckWriter deck;

  BeamRow(int geometry, int code, int n, const Vector2& a, const Vector2& z, int law,
          const std::vector<double>& parameters);
  int node(int i) const { return order * i + 1; }  // at the end of i elements
  int last() const { return node(elements); }
  std::vector<int> nodes() const;  // from a to z, those in the middle too
  void clamp(int n);
  // Springs from all nodes to ground that is held: group and material 2, interface elements with `formulation`.
  void stand_on(double along, double across, int formulation);
};

// A beam along x that shears, on springs of k: EI w'''' - (k EI/GA) w'' + k w = q.  A cylindrical shell without axial
// force is one too, with k = E t/a^2 and EI = E t^3/(12 (1 - nu^2)).  Deflection w and pressure q to the left of x
// (upwards), slope counter-clockwise, moment positive where it pulls the right-hand side, theta' = M/EI, M' = -Q,
// Q = GA (w' - theta).  Not for k EI = 4 GA^2, where two of its four roots are one.
struct BeamOnSprings {
  enum Quantity { deflection, slope, moment, shear };
  using State = Vector4;  // in the order of Quantity

  BeamOnSprings(double EI_, double GA_, double k_, double length_) : EI(EI_), GA(GA_), k(k_), length(length_) {}

  double EI, GA, k, length;
  double q0 = 0.0, q1 = 0.0;  // pressure q0 + q1 x

  struct Given {
    Quantity what;
    double value;
  };
  // Two quantities at x = 0 and two at x = length.
  void solve(const Given& a, const Given& b, const Given& c, const Given& d);
  State at(double x) const;

 private:
  Eigen::Matrix<std::complex<double>, 4, 4> shapes_;
  Eigen::Matrix<std::complex<double>, 4, 1> rates_, shares_;
  Vector4 under_load(double x) const { return {(q0 + q1 * x) / k, q1 / k, 0.0, 0.0}; }
  Eigen::Matrix<std::complex<double>, 4, 1> growth(double x) const;
};

// A sphere's shell from the equator, where it is clamped, up to a round opening with a free edge, pressed from inside: the
// equations of a shell of revolution that shears (Reissner), as six of first order along the meridian, by collocation at
// Chebyshev's points.  Nothing is integrated by parts, and no element stands behind it.
struct ClampedSphere {
  // Displacement from the axis, rotation counter-clockwise, meridian's force, shear and moment of a unit of circumference;
  // signs as of beams that go up from the equator.
  struct State {
    double u = 0.0, rotation = 0.0, N = 0.0, Q = 0.0, M = 0.0;
  };
  double a = 1.0, t = 0.05, E = 1000.0, nu = 0.3, pressure = 1.0;
  double shear_share = 5.0 / 6.0;  // of E t/(2 (1 + nu))
  double opening = 60.0;           // degrees above the equator
  int degree = 60;                 // of the polynomials

  void solve();
  // Degrees above the equator.
  State at(double angle) const;

 private:
  Eigen::MatrixXd y_;            // six rows: u_r, u_z, rotation, r F_r, r F_z, r M; a column a point
  Eigen::VectorXd arc_;          // of the points, from -1 (the equator) to 1
  double along(double x) const;  // radians above the equator
};

// A ring (EA, EI, GA) of radius a in an infinite plane of E, nu, joined by springs of kn across and ks along for each
// unit of area; 0 is none along, infinity bonded.  The plane is under sv (vertical) and K0 sv, compression positive:
// overpressure turns that on with the ring in place, excavation digs the hole and puts the ring in at once, while the
// ground is as it was before.  Modes 0 and 2 of Michell's solution; angles from the horizontal axis, counter-clockwise.
struct RingInGround {
  double E = 1.0, nu = 0.3, a = 1.0;
  double EA = 1.0, EI = 1.0, GA = 1e9;
  double kn = 1e300, ks = 1e300;
  double sv = 1.0, K0 = 1.0;
  bool excavation = false;
  // The ring's moment from theta', as beam elements have it, or from the change of its line's curvature, w'' + w/a^2, as
  // Einstein and Schwartz have it: they differ by N EI/(EA a).
  bool of_curvature = false;

  void solve();
  // Tension positive; moment positive where it pulls the inner side.
  double axial_force(double angle) const;
  double moment(double angle) const;
  Vector2 ring_displacement(double angle) const;  // along x and y
  // Of the ground, along x and y, r >= a: since the ring came.
  Vector2 ground_displacement(const Vector2& at) const;

 private:
  double W0_ = 0.0, A_ = 0.0;                               // u_r = A/r of the ground
  double W_ = 0.0, V_ = 0.0, T_ = 0.0, B_ = 0.0, C_ = 0.0;  // of cos or sin 2 angle
};

// Quarter of the above: ground from a to `outer`, held there as the solution moves, and ring of beam3; the ground inside
// the ring is group 4, which the last stage of an excavation takes away.
struct RingDeck {
  RingInGround exact;
  int around = 16, out = 12;
  double outer = 2.0;
  bool joined = false;  // with interface elements, of the ring's kn and ks; else common nodes

  Block ground() const;
  // Element i of the ring from the crown on, and its nodes.
  std::vector<int> ring() const;  // nodes
  DeckWriter deck() const;
};

}  // namespace sage::scenes

#include "tests/studies/scenes/structures.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "sage/model/dof_map.hpp"

namespace sage::scenes {

std::string rotation_held(int node) {
  return fmt::format("{:5}{:5}{:5}{:5}{:5}{:20}rotation", node, 0, 0, 1, 0, "");
}

double rotation_of(const WholeRun& run, int node) {
  return run.last().u[DofMap(*run.model).of(run.index(node), find_unknown(run.model->unknowns, "rotation"))];
}

BeamRow::BeamRow(int geometry, int code, int n, const Vector2& a, const Vector2& z, int law,
                 const std::vector<double>& parameters)
    : elements(n), order(code == kBeam3 ? 2 : 1), deck(geometry) {
  const int last = order * n;
  for (int i = 0; i <= last; ++i) {
    const Vector2 at = a + (z - a) * i / last;
    deck.node(i + 1, at.x(), at.y());
  }
  deck.material(1, law, parameters);
  deck.group(1, code, 0, 1);
  for (int e = 0; e < n; ++e) {
    std::vector<int> nodes{order * e + 1, order * (e + 1) + 1};
    if (order == 2) nodes.push_back(2 * e + 2);
    deck.element(e + 1, 1, nodes);
  }
}

std::vector<int> BeamRow::nodes() const {
  std::vector<int> list;
  for (int i = 1; i <= last(); ++i) list.push_back(i);
  return list;
}

void BeamRow::clamp(int n) {
  deck.fix(n, 1, 1);
  deck.fixities.push_back(rotation_held(n));
}

void BeamRow::stand_on(double along, double across, int formulation) {
  std::vector<int> held;
  const std::vector<std::string> beam(deck.nodes.begin(), deck.nodes.begin() + last());
  for (int i = 1; i <= last(); ++i) {
    const int copy = last() + i;
    deck.nodes.push_back(fmt::format("{:5}", copy) + beam[i - 1].substr(5));
    deck.fix(copy, 1, 1);
    held.push_back(copy);
  }
  deck.material(2, kGoodman, {along, across, 1.0});
  deck.group(2, order == 2 ? kInterface6 : kInterface4, formulation, 2);
  join(deck, elements + 1, 2, held, nodes(), order);
}

// State (w, theta, M, Q) = shapes exp(rates x): solutions that fall with x count from its beginning, those that grow from
// its end, so that long beams lose no digits.
Eigen::Matrix<std::complex<double>, 4, 1> BeamOnSprings::growth(double x) const {
  Eigen::Matrix<std::complex<double>, 4, 1> g;
  for (int i = 0; i < 4; ++i) g[i] = std::exp(rates_[i] * (rates_[i].real() < 0.0 ? x : x - length));
  return g;
}

void BeamOnSprings::solve(const Given& a, const Given& b, const Given& c, const Given& d) {
  using Complex = std::complex<double>;
  const double half = 0.5 * k / GA;
  const Complex root = std::sqrt(Complex(half * half - k / EI));
  const Complex first = std::sqrt(half + root), second = std::sqrt(half - root);
  rates_ << first, -first, second, -second;
  for (int i = 0; i < 4; ++i) {
    const Complex m = rates_[i], turned = m - k / (m * GA);
    shapes_.col(i) << 1.0, turned, EI * m * turned, k / m;
  }
  Eigen::Matrix<std::complex<double>, 4, 4> matrix;
  Eigen::Matrix<std::complex<double>, 4, 1> right;
  const Given given[] = {a, b, c, d};
  for (int i = 0; i < 4; ++i) {
    const double x = i < 2 ? 0.0 : length, size = shapes_.row(given[i].what).norm();
    matrix.row(i) = shapes_.row(given[i].what).cwiseProduct(growth(x).transpose()) / size;
    right[i] = (given[i].value - under_load(x)[given[i].what]) / size;
  }
  shares_ = matrix.fullPivLu().solve(right);
}

BeamOnSprings::State BeamOnSprings::at(double x) const {
  return under_load(x) + (shapes_ * growth(x).cwiseProduct(shares_)).real();
}

double ClampedSphere::along(double x) const {
  return 0.5 * (1.0 + x) * opening * kPi / 180.0;
}

// With ' along the meridian, t along it and n to its left (inwards), F = N t + Q n:
//   u' = axial t + (shear + rotation) n, rotation' = bending,
//   (r F)' = N_hoop e_r - r q, (r M)' = M_hoop t_r - r Q.
void ClampedSphere::solve() {
  const double C = E * t / (1.0 - nu * nu), B = C * t * t / 12.0, G = shear_share * E * t / (2.0 * (1.0 + nu));
  const int points = degree + 1;
  arc_ = Eigen::VectorXd::NullaryExpr(
      points, [&](Eigen::Index i) { return -std::cos(kPi * static_cast<double>(i) / degree); });
  // d/dx of the polynomial through the points (Trefethen 2000, chapter 6).
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(points, points);
  const auto weight = [&](int i) { return (i == 0 || i == degree ? 2.0 : 1.0) * (i % 2 == 0 ? 1.0 : -1.0); };
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j)
      if (i != j) {
        D(i, j) = weight(i) / weight(j) / (arc_[i] - arc_[j]);
        D(i, i) -= D(i, j);
      }
  const double per_length = 2.0 / (a * opening * kPi / 180.0);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(6 * points, 6 * points);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * points);
  for (int i = 0; i < points; ++i) {
    const double angle = along(arc_[i]), c = std::cos(angle), s = std::sin(angle), r = a * c;
    const Vector2 tangent(-s, c), normal(-c, -s);
    using Row = Eigen::Matrix<double, 1, 6>;  // of a quantity in (u_r, u_z, rotation, r F_r, r F_z, r M)
    const Row hoop = Row::Unit(0) / r, hoop_bending = Row::Unit(2) * tangent.x() / r;
    const Row N = (tangent.x() * Row::Unit(3) + tangent.y() * Row::Unit(4)) / r,
              Q = (normal.x() * Row::Unit(3) + normal.y() * Row::Unit(4)) / r, M = Row::Unit(5) / r;
    const Row axial = N / C - nu * hoop, bending = M / B - nu * hoop_bending, turned = Q / G + Row::Unit(2);
    Eigen::Matrix<double, 6, 6> A;
    A.row(0) = tangent.x() * axial + normal.x() * turned;
    A.row(1) = tangent.y() * axial + normal.y() * turned;
    A.row(2) = bending;
    A.row(3) = C * (hoop + nu * axial);
    A.row(4).setZero();
    A.row(5) = B * (hoop_bending + nu * bending) * tangent.x() - r * Q;
    for (int k = 0; k < 6; ++k) {
      for (int j = 0; j < points; ++j) all(6 * i + k, 6 * j + k) = per_length * D(i, j);
      all.block<1, 6>(6 * i + k, 6 * i) -= A.row(k);
    }
    right.segment<2>(6 * i + 3) = r * pressure * normal;
  }
  // Three equations at either end give way to what is known there: no motion, and no force.
  for (int k = 0; k < 3; ++k)
    for (const int row : {k, 6 * degree + 3 + k}) {
      all.row(row).setZero();
      all(row, row) = 1.0;
      right[row] = 0.0;
    }
  // Displacements and forces differ by the stiffness.
  const Eigen::VectorXd scale = Eigen::VectorXd::NullaryExpr(6 * points, [&](Eigen::Index i) {
    return i % 6 < 3 ? 1.0 / C : i % 6 < 5 ? 1.0 : t;
  });
  all = all * scale.asDiagonal();
  for (int row = 0; row < 6 * points; ++row) {
    const double size = all.row(row).cwiseAbs().maxCoeff();
    all.row(row) /= size;
    right[row] /= size;
  }
  const Eigen::VectorXd x = scale.cwiseProduct(all.fullPivLu().solve(right));
  y_ = Eigen::Map<const Eigen::MatrixXd>(x.data(), 6, points);
}

// Barycentric interpolation.
ClampedSphere::State ClampedSphere::at(double angle) const {
  const double x = 2.0 * angle / opening - 1.0;
  Eigen::VectorXd w(arc_.size());
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    w[i] = (i == 0 || i == degree ? 0.5 : 1.0) * (i % 2 == 0 ? 1.0 : -1.0);
    const double away = x - arc_[i];
    if (std::abs(away) < 1e-12) {
      w.setZero();
      w[i] = 1.0;
      break;
    }
    w[i] /= away;
  }
  const Eigen::VectorXd y = y_ * w / w.sum();
  const double up = along(x), c = std::cos(up), s = std::sin(up), r = a * c;
  return {y[0], y[2], (-s * y[3] + c * y[4]) / r, (-c * y[3] - s * y[4]) / r, y[5] / r};
}

void RingInGround::solve() {
  const double G = E / (2.0 * (1.0 + nu)), kappa = 3.0 - 4.0 * nu, far = excavation ? 0.0 : 1.0;
  const double P = -0.5 * sv * (1.0 + K0), S = 0.5 * sv * (1.0 - K0);  // sigma_r = P + S cos 2 angle
  // Mode 0: EA W0/a^2 = p, p = P - 2 G A/a^2, u_r - W0 = p/kn.
  const double stiffness = EA / (a * a);
  const double u_far = far * (1.0 - 2.0 * nu) * P * a / (2.0 * G);
  const double p = (P + 2.0 * G * u_far / a) / (1.0 + 2.0 * G / a * (1.0 / stiffness + 1.0 / kn));
  W0_ = p / stiffness;
  A_ = (P - p) * a * a / (2.0 * G);
  // Mode 2: stiffness of the ring against (p_r, p_t, 0), springs, and the ground's
  //   2 G u_r = B r^-3 + (kappa + 1) C r^-1, 2 G u_t = B r^-3 - (kappa - 1) C r^-1,
  //   sigma_r = -3 B r^-4 - 4 C r^-2, tau = -3 B r^-4 - 2 C r^-2.
  Eigen::Matrix<double, 5, 5> m = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
  const Eigen::Vector3d axial(1.0 / a, 2.0 / a, 0.0), sheared(2.0 / a, 1.0 / a, -1.0),
      bending(0.0, 0.0, 2.0 / a);
  const Eigen::Vector3d curvature = of_curvature ? Eigen::Vector3d(3.0 / (a * a), 0.0, 0.0) : bending;
  m.topLeftCorner<3, 3>() = EA * axial * axial.transpose() + GA * sheared * sheared.transpose() +
                            EI * bending * curvature.transpose();
  const double a2 = a * a, a4 = a2 * a2;
  m(0, 3) = 3.0 / a4;
  m(0, 4) = 4.0 / a2;
  right[0] = S;
  m(1, 3) = 3.0 / a4;
  m(1, 4) = 2.0 / a2;
  right[1] = -S;
  // u_r - W = p_r/kn
  m(3, 0) = -1.0;
  m(3, 3) = 1.0 / (2.0 * G * a2 * a) + 3.0 / a4 / kn;
  m(3, 4) = (kappa + 1.0) / (2.0 * G * a) + 4.0 / a2 / kn;
  right[3] = S / kn - far * S * a / (2.0 * G);
  // u_t - V = p_t/ks
  m(4, 1) = -ks;
  m(4, 3) = ks / (2.0 * G * a2 * a) + 3.0 / a4;
  m(4, 4) = -ks * (kappa - 1.0) / (2.0 * G * a) + 2.0 / a2;
  right[4] = -S + ks * far * S * a / (2.0 * G);
  if (ks > 1.0) {
    m.row(4) /= ks;
    right[4] /= ks;
  }
  const Eigen::Matrix<double, 5, 1> x = m.fullPivLu().solve(right);
  W_ = x[0];
  V_ = x[1];
  T_ = x[2];
  B_ = x[3];
  C_ = x[4];
}

double RingInGround::axial_force(double angle) const {
  return EA * (W0_ + (2.0 * V_ + W_) * std::cos(2.0 * angle)) / a;
}

double RingInGround::moment(double angle) const {
  return -EI * (of_curvature ? 3.0 * W_ / (a * a) : 2.0 * T_ / a) * std::cos(2.0 * angle);
}

namespace {

Vector2 cartesian(double radial, double along, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {radial * c - along * s, radial * s + along * c};
}

}  // namespace

Vector2 RingInGround::ring_displacement(double angle) const {
  return cartesian(W0_ + W_ * std::cos(2.0 * angle), V_ * std::sin(2.0 * angle), angle);
}

Vector2 RingInGround::ground_displacement(const Vector2& at) const {
  const double r = at.norm(), angle = std::atan2(at.y(), at.x());
  const double G2 = E / (1.0 + nu), kappa = 3.0 - 4.0 * nu, far = excavation ? 0.0 : 1.0;
  const double P = -0.5 * sv * (1.0 + K0), S = 0.5 * sv * (1.0 - K0);
  const double b = B_ / (r * r * r), c = C_ / r;
  const double radial = far * (1.0 - 2.0 * nu) * P * r / G2 + A_ / r +
                        (far * S * r + b + (kappa + 1.0) * c) / G2 * std::cos(2.0 * angle);
  return cartesian(radial, (-far * S * r + b - (kappa - 1.0) * c) / G2 * std::sin(2.0 * angle), angle);
}

Block RingDeck::ground() const {
  Block block;
  block.cell = Cell::quad9;
  block.columns = out;
  block.rows = around;
  block.polar = true;
  const double a = exact.a, b = outer;
  block.place = [a, b](double s, double t) -> Vector2 { return {a * std::pow(b / a, s), 90.0 * t}; };
  return block;
}

std::vector<int> RingDeck::ring() const {
  std::vector<int> nodes = ground().left();
  if (joined)
    for (int& n : nodes) n = 20001 + (n - 1) / ground().across();
  return {nodes.rbegin(), nodes.rend()};
}

DeckWriter RingDeck::deck() const {
  DeckWriter deck(1);
  const Block block = ground();
  block.write_nodes(deck);
  deck.material(1, 1, {exact.E, exact.nu});
  deck.material(2, kSection, {exact.EA, exact.EI, exact.GA});
  deck.group(1, 5, 0, 1);
  block.write_elements(deck, 1);
  if (joined) copy_row(deck, block, block.left(), 20001);
  deck.group(2, kBeam3, 0, 2);
  const std::vector<int> nodes = ring();
  for (int e = 0; e < around; ++e) {
    const auto first = static_cast<std::size_t>(2 * e);
    deck.element(20001 + e, 2, {nodes[first], nodes[first + 2], nodes[first + 1]});
  }
  if (joined) {  // down from the crown the ground is on the left
    deck.material(3, kGoodman, {exact.ks, exact.kn, 1.0});
    deck.group(3, kInterface6, 2, 3);
    const std::vector<int> side = block.left();
    join(deck, 30001, 3, nodes, {side.rbegin(), side.rend()}, 2);
  }
  for (int n : block.bottom()) deck.fix(n, 0, 1);
  for (int n : block.top()) deck.fix(n, 1, 0);
  deck.fix(nodes.front(), 1, 0);
  deck.fix(nodes.back(), 0, 1);
  deck.fixities.push_back(rotation_held(nodes.front()));
  deck.fixities.push_back(rotation_held(nodes.back()));
  if (!exact.excavation) {
    deck.stage();
    return deck;
  }
  Block inside = block;
  inside.columns = 1;
  inside.first_node = 10001;
  inside.first_element = 10001;
  const double a = exact.a;
  inside.place = [a](double s, double t) -> Vector2 { return {a * (0.5 + 0.5 * s), 90.0 * t}; };
  DeckWriter own(1);  // its outermost nodes are the ground's
  inside.write_nodes(own);
  inside.write_elements(own, 4);
  deck.group(4, 5, 0, 1);
  for (const std::string& card : own.nodes)
    if ((std::stoi(card.substr(0, 5)) - 10001) % 3 != 2) deck.nodes.push_back(card);
  for (const std::string& card : own.elements) {
    std::string line = card.substr(0, 10);
    for (std::size_t at = 10; at < card.size(); at += 5) {
      int number = std::stoi(card.substr(at, 5));
      if ((number - 10001) % 3 == 2) number = block.node(0, (number - 10001) / 3);
      line += fmt::format("{:5}", number);
    }
    deck.elements.push_back(line);
  }
  for (int j = 0; j < inside.up(); ++j) deck.fix(inside.node(0, j), 1, 1);
  deck.fix(inside.node(1, 0), 0, 1);
  deck.fix(inside.node(1, inside.up() - 1), 1, 0);
  const double sh = exact.K0 * exact.sv;
  for (int group : {1, 4}) deck.initial(group, 0, sh, exact.sv, exact.nu * (sh + exact.sv), 0.0);
  StageCards& at_rest = deck.stage();
  for (int n : block.right()) at_rest.fix(n, 1, 1);
  deck.stage().deaths.push_back(4);
  return deck;
}

}  // namespace sage::scenes

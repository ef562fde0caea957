#include "tests/studies/scenes/lame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sage::scenes {

namespace {

constexpr double kA = 1.0, kB = 2.0, kC = 1.5;  // inner, outer radius; the rings meet at kC

Vector2 radial_direction(LameBody body, const Vector2& x) {
  return body == LameBody::strip ? Vector2(1.0, 0.0) : Vector2(x.normalized());
}

double radius(LameBody body, const Vector2& x) {
  return body == LameBody::strip ? x.x() : x.norm();
}

// Rings from radius to radius: 90 degrees, or 0.5 high.
Block ring(LameBody body, Cell cell, int columns, int rows, double from, double to) {
  Block block;
  block.cell = cell;
  block.columns = columns;
  block.rows = rows;
  block.polar = body != LameBody::strip;
  block.place = rectangle(from, to, 0.0, block.polar ? 90.0 : 0.5);
  return block;
}

void hold_sides(DeckWriter& deck, LameBody body, const Block& block) {
  const bool strip = body == LameBody::strip;
  for (int n : block.bottom()) deck.fix(n, 0, 1);
  for (int n : block.top()) deck.fix(n, strip ? 0 : 1, strip ? 1 : 0);
}

// The inner face is the fourth edge of a quadrilateral and the third of a triangle's first half.
void press(DeckWriter& deck, const Block& block) {
  StageCards& stage = deck.stage();
  const int inner = block.cell == Cell::tri3 || block.cell == Cell::tri6 ? 3 : 4;
  for (int j = 0; j < block.rows; ++j) stage.pressure(block.element(0, j), inner, 1.0, 1.0);
}

}  // namespace

Lame lame(LameBody body, double nu, double r) {
  if (body == LameBody::sphere) {
    const double f = std::pow(kA, 3) / (std::pow(kB, 3) - std::pow(kA, 3)), b3 = std::pow(kB / r, 3);
    return {f * r * ((1 - 2 * nu) + (1 + nu) * b3 / 2), f * (1 - b3), f * (1 + b3 / 2), 0.0};
  }
  const double f = kA * kA / (kB * kB - kA * kA), b2 = std::pow(kB / r, 2);
  return {(1 + nu) * f * r * ((1 - 2 * nu) + b2), f * (1 - b2), f * (1 + b2), 2 * nu * f};
}

Vector2 lame_displacement(LameBody body, double nu, const Vector2& x) {
  return lame(body, nu, radius(body, x)).u * radial_direction(body, x);
}

Vector4 lame_stress(LameBody body, double nu, const Vector2& x) {
  const Lame s = lame(body, nu, radius(body, x));
  if (body == LameBody::strip) return {s.radial, s.axial, s.hoop, 0.0};
  const Vector2 n = radial_direction(body, x);
  const double out = body == LameBody::sector ? s.axial : s.hoop, d = s.radial - s.hoop;
  return {s.hoop + d * n.x() * n.x(), s.hoop + d * n.y() * n.y(), out, d * n.x() * n.y()};
}

double lame_error(const WholeRun& run, LameBody body, double nu) {
  double error = 0.0, size = 0.0;
  for (int i = 0; i < run.model->mesh.nodes(); ++i) {
    const Vector2 exact = lame_displacement(body, nu, run.model->mesh.x.col(i));
    error += (run.last().u.segment<2>(DofMap::displacement(i)) - exact).squaredNorm();
    size += exact.squaredNorm();
  }
  return std::sqrt(error / size);
}

DeckWriter LameDeck::deck() const {
  const Block block = ring(body, cell, n, body == LameBody::strip ? std::max(1, n / 2) : n, kA, kB);
  DeckWriter deck(body == LameBody::sector ? 1 : 2);
  block.write_nodes(deck);
  deck.material(1, 1, {1.0, nu});
  deck.group(1, code > 0 ? code : static_cast<int>(cell), formulation, 1);
  block.write_elements(deck, 1);
  hold_sides(deck, body, block);
  press(deck, block);
  return deck;
}

DeckWriter TwoRingDeck::deck() const {
  const LameBody body = sector ? LameBody::sector : LameBody::strip;
  const Block inner = ring(body, Cell::quad8, 4, sector ? 8 : 2, kA, kC);
  Block outer = ring(body, Cell::quad8, 4, inner.rows, kC, kB);
  outer.first_node = outer.first_element = 1001;
  DeckWriter deck(sector ? 1 : 2);
  inner.write_nodes(deck);
  outer.write_nodes(deck);
  deck.material(1, 1, {1.0, 0.3});
  deck.material(2, 21, {kn, kn, 1.0});
  deck.group(1, 2, 1, 1);
  deck.group(2, 12, 0, 2);
  inner.write_elements(deck, 1);
  outer.write_elements(deck, 1);
  join(deck, 2001, 2, outer.left(), inner.right(), 2);
  hold_sides(deck, body, inner);
  hold_sides(deck, body, outer);
  press(deck, inner);
  return deck;
}

// Lame on both rings and u_out(c; pc) - u_in(c; p, pc) = -pc/kn.
TwoRingAnswer two_ring_answer(double kn) {
  const double nu = 0.3, a = kA, b = kB, c = kC, f = 1 + nu;
  const double outer = f * c * c / (b * b - c * c) * ((1 - 2 * nu) * c + b * b / c);  // u_out(c) by pc
  const double g = f / (c * c - a * a);
  const auto u_in = [&](double r, double pc) {
    return g * ((1 - 2 * nu) * r * (a * a - pc * c * c) + a * a * c * c / r * (1.0 - pc));
  };
  // u_in(c, pc) = u0 - u1 pc.
  const double u0 = u_in(c, 0.0), u1 = u0 - u_in(c, 1.0);
  TwoRingAnswer answer;
  answer.contact = u0 / (outer + u1 + 1.0 / kn);
  answer.u_a = u_in(a, answer.contact);
  return answer;
}

double contact_error(const WholeRun& run, const TwoRingAnswer& exact) {
  return (-run.stress[TwoRingDeck::joint].row(1).array() - exact.contact).abs().maxCoeff() / exact.contact;
}

}  // namespace sage::scenes

#include "tests/studies/scenes/seepage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sage/model/dof_map.hpp"

namespace sage::scenes {

namespace {

constexpr double kNear = 1e-9;

int index_of_head(const WholeRun& run, int node) {
  return DofMap(*run.model).of(run.index(node), find_unknown(run.model->unknowns, "head"));
}

}  // namespace

int flow_element(Cell cell) {
  switch (cell) {
    case Cell::quad4:
      return 41;
    case Cell::quad8:
      return 42;
    case Cell::tri3:
      return 43;
    case Cell::tri6:
      return 44;
    case Cell::quad9:
      return 45;
  }
  return 0;
}

std::string head_card(int node, double value, int code) {
  return fmt::format("{:5}{:5}{:5}{:5}{:5}{}{:10}{:20}", node, 0, 0, code, 0, ten_columns(value), "", "head");
}

std::string inflow_card(int node, double value) {
  return fmt::format("{:5}{:5}{:5}{}{:10}{:20}", node, 0, 0, ten_columns(value), "", "head");
}

std::string discharge_card(const std::vector<int>& nodes) {
  std::string card = fmt::format("{:5}{:25}{:30}{:5}\n", 4, "", "", nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    card += fmt::format("{:5}{}", nodes[i], i % 16 == 15 && i + 1 < nodes.size() ? "\n" : "");
  return card;
}

DeckWriter flow_deck(const Block& block, int geometry, int law, const std::vector<double>& permeability) {
  DeckWriter deck(geometry);
  block.write_nodes(deck);
  deck.material(1, law, permeability);
  deck.group(1, flow_element(block.cell), 0, 1);
  block.write_elements(deck, 1);
  deck.stage();
  return deck;
}

void hold_heads(StageCards& stage, const std::vector<int>& nodes, double head) {
  for (const int n : nodes) stage.fixities.push_back(head_card(n, head));
}

std::vector<double> lattice_lines(double from, const std::vector<Interval>& intervals) {
  std::vector<double> at{from};
  for (const Interval& one : intervals) {
    for (int i = 1; i <= one.n; ++i) {
      const double s = static_cast<double>(i) / one.n;
      const double t = one.fine < 0 ? std::pow(s, 3.0) : one.fine > 0 ? 1.0 - std::pow(1.0 - s, 3.0) : s;
      at.push_back(from + t * (one.to - from));
    }
    from = one.to;
  }
  return at;
}

Block lattice(const std::vector<double>& xs, const std::vector<double>& ys, Cell cell) {
  Block block;
  block.columns = static_cast<int>(xs.size()) - 1;
  block.rows = static_cast<int>(ys.size()) - 1;
  block.cell = cell;
  const auto at = [](const std::vector<double>& list, double s) {
    const double place = s * static_cast<double>(list.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place + 1e-9), list.size() - 2);
    return list[i] + (place - static_cast<double>(i)) * (list[i + 1] - list[i]);
  };
  block.place = [=](double s, double t) { return Vector2(at(xs, s), at(ys, t)); };
  return block;
}

double head_of(const WholeRun& run, int node) {
  return run.last().u[index_of_head(run, node)];
}

double inflow_of(const WholeRun& run, const std::vector<int>& nodes) {
  double sum = 0.0;
  for (const int node : nodes) {
    const int dof = index_of_head(run, node);
    sum += run.last().internal[dof] - run.last().external[dof];
  }
  return sum;
}

Block Barrier::block() const {
  std::vector<Interval> along, up;
  if (b > 0.0) along = {{0.5 * b, n, -1}, {b, n, 1}};
  along.insert(along.end(), {{b + 1.0, n, -1}, {b + 5.0, n, 0}});
  if (s > 0.0) up.push_back({-s, n, 1});
  for (const double at : depths) up.push_back({-at, n, at == depths.front() ? -1 : 0});
  if (depths.empty() && b > 0.0 && s > 0.0) up.push_back({-0.5 * s, n, -1});
  up.push_back({0.0, n, b > 0.0 ? 1 : depths.empty() ? -1 : 0});
  return lattice(lattice_lines(0.0, along), lattice_lines(-1.0, up), cell);
}

std::vector<int> Barrier::exit() const {
  const Block ground = block();
  std::vector<int> nodes;
  for (int i = ground.across() - 1; i >= 0; --i)
    if (ground.at(i, ground.up() - 1).x() >= b - kNear) nodes.push_back(ground.node(i, ground.up() - 1));
  return nodes;
}

DeckWriter Barrier::deck() const {
  const Block ground = block();
  DeckWriter deck = flow_deck(ground, 1, kDarcyLaw, {1.0});
  hold_heads(deck.stages.back(), exit(), 0.0);
  for (int j = 0; j < ground.up(); ++j)
    if (ground.at(0, j).y() <= -s + kNear) hold_heads(deck.stages.back(), {ground.node(0, j)}, 0.5);
  deck.reports.push_back(discharge_card(exit()));
  return deck;
}

Block Dam::block() const {
  Block body;
  body.columns = columns;
  body.rows = rows;
  body.cell = cell;
  body.place = rectangle(left, left + W, 0.0, top);
  return body;
}

DeckWriter Dam::deck() const {
  const Block body = block();
  DeckWriter deck = flow_deck(body, geometry, kFreeSurfaceLaw, {k, 0.0, 0.0, ramp});
  const auto face = [&](const std::vector<int>& nodes, double water) {
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const double y = body.at(0, static_cast<int>(j)).y();
      const bool wet = y <= water + kNear;
      deck.stages.back().fixities.push_back(head_card(nodes[j], wet ? water : 0.0, wet ? 1 : 2));
    }
  };
  face(body.left(), H);
  face(body.right(), h);
  deck.reports.push_back(discharge_card(body.right()));
  return deck;
}

}  // namespace sage::scenes

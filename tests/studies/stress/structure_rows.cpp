// Structures: stiff beyond measure, without stiffness, and what must not change their forces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/stress/row.hpp"

namespace sage::stress {

namespace {

using namespace scenes;

// Codes of the catalogue.
constexpr int kInterface4 = 11, kGoodman = 21, kBar2 = 31, kAxial = 31, kBeam2 = 35, kSection = 36;

std::string rotation_held(int node) {
  return fmt::format("{:5}{:5}{:5}{:5}{:5}{:20}rotation", node, 0, 0, 1, 0, "");
}

const char* geometry_name(int geometry) {
  return geometry == 1 ? "plane strain" : "axisymmetric";
}

// Half of a raft, 2 wide, in the middle of soil of 4 x 4 with E = 1, nu = .3 that is held below and smooth at its
// sides; in axisymmetry a round one.
struct Raft {
  int geometry = 1;
  Block block;
  DeckWriter deck;
  static constexpr int kCells = 8, kUnder = 4;

  explicit Raft(int code) : geometry(code), deck(code) {
    block.columns = block.rows = kCells;
    block.place = rectangle(0.0, 4.0, 0.0, 4.0);
    block.write_nodes(deck);
    deck.material(1, 1, {1.0, 0.3});
    deck.group(1, 1, 1, 1);
    block.write_elements(deck, 1);
    for (const int n : block.bottom()) deck.fix(n, 1, 1);
    for (int j = 1; j <= kCells; ++j) {
      deck.fix(block.node(0, j), 1, 0);
      deck.fix(block.node(kCells, j), 1, 0);
    }
  }
  int top(int i) const { return block.node(i, kCells); }
  // Elements of two nodes along the raft.
  void lay(int element, int law, const std::vector<double>& parameters) {
    deck.material(2, law, parameters);
    deck.group(2, element, 0, 2);
    for (int i = 0; i < kUnder; ++i) deck.element(1001 + i, 2, {top(i), top(i + 1)});
    if (element == kBeam2 && geometry == 1) deck.fixities.push_back(rotation_held(top(0)));
  }
  void press() { deck.stage().load(top(kUnder), 0.0, -1.0); }
};

std::vector<double> displacements(const Raft& raft, const WholeRun& run) {
  std::vector<double> u;
  for (int j = 0; j <= Raft::kCells; ++j)
    for (int i = 0; i <= Raft::kCells; ++i)
      for (const int c : {0, 1}) u.push_back(run.u(raft.block.node(i, j))[c]);
  return u;
}

// Beside the largest of b.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || b.empty()) return kUnknown;
  double most = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return size > 0.0 ? most / size : most;
}

// EA, EI and GA to infinity: the soil under the raft moves as one.
void rigid(Sweep& s) {
  for (const int geometry : {1, 2}) {
    Raft body(geometry);
    StageCards& stage = body.deck.stage();
    for (int i = 0; i <= Raft::kUnder; ++i) {
      body.deck.fix(body.top(i), 1, 1);
      stage.fix(body.top(i), 1, 1, 0.0, -1.0);
    }
    const Ran reference = s.run(body.deck.text());
    if (!reference.completed()) {
      s.clean(fmt::format("{}, rigid body", geometry_name(geometry)), kUnknown, reference);
      continue;
    }
    double force = 0.0;
    for (int i = 0; i <= Raft::kUnder; ++i) force -= reference.run->reaction(body.top(i)).y();
    std::vector<double> exact = displacements(body, *reference.run);
    for (double& u : exact) u /= force;
    for (int power = 2; power <= 14; ++power) {
      const double stiff = std::pow(10.0, power);
      Raft raft(geometry);
      raft.lay(kBeam2, kSection, {stiff, stiff, stiff, stiff, stiff});
      raft.press();
      const Ran ran = s.run(raft.deck.text());
      const std::string label = fmt::format("{}, EI = 1e{} E L^3", geometry_name(geometry), power);
      if (power >= 13) {  // 16 digits hold the soil's stiffness beside the raft's no more
        s.says(label, kUnknown, ran, "the stiffness matrix is singular");
        continue;
      }
      Trial& t = s.right(label, stiff, ran,
                         ran.completed() ? difference(displacements(raft, *ran.run), exact) : kUnknown,
                         20.0 / stiff + 1e-12 + 100.0 * kUnit * stiff);
      t.series = geometry_name(geometry);
      if (power >= 9) s.says(label, kUnknown, ran, "digits are lost");
      if (power <= 6) s.silent(label, kUnknown, ran, "digits are lost");
    }
  }
}

// EI and GA to nothing beside EA: a bar.  Both to nothing: no structure at all.
void soft(Sweep& s, bool axial) {
  constexpr double EA = 10.0;
  for (const int geometry : {1, 2}) {
    Raft plain(geometry);
    if (axial) plain.lay(kBar2, kAxial, {EA});
    plain.press();
    const Ran reference = s.run(plain.deck.text());
    for (int power = 2; power <= 18; power += 2) {
      const double small = std::pow(10.0, -power);
      Raft raft(geometry);
      raft.lay(kBeam2, kSection, {axial ? EA : small, small, small});
      raft.press();
      const Ran ran = s.run(raft.deck.text());
      const bool both = ran.completed() && reference.completed();
      const std::string label =
          fmt::format("{}, {} = 1e-{}", geometry_name(geometry), axial ? "EI" : "EA = EI", power);
      s.right(label, small, ran,
              both ? difference(displacements(raft, *ran.run), displacements(plain, *reference.run)) : kUnknown,
              20.0 * small + 1e-12)
          .series = geometry_name(geometry);
      s.silent(label, kUnknown, ran, "digits are lost");
    }
  }
}

// A wall (in axisymmetry a shaft) between two bodies of soil, 4 x 4 each, on joints that open, with a strut that is
// put in before the second load; the same in other words.
struct WallDeck {
  int geometry = 1;
  std::function<int(int)> number = [](int n) { return n; };
  bool mirrored = false;   // x to -x; in axisymmetry z to -z
  bool reversed = false;   // beams and strut from their other ends
  bool backwards = false;  // elements in the other order
  double length = 1.0, stress = 1.0;

  static constexpr int kCells = 4, kSide = kCells + 1, kLeft = 1, kRight = 101, kWall = 201, kGround = 301;

  static int left(int i, int j) { return kLeft + j * kSide + i; }
  static int right(int i, int j) { return kRight + j * kSide + i; }
  static int wall(int j) { return kWall + j; }
  double sense() const { return mirrored ? -1.0 : 1.0; }
  // On the way that is mirrored.
  Vector2 turned(double x, double y) const {
    if (!mirrored) return {x, y};
    return geometry == 1 ? Vector2(-x, y) : Vector2(x, -y);
  }

  std::string text() const;

 private:
  struct Card {
    int number, group;
    std::vector<int> nodes;
  };
  std::vector<Card> elements() const;
  void write_nodes(DeckWriter& deck) const;
  void add_node(DeckWriter& deck, int n, double x, double y) const {
    const Vector2 at = length * turned(x, y);
    deck.node(number(n), at.x(), at.y());
  }
};

void WallDeck::write_nodes(DeckWriter& deck) const {
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      add_node(deck, left(i, j), 1.0 + i, j);
      add_node(deck, right(i, j), 5.0 + i, j);
    }
    add_node(deck, wall(j), 5.0, j);
  }
  add_node(deck, kGround, 8.0, 5.0);
}

std::vector<WallDeck::Card> WallDeck::elements() const {
  std::vector<Card> cards;
  int next = 1;
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i)
      for (const auto& node : {&WallDeck::left, &WallDeck::right}) {
        std::vector<int> nodes{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
        if (mirrored) std::ranges::reverse(nodes);
        cards.push_back({next++, 1, nodes});
      }
  for (int j = 0; j < kCells; ++j) {
    std::vector<int> beam{wall(j), wall(j + 1)};
    if (reversed) std::ranges::reverse(beam);
    cards.push_back({next++, 2, beam});
    for (std::vector<int> joint : {std::vector{wall(j), wall(j + 1), left(kCells, j + 1), left(kCells, j)},
                                   {right(0, j), right(0, j + 1), wall(j + 1), wall(j)}}) {
      if (mirrored) std::ranges::reverse(joint);
      cards.push_back({next++, 3, joint});
    }
  }
  cards.push_back(
      {next, 4, reversed ? std::vector{kGround, wall(kCells)} : std::vector{wall(kCells), kGround}});
  if (backwards) std::ranges::reverse(cards);
  return cards;
}

std::string WallDeck::text() const {
  const double p = stress, l = length;
  DeckWriter deck(geometry);
  write_nodes(deck);
  deck.material(1, 1, {1000.0 * p, 0.3});
  deck.material(2, kSection, {1e5 * p * l, 1e3 * p * l * l * l, 4e4 * p * l, 1e4 * p * l, 1e2 * p * l * l * l});
  deck.material(3, kGoodman, {1e4 * p / l, 1e5 * p / l, 0.0});
  deck.material(4, kAxial, {8e3 * p * l * l, 2.0 * l});
  deck.group(1, 1, 1, 1);
  deck.group(2, kBeam2, 0, 2);
  deck.group(3, kInterface4, 2, 3);
  deck.group(4, kBar2, 0, 4);
  for (const Card& card : elements()) {
    std::vector<int> nodes;
    for (const int n : card.nodes) nodes.push_back(number(n));
    deck.element(card.number, card.group, nodes);
  }
  for (int i = 0; i < kSide; ++i)
    for (const int n : {left(i, 0), right(i, 0)}) deck.fix(number(n), 1, 1);
  deck.fix(number(wall(0)), 1, 1);
  deck.fix(number(kGround), 1, 1);
  const double force = geometry == 1 ? p * l : p * l * l;
  const auto load = [&](StageCards& stage, double size) {
    const Vector2 f = size * force * turned(1.0, -0.5);
    stage.load(number(left(0, kCells)), f.x(), f.y());
  };
  load(deck.stage(), 10.0);
  StageCards& strut = deck.stage();
  strut.births = {4};
  load(strut, 20.0);
  return deck.text();
}

// Free of units, direction and order: displacements, and N, Q and M at the points of the wall, N of the strut.
std::vector<std::vector<double>> answer_of(const WallDeck& deck, const WholeRun& run) {
  std::vector<std::vector<double>> answer(5);
  const auto add = [&](int n) {
    const Vector2 u = run.u(deck.number(n)) / deck.length;
    const Vector2 back = deck.turned(u.x(), u.y());
    answer[0].push_back(back.x());
    answer[0].push_back(back.y());
  };
  for (int j = 0; j < WallDeck::kSide; ++j) {
    for (int i = 0; i < WallDeck::kSide; ++i) {
      add(WallDeck::left(i, j));
      add(WallDeck::right(i, j));
    }
    add(WallDeck::wall(j));
  }
  const double force = deck.stress * deck.length, moment = force * deck.length;
  const PointStresses& wall = run.stress[1];
  // Mirrored, a wall's left is its right; so it is for one that goes the other way, where Q's sense turns too.
  const double turn = deck.mirrored ? -1.0 : 1.0, around = deck.reversed ? -turn : turn;
  for (int e = 0; e < WallDeck::kCells; ++e)
    for (int k = 0; k < 3; ++k) {
      const int element = deck.backwards ? WallDeck::kCells - 1 - e : e;
      const int point = 3 * element + (deck.reversed ? 2 - k : k);
      answer[1].push_back(wall(0, point) / force);
      answer[2].push_back(turn * wall(2, point) / force);
      answer[3].push_back(around * wall(3, point) / moment);
    }
  answer[4].push_back(run.stress[3](0, 0) / force);
  return answer;
}

void against_plain_wall(Sweep& s, const std::string& label, double parameter, const WallDeck& changed,
                        double allowed) {
  WallDeck plain;
  plain.geometry = changed.geometry;
  const Ran a = s.run(changed.text()), b = s.run(plain.text());
  double error = kUnknown;
  if (a.completed() && b.completed()) {
    const auto one = answer_of(changed, *a.run), other = answer_of(plain, *b.run);
    error = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) error = std::max(error, difference(one[i], other[i]));
  }
  s.right(fmt::format("{}, {}", geometry_name(changed.geometry), label), parameter, a, error, allowed);
}

void wall_variants(Sweep& s) {
  constexpr double kAllowed = 1e-10;
  for (const int geometry : {1, 2}) {
    WallDeck deck;
    deck.geometry = geometry;
    WallDeck mirrored = deck, reversed = deck, backwards = deck, all = deck;
    mirrored.mirrored = all.mirrored = true;
    reversed.reversed = all.reversed = true;
    backwards.backwards = all.backwards = true;
    against_plain_wall(s, "mirrored", kUnknown, mirrored, kAllowed);
    against_plain_wall(s, "beams reversed", kUnknown, reversed, kAllowed);
    against_plain_wall(s, "elements backwards", kUnknown, backwards, kAllowed);
    against_plain_wall(s, "mirrored, reversed and backwards", kUnknown, all, kAllowed);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      std::vector<int> numbers(301);
      std::iota(numbers.begin(), numbers.end(), 1);
      std::shuffle(numbers.begin(), numbers.end(), std::mt19937(seed));
      WallDeck shuffled = deck;
      shuffled.number = [numbers](int n) { return numbers[n - 1]; };
      against_plain_wall(s, fmt::format("random numbers {}", seed), kUnknown, shuffled, kAllowed);
    }
    for (const int power : {-9, -6, -3, 3, 6, 9}) {
      WallDeck lengths = deck, stresses = deck;
      lengths.length = stresses.stress = std::pow(10.0, power);
      against_plain_wall(s, fmt::format("lengths x 1e{}", power), kUnknown, lengths, kAllowed);
      against_plain_wall(s, fmt::format("stresses x 1e{}", power), kUnknown, stresses, kAllowed);
    }
  }
}

// Every joint's side beside the wall, told from the others.
void wrong_sides(Sweep& s) {
  for (const int geometry : {1, 2}) {
    WallDeck deck;
    deck.geometry = geometry;
    const std::string right = deck.text();
    s.silent(fmt::format("{}, as it should be", geometry_name(geometry)), kUnknown, s.run(right), "S327");
    std::string wrong = right;  // 4 3 2 1 in place of 1 2 3 4
    const std::string before = fmt::format("{:5}{:5}{:5}{:5}", 201, 202, 10, 5),
                      after = fmt::format("{:5}{:5}{:5}{:5}", 5, 10, 202, 201);
    const std::size_t at = wrong.find(before);
    s.holds(fmt::format("{}, the card is there", geometry_name(geometry)), kUnknown, at != std::string::npos,
            "found", at != std::string::npos ? "found" : "not found");
    if (at == std::string::npos) continue;
    wrong.replace(at, before.size(), after);
    s.says(fmt::format("{}, sides swapped", geometry_name(geometry)), kUnknown, s.run(wrong),
           "its sides are swapped");
  }
}

}  // namespace

std::vector<Row> structure_rows() {
  const std::string family = "Structures";
  return {
      {"beam-rigid", family, "a raft on soil, EA = EI = GA from 1e2 to 1e14 E L^3",
       "the soil alone, whose nodes under the raft move as a rigid body. Allowed: 20/EI, the flexibility of "
       "the raft, and 100 u EI, rounding. From 1e13 on sagefe must call the matrix singular",
       "EI", true, rigid},
      {"beam-bar", family, "the same raft, EI = GA from 1e-2 to 1e-18 E L^3, EA = 10 E L",
       "a bar in its place. Allowed: 20 EI + 1e-12", "EI", true, [](Sweep& s) { soft(s, true); }},
      {"beam-nothing", family, "the same raft, EA = EI = GA from 1e-2 to 1e-18",
       "the soil without it. Allowed: 20 EI + 1e-12", "EI", true, [](Sweep& s) { soft(s, false); }},
      {"wall-variants", family,
       "wall with strut and joints on both sides: mirror, numbers, order, units, reversed beams",
       "the same wall in its plain form: u, N, Q, M and the strut's force. Allowed: 1e-10", "", false,
       wall_variants},
      {"wall-sides", family, "a joint beside a wall with its sides swapped", "the message that names it", "",
       false, wrong_sides}};
}

}  // namespace sage::stress

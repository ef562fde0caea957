// Cards that a deck of any layout may have in place of stages: each stands for one stage or more.
#include <algorithm>
#include <cmath>
#include <map>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"

namespace sage::builder {

namespace {

constexpr int kMostIncrements = 10'000'000;

std::vector<CardView> on_their_own(const Builder& b, std::string_view name) {
  std::vector<CardView> cards = b.deck.all(name);
  std::erase_if(cards, [&](const CardView& card) { return !outside_stages(b.deck, card); });
  return cards;
}

// A displacement card: nodes that are moved in one direction.
struct Moved {
  std::vector<int> nodes;
  std::size_t direction = 0;  // 0 x, 1 y
  double value = 1.0;         // of the first step, or a multiple of the increments' displacement
  CardView card;
};

std::vector<Moved> read_displacements(Builder& b, bool values_needed) {
  std::vector<Moved> all;
  for (const CardView& card : on_their_own(b, "displacement")) {
    Moved moved{node_range(b, card), 0, card.real("value", 1.0), card};
    const int direction = card.integer("direction");
    if (direction != 1 && direction != 2)
      b.error("S210", card.where("direction"),
              "direction " + std::to_string(direction) + " of a displacement is unknown; 1 x, 2 y");
    else
      moved.direction = static_cast<std::size_t>(direction - 1);
    b.usable(card, "value", moved.value);
    if (values_needed && card.blank("value"))
      b.error("S240", card.where("value"),
              "the displacement is missing; it stands here or on the increments card");
    all.push_back(std::move(moved));
  }
  return all;
}

Fixity fixity_of(const Moved& moved, int node, double value) {
  Fixity fixity;
  fixity.node = node;
  fixity.code[moved.direction] = FixityCode::fixed;
  fixity.value[moved.direction] = value;
  fixity.line = moved.card.card().line;
  return fixity;
}

// What the steps are multiples of.
struct Loads {
  std::vector<NodalLoad> loads;
  std::vector<FieldLoad> field_loads;
  std::vector<EdgeLoad> pressures;
  std::vector<Moved> moved;
  Vector2 gravity = Vector2::Zero();
  SourcePosition where;

  // A card asks for them, if only for nothing.
  bool any() const { return where.line > 0; }
};

Loads read_loads(Builder& b, bool values_needed) {
  Loads all;
  const auto seen = [&](const CardView& card) {
    if (all.where.line == 0) all.where = card.where();
  };
  for (const CardView& card : on_their_own(b, "load")) {
    seen(card);
    read_load(b, card, all.loads, all.field_loads);
  }
  for (const CardView& card : on_their_own(b, "pressure")) {
    seen(card);
    read_pressure(b, card, all.pressures);
  }
  for (const CardView& card : on_their_own(b, "edge_load")) {
    seen(card);
    read_edge_load(b, card, all.pressures, all.loads);
  }
  for (const CardView& card : on_their_own(b, "gravity")) {
    seen(card);
    all.gravity += Vector2(card.real("gravity_x"), card.real("gravity_y"));
  }
  all.moved = read_displacements(b, values_needed);
  if (!all.moved.empty()) seen(all.moved.front().card);
  return all;
}

// One stage: all loads times a factor.
void apply(const Loads& loads, double factor, Stage& stage) {
  for (NodalLoad load : loads.loads) {
    load.force *= factor;
    stage.loads.push_back(load);
  }
  for (FieldLoad load : loads.field_loads) {
    load.value *= factor;
    stage.field_loads.push_back(load);
  }
  for (EdgeLoad load : loads.pressures) {
    load.normal *= factor;
    load.shear *= factor;
    stage.pressures.push_back(load);
  }
  stage.gravity += factor * loads.gravity;
}

void move(const std::vector<Moved>& all, double factor, Stage& stage) {
  for (const Moved& moved : all)
    for (const int node : moved.nodes) stage.fixities.push_back(fixity_of(moved, node, factor * moved.value));
}

struct Step {
  double factor = 1.0;
  SourcePosition where;
};

// A factor that is added, or the one that is reached.
void add_factor(Builder& b, const SourcePosition& where, double value, bool total, double& sum,
                std::vector<Step>& steps) {
  if (!(std::abs(value) < 1e100))
    b.error("S208", where, "the load factor is too large to compute with (beyond 1e100)");
  steps.push_back({total ? value - sum : value, where});
  sum = total ? value : sum + value;
}

// From lists on the increments card, or from increment cards, one a step.
std::vector<Step> read_factors(Builder& b) {
  std::vector<Step> steps;
  double sum = 0.0;
  for (const char* cards : {"increments", "increment"})
    for (const CardView& card : on_their_own(b, cards)) {
      for (const auto& [list, total] : {std::pair{"factors", false}, std::pair{"totals", true}})
        for (const FieldValue& value : card.list(list))
          add_factor(b, card.where(value), value.number, total, sum, steps);
      for (const auto& [field, total] : {std::pair{"factor", false}, std::pair{"total", true}})
        if (!card.blank(field)) add_factor(b, card.where(field), card.real(field), total, sum, steps);
    }
  return steps;
}

Stage new_stage(const std::string& title, const SourcePosition& where, int increments = 1) {
  Stage stage;
  stage.title = title;
  stage.where = where;
  stage.increments = increments;
  return stage;
}

// The field `increments` of the card with that name; 1 without it.
int number_of_increments(Builder& b) {
  for (const CardView& card : on_their_own(b, "increments")) {
    if (card.blank("increments")) continue;
    const int n = card.integer("increments");
    if (n >= 1 && n <= kMostIncrements) return n;
    b.error("S238", card.where("increments"), "the number of increments must be between 1 and 10000000");
  }
  return 1;
}

// The force on all moved nodes, row by row.
void report_moved(Builder& b, const Loads& loads) {
  Report report;
  report.kind = ReportKind::nodes;
  report.stage = static_cast<int>(b.model.stages.size()) - 1;
  report.where = loads.where;
  for (const Moved& moved : loads.moved)
    for (const int node : moved.nodes)
      if (std::find(report.nodes.begin(), report.nodes.end(), node) == report.nodes.end())
        report.nodes.push_back(node);
  b.model.reports.push_back(std::move(report));
}

void add_load_steps(Builder& b, const Loads& loads) {
  double each = 0.0;
  SourcePosition where = loads.where;
  for (const CardView& card : on_their_own(b, "increments"))
    if (!card.blank("displacement")) {
      each = card.real("displacement");
      where = card.where();
    }
  const std::vector<Step> steps = read_factors(b);
  if (each != 0.0 && !steps.empty())
    b.error("S240", where,
            "load factors and a displacement of each increment stand on one card: only one of them can be");
  if (!loads.any()) {
    if (!steps.empty())
      b.error("S240", steps.front().where,
              "there are load factors, but no load, pressure, displacement or gravity card");
    return;
  }
  if (each != 0.0) {
    if (loads.moved.empty())
      b.error("S240", where,
              "a displacement of each increment is given, but no displacement card says of which nodes");
    const int increments = number_of_increments(b);
    Stage stage = new_stage("displacement", where, increments);
    stage.output_every = 1;
    apply(loads, 1.0, stage);
    move(loads.moved, increments * each, stage);
    b.model.stages.push_back(std::move(stage));
    return report_moved(b, loads);
  }
  if (steps.empty()) {
    Stage stage = new_stage("load", where);
    apply(loads, 1.0, stage);
    move(loads.moved, 1.0, stage);
    b.model.stages.push_back(std::move(stage));
    return;
  }
  int number = 0;
  for (const Step& step : steps) {
    Stage stage = new_stage("load step " + std::to_string(++number), step.where);
    apply(loads, step.factor, stage);
    move(loads.moved, step.factor, stage);
    b.model.stages.push_back(std::move(stage));
  }
}

void add_removals(Builder& b) {
  const std::vector<CardView> cards = on_their_own(b, "removal");
  if (cards.empty()) return;
  const int increments = number_of_increments(b);
  int number = 0;
  for (const CardView& card : cards) {
    Stage stage = new_stage("removal " + std::to_string(++number), card.where(), increments);
    if (const auto found = b.removed.find(card.index()); found != b.removed.end()) stage.deaths = found->second;
    b.model.stages.push_back(std::move(stage));
  }
}

// Elements of one group that are treated apart: a group of their own, of the same number.
int piece_of(Builder& b, int from, const std::string& name) {
  const Group& whole = b.model.groups[from];
  Group piece = whole;
  piece.name = (whole.name.empty() ? "" : whole.name + ", ") + name;
  piece.element_numbers.clear();
  piece.element_lines.clear();
  piece.nodes.clear();
  b.model.groups.push_back(std::move(piece));
  return static_cast<int>(b.model.groups.size()) - 1;
}

void copy_element(const Group& from, int element, Group& to) {
  const auto e = static_cast<std::size_t>(element);
  to.element_numbers.push_back(from.element_numbers[e]);
  to.element_lines.push_back(from.element_lines[e]);
  to.nodes.insert(to.nodes.end(), from.nodes_of(element), from.nodes_of(element) + from.node_count());
}

// card_of: element number -> place among the removal cards.
void split_by_cards(Builder& b, int group, const std::vector<CardView>& cards,
                    const std::unordered_map<int, std::size_t>& card_of) {
  std::vector<int> keys;
  for (const int number : b.model.groups[group].element_numbers) {
    const auto card = card_of.find(number);
    keys.push_back(card == card_of.end() ? -1 : static_cast<int>(card->second));
  }
  for (const auto& [key, piece] : split_group(b, group, keys, "removal"))
    b.removed[cards[static_cast<std::size_t>(key)].index()].push_back(piece);
}

// Once all cards are read that name a group by its number: pieces get numbers of their own.
void number_pieces(Builder& b) {
  int largest = 0;
  for (const Group& group : b.model.groups) largest = std::max(largest, group.number);
  std::vector<int> pieces;
  for (const auto& [card, groups] : b.removed) pieces.insert(pieces.end(), groups.begin(), groups.end());
  pieces.insert(pieces.end(), b.layer_pieces.begin(), b.layer_pieces.end());
  std::sort(pieces.begin(), pieces.end());
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  for (const int piece : pieces) b.model.groups[piece].number = ++largest;
}

}  // namespace

std::map<int, int> split_group(Builder& b, int group, const std::vector<int>& keys, const std::string& name) {
  const Group whole = b.model.groups[group];
  std::map<int, int> pieces;
  for (const int key : keys)
    if (key >= 0 && !pieces.contains(key))
      pieces[key] = piece_of(b, group, name + " " + std::to_string(key + 1));
  if (pieces.empty()) return pieces;
  Group& rest = b.model.groups[group];
  rest.element_numbers.clear();
  rest.element_lines.clear();
  rest.nodes.clear();
  for (int e = 0; e < whole.elements(); ++e) {
    const int key = keys[e];
    const int to = key < 0 ? group : pieces.at(key);
    Group& now = b.model.groups[to];
    ElementPlace& place = b.element_place.at(whole.element_numbers[e]);
    place.group = to;
    place.element = now.elements();
    copy_element(whole, e, now);
  }
  return pieces;
}

void split_removed(Builder& b) {
  const std::vector<CardView> cards = b.deck.all("removal");
  if (cards.empty() || !b.elements_known) return;
  std::unordered_map<int, std::size_t> card_of;
  for (std::size_t c = 0; c < cards.size(); ++c)
    for (const FieldValue& value : cards[c].list("elements")) {
      const int number = static_cast<int>(std::clamp(value.number, -2e9, 2e9));
      if (!b.element_place.contains(number))
        b.error("S202", cards[c].where(value),
                "element " + std::to_string(number) + " is to be removed, but no card defines it");
      else if (const auto [before, added] = card_of.try_emplace(number, c); !added)
        b.error("S239", cards[c].where(value),
                "element " + std::to_string(number) + " is removed already by line " +
                    std::to_string(cards[before->second].card().line));
    }
  if (b.problems.errors() > 0) return;
  const int groups = static_cast<int>(b.model.groups.size());
  for (int g = 0; g < groups; ++g) split_by_cards(b, g, cards, card_of);
}

void build_steps(Builder& b) {
  const bool moves = !on_their_own(b, "displacement").empty();
  bool by_increments = false;
  for (const CardView& card : on_their_own(b, "increments"))
    by_increments = by_increments || !card.blank("displacement");
  const Loads loads = read_loads(b, moves && !by_increments);
  if (b.deck.has("start_stress")) {
    Stage stage = new_stage("start stress", b.deck.all("start_stress").front().where());
    move(loads.moved, 0.0, stage);
    add_start_stress(b, std::move(stage));
  }
  add_load_steps(b, loads);
  add_removals(b);
  number_pieces(b);
  for (std::size_t i = 0; i < b.model.stages.size(); ++i) b.model.stages[i].number = static_cast<int>(i) + 1;
}

}  // namespace sage::builder

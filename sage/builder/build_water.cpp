// Water cards: pore pressures of solids stage by stage, and groups whose water can't leave.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "sage/builder/builder.hpp"
#include "sage/deck/text.hpp"
#include "sage/model/law_table.hpp"
#include "sage/model/undrained.hpp"
#include "sage/model/water.hpp"

namespace sage::builder {

namespace {

constexpr int kKinds = 9;
constexpr int kDrawdown = static_cast<int>(WaterKind::drawdown);
constexpr int kStored = 7;  // heads of an earlier run: pressures at nodes, once they are read

std::vector<double> values_of(Builder& b, const CardView& card) {
  std::vector<double> values;
  for (const FieldValue& value : card.list("values")) {
    if (!(std::abs(value.number) < 1e100)) {
      b.error("S208", card.where(value),
              "a value of the water card is too large to compute with (beyond 1e100)");
      return {};
    }
    values.push_back(value.number);
  }
  return values;
}

void read_line(Builder& b, const CardView& card, WaterCard& water) {
  const std::vector<double> values = values_of(b, card);
  if (values.empty() || values.size() % 2 != 0) {
    b.error("S248", card.where("listed"),
            "a phreatic line takes x and y of its points, two values a point; the card has " +
                std::to_string(values.size()) + " values");
    return;
  }
  for (std::size_t i = 0; i < values.size(); i += 2) {
    const Vector2 point(values[i], values[i + 1]);
    if (!water.line.empty() && !(point.x() > water.line.back().x())) {
      b.error("S248", card.where("values"), "the points of a phreatic line stand by rising x");
      return;
    }
    water.line.push_back(point);
  }
}

void read_nodes(Builder& b, const CardView& card, WaterCard& water) {
  const std::vector<double> values = values_of(b, card);
  if (values.empty() || values.size() % 2 != 0) {
    b.error("S248", card.where("listed"),
            "pressures at nodes are pairs of a node and its pressure; the card has " +
                std::to_string(values.size()) + " values");
    return;
  }
  std::set<int> seen;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    if (!(values[i] >= 1.0 && values[i] < 2e9 && values[i] == std::floor(values[i])) || values[i + 1] < 0.0) {
      b.error("S248", card.where("values"),
              "pressures at nodes are pairs of a node's number and a pressure that is not negative");
      return;
    }
    const int node = b.node(card, "values", static_cast<std::int64_t>(values[i]));
    if (node < 0) return;
    if (!seen.insert(node).second) {
      b.error("S248", card.where("values"),
              "node " + rounded_text(values[i], 10) + " stands twice on the card of pressures at nodes");
      return;
    }
    water.nodes.emplace_back(node, values[i + 1]);
  }
}

void require_unit_weight(Builder& b, const CardView& card) {
  if (!(b.model.units.water_unit_weight > 0.0))
    b.error("S247", card.where("kind"),
            "pressures from a level of water need the unit weight of water of the unit card");
}

// Stage of a card, 0-based; -1 after an error.
int read_first_stage(Builder& b, const CardView& card) {
  const int stage = card.integer("stage") == 0 ? 1 : card.integer("stage");
  const int stages = static_cast<int>(b.model.stages.size());
  if (stage >= 1 && stage <= stages) return stage - 1;
  b.error("S248", card.where("stage"),
          "there is no stage " + std::to_string(stage) + "; the deck has " + std::to_string(stages));
  return -1;
}

void read_heads(Builder& b, const CardView& card, const WaterCard& water) {
  require_unit_weight(b, card);
  if (find_unknown(b.model.unknowns, "head") < 0)
    b.error("S248", card.where("kind"), "no element of the deck solves for heads");
  else if (water.stage == 0)
    b.error("S248", card.where("stage"),
            "heads are taken as they stand at the start of the stage: they need a stage of flow before it");
}

void read_drawdown(Builder& b, const CardView& card, WaterCard& water) {
  require_unit_weight(b, card);
  read_line(b, card, water);
  if (card.blank("value1")) water.value = 1.0;
  if (!(water.value > 0.0 && water.value <= 1.0))
    b.error("S248", card.where("value1"), "B-bar of a rapid drawdown is above 0 and at most 1; blank is 1");
  if (water.action != WaterAction::edges)
    b.error("S248", card.where("action"), "a rapid drawdown needs water at free edges (action 0)");
}

void read_kind(Builder& b, const CardView& card, WaterCard& water) {
  switch (water.kind) {
    case WaterKind::line:
      require_unit_weight(b, card);
      return read_line(b, card, water);
    case WaterKind::drawdown:
      return read_drawdown(b, card, water);
    case WaterKind::ratio:
      if (!(water.value >= 0.0 && water.value <= 1.0))
        b.error("S248", card.where("value1"), "r_u lies between 0 and 1");
      if (water.action == WaterAction::force)
        b.error("S248", card.where("action"), "r_u has no seepage force: its pressures belong to no flow");
      return;
    case WaterKind::nodes:
      return read_nodes(b, card, water);
    case WaterKind::heads:
      return read_heads(b, card, water);
    default:
      return;
  }
}

// A number in a field that the card's kind has no use for stands there by mistake, for another field or kind.
void refuse_unread(Builder& b, const CardView& card, bool structure) {
  const int kind = card.integer("kind");
  const auto refuse = [&](const char* field, const std::string& what, const std::string& who) {
    b.error("S248", card.where(field),
            "a water card of kind " + std::to_string(kind) + " reads no " + what + "; " + who);
  };
  const auto among = [kind](std::initializer_list<int> kinds) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  if (card.integer("listed") > 0 && !among({1, 3, kDrawdown}))
    refuse("listed", "values listed",
           "a phreatic line (kind 1), pressures at nodes (kind 3) and a rapid drawdown (kind 8) do");
  if (kind == 1 && !structure && card.real("value1") != 0.0 && card.real("value1") != 1.0)
    b.error(
        "S248", card.where("value1"),
        "value 1 of a phreatic line is 0 (all of the vertical depth counts) or 1 (cos^2 of the line's slope)");
  if (card.real("value1") != 0.0 && !among({1, 2, 5, kStored, kDrawdown}) && !structure)
    refuse("value1", "value 1",
           "r_u, the rule of a phreatic line, the bulk of water, the stage of an earlier run and B-bar stand "
           "there, and sides of beams");
  if (card.real("value2") != 0.0 && !among({5}))
    refuse("value2", "value 2", "an undrained Poisson's ratio (kind 5) stands there");
}

void read_file(Builder& b, const CardView& card) {
  const double stage = card.real("value1");
  const std::string file = b.text(card, "file");
  if (file.empty())
    b.error("S248", card.where("file"),
            "heads of an earlier run stand in its result file (sagefe run --result), which the card must name");
  else if (!(stage >= 0.0 && stage < 1e6 && stage == std::floor(stage)))
    b.error(
        "S248", card.where("value1"),
        "value 1 is the number of a stage of the earlier run, 0 for its last, not " + rounded_text(stage, 7));
  else
    b.stored_heads.push_back({b.model.water.size(), file, card.where("file"), static_cast<int>(stage)});
}

// Beams, all of whose ends go where their nodes go.
bool bears_water(const ElementEntry& entry) {
  const auto has = [&](auto what) {
    return std::ranges::any_of(entry.unknowns, [&](const ElementUnknown& one) { return what(one.field); });
  };
  return has([](const UnknownField& field) { return field.turns; }) &&
         !has([](const UnknownField& field) { return !field.turns && !field.displacement(); });
}

// group: its place, -1 = all of the model.
bool is_structure(const Builder& b, int group) {
  if (group < 0) return false;
  const Group& own = b.model.groups[group];
  return own.entry != nullptr && own.structure();
}

// Cards about structures: free water on their sides, or none.
bool free_water_fits(Builder& b, const CardView& card, const Group& group) {
  const std::string name = "group " + std::to_string(group.number) + " (" + group.element_name + ")";
  const int kind = card.integer("kind");
  const auto refuse = [&](const char* field, const std::string& text) {
    b.error("S248", card.where(field), name + text);
    return false;
  };
  if (kind != 0 && kind != 1)
    return refuse("kind",
                  ": structures have no pores; the water that stands beside them is kind 1 (its level) or 0");
  if (!bears_water(*group.entry))
    return refuse("group",
                  ": water can't stand on it; beams bear it whose ends don't slide against their nodes");
  if (card.integer("action") != 0)
    return refuse("action", ": the water beside a structure presses on it (action 0)");
  const double side = card.real("value1");
  if (side != 0.0 && side != 1.0 && side != -1.0)
    return refuse("value1", ": value 1 is the side, 1 left of the way from node 1 to node 2, -1 right, 0 both");
  return true;
}

// Groups that a card is about.
std::vector<int> groups_of(Builder& b, const CardView& card) {
  const int number = card.integer("group");
  if (number == 0) return {-1};
  std::vector<int> groups;
  for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
    const Group& group = b.model.groups[g];
    if (group.number != number) continue;
    groups.push_back(static_cast<int>(g));
    if (group.entry == nullptr || group.solid()) continue;
    if (group.structure()) {
      if (free_water_fits(b, card, group)) continue;
      return {};
    }
    b.error(
        "S248", card.where("group"),
        "group " + std::to_string(number) +
            " is neither a solid nor a structure: pore pressures are those of solids, joints take that of the "
            "solids beside them, and free water stands on structures");
    return {};
  }
  if (groups.empty()) b.group_missing(card.where("group"), number);
  return groups;
}

// K_w / n of a card about undrained groups; 0 after an error.
double bulk_of(Builder& b, const CardView& card, const Group& group) {
  const double bulk = card.real("value1"), nu = card.real("value2");
  if (bulk > 0.0 && nu == 0.0) return bulk;
  if (bulk != 0.0 || !(nu > 0.0 && nu <= 0.5)) {
    b.error("S248", card.where("value1"),
            "an undrained group takes the bulk of water over the porosity, or (value 2) an undrained Poisson's "
            "ratio between 0 and 1/2 (1/2: no change of volume), and not both");
    return 0.0;
  }
  const LawRef law = b.model.material_of(group).law_ref();
  const auto* const solid = std::get_if<const SolidLaw*>(&law);
  const double found = solid == nullptr || *solid == nullptr ? 0.0 : bulk_for(**solid, nu);
  if (found > 0.0) return found;
  b.error("S248", card.where("value2"),
          "group " + std::to_string(group.number) + " (" + b.model.material_of(group).law_name +
              ") has no bulk of water that gives this undrained Poisson's ratio at zero stress; state the bulk "
              "(value 1)");
  return 0.0;
}

// A material with room for the excess pressure, one for each that undrained groups have.
void shut_in(Builder& b, Group& group, std::map<int, int>& twins) {
  if (group.excess >= 0) return;
  const int from = group.material;
  auto twin = twins.find(from);
  if (twin == twins.end()) {
    Material material = twin_of(b.model.materials[from], b.model.units);
    material.undrained = material.twin = true;
    material.law = make_law(material, b.model.units);
    twin = twins.emplace(from, static_cast<int>(b.model.materials.size())).first;
    b.model.materials.push_back(std::move(material));
  }
  group.material = twin->second;
  group.excess = static_cast<int>(history_of(b.model.material_of(group).law_ref()).size() - UndrainedLaw::kOwn);
}

void read_undrained(Builder& b, const CardView& card, WaterCard water, std::map<int, int>& twins,
                    const std::vector<int>& groups) {
  std::vector<int> all = groups;
  if (groups == std::vector<int>{-1}) {
    all.clear();
    for (std::size_t g = 0; g < b.model.groups.size(); ++g)
      if (b.model.groups[g].entry != nullptr && b.model.groups[g].solid()) all.push_back(static_cast<int>(g));
  }
  for (const int g : all) {
    Group& group = b.model.groups[g];
    if (group.entry != nullptr && group.entry->has_pores()) {
      b.error("S366", card.where(),
              "group " + std::to_string(group.number) + " (" + group.element_name +
                  ") solves for the pressure of its pore water; its stages say whether it is shut in");
      continue;
    }
    water.group = g;
    water.value = bulk_of(b, card, group);
    if (!(water.value > 0.0)) return;
    shut_in(b, group, twins);
    b.model.water.push_back(water);
  }
}

// A pressure that is given while the volume says what it is.
void check_undrained(Builder& b) {
  for (const WaterCard& shut : b.model.water) {
    if (shut.kind != WaterKind::undrained) continue;
    int until = static_cast<int>(b.model.stages.size());
    for (const WaterCard& open : b.model.water)
      if (open.kind == WaterKind::drained && open.stage > shut.stage &&
          (open.group < 0 || open.group == shut.group))
        until = std::min(until, open.stage);
    for (const WaterCard& given : b.model.water) {
      const bool about_it = given.group < 0 || given.group == shut.group;
      if (!given.pressure() || !about_it || given.kind == WaterKind::drawdown) continue;
      const bool begins = given.stage > shut.stage || (given.stage == shut.stage && given.stage > 0);
      if (begins && given.stage < until)
        b.error("S249", given.where,
                "group " + std::to_string(b.model.groups[shut.group].number) + " is undrained in stage " +
                    std::to_string(given.stage + 1) +
                    ": its pressure follows from the change of volume and can't be given as well");
    }
  }
}

// Of two cards of one stage about the same the last stands; a card that drains what was never shut in does nothing.
void warn_of_water_cards(Builder& b) {
  const auto name = [&](int group) {
    return group < 0 ? std::string("all solids") : "group " + std::to_string(b.model.groups[group].number);
  };
  const auto same = [&](const WaterCard& a, const WaterCard& c) {
    const bool structure = is_structure(b, a.group);
    return a.stage == c.stage && a.group == c.group && a.pressure() == c.pressure() &&
           (!structure || c.value == 0.0 || a.value == c.value);
  };
  const std::vector<WaterCard>& cards = b.model.water;
  for (auto card = cards.begin(); card != cards.end(); ++card) {
    const auto before =
        std::find_if(cards.begin(), card, [&](const WaterCard& one) { return same(one, *card); });
    if (before != card)
      b.warning("S320", card->where,
                "two water cards say of " + name(card->group) + " how it is in stage " +
                    std::to_string(card->stage + 1) + "; this one stands, that of line " +
                    std::to_string(before->where.line) + " does not");
    if (card->kind != WaterKind::drained) continue;
    const bool shut = std::any_of(cards.begin(), cards.end(), [&](const WaterCard& one) {
      return one.kind == WaterKind::undrained && one.stage <= card->stage &&
             (card->group < 0 || one.group == card->group);
    });
    if (!shut)
      b.warning("S332", card->where, name(card->group) + " is drained: no card before shuts its water in");
  }
}

// Which rule the pressures below a sloping line follow: the two differ.
void note_rule_of_line(Builder& b, const WaterCard& card) {
  constexpr double kSlopes = 0.1;  // 1 % of the pressure
  double steepest = 0.0;
  for (std::size_t i = 1; i < card.line.size(); ++i) {
    const Vector2 way = card.line[i] - card.line[i - 1];
    steepest = std::max(steepest, std::abs(way.y() / way.x()));
  }
  if (!(steepest > kSlopes)) return;
  const double share = 1.0 / (1.0 + steepest * steepest);
  b.note("S541", card.where,
         std::string("pore pressure below the phreatic line: gamma_w times the vertical depth") +
             (card.value == 1.0 ? " times cos^2 of the line's slope" : "") + "; its steepest part slopes by " +
             rounded_text(std::atan(steepest) / kRadiansPerDegree, 3) + " degrees, where " +
             (card.value == 1.0 ? "this is " : "seepage along the slope has ") + rounded_text(share, 3) +
             (card.value == 1.0 ? " of the full depth" : " of that (value 1 = 1: cos^2 of the slope)"));
}

// Nodes of the solids that a water card is about, each once, and a place within an element of each.
void list_nodes(const Model& model, const WaterCard& card, HeadRequest& request) {
  std::vector<char> listed(static_cast<std::size_t>(model.mesh.nodes()), 0);
  Eigen::Matrix2Xd x;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Group& group = model.groups[g];
    if (!group.solid() || (card.group >= 0 && card.group != static_cast<int>(g))) continue;
    for (int e = 0; e < group.elements(); ++e) {
      element_coordinates(model.mesh, group, e, x);
      for (std::size_t i = 0; i < group.node_count(); ++i) {
        const int node = group.nodes_of(e)[i];
        if (listed[node]++ > 0) continue;
        request.nodes.push_back(node);
        request.inside.emplace_back(x.leftCols(group.entry->corners).rowwise().mean());
      }
    }
  }
}

// Seen from the deck's folder, as names in a deck are.
std::string beside(const std::string& deck, const std::string& file) {
  const std::filesystem::path path(file);
  return path.is_absolute() ? file : (std::filesystem::path(deck).parent_path() / path).string();
}

void take_heads(Builder& b, const StoredHeads& stored) {
  Model& model = b.model;
  WaterCard& card = model.water[stored.card];
  HeadRequest request{beside(b.deck.file, stored.file), stored.stage, &model, {}, {}};
  list_nodes(model, card, request);
  std::vector<double> head;
  try {
    head = b.options.heads(request);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics().list())
      if (d.severity == Severity::error)
        b.error("S250", stored.where, "heads of an earlier run: " + request.file + ": " + d.message);
    return;
  }
  int outside = 0, first = -1;
  for (std::size_t i = 0; i < request.nodes.size(); ++i) {
    const int node = request.nodes[i];
    if (std::isnan(head[i]) && outside++ == 0) first = node;
    card.nodes.emplace_back(node, model.units.water_unit_weight * (head[i] - model.mesh.x(1, node)));
  }
  if (outside == 0) return;
  b.error("S250", stored.where,
          "heads of an earlier run: " + std::to_string(outside) + " node(s) lie outside the mesh of " +
              request.file + ", the first is node " + std::to_string(model.mesh.number[first]) + " at (" +
              rounded_text(model.mesh.x(0, first), 6) + ", " + rounded_text(model.mesh.x(1, first), 6) + ")");
}

// Of one group; true after an error.
bool check_drawdown(Builder& b, const WaterCard& card, int group) {
  const std::string name = "group " + std::to_string(b.model.groups[group].number);
  const auto fail = [&](const SourcePosition& where, const std::string& text) {
    b.error("S248", where, name + text);
    return true;
  };
  const WaterCard* const before = line_before(b.model, card, group);
  if (before == nullptr || before->action != WaterAction::edges)
    return fail(card.where, " has no phreatic line with action 0 before stage " +
                                std::to_string(card.stage + 1) + " from which a rapid drawdown could begin");
  if (b.model.groups[group].second_material >= 0)
    return fail(
        card.where,
        " solves for its pore pressure, which a rapid drawdown can't give; lower its line (kind 1) in a "
        "stage with pore_water 1");
  if (!is_undrained(b.model, card.stage, group)) return false;
  for (const WaterCard& open : b.model.water) {
    const bool opens =
        open.kind == WaterKind::drained && open.stage > card.stage && (open.group < 0 || open.group == group);
    if (opens && water_card(b.model, open.stage, group) == &card)
      return fail(
          open.where,
          " is drained with the pressures from before the drawdown: give it a phreatic line from stage " +
              std::to_string(open.stage + 1) + " on");
  }
  return false;
}

// Each needs a phreatic line with water at free edges to fall from.
void check_drawdowns(Builder& b) {
  for (const WaterCard& card : b.model.water) {
    if (card.kind != WaterKind::drawdown) continue;
    for (std::size_t g = 0; g < b.model.groups.size(); ++g) {
      const bool own = card.group < 0 || card.group == static_cast<int>(g);
      if (!own || !b.model.groups[g].solid()) continue;
      if (check_drawdown(b, card, static_cast<int>(g))) break;
    }
  }
}

}  // namespace

void take_stored_heads(Builder& b) {
  for (const StoredHeads& stored : b.stored_heads) {
    if (!b.options.heads) {
      b.error("S250", stored.where, "this command does not read heads of an earlier run");
      return;
    }
    const int before = b.problems.errors();
    take_heads(b, stored);
    if (b.problems.errors() > before) return;
  }
}

void build_water(Builder& b) {
  std::map<int, int> twins;
  for (const CardView& card : b.deck.all("water")) {
    const int kind = card.integer("kind"), action = card.integer("action");
    if (kind < 0 || kind >= kKinds) {
      b.error("S210", card.where("kind"),
              "water of kind " + std::to_string(kind) +
                  " is unknown; 0 dry, 1 phreatic line, 2 r_u, 3 nodes, 4 heads, 5 undrained, 6 drained, 7 "
                  "heads of an earlier run, 8 rapid drawdown");
      continue;
    }
    if (action < 0 || action > 2) {
      b.error("S210", card.where("action"),
              "action " + std::to_string(action) +
                  " is unknown; 0 water stands at free edges, 1 it does not, 2 seepage force");
      continue;
    }
    WaterCard water;
    water.kind = kind == kStored ? WaterKind::nodes : static_cast<WaterKind>(kind);
    water.action = static_cast<WaterAction>(action);
    water.where = card.where();
    water.value = card.real("value1");
    water.stage = read_first_stage(b, card);
    const std::vector<int> groups = groups_of(b, card);
    if (water.stage < 0 || groups.empty() || !b.materials_known || !b.groups_known) continue;
    refuse_unread(b, card, is_structure(b, groups.front()));
    if (water.kind == WaterKind::undrained) {
      read_undrained(b, card, water, twins, groups);
      continue;
    }
    if (kind == kStored)
      require_unit_weight(b, card);
    else
      read_kind(b, card, water);
    if (water.kind == WaterKind::line && !is_structure(b, groups.front())) note_rule_of_line(b, water);
    for (const int g : groups) {
      water.group = g;
      if (kind == kStored) read_file(b, card);
      b.model.water.push_back(water);
    }
  }
  check_undrained(b);
  check_drawdowns(b);
  warn_of_water_cards(b);
  if (!b.model.water.empty() || b.model.has_pores()) b.model.fields.add_free(water_fields());
  b.water_nodes = b.model.mesh.nodes();
}

}  // namespace sage::builder

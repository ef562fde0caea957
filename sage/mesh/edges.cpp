#include "sage/mesh/edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "sage/messages/error.hpp"
#include "sage/model/joined.hpp"

namespace sage::mesh {

namespace {

// An edge with nodes that were made, and the nodes there were before: its ends, and those that its cards give.
struct CutEdge {
  std::vector<OnEdge> known, made;

  // The first known node behind a made one; there is one before it too.
  std::size_t behind(const OnEdge& node) const {
    std::size_t i = 1;
    while (i + 1 < known.size() && known[i].at < node.at) ++i;
    return i;
  }
};

// Edges with made nodes that are wanted.  wanted(edge, known): known nodes inside it.
template <class Wanted>
std::vector<CutEdge> cut_edges(const EdgeTable& edges, int first_made, const Wanted& wanted) {
  std::vector<CutEdge> cut;
  for (const EdgeTable::Edge& edge : edges.edges()) {
    int known = 0, made = 0;
    const auto each = [&](auto&& visit) {
      for (int i = edge.first; i >= 0; i = edges.link(i).next) visit(edges.link(i));
    };
    each([&](const OnEdge& node) { ++(node.node < first_made ? known : made); });
    if (made == 0 || !wanted(edge, known)) continue;
    CutEdge one{{{0.0, edge.ends.first}, {1.0, edge.ends.second}}, {}};
    each([&](const OnEdge& node) { (node.node < first_made ? one.known : one.made).push_back(node); });
    std::sort(one.known.begin(), one.known.end(), [](const OnEdge& a, const OnEdge& b) { return a.at < b.at; });
    cut.push_back(std::move(one));
  }
  return cut;
}

// Outer ones, and inner ones whose own middle node says what is meant.
std::vector<CutEdge> cut_edges_of_sides(const EdgeTable& edges, int first_made) {
  return cut_edges(edges, first_made,
                   [](const EdgeTable::Edge& edge, int known) { return edge.solids <= 1 || known > 0; });
}

// For a field of corners alone, where middle nodes count as made ones, since they become corners.  Outer edges, and inner ones but
// those that cross from one side of the model to another.
std::vector<CutEdge> cut_edges_of_corners(const EdgeTable& edges, int first_made) {
  std::vector<char> outer(static_cast<std::size_t>(first_made), 0);
  for (const EdgeTable::Edge& edge : edges.edges())
    if (edge.solids <= 1) outer[edge.ends.first] = outer[edge.ends.second] = 1;
  std::vector<CutEdge> cut = cut_edges(edges, first_made, [&](const EdgeTable::Edge& edge, int) {
    return edge.solids <= 1 || outer[edge.ends.first] == 0 || outer[edge.ends.second] == 0;
  });
  for (CutEdge& edge : cut) {
    edge.made.insert(edge.made.end(), edge.known.begin() + 1, edge.known.end() - 1);
    edge.known.erase(edge.known.begin() + 1, edge.known.end() - 1);
  }
  return cut;
}

// All that lie between two listed nodes, and those that have known nodes inside.
std::vector<CutEdge> cut_edges_between(const std::vector<int>& listed, const EdgeTable& edges, int first_made) {
  std::vector<char> is_listed(static_cast<std::size_t>(first_made), 0);
  for (const int node : listed)
    if (node < first_made) is_listed[node] = 1;
  return cut_edges(edges, first_made, [&](const EdgeTable::Edge& edge, int known) {
    return known > 0 || (is_listed[edge.ends.first] != 0 && is_listed[edge.ends.second] != 0);
  });
}

// What holds every component of every node, one list of cards after the other: those before the stages, then
// those of each stage.
class Supports {
 public:
  explicit Supports(int nodes) : held_(static_cast<std::size_t>(nodes)) {}

  // The cards of a list, later ones win; then those for the nodes that were made are added to it.
  void follow(std::vector<Fixity>& list, const std::vector<CutEdge>& edges) {
    cards_.clear();
    for (const Fixity& f : list) {
      Fixity& all = cards_.try_emplace(f.node, Fixity{f.node, {}, {}, f.line}).first->second;
      all.line = f.line;
      if (f.code[0] != FixityCode::unchanged || f.code[1] != FixityCode::unchanged) all.history = f.history;
      for (std::size_t c = 0; c < 2; ++c) {
        if (f.code[c] == FixityCode::unchanged) continue;
        all.code[c] = f.code[c];
        all.value[c] = f.value[c];
        held(f.node, c) = f.code[c] == FixityCode::fixed;
      }
    }
    if (cards_.empty()) return;
    for (const CutEdge& edge : edges) add_cards(edge, list);
  }

 private:
  bool& held(int node, std::size_t c) { return held_[node][c]; }

  const Fixity* card(int node) const {
    const auto it = cards_.find(node);
    return it == cards_.end() ? nullptr : &it->second;
  }

  // Displacement that this list adds to a held node.
  double value(int node, std::size_t c) const {
    const Fixity* f = card(node);
    return f != nullptr && f->code[c] == FixityCode::fixed ? f->value[c] : 0.0;
  }

  // Through all known nodes of the edge where all of them are held, else through the two around the made one.
  double interpolated(const CutEdge& edge, const OnEdge& made, std::size_t behind, std::size_t c) {
    const bool all = std::all_of(edge.known.begin(), edge.known.end(),
                                 [&](const OnEdge& known) { return held(known.node, c); });
    const std::size_t first = all ? 0 : behind - 1, end = all ? edge.known.size() : behind + 1;
    double sum = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      double part = value(edge.known[i].node, c);
      for (std::size_t j = first; j < end; ++j)
        if (j != i) part *= (made.at - edge.known[j].at) / (edge.known[i].at - edge.known[j].at);
      sum += part;
    }
    return sum;
  }

  bool here(int node, std::size_t c) const {
    return card(node) != nullptr && card(node)->code[c] == FixityCode::fixed;
  }

  // Both nodes around a made one are held.  Where a card gives a middle node that is enough.  Else one list
  // must hold both: the ends of a long edge may belong to two other sides.
  bool holds(const CutEdge& edge, const OnEdge& made, std::size_t behind, std::size_t c) {
    const int before = edge.known[behind - 1].node, after = edge.known[behind].node;
    if (!held(before, c) || !held(after, c)) return false;
    return edge.known.size() > 2 || held(made.node, c) || (here(before, c) && here(after, c));
  }

  // Of the cards that move nodes of the edge.
  const TimeTable& common_table(const CutEdge& edge) const {
    static const TimeTable none;
    const Fixity* first = nullptr;
    for (const OnEdge& known : edge.known) {
      const Fixity* f = card(known.node);
      if (f == nullptr || f->value == std::array<double, 2>{}) continue;
      if (first != nullptr && first->history != f->history)
        throw InputError("S591", {{}, f->line, 0, 0},
                         "a finer mesh needs the same table of time on both ends of an edge that is moved");
      if (first == nullptr) first = f;
    }
    return first == nullptr ? none : first->history;
  }

  void add_cards(const CutEdge& edge, std::vector<Fixity>& list) {
    const Fixity* first = nullptr;
    std::array<bool, 2> touched{};
    for (const OnEdge& known : edge.known) {
      const Fixity* f = card(known.node);
      if (f == nullptr) continue;
      if (first == nullptr) first = f;
      for (std::size_t c = 0; c < 2; ++c) touched[c] = touched[c] || f->code[c] != FixityCode::unchanged;
    }
    if (first == nullptr) return;
    const TimeTable& history = common_table(edge);
    for (const OnEdge& made : edge.made) {
      const std::size_t behind = edge.behind(made);
      Fixity f{made.node, {}, {}, first->line, history};
      for (std::size_t c = 0; c < 2; ++c) {
        if (!touched[c]) continue;
        const bool hold = holds(edge, made, behind, c);
        const bool was_held = held(made.node, c);
        if (!hold && !was_held) continue;
        const double value = hold ? interpolated(edge, made, behind, c) : 0.0;
        const bool stays = hold && was_held && value == 0.0;
        if (stays && !(here(edge.known[behind - 1].node, c) && here(edge.known[behind].node, c))) continue;
        f.code[c] = hold ? FixityCode::fixed : FixityCode::released;
        f.value[c] = value;
        held(made.node, c) = hold;
      }
      if (f.code[0] != FixityCode::unchanged || f.code[1] != FixityCode::unchanged) list.push_back(f);
    }
  }

  std::vector<std::array<bool, 2>> held_;  // of each node
  std::unordered_map<int, Fixity> cards_;  // of the list in hand, by node
};

void inherit_report(Report& report, const std::vector<CutEdge>& edges) {
  std::vector<int> listed = report.nodes;
  std::sort(listed.begin(), listed.end());
  const auto has = [&](const OnEdge& known) {
    return std::binary_search(listed.begin(), listed.end(), known.node);
  };
  for (const CutEdge& edge : edges)
    for (const OnEdge& made : edge.made) {
      const std::size_t behind = edge.behind(made);
      if (has(edge.known[behind - 1]) && has(edge.known[behind])) report.nodes.push_back(made.node);
    }
}

bool follows_a_line(const Report& report) {
  return report.kind == ReportKind::discharge || report.kind == ReportKind::uplift;
}

// A line that discharge or uplift is asked for may go anywhere: what was made between two of its nodes is put between them.
void fill_line(std::vector<int>& line, const EdgeTable& edges, int first_made) {
  std::map<std::pair<int, int>, std::vector<OnEdge>> between;  // known nodes next to each other, both ways
  for (const CutEdge& edge : cut_edges_between(line, edges, first_made))
    for (const OnEdge& made : edge.made) {
      const std::size_t behind = edge.behind(made);
      const int a = edge.known[behind - 1].node, z = edge.known[behind].node;
      between[{a, z}].push_back(made);
      between[{z, a}].push_back({-made.at, made.node});
    }
  std::vector<int> filled;
  for (std::size_t i = 0; i < line.size(); ++i) {
    filled.push_back(line[i]);
    if (i + 1 == line.size()) break;
    const auto found = between.find({line[i], line[i + 1]});
    if (found == between.end()) continue;
    std::ranges::sort(found->second, {}, &OnEdge::at);
    for (const OnEdge& made : found->second) filled.push_back(made.node);
  }
  line = std::move(filled);
}

// The supports of one field of one number a node, in a list of cards, follow as those of a displacement do.
void follow_field(Supports& supports, int field, std::vector<FieldFixity>& list,
                  const std::vector<CutEdge>& edges) {
  std::vector<Fixity> cards;
  for (const FieldFixity& f : list)
    if (f.field == field) cards.push_back({f.node, {f.code}, {f.value}, f.line});
  const std::size_t given = cards.size();
  supports.follow(cards, edges);
  for (std::size_t i = given; i < cards.size(); ++i) {
    const auto same = std::ranges::find_if(
        list, [&](const FieldFixity& f) { return f.field == field && f.line == cards[i].line; });
    TimeTable history = same != list.end() ? same->history : TimeTable();
    list.push_back(
        {field, cards[i].node, cards[i].code[0], cards[i].value[0], cards[i].line, std::move(history)});
  }
}

// The supports of one angle, in a list of turned ones.
void follow_turned(Supports& supports, double angle, std::vector<TurnedFixity>& list,
                   const std::vector<CutEdge>& edges) {
  std::vector<Fixity> cards;
  for (const TurnedFixity& f : list)
    if (f.angle == angle) cards.push_back(f);
  const std::size_t given = cards.size();
  supports.follow(cards, edges);
  for (std::size_t i = given; i < cards.size(); ++i) list.push_back({cards[i], angle});
}

void inherit_turned(Model& model, const std::vector<CutEdge>& edges) {
  std::set<double> angles;
  for (const TurnedFixity& f : model.turned_fixities) angles.insert(f.angle);
  for (const Stage& stage : model.stages)
    for (const TurnedFixity& f : stage.turned_fixities) angles.insert(f.angle);
  for (const double angle : angles) {
    Supports supports(model.mesh.nodes());
    follow_turned(supports, angle, model.turned_fixities, edges);
    for (Stage& stage : model.stages) follow_turned(supports, angle, stage.turned_fixities, edges);
  }
}

// A made node of an edge: its place between the two known nodes around it, and itself.
struct MadeBetween {
  int before, after, node;
  double share;
};

std::vector<MadeBetween> made_between(const std::vector<CutEdge>& edges) {
  std::vector<MadeBetween> all;
  for (const CutEdge& edge : edges)
    for (const OnEdge& made : edge.made) {
      const std::size_t behind = edge.behind(made);
      const OnEdge &a = edge.known[behind - 1], &z = edge.known[behind];
      all.push_back({a.node, z.node, made.node, (made.at - a.at) / (z.at - a.at)});
    }
  return all;
}

// Nodes that ties join in one component.
class TiedNodes {
 public:
  TiedNodes(const Model& model, std::size_t component)
      : mesh_(model.mesh), joined_(static_cast<std::size_t>(model.mesh.nodes())) {
    for (const Tie& tie : model.ties)
      if (tie.component[component]) joined_.join(tie.node, tie.to);
    for (const Tie& tie : model.ties)
      if (tie.component[component])
        for (const int node : {tie.node, tie.to}) nodes_[of(node)].insert(node);
  }

  int of(int node) { return joined_.set_of(node); }
  bool is_tied(int node) { return nodes_.contains(of(node)); }
  // More than two on a line: what is rigid.  Two nodes, and the corners of a body that repeats, may be opposite to each other.
  bool is_cap(int set) const {
    const std::vector<int> nodes(nodes_.at(set).begin(), nodes_.at(set).end());
    const Vector2 first = mesh_.x.col(nodes[0]), along = Vector2(mesh_.x.col(nodes[1])) - first;
    return nodes.size() > 2 && std::ranges::all_of(nodes, [&](int node) {
             const Vector2 from = Vector2(mesh_.x.col(node)) - first;
             return std::abs(along.x() * from.y() - along.y() * from.x()) <= 1e-6 * along.norm() * from.norm();
           });
  }

 private:
  const Mesh& mesh_;
  Joined joined_;
  std::map<int, std::set<int>> nodes_;
};

// A made node within a rigid cap is tied to it.  Others between tied nodes are tied to those at the same place between nodes
// that are tied to these, as on the opposite side of a body that repeats.
void inherit_ties(Model& model, const std::vector<CutEdge>& edges) {
  if (model.ties.empty()) return;
  const std::vector<MadeBetween> all = made_between(edges);
  std::vector<Tie> ties;
  const MadeBetween* unclear = nullptr;
  for (std::size_t c = 0; c < 2; ++c) {
    TiedNodes tied(model, c);
    std::map<std::tuple<int, int, long>, int> first;  // by the sets of both ends and the share between them
    const auto add = [&](int node, int to) {
      ties.push_back({node, to, {c == 0, c == 1}, model.ties.front().line});
    };
    for (const MadeBetween& made : all) {
      if (!tied.is_tied(made.before) || !tied.is_tied(made.after)) continue;
      const int a = tied.of(made.before), z = tied.of(made.after);
      if (a == z && tied.is_cap(a))
        add(made.node, made.before);
      else if (a == z || (tied.is_cap(a) && tied.is_cap(z)))
        unclear = &made;
      else {
        const double share = a < z ? made.share : 1.0 - made.share;
        const auto [at, is_first] =
            first.try_emplace({std::min(a, z), std::max(a, z), std::lround(1e6 * share)}, made.node);
        if (!is_first) add(made.node, at->second);
      }
    }
  }
  if (unclear != nullptr)
    model.diagnostics.warning(
        "S371", {model.file, model.ties.front().line, 0, 0},
        "the new node between nodes " + std::to_string(model.mesh.number[unclear->before]) + " and " +
            std::to_string(model.mesh.number[unclear->after]) + " is not tied, although these two are");
  model.ties.insert(model.ties.end(), ties.begin(), ties.end());
}

void inherit_field(Model& model, int field, const std::vector<CutEdge>& edges) {
  Supports supports(model.mesh.nodes());
  follow_field(supports, field, model.field_fixities, edges);
  for (Stage& stage : model.stages) follow_field(supports, field, stage.field_fixities, edges);
}

// Between two exits of one stage there are exits.  field: as of an exit.
void follow_exits(std::vector<Exit>& exits, int field, const std::vector<CutEdge>& edges) {
  std::unordered_map<int, Exit> given;
  for (const Exit& exit : exits)
    if (exit.field == field) given[exit.node] = exit;
  if (given.empty()) return;
  for (const CutEdge& edge : edges)
    for (const OnEdge& made : edge.made) {
      const std::size_t behind = edge.behind(made);
      const auto a = given.find(edge.known[behind - 1].node), z = given.find(edge.known[behind].node);
      if (a == given.end() || z == given.end()) continue;
      const double share =
          (made.at - edge.known[behind - 1].at) / (edge.known[behind].at - edge.known[behind - 1].at);
      const double pressure_head = (1.0 - share) * a->second.pressure_head + share * z->second.pressure_head;
      exits.push_back({made.node, pressure_head, a->second.line, a->second.field});
    }
}

// act(smaller end, larger end) for the edges of all elements, or of all but structures.
template <class Act>
void for_element_edges(const Model& model, bool structures, const Act& act) {
  for (const Group& group : model.groups) {
    if (group.structure() && !structures) continue;
    const auto& edges = group.element->edges();
    const int elements = group.elements();
    for (int e = 0; e < elements; ++e)
      for (const auto& edge : edges) {
        const int* nodes = group.nodes_of(e);
        const EdgeKey key = edge_key(nodes[edge[0]], nodes[edge[1]]);
        if (key.first >= 0) act(key.first, key.second);
      }
  }
}

}  // namespace

EdgeTable::EdgeTable(const Model& model, bool structures)
    : start_(static_cast<std::size_t>(model.mesh.nodes()) + 1, 0) {
  for_element_edges(model, structures, [&](int low, int) { ++start_[static_cast<std::size_t>(low) + 1]; });
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  std::vector<int> high(static_cast<std::size_t>(start_.back()));
  std::vector<int> end(start_.begin(), start_.end() - 1);
  // Two elements share most edges: of each only one entry stays.
  for_element_edges(model, structures, [&](int low, int other) {
    const auto node = static_cast<std::size_t>(low);
    const auto begin = high.begin() + start_[node], stop = high.begin() + end[node];
    if (std::find(begin, stop, other) == stop) high[end[node]++] = other;
  });
  edges_.reserve(high.size() / 2 + high.size() / 8);
  for (std::size_t node = 0; node < end.size(); ++node) {
    const auto begin = high.begin() + start_[node], stop = high.begin() + end[node];
    std::sort(begin, stop);
    start_[node] = static_cast<int>(edges_.size());
    for (auto it = begin; it != stop; ++it) edges_.push_back({{static_cast<int>(node), *it}});
  }
  start_.back() = static_cast<int>(edges_.size());
  join_beyond_interfaces(model);
}

void EdgeTable::join_beyond_interfaces(const Model& model) {
  if (std::ranges::none_of(model.groups, &Group::interface)) return;
  Joined pairs(static_cast<std::size_t>(model.mesh.nodes()));
  std::vector<char> paired(static_cast<std::size_t>(model.mesh.nodes()), 0);
  std::set<EdgeKey> lined;  // an interface lies on them
  for (const Group& group : model.groups) {
    if (!group.interface() || group.entry->corners != 4) continue;
    for (int e = 0; e < group.elements(); ++e) {
      const int* const n = group.nodes_of(e);
      for (const std::vector<int>& edge : group.element->edges())
        lined.insert(edge_key(n[edge[0]], n[edge[1]]));
      for (const auto& [one, other] : {std::pair{n[0], n[3]}, {n[1], n[2]}}) {
        if (one == other || model.mesh.x.col(one) != model.mesh.x.col(other)) continue;
        pairs.join(one, other);
        paired[one] = paired[other] = 1;
      }
    }
  }
  std::map<std::pair<int, int>, int> first;  // of the nodes of a pair, by the pair and the other end
  for (const Edge& edge : edges_) {
    const auto [low, high] = edge.ends;
    if ((paired[low] == 0 && paired[high] == 0) || lined.contains(edge.ends)) continue;
    const auto stands = [&](int tip, int far) {
      return paired[tip] != 0 ? first.try_emplace({pairs.set_of(tip), far}, tip).first->second : tip;
    };
    if (const int tip = stands(low, high); tip != low) standing_for_[edge.ends] = {tip, high};
    if (const int tip = stands(high, low); tip != high) standing_for_[edge.ends] = {low, tip};
  }
}

std::pair<int, int> EdgeTable::ends(int a, int z) const {
  if (standing_for_.empty()) return {a, z};
  const auto found = standing_for_.find(edge_key(a, z));
  if (found == standing_for_.end()) return {a, z};
  const auto [low, high] = found->second;
  return a < z ? std::pair{low, high} : std::pair{high, low};
}

EdgeTable::Edge* EdgeTable::find(int a, int z) {
  const auto [of_a, of_z] = ends(a, z);
  const auto [low, high] = edge_key(of_a, of_z);
  if (low < 0 || low + 1 >= static_cast<int>(start_.size())) return nullptr;
  const auto node = static_cast<std::size_t>(low);
  const auto begin = edges_.begin() + start_[node], end = edges_.begin() + start_[node + 1];
  const auto found =
      std::ranges::lower_bound(begin, end, high, {}, [](const Edge& edge) { return edge.ends.second; });
  return found != end && found->ends.second == high ? &*found : nullptr;
}

void EdgeTable::add(Edge& edge, const Link& link) {
  const int i = static_cast<int>(links_.size());
  links_.push_back(link);
  (edge.first < 0 ? edge.first : links_[edge.last].next) = i;
  edge.last = i;
}

void inherit_along_edges(Model& model, const EdgeTable& edges, int first_made) {
  for (Report& report : model.reports)
    if (follows_a_line(report)) fill_line(report.nodes, edges, first_made);
  const std::vector<CutEdge> cut = cut_edges_of_sides(edges, first_made);
  if (cut.empty()) return;
  Supports supports(model.mesh.nodes());
  supports.follow(model.fixities, cut);
  for (Stage& stage : model.stages) supports.follow(stage.fixities, cut);
  inherit_turned(model, cut);
  inherit_ties(model, cut);
  const int pores = model.pore_field();
  for (std::size_t field = 1; field < model.unknowns.size(); ++field)
    if (static_cast<int>(field) != pores) inherit_field(model, static_cast<int>(field), cut);
  for (Stage& stage : model.stages) follow_exits(stage.exits, -1, cut);
  if (pores > 0) {
    const std::vector<CutEdge> corners = cut_edges_of_corners(edges, first_made);
    inherit_field(model, pores, corners);
    for (Stage& stage : model.stages) follow_exits(stage.exits, pores, corners);
  }
  for (Report& report : model.reports)
    if (!follows_a_line(report)) inherit_report(report, cut);
}

int NewNodes::append() {
  const int first_made = first_;
  if (made_.empty()) return first_made;
  const Eigen::Index old = mesh_->x.cols();
  mesh_->x.conservativeResize(2, old + static_cast<Eigen::Index>(made_.size()));
  int number = *std::max_element(mesh_->number.begin(), mesh_->number.end());
  for (std::size_t i = 0; i < made_.size(); ++i) {
    mesh_->x.col(old + static_cast<Eigen::Index>(i)) = made_[i];
    mesh_->number.push_back(++number);
  }
  first_ = mesh_->nodes();
  made_.clear();
  return first_made;
}

}  // namespace sage::mesh

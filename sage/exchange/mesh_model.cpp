#include "sage/exchange/mesh_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "sage/deck/text.hpp"
#include "sage/exchange/foreign_mesh.hpp"
#include "sage/exchange/msh_interfaces.hpp"
#include "sage/math/rounding.hpp"
#include "sage/messages/near_names.hpp"
#include "sage/model/dof_map.hpp"

namespace sage {

namespace {

using Kind = MeshUse::Kind;

// The nodes of an element the other way round: its two parent coordinates change
// places, the first corner stays.
void turn_round(std::vector<int>& nodes, const ElementEntry& entry) {
  constexpr double kSame = rounding::kText;
  const auto& at = entry.parent_nodes;
  const std::vector<int> before = nodes;
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t j = 0; j < before.size(); ++j)
      if (std::abs(at[i][0] - at[j][1]) < kSame && std::abs(at[i][1] - at[j][0]) < kSame) nodes[j] = before[i];
}

double twice_area(const Mesh& mesh, const std::vector<int>& nodes, int corners) {
  double sum = 0.0;
  for (int i = 0; i < corners; ++i) {
    const auto a = mesh.x.col(nodes[i]), b = mesh.x.col(nodes[(i + 1) % corners]);
    sum += a.x() * b.y() - b.x() * a.y();
  }
  return sum;
}

// Where a name of the mesh is: lines, points and nodes.
struct NamedPlace {
  std::vector<ForeignMeshElement> lines;
  std::vector<int> nodes;  // of points and sets, besides those of the lines
  bool set = false;        // of nodes alone: its lines are the edges between them
};

// An edge of an element of a group, and how many elements have it.
struct EdgeOfMesh {
  int group = -1, element = -1, edge = -1;
  int uses = 0;
};
// Where an element of the file went.
struct ElementPlace {
  int group, element, corners;
  bool clockwise;  // in the file
};

class Skeleton {
 public:
  Skeleton(ForeignMesh mesh, const std::string& file, const Catalogue& catalogue,
           const ForeignMeshOptions& options)
      : mesh_(std::move(mesh)), catalogue_(catalogue), options_(options) {
    model_.file = file;
    model_.title = "mesh from " + file;
    model_.geometry = options.geometry;
    if (!options.geometry_given && mesh_.family == MeshFamily::axisymmetric)
      model_.geometry = Geometry::axisymmetric;
    if (options.geometry_given &&
        ((options.geometry == Geometry::plane_strain && mesh_.family == MeshFamily::axisymmetric) ||
         (options.geometry == Geometry::axisymmetric && mesh_.family == MeshFamily::plane)))
      message(Severity::warning, "S704",
              std::string("the elements of the mesh are ") +
                  (mesh_.family == MeshFamily::plane ? "plane" : "axisymmetric") +
                  "; --geometry says otherwise");
    model_.units.water_unit_weight = options.water_weight;
  }

  Model build() {
    for (const Diagnostic& one : mesh_.diagnostics.list()) model_.diagnostics.add(one);
    drop_unused_nodes();
    nodes();
    model_.stages.push_back({});
    Stage& stage = model_.stages.back();
    stage.number = 1;
    stage.title = "weight and pressures";
    stage.gravity = {0.0, -1.0};
    for (const MeshBlock& block : mesh_.blocks)
      if (block.shape.dimension == 2) surface(block);
    if (model_.groups.empty())
      throw InputError("S711", {model_.file, 0, 0, 0}, "the mesh holds no surface elements");
    find_places();
    for (const std::string& name : order_) use(name);
    for (const auto& [name, sides] : joints_) join(name, sides);
    check_uses();
    collect_unknowns(model_);
    if (turned_ > 0)
      message(Severity::note, "S704",
              std::to_string(turned_) + " element(s) listed clockwise were turned round");
    return std::move(model_);
  }

 private:
  void message(Severity severity, Code code, const std::string& text) {
    model_.diagnostics.add({severity, code, {model_.file, 0, 0, 0}, text, {}});
  }
  [[noreturn]] void refuse(const std::string& text) const {
    throw InputError("S739", {model_.file, 0, 0, 0}, text);
  }

  // Nodes of the geometry, such as the centres of arcs, belong to no element.
  void drop_unused_nodes() {
    std::vector<char> used(mesh_.nodes.size(), 0);
    for (const MeshBlock& block : mesh_.blocks)
      if (block.shape.dimension > 0)
        for (const ForeignMeshElement& element : block.elements)
          for (const int node : element.nodes) used[node] = 1;
    std::vector<int> moved(used.size(), -1), dropped;
    int next = 0;
    std::size_t at = 0;
    for (const auto& [number, x] : mesh_.nodes) {
      if (used[at] != 0)
        moved[at] = next++;
      else
        dropped.push_back(number);
      ++at;
    }
    if (dropped.empty()) return;
    for (const int number : dropped) mesh_.nodes.erase(number);
    for (MeshBlock& block : mesh_.blocks)
      for (ForeignMeshElement& element : block.elements) renumber(element.nodes, moved);
    for (auto& [name, set] : mesh_.sets) renumber(set.nodes, moved);
    const std::size_t shown = std::min<std::size_t>(dropped.size(), 8);
    message(Severity::note, "S704",
            fmt::format("{} node(s) of no element are left out: {}{}", dropped.size(),
                        fmt::join(dropped.begin(), dropped.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                        shown < dropped.size() ? ", ..." : ""));
  }
  static void renumber(std::vector<int>& nodes, const std::vector<int>& moved) {
    for (int& node : nodes) node = moved[node];
    std::erase(nodes, -1);
  }

  void nodes() {
    Mesh& mesh = model_.mesh;
    mesh.x.resize(2, static_cast<Eigen::Index>(mesh_.nodes.size()));
    for (const auto& [number, x] : mesh_.nodes) {
      mesh.x.col(mesh.nodes()) = x;
      mesh.number.push_back(number);
    }
    mesh.deck_nodes = mesh.nodes();
  }

  // Of a law with zeros where the user gives the values, or with the constants of the options.
  int material(const std::string& name, const ElementEntry& of) {
    const std::string law = of.interface()     ? "goodman"
                            : of.solid()       ? "linear_elastic"
                            : of.law_size == 1 ? "axial_elastic"
                                               : "section_elastic";
    for (std::size_t m = 0; m < model_.materials.size(); ++m)
      if (model_.materials[m].name == name && model_.materials[m].law_name == law) return static_cast<int>(m);
    Material material;
    material.number = static_cast<int>(model_.materials.size()) + 1;
    material.name = name;
    material.code = catalogue_.materials.code_of(law);
    material.entry = catalogue_.materials.share(material.code);
    material.law_name = law;
    material.parameters.assign(of.interface() ? 3 : of.law_size == 1 ? 1 : 2, 0.0);
    if (of.solid()) {
      material.parameters = {options_.youngs_modulus, options_.poissons_ratio};
      material.unit_weight = options_.unit_weight;
    }
    model_.materials.push_back(std::move(material));
    return static_cast<int>(model_.materials.size()) - 1;
  }

  Group& group(const std::string& name, int element) {
    for (Group& group : model_.groups)
      if (group.name == name && group.element_code == element) return group;
    Group group;
    group.number = static_cast<int>(model_.groups.size()) + 1;
    group.name = name;
    group.material = material(name, *catalogue_.elements.find(element));
    set_element(group, catalogue_, element, 0, model_.geometry);
    model_.groups.push_back(std::move(group));
    return model_.groups.back();
  }

  void surface(const MeshBlock& block) {
    const std::string name = block.names.empty() ? block.otherwise : block.names.front();
    Group& target = group(name, block.shape.code);
    const int g = static_cast<int>(&target - model_.groups.data());
    for (const ForeignMeshElement& element : block.elements) {
      std::vector<int> nodes = element.nodes;
      const double area = twice_area(model_.mesh, nodes, block.shape.element->corners);
      if (area == 0.0)
        throw InputError("S710", {model_.file, element.line, 0, 0},
                         "element " + std::to_string(element.number) + " has no area");
      const bool clockwise = area < 0.0;
      if (clockwise) {
        turn_round(nodes, *block.shape.element);
        ++turned_;
      }
      const int e = target.elements();
      place_of_[element.number] = {g, e, block.shape.element->corners, clockwise};
      target.element_numbers.push_back(element.number);
      target.element_lines.push_back(0);
      target.nodes.insert(target.nodes.end(), nodes.begin(), nodes.end());
      largest_ = std::max(largest_, element.number);
      const auto& edges = target.element->edges();
      for (std::size_t i = 0; i < edges.size(); ++i) {
        EdgeOfMesh& edge = edge_of_[std::minmax(nodes[edges[i][0]], nodes[edges[i][1]])];
        edge = {g, e, static_cast<int>(i), edge.uses + 1};
      }
    }
  }

  std::vector<int> nodes_of(const EdgeOfMesh& edge) const {
    const Group& group = model_.groups[edge.group];
    std::vector<int> nodes;
    for (const int local : group.element->edges()[edge.edge])
      nodes.push_back(group.nodes_of(edge.element)[local]);
    return nodes;
  }

  // Names in the order of the file: of curves and points, then of sets.
  void find_places() {
    for (const MeshBlock& block : mesh_.blocks) {
      for (const ForeignMeshElement& element : block.elements) largest_ = std::max(largest_, element.number);
      if (block.shape.dimension == 2) continue;
      for (const std::string& name : block.names) {
        NamedPlace& place = place_named(name);
        if (block.shape.dimension == 1)
          place.lines.insert(place.lines.end(), block.elements.begin(), block.elements.end());
        else
          for (const ForeignMeshElement& point : block.elements)
            place.nodes.insert(place.nodes.end(), point.nodes.begin(), point.nodes.end());
      }
    }
    for (const auto& [name, set] : mesh_.sets) {
      const bool is_new = !places_.contains(name);
      NamedPlace& place = place_named(name);
      place.nodes.insert(place.nodes.end(), set.nodes.begin(), set.nodes.end());
      place.set = is_new && set.edges.empty();
      for (const auto& [number, side] : set.edges) place.lines.push_back({number, edge_nodes(number, side), 0});
    }
  }
  NamedPlace& place_named(const std::string& name) {
    if (!places_.contains(name)) order_.push_back(name);
    return places_[name];
  }

  // Of an element's side as the file counts it.  Turned round, the first corner has stayed and sides count backwards.
  std::vector<int> edge_nodes(int number, int side) const {
    const ElementPlace& at = place_of_.at(number);
    return nodes_of({at.group, at.element, at.clockwise ? at.corners - 1 - side : side, 1});
  }

  // Edges between nodes of a set: all of them, or those of the outline.
  std::vector<ForeignMeshElement> lines_of(const NamedPlace& place, bool outline) const {
    if (!place.set) return place.lines;
    const std::set<int> nodes(place.nodes.begin(), place.nodes.end());
    std::vector<ForeignMeshElement> lines;
    for (const auto& [ends, edge] : edge_of_) {
      if (!nodes.contains(ends.first) || !nodes.contains(ends.second) || (outline && edge.uses > 1)) continue;
      lines.push_back({0, nodes_of(edge), 0});
    }
    return lines;
  }

  static std::vector<int> all_nodes(const NamedPlace& place) {
    std::vector<int> nodes;
    for (const ForeignMeshElement& line : place.lines)
      nodes.insert(nodes.end(), line.nodes.begin(), line.nodes.end());
    nodes.insert(nodes.end(), place.nodes.begin(), place.nodes.end());
    return nodes;
  }

  // What the options say of the name; else what the name itself says.
  void use(const std::string& name) {
    const NamedPlace& place = places_.at(name);
    for (const bool top : {false, true}) {
      const std::string_view mark = top ? msh::kInterfaceTop : msh::kInterfaceBottom;
      if (!name.starts_with(mark)) continue;
      Joint& joint = joints_[name.substr(mark.size())];
      std::vector<ForeignMeshElement>& side = top ? joint.top : joint.bottom;
      side.insert(side.end(), place.lines.begin(), place.lines.end());
      used_.insert(name);
      return;
    }
    bool used = false;
    for (const MeshUse& one : options_.uses) {
      if (place_for(one.name) != name) continue;
      apply(one, name, place);
      used = true;
    }
    const MeshUse own = used ? MeshUse() : use_of_name(name);
    if (own.kind != Kind::none) apply(own, name, place);
    if (used || own.kind != Kind::none) used_.insert(name);
  }

  // The name in the mesh that an option means: the same in upper and lower case too, else the only one that differs in
  // nothing else (Abaqus ignores case).
  std::string place_for(const std::string& wanted) const {
    if (places_.contains(wanted)) return wanted;
    std::vector<std::string> found;
    for (const std::string& name : order_)
      if (lower_case(name) == lower_case(wanted)) found.push_back(name);
    if (found.size() > 1)
      refuse(
          fmt::format("'{}' may mean '{}': the mesh has these names, and the option needs one of them with its "
                      "upper and lower case",
                      wanted, fmt::join(found, "' or '")));
    return found.empty() ? std::string() : found.front();
  }

  static MeshUse use_of_name(const std::string& name) {
    if (name == "fix_x" || name == "fix_y" || name == "fix_xy")
      return mesh_use("fix", name + "=" + name.substr(4));
    if (name == "water") return mesh_use("water", name);
    for (const std::string kind : {"pressure", "force"})
      if (name.size() > kind.size() + 1 && name.starts_with(kind) &&
          (name[kind.size()] == '=' || name[kind.size()] == ':'))
        try {
          return mesh_use(kind, name + "=" + name.substr(kind.size() + 1));
        } catch (const std::invalid_argument&) {
        }
    for (const std::string kind : {"beam", "bar"})
      if (name.starts_with(kind + "=")) return mesh_use(kind, name.substr(kind.size() + 1));
    return {};
  }

  void check_uses() {
    for (const MeshUse& one : options_.uses)
      if (place_for(one.name).empty())
        refuse("the mesh has no curve, point or set named '" + one.name + "'" + did_you_mean(one.name, order_) +
               (order_.empty() ? "; it has no names" : fmt::format("; there are {}", fmt::join(order_, ", "))));
    std::set<std::string> unused;
    for (const MeshBlock& block : mesh_.blocks)
      if (block.shape.dimension == 1 &&
          std::ranges::none_of(block.names, [&](const std::string& name) { return used_.contains(name); }))
        unused.insert(block.names.begin(), block.names.end());
    if (!unused.empty())
      message(Severity::warning, "S713",
              fmt::format("curve(s) '{}'", fmt::join(unused, "', '")) +
                  " are left out; use them by --fix, --pressure, --beam, --bar or --water, or name them fix_x, "
                  "fix_y, "
                  "fix_xy, pressure=VALUE, beam=NAME, bar=NAME, water, interface_bottom=NAME and "
                  "interface_top=NAME");
  }

  void apply(const MeshUse& one, const std::string& name, const NamedPlace& place) {
    switch (one.kind) {
      case Kind::none:
        return;
      case Kind::fix:
        return hold(one, name, place);
      case Kind::pressure:
        return load(name, lines_of(place, true), one.value.x());
      case Kind::force:
        return push(name, place, one.value);
      case Kind::beam:
      case Kind::bar:
        return structure(one, name, lines_of(place, false));
      case Kind::water:
        return water(name, place);
    }
  }

  void hold(const MeshUse& one, const std::string& name, const NamedPlace& place) {
    const std::vector<int> nodes = all_nodes(place);
    if (nodes.empty()) refuse("'" + name + "' has no nodes of the mesh to hold");
    for (const int node : nodes) {
      if (!held_.insert({node, one.x, one.y}).second) continue;
      Fixity fixity;
      fixity.node = node;
      if (one.x) fixity.code[0] = FixityCode::fixed;
      if (one.y) fixity.code[1] = FixityCode::fixed;
      model_.fixities.push_back(fixity);
    }
  }

  void push(const std::string& name, const NamedPlace& place, const Vector2& force) {
    std::vector<int> nodes = all_nodes(place);
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.size() != 1)
      refuse("'" + name + "' has " + std::to_string(nodes.size()) +
             " nodes; a force needs one node, and a line a pressure");
    NodalLoad load;
    load.node = nodes.front();
    load.force = force;
    model_.stages.front().loads.push_back(load);
  }

  // Lines in a row, each from the end of the one before: from the highest free end, else from the highest node.
  std::vector<std::vector<int>> in_a_row(const std::vector<ForeignMeshElement>& lines) const {
    std::multimap<int, std::size_t> at;  // by end node
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (const int end : {lines[i].nodes[0], lines[i].nodes[1]}) at.emplace(end, i);
    std::vector<char> done(lines.size(), 0);
    std::vector<std::vector<int>> row;
    const auto higher = [&](int a, int b) {
      const Vector2 p = model_.mesh.x.col(a), q = model_.mesh.x.col(b);
      return p.y() != q.y() ? p.y() > q.y() : p.x() < q.x();
    };
    const auto left_at = [&](int node) {
      std::vector<std::size_t> left;
      const auto [begin, end] = at.equal_range(node);
      for (auto it = begin; it != end; ++it)
        if (done[it->second] == 0) left.push_back(it->second);
      return left;
    };
    while (row.size() < lines.size()) {
      int first = -1;
      bool free = false;
      for (const auto& [node, line] : at) {
        if (done[line] != 0) continue;
        const bool is_end = left_at(node).size() == 1;
        if (first < 0 || (is_end && !free) || (is_end == free && higher(node, first)))
          first = node, free = is_end;
      }
      for (std::vector<std::size_t> next = left_at(first); !next.empty(); next = left_at(first)) {
        std::vector<int> nodes = lines[next.front()].nodes;
        if (nodes[0] != first) {
          std::swap(nodes[0], nodes[1]);
          std::reverse(nodes.begin() + 2, nodes.end());
        }
        done[next.front()] = 1;
        first = nodes[1];
        row.push_back(std::move(nodes));
      }
    }
    return row;
  }

  void structure(const MeshUse& one, const std::string& name, const std::vector<ForeignMeshElement>& lines) {
    if (lines.empty()) refuse("'" + name + "' has no lines for a structure");
    for (const std::vector<int>& nodes : in_a_row(lines)) {
      const int code =
          catalogue_.elements.code_of((one.kind == Kind::beam ? "beam" : "bar") + std::to_string(nodes.size()));
      if (code == 0)
        refuse("'" + name + "' has lines of " + std::to_string(nodes.size()) +
               " nodes; structures have 2 or 3");
      Group& target = group(one.name, code);
      target.element_numbers.push_back(++largest_);
      target.element_lines.push_back(0);
      target.nodes.insert(target.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  void water(const std::string& name, const NamedPlace& place) {
    WaterCard card;
    card.kind = WaterKind::line;
    std::map<double, double> line;
    for (const int node : all_nodes(place)) {
      const Vector2 x = model_.mesh.x.col(node);
      const auto [at, is_new] = line.try_emplace(x.x(), x.y());
      if (!is_new && at->second != x.y())
        refuse("'" + name + "' has two heights at x = " + number_text(x.x()) +
               "; a water line has one for each x");
    }
    for (const auto& [x, y] : line) card.line.emplace_back(x, y);
    if (card.line.size() < 2)
      refuse("'" + name + "' has " + std::to_string(line.size()) + " node(s); a water line has two or more");
    model_.water.push_back(std::move(card));
  }

  // Lines of both sides of a group of interfaces.
  struct Joint {
    std::vector<ForeignMeshElement> bottom, top;
  };

  bool at_one_place(int a, int b, double length) const {
    constexpr double kSame = 1e-6;  // of the line's length
    return (model_.mesh.x.col(a) - model_.mesh.x.col(b)).norm() <= kSame * length;
  }
  // The nodes of a top line in the order of the bottom's; nothing where it lies elsewhere.
  std::vector<int> on(const ForeignMeshElement& bottom, const ForeignMeshElement& top) const {
    const auto &b = bottom.nodes, &t = top.nodes;
    if (b.size() != t.size()) return {};
    const double length = (model_.mesh.x.col(b[0]) - model_.mesh.x.col(b[1])).norm();
    if (at_one_place(b[0], t[0], length) && at_one_place(b[1], t[1], length)) return t;
    if (!at_one_place(b[0], t[1], length) || !at_one_place(b[1], t[0], length)) return {};
    std::vector<int> turned = t;
    std::swap(turned[0], turned[1]);
    std::reverse(turned.begin() + 2, turned.end());
    return turned;
  }
  // As files of this program have them the lines of both sides come in one order; those of a mesher need not.
  std::vector<int> top_of(const std::string& name, const Joint& joint, std::size_t line) const {
    const ForeignMeshElement& bottom = joint.bottom[line];
    std::vector<int> found;
    if (line < joint.top.size()) found = on(bottom, joint.top[line]);
    for (std::size_t i = 0; found.empty() && i < joint.top.size(); ++i) found = on(bottom, joint.top[i]);
    if (found.empty())
      throw InputError("S714", {model_.file, 0, 0, 0},
                       "line " + std::to_string(bottom.number) + " of interface_bottom=" + name +
                           " has no line with as many nodes at the same place in interface_top=" + name);
    return found;
  }

  void join(const std::string& name, const Joint& joint) {
    if (joint.bottom.size() != joint.top.size())
      throw InputError("S714", {model_.file, 0, 0, 0},
                       "interface_bottom=" + name + " has " + std::to_string(joint.bottom.size()) +
                           " line(s), interface_top=" + name + " " + std::to_string(joint.top.size()));
    for (std::size_t i = 0; i < joint.bottom.size(); ++i) {
      const std::vector<int>& bottom = joint.bottom[i].nodes;
      const std::vector<int> top = top_of(name, joint, i);
      int code = 0;
      const ElementEntry* entry = msh::interface_of(catalogue_.elements, bottom.size(), code);
      if (entry == nullptr)
        throw InputError(
            "S714", {model_.file, 0, 0, 0},
            "no interface has " + std::to_string(bottom.size()) + " nodes on a side, as " + name + " has");
      const msh::InterfaceSides sides = msh::interface_sides(*entry);
      std::vector<int> nodes(static_cast<std::size_t>(entry->nodes));
      for (std::size_t n = 0; n < bottom.size(); ++n) {
        nodes[sides.bottom[n]] = bottom[n];
        nodes[sides.top[n]] = top[n];
      }
      Group& target = group(name, code);
      target.element_numbers.push_back(joint.bottom[i].number);
      target.element_lines.push_back(0);
      target.nodes.insert(target.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  void load(const std::string& name, const std::vector<ForeignMeshElement>& lines, double value) {
    int outside = 0;
    for (const ForeignMeshElement& line : lines) {
      const auto it = edge_of_.find(std::minmax(line.nodes[0], line.nodes[1]));
      if (it == edge_of_.end()) {
        ++outside;
        continue;
      }
      EdgeLoad load;
      load.group = it->second.group;
      load.element = it->second.element;
      load.edge = it->second.edge;
      load.normal = {value, value};
      model_.stages.front().pressures.push_back(load);
    }
    if (lines.empty()) refuse("'" + name + "' has no lines to press on");
    if (outside > 0)
      message(
          Severity::warning, "S713",
          std::to_string(outside) + " line(s) of '" + name + "' lie on no element: their pressure is left out");
  }

  ForeignMesh mesh_;
  const Catalogue& catalogue_;
  const ForeignMeshOptions& options_;
  Model model_;
  std::map<std::pair<int, int>, EdgeOfMesh> edge_of_;
  std::map<int, ElementPlace> place_of_;  // by element number
  std::map<std::string, NamedPlace> places_;
  std::vector<std::string> order_;  // of their names
  std::set<std::tuple<int, bool, bool>> held_;
  std::set<std::string> used_;
  std::map<std::string, Joint> joints_;
  int turned_ = 0, largest_ = 0;
};

// Written so that NaN is refused too.  Zero stands for what is not known yet.
void check_constants(const ForeignMeshOptions& options, const std::string& file) {
  constexpr double kTooLarge = 1e100;  // as in decks
  const auto refuse = [&](const std::string& message) { throw InputError("S712", {file, 0, 0, 0}, message); };
  if (!(options.youngs_modulus >= 0.0 && options.youngs_modulus < kTooLarge))
    refuse("Young's modulus must be positive and below 1e100; it is " + number_text(options.youngs_modulus));
  if (!(options.poissons_ratio > -1.0 && options.poissons_ratio < 0.5))
    refuse("Poisson's ratio must lie between -1 and 0.5; it is " + number_text(options.poissons_ratio));
  if (!(std::abs(options.unit_weight) < kTooLarge))
    refuse("the unit weight must be below 1e100; it is " + number_text(options.unit_weight));
}

}  // namespace

MeshUse mesh_use(std::string_view kind, std::string_view text) {
  const std::size_t equals = text.rfind('=');
  const bool named = kind == "beam" || kind == "bar" || kind == "water";
  MeshUse use;
  use.name = std::string(named ? text : text.substr(0, equals));
  const std::string value(named || equals == std::string_view::npos ? std::string_view()
                                                                    : text.substr(equals + 1));
  const auto wrong = [&](const std::string& wanted) {
    throw std::invalid_argument("'" + std::string(text) + "': " + wanted + " was expected");
  };
  if (use.name.empty()) wrong("the name of a curve, point or set of the mesh");
  use.kind = kind == "fix"        ? Kind::fix
             : kind == "pressure" ? Kind::pressure
             : kind == "force"    ? Kind::force
             : kind == "beam"     ? Kind::beam
             : kind == "bar"      ? Kind::bar
                                  : Kind::water;
  const std::size_t comma = value.find(',');
  if (use.kind == Kind::fix) {
    use.x = value == "x" || value == "xy";
    use.y = value == "y" || value == "xy";
    if (!use.x && !use.y) wrong("NAME=x, NAME=y or NAME=xy");
  } else if (use.kind == Kind::pressure) {
    if (!read_number(value, use.value.x())) wrong("NAME=VALUE");
  } else if (use.kind == Kind::force) {
    if (comma == std::string::npos || !read_number(std::string_view(value).substr(0, comma), use.value.x()) ||
        !read_number(std::string_view(value).substr(comma + 1), use.value.y()))
      wrong("NAME=FX,FY");
  }
  return use;
}

Model model_from_mesh(std::string_view text, const std::string& file, const Catalogue& catalogue,
                      const ForeignMeshOptions& options) {
  check_constants(options, file);
  return Skeleton(read_mesh(text, file, catalogue.elements), file, catalogue, options).build();
}

}  // namespace sage

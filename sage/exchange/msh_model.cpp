#include "sage/exchange/msh_model.hpp"
#include "sage/model/dof_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "sage/deck/text.hpp"
#include "sage/exchange/msh_file.hpp"
#include "sage/exchange/msh_interfaces.hpp"

namespace sage {

namespace {

using msh::MshBlock;
using msh::MshElement;
using msh::MshFile;

// The nodes of an element the other way round: its two parent coordinates change
// places, the first corner stays.
void turn_round(std::vector<int>& nodes, const ElementEntry& entry) {
  constexpr double kSame = 1e-9;
  const auto& at = entry.parent_nodes;
  const std::vector<int> before = nodes;
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t j = 0; j < before.size(); ++j)
      if (std::abs(at[i][0] - at[j][1]) < kSame && std::abs(at[i][1] - at[j][0]) < kSame) nodes[j] = before[i];
}

double twice_area(const Mesh& mesh, const std::vector<int>& nodes, int corners) {
  double sum = 0.0;
  for (int i = 0; i < corners; ++i) {
    const auto a = mesh.x.col(nodes[static_cast<std::size_t>(i)]),
               b = mesh.x.col(nodes[static_cast<std::size_t>((i + 1) % corners)]);
    sum += a.x() * b.y() - b.x() * a.y();
  }
  return sum;
}

class Skeleton {
 public:
  Skeleton(const MshFile& msh, const std::string& file, const Catalogue& catalogue, const MshOptions& options)
      : msh_(msh), catalogue_(catalogue), options_(options) {
    model_.file = file;
    model_.title = "mesh from " + file;
    model_.geometry = options.geometry;
  }

  Model build() {
    nodes();
    model_.stages.push_back({});
    Stage& stage = model_.stages.back();
    stage.number = 1;
    stage.title = "weight and pressures";
    stage.gravity = {0.0, -1.0};
    for (const MshBlock& block : msh_.blocks)
      if (block.shape.dimension == 2) surface(block);
    if (model_.groups.empty())
      throw InputError("S711", {model_.file, 0, 0, 0}, "the mesh holds no surface elements");
    for (const MshBlock& block : msh_.blocks)
      if (block.shape.dimension == 1)
        for (const std::string& name : names_of(block)) curve(block, name);
    for (const auto& [name, sides] : joints_) join(name, sides);
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
  // Of the physical groups that it belongs to.
  std::vector<std::string> names_of(const MshBlock& block) const {
    std::vector<std::string> names;
    const auto physical = msh_.physical.find(block.entity);
    if (physical == msh_.physical.end()) return names;
    for (const int tag : physical->second) {
      const auto name = msh_.names.find({block.entity.first, tag});
      names.push_back(name == msh_.names.end() ? "physical " + std::to_string(tag) : name->second);
    }
    return names;
  }

  void nodes() {
    Mesh& mesh = model_.mesh;
    mesh.x.resize(2, static_cast<Eigen::Index>(msh_.nodes.size()));
    for (const auto& [tag, x] : msh_.nodes) {
      mesh.x.col(mesh.nodes()) = x;
      mesh.number.push_back(tag);
    }
    mesh.deck_nodes = mesh.nodes();
  }

  int material(const std::string& name, bool of_interface) {
    const std::string law = of_interface ? "goodman" : "linear_elastic";
    for (std::size_t m = 0; m < model_.materials.size(); ++m)
      if (model_.materials[m].name == name && model_.materials[m].law_name == law) return static_cast<int>(m);
    Material material;
    material.number = static_cast<int>(model_.materials.size()) + 1;
    material.name = name;
    material.code = catalogue_.materials.code_of(law);
    material.entry = catalogue_.materials.share(material.code);
    material.law_name = law;
    material.parameters = {0.0, 0.0, 0.0};
    if (!of_interface) {
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
    group.material = material(name, catalogue_.elements.find(element)->interface());
    set_element(group, catalogue_, element, 0, model_.geometry);
    model_.groups.push_back(std::move(group));
    return model_.groups.back();
  }

  void surface(const MshBlock& block) {
    const std::vector<std::string> names = names_of(block);
    const std::string name = names.empty() ? "surface " + std::to_string(block.entity.second) : names.front();
    Group& target = group(name, block.shape.code);
    const int g = static_cast<int>(&target - model_.groups.data());
    for (const MshElement& element : block.elements) {
      std::vector<int> nodes = element.nodes;
      if (twice_area(model_.mesh, nodes, block.shape.element->corners) < 0.0) {
        turn_round(nodes, *block.shape.element);
        ++turned_;
      }
      const int e = target.elements();
      target.element_numbers.push_back(element.number);
      target.element_lines.push_back(0);
      target.nodes.insert(target.nodes.end(), nodes.begin(), nodes.end());
      const auto& edges = target.element->edges();
      for (std::size_t i = 0; i < edges.size(); ++i)
        edge_of_[std::minmax(nodes[static_cast<std::size_t>(edges[i][0])],
                             nodes[static_cast<std::size_t>(edges[i][1])])] = {g, e, static_cast<int>(i)};
    }
  }

  void curve(const MshBlock& block, const std::string& name) {
    for (const bool top : {false, true}) {
      const std::string_view mark = top ? msh::kInterfaceTop : msh::kInterfaceBottom;
      if (!name.starts_with(mark)) continue;
      Joint& joint = joints_[name.substr(mark.size())];
      std::vector<MshElement>& side = top ? joint.top : joint.bottom;
      side.insert(side.end(), block.elements.begin(), block.elements.end());
      return;
    }
    if (name == "fix_x" || name == "fix_y" || name == "fix_xy") return hold(block, name);
    const bool pressure = name.starts_with("pressure") && name.size() > 9;
    char* end = nullptr;
    const double value = pressure ? std::strtod(name.c_str() + 9, &end) : 0.0;
    if (pressure && *end == '\0') return load(block, value);
    if (!name.empty() && warned_.insert(name).second)
      message(Severity::warning, "S713",
              "curve '" + name +
                  "' is left out; known are fix_x, fix_y, fix_xy, pressure=VALUE, "
                  "interface_bottom=NAME and interface_top=NAME");
  }

  void hold(const MshBlock& block, const std::string& name) {
    for (const MshElement& line : block.elements)
      for (int node : line.nodes) {
        if (!held_.insert({name, node}).second) continue;
        Fixity fixity;
        fixity.node = node;
        if (name != "fix_y") fixity.code[0] = FixityCode::fixed;
        if (name != "fix_x") fixity.code[1] = FixityCode::fixed;
        model_.fixities.push_back(fixity);
      }
  }

  // Lines of both sides of a group of interfaces.
  struct Joint {
    std::vector<MshElement> bottom, top;
  };

  bool at_one_place(int a, int b, double length) const {
    constexpr double kSame = 1e-6;  // of the line's length
    return (model_.mesh.x.col(a) - model_.mesh.x.col(b)).norm() <= kSame * length;
  }
  // The nodes of a top line in the order of the bottom's; nothing where it lies elsewhere.
  std::vector<int> on(const MshElement& bottom, const MshElement& top) const {
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
    const MshElement& bottom = joint.bottom[line];
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
        nodes[static_cast<std::size_t>(sides.bottom[n])] = bottom[n];
        nodes[static_cast<std::size_t>(sides.top[n])] = top[n];
      }
      Group& target = group(name, code);
      target.element_numbers.push_back(joint.bottom[i].number);
      target.element_lines.push_back(0);
      target.nodes.insert(target.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  void load(const MshBlock& block, double value) {
    for (const MshElement& line : block.elements) {
      const auto it = edge_of_.find(std::minmax(line.nodes[0], line.nodes[1]));
      if (it == edge_of_.end()) {
        message(Severity::warning, "S713",
                "line " + std::to_string(line.number) + " lies on no element: its pressure is left out");
        continue;
      }
      EdgeLoad load = it->second;
      load.normal = {value, value};
      model_.stages.front().pressures.push_back(load);
    }
  }

  struct Edge {
    int group, element, edge;
    operator EdgeLoad() const {
      EdgeLoad load;
      load.group = group;
      load.element = element;
      load.edge = edge;
      return load;
    }
  };
  const MshFile& msh_;
  const Catalogue& catalogue_;
  const MshOptions& options_;
  Model model_;
  std::map<std::pair<int, int>, Edge> edge_of_;
  std::set<std::pair<std::string, int>> held_;
  std::set<std::string> warned_;
  std::map<std::string, Joint> joints_;
  int turned_ = 0;
};

// Written so that NaN is refused too.  Zero stands for what is not known yet.
void check_constants(const MshOptions& options, const std::string& file) {
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

Model model_from_msh(std::string_view text, const std::string& file, const Catalogue& catalogue,
                     const MshOptions& options) {
  check_constants(options, file);
  const MshFile mesh = msh::read_msh(text, file, catalogue.elements);
  return Skeleton(mesh, file, catalogue, options).build();
}

}  // namespace sage

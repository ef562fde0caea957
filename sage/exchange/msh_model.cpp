#include "sage/exchange/msh_model.hpp"
#include "sage/model/dof_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "sage/deck/text.hpp"
#include "sage/exchange/msh_file.hpp"

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
    collect_unknowns(model_);
    if (model_.groups.empty())
      throw InputError("S711", {model_.file, 0, 0, 0}, "the mesh holds no surface elements");
    for (const MshBlock& block : msh_.blocks)
      if (block.shape.dimension == 1) curve(block);
    if (turned_ > 0)
      message(Severity::note, "S704",
              std::to_string(turned_) + " element(s) listed clockwise were turned round");
    return std::move(model_);
  }

 private:
  void message(Severity severity, Code code, const std::string& text) {
    model_.diagnostics.add({severity, code, {model_.file, 0, 0, 0}, text, {}});
  }
  std::string name_of(const MshBlock& block) const {
    const auto physical = msh_.physical.find(block.entity);
    if (physical == msh_.physical.end()) return {};
    const auto name = msh_.names.find({block.entity.first, physical->second});
    return name == msh_.names.end() ? "physical " + std::to_string(physical->second) : name->second;
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

  int material(const std::string& name) {
    for (std::size_t m = 0; m < model_.materials.size(); ++m)
      if (model_.materials[m].name == name) return static_cast<int>(m);
    Material material;
    material.number = static_cast<int>(model_.materials.size()) + 1;
    material.name = name;
    material.code = catalogue_.materials.code_of("linear_elastic");
    material.entry = catalogue_.materials.share(material.code);
    material.law_name = "linear_elastic";
    material.parameters = {options_.youngs_modulus, options_.poissons_ratio};
    material.unit_weight = options_.unit_weight;
    model_.materials.push_back(std::move(material));
    return static_cast<int>(model_.materials.size()) - 1;
  }

  Group& group(const std::string& name, int element) {
    for (Group& group : model_.groups)
      if (group.name == name && group.element_code == element) return group;
    Group group;
    group.number = static_cast<int>(model_.groups.size()) + 1;
    group.name = name;
    group.material = material(name);
    set_element(group, catalogue_, element, 0, model_.geometry);
    model_.groups.push_back(std::move(group));
    return model_.groups.back();
  }

  void surface(const MshBlock& block) {
    std::string name = name_of(block);
    if (name.empty()) name = "surface " + std::to_string(block.entity.second);
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

  void curve(const MshBlock& block) {
    const std::string name = name_of(block);
    if (name == "fix_x" || name == "fix_y" || name == "fix_xy") return hold(block, name);
    const bool pressure = name.starts_with("pressure") && name.size() > 9;
    char* end = nullptr;
    const double value = pressure ? std::strtod(name.c_str() + 9, &end) : 0.0;
    if (pressure && *end == '\0') return load(block, value);
    if (!name.empty() && warned_.insert(name).second)
      message(Severity::warning, "S713",
              "curve '" + name + "' is left out; known are fix_x, fix_y, fix_xy, pressure=VALUE");
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

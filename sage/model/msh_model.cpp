#include "sage/model/msh_model.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <map>
#include <set>

namespace sage {

namespace {

struct Shape {
  const char* element;  // nullptr = a line or point
  int dimension, nodes, corners;
};

// Gmsh's element types that a 2-D mesh of this program can hold.
const Shape* shape_of(int type) {
  static const std::map<int, Shape> kShapes{
      {15, {nullptr, 0, 1, 1}}, {1, {nullptr, 1, 2, 2}}, {8, {nullptr, 1, 3, 2}},   {27, {nullptr, 1, 5, 2}},
      {2, {"tri3", 2, 3, 3}},   {9, {"tri6", 2, 6, 3}},  {23, {"tri15", 2, 15, 3}}, {3, {"quad4", 2, 4, 4}},
      {16, {"quad8", 2, 8, 4}}, {10, {"quad9", 2, 9, 4}}};
  const auto it = kShapes.find(type);
  return it == kShapes.end() ? nullptr : &it->second;
}

// Words and numbers of the file with their line.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::string_view word() {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) > ' ') ++at_;
    return text_.substr(begin, at_ - begin);
  }
  bool end() {
    skip();
    return at_ >= text_.size();
  }
  template <class Number>
  Number number() {
    const std::string_view w = word();
    Number value{};
    const auto [last, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || last != w.data() + w.size())
      fail("a number was expected, not '" + std::string(w.substr(0, 20)) + "'");
    return value;
  }
  int integer() { return number<int>(); }
  double real() { return number<double>(); }
  // How many entries follow; refuses counts that the rest of the file can't hold.
  int count() {
    const int n = integer();
    if (n < 0 || static_cast<std::size_t>(n) > text_.size())
      fail("a count of " + std::to_string(n) + " can't be");
    return n;
  }
  std::string quoted() {
    skip();
    if (at_ >= text_.size() || text_[at_] != '"') fail("a name in quotes was expected");
    const std::size_t last = text_.find('"', at_ + 1);
    if (last == std::string_view::npos) fail("the quote of a name is not closed");
    std::string name(text_.substr(at_ + 1, last - at_ - 1));
    at_ = last + 1;
    return name;
  }
  void expect(std::string_view wanted) {
    const std::string_view found = word();
    if (found != wanted)
      fail(std::string(wanted) + " was expected, not '" + std::string(found.substr(0, 20)) + "'");
  }
  void pass_section(std::string_view name) {
    const std::string mark = "$End" + std::string(name.substr(1));
    const std::size_t found = text_.find(mark, at_);
    if (found == std::string_view::npos) fail(mark + " is missing");
    while (at_ < found) line_ += text_[at_++] == '\n' ? 1 : 0;
    at_ += mark.size();
  }
  [[noreturn]] void fail(const std::string& message) const { throw InputError({file_, line_, 0, 0}, message); }

 private:
  void skip() {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ')
      line_ += text_[at_++] == '\n' ? 1 : 0;
  }
  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

using EntityKey = std::pair<int, int>;  // dimension, tag

struct MshElement {
  int number = 0;
  std::vector<int> nodes;  // indices
};

struct MshBlock {
  EntityKey entity;
  const Shape* shape = nullptr;
  std::vector<MshElement> elements;
};

struct MshFile {
  std::map<EntityKey, std::string> names;  // of physical groups
  std::map<EntityKey, int> physical;       // entity -> physical tag
  std::map<int, Vector2> nodes;            // by tag
  std::map<int, int> index;                // tag -> index
  std::vector<MshBlock> blocks;
};

void read_names(Scanner& in, MshFile& msh) {
  for (int i = in.count(); i > 0; --i) {
    const int dimension = in.integer(), tag = in.integer();
    msh.names[{dimension, tag}] = in.quoted();
  }
}

void read_entities(Scanner& in, MshFile& msh) {
  int counts[4];
  for (int& count : counts) count = in.count();
  for (int dimension = 0; dimension < 4; ++dimension)
    for (int i = 0; i < counts[dimension]; ++i) {
      const int tag = in.integer();
      for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c) in.real();
      for (int p = in.count(), first = 1; p > 0; --p, first = 0) {
        const int physical = in.integer();
        if (first) msh.physical[{dimension, tag}] = physical;
      }
      if (dimension > 0)
        for (int b = in.count(); b > 0; --b) in.integer();
    }
}

void read_nodes(Scanner& in, MshFile& msh) {
  const int blocks = in.count();
  for (int i = 0; i < 3; ++i) in.integer();
  for (int b = 0; b < blocks; ++b) {
    const int dimension = in.integer();
    in.integer();
    const int parametric = in.integer();
    std::vector<int> tags(static_cast<std::size_t>(in.count()));
    for (int& tag : tags) tag = in.integer();
    for (int tag : tags) {
      const double x = in.real(), y = in.real();
      in.real();
      for (int p = 0; p < (parametric ? dimension : 0); ++p) in.real();
      if (!msh.nodes.try_emplace(tag, Vector2(x, y)).second)
        in.fail("node " + std::to_string(tag) + " stands twice");
    }
  }
  int next = 0;
  for (const auto& [tag, x] : msh.nodes) msh.index[tag] = next++;
}

void read_elements(Scanner& in, MshFile& msh) {
  const int blocks = in.count();
  for (int i = 0; i < 3; ++i) in.integer();
  for (int b = 0; b < blocks; ++b) {
    MshBlock block;
    block.entity.first = in.integer();
    block.entity.second = in.integer();
    const int type = in.integer();
    block.shape = shape_of(type);
    if (block.shape == nullptr)
      in.fail("elements of Gmsh type " + std::to_string(type) + " have no counterpart here");
    for (int e = in.count(); e > 0; --e) {
      MshElement element;
      element.number = in.integer();
      for (int i = 0; i < block.shape->nodes; ++i) {
        const int tag = in.integer();
        const auto it = msh.index.find(tag);
        if (it == msh.index.end()) in.fail("node " + std::to_string(tag) + " is not defined");
        element.nodes.push_back(it->second);
      }
      block.elements.push_back(std::move(element));
    }
    msh.blocks.push_back(std::move(block));
  }
}

MshFile read_msh(std::string_view text, const std::string& file) {
  Scanner in(text, file);
  MshFile msh;
  bool format = false;
  while (!in.end()) {
    const std::string section(in.word());
    if (section.size() < 2 || section[0] != '$') in.fail("a section ($...) was expected");
    if (section == "$MeshFormat") {
      const std::string version(in.word());
      if (version != "4.1") in.fail("MSH version " + version + ": save the mesh as version 4.1 ASCII");
      if (in.integer() != 0) in.fail("the file is binary: save the mesh as version 4.1 ASCII");
      format = true;
    } else if (!format) {
      in.fail("$MeshFormat must come first");
    } else if (section == "$PhysicalNames") {
      read_names(in, msh);
    } else if (section == "$Entities") {
      read_entities(in, msh);
    } else if (section == "$Nodes") {
      read_nodes(in, msh);
    } else if (section == "$Elements") {
      read_elements(in, msh);
    }
    in.pass_section(section);
  }
  if (msh.nodes.empty() || msh.blocks.empty()) in.fail("the file holds no mesh");
  return msh;
}

// Corners and edges the other way round; the first corner stays.
void turn_round(std::vector<int>& nodes, const Shape& shape) {
  const auto corners = nodes.begin() + shape.corners;
  const int inner = shape.nodes == 9 ? 1 : shape.nodes == 15 ? 3 : 0;
  std::reverse(nodes.begin() + 1, corners);
  std::reverse(corners, nodes.end() - inner);
  if (inner == 3) std::swap(nodes[13], nodes[14]);
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
      if (block.shape->dimension == 2) surface(block);
    if (model_.groups.empty()) throw InputError({model_.file, 0, 0, 0}, "the mesh holds no surface elements");
    for (const MshBlock& block : msh_.blocks)
      if (block.shape->dimension == 1) curve(block);
    if (turned_ > 0)
      message(Severity::note, std::to_string(turned_) + " element(s) listed clockwise were turned round");
    return std::move(model_);
  }

 private:
  void message(Severity severity, const std::string& text) {
    model_.diagnostics.add({severity, {model_.file, 0, 0, 0}, text, {}});
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
    for (const auto& [code, entry] : catalogue_.materials.entries())
      if (entry.name == "linear_elastic") material.code = code;
    material.law_name = "linear_elastic";
    material.parameters = {options_.youngs_modulus, options_.poissons_ratio};
    material.unit_weight = options_.unit_weight;
    model_.materials.push_back(std::move(material));
    return static_cast<int>(model_.materials.size()) - 1;
  }

  Group& group(const std::string& name, const char* element) {
    for (Group& group : model_.groups)
      if (group.name == name && catalogue_.elements.find(group.element_code)->name == element) return group;
    Group group;
    group.number = static_cast<int>(model_.groups.size()) + 1;
    group.name = name;
    group.material = material(name);
    for (const auto& [code, entry] : catalogue_.elements.entries()) {
      if (entry.name != element) continue;
      group.element_code = code;
      group.element_name = entry.name + " " + entry.formulations.front().name;
      group.element = entry.make(model_.geometry, 0);
    }
    if (!group.element)
      throw InputError({model_.file, 0, 0, 0}, "no element " + std::string(element) + " here");
    model_.groups.push_back(std::move(group));
    return model_.groups.back();
  }

  void surface(const MshBlock& block) {
    std::string name = name_of(block);
    if (name.empty()) name = "surface " + std::to_string(block.entity.second);
    Group& target = group(name, block.shape->element);
    const int g = static_cast<int>(&target - model_.groups.data());
    for (const MshElement& element : block.elements) {
      std::vector<int> nodes = element.nodes;
      if (twice_area(model_.mesh, nodes, block.shape->corners) < 0.0) {
        turn_round(nodes, *block.shape);
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
      message(Severity::warning,
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
        message(Severity::warning,
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

}  // namespace

Model model_from_msh(std::string_view text, const std::string& file, const Catalogue& catalogue,
                     const MshOptions& options) {
  const MshFile msh = read_msh(text, file);
  return Skeleton(msh, file, catalogue, options).build();
}

}  // namespace sage

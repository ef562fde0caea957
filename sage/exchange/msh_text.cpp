// A model's mesh as Gmsh MSH 4.1, as text or binary.  Gmsh counts nodes of an element as this program does.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>

#include "sage/exchange/boundary_edges.hpp"
#include "sage/exchange/convert.hpp"
#include "sage/exchange/foreign_mesh.hpp"
#include "sage/exchange/msh_interfaces.hpp"
#include "sage/model/foreign_element.hpp"
#include "sage/model/msh_numbers.hpp"

namespace sage {

namespace {

// Gmsh's type of a solid: of its corners where it has none for the element.
int solid_type(const ElementEntry& entry) {
  if (entry.gmsh.type != 0) return entry.gmsh.type;
  return entry.triangle() ? 2 : 3;
}

struct Block {
  int dimension = 2, type = 0, tag = 0;
  std::string name;
  std::vector<std::vector<int>> elements;  // number, then node numbers
};

// A group's name, or its number; another one where a group before it bears the name.
std::string unlike(const Group& group, const std::vector<Block>& blocks, std::string_view before = "") {
  std::string name =
      std::string(before) + (group.name.empty() ? "group " + std::to_string(group.number) : group.name);
  if (std::ranges::find(blocks, name, &Block::name) != blocks.end()) name += " " + std::to_string(group.number);
  return name;
}

std::vector<Block> surfaces(const Model& model, Diagnostics& diagnostics, int& largest) {
  std::vector<Block> blocks;
  for (const Group& group : model.groups) {
    for (int number : group.element_numbers) largest = std::max(largest, number);
    if (!group.solid() || group.elements() == 0) continue;
    if (group.entry->gmsh.type == 0) warn_of_corners(group, "MSH", diagnostics);
    const std::vector<int> order = foreign_nodes(*group.entry, group.entry->gmsh);
    Block block{2, solid_type(*group.entry), static_cast<int>(blocks.size()) + 1, unlike(group, blocks), {}};
    for (int e = 0; e < group.elements(); ++e) {
      std::vector<int> row{group.element_numbers[e]};
      for (int i : order) row.push_back(model.mesh.number[group.nodes_of(e)[i]]);
      block.elements.push_back(std::move(row));
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

// A curve of lines through some nodes (`side`) of each element of a group.  numbers: of the lines.
Block side_lines(const Model& model, const Group& group, const std::vector<int>& side,
                 const std::vector<int>& numbers) {
  Block block{1, gmsh_line_type(side.size()), 0, "", {}};
  for (int e = 0; e < group.elements(); ++e) {
    std::vector<int> row{numbers[e]};
    for (int i : side) row.push_back(model.mesh.number[group.nodes_of(e)[i]]);
    block.elements.push_back(std::move(row));
  }
  return block;
}

// Both sides of all interfaces; the lines of bottoms bear the elements' numbers.
std::vector<Block> interfaces(const Model& model, Diagnostics& diagnostics, int& largest) {
  std::vector<Block> blocks;
  for (const Group& group : model.groups) {
    if (!group.interface() || group.elements() == 0) continue;
    const msh::InterfaceSides sides = msh::interface_sides(*group.entry);
    if (gmsh_line_type(sides.bottom.size()) == 0) {
      diagnostics.add({Severity::warning,
                       "S720",
                       group.where,
                       std::to_string(group.elements()) + " " + group.element_name +
                           " element(s) left out: MSH has no line for their sides",
                       {}});
      continue;
    }
    const std::string name = unlike(group, blocks, msh::kInterfaceBottom);
    std::vector<int> of_top(group.element_numbers.size());
    for (int& number : of_top) number = ++largest;
    blocks.push_back(side_lines(model, group, sides.bottom, group.element_numbers));
    blocks.back().name = name;
    blocks.push_back(side_lines(model, group, sides.top, of_top));
    blocks.back().name = std::string(msh::kInterfaceTop) + name.substr(msh::kInterfaceBottom.size());
  }
  return blocks;
}

// Bars and beams as lines, rings as points, that bear the elements' numbers, behind the curves that there are.
void add_structures(const Model& model, std::vector<Block>& blocks, Diagnostics& diagnostics) {
  for (const Group& group : model.groups) {
    if (!group.structure() || group.elements() == 0) continue;
    const std::vector<int> order = foreign_nodes(*group.entry, group.entry->vtk);
    const bool point = order.size() == 1;
    if (!point && gmsh_line_type(order.size()) == 0) {
      diagnostics.add({Severity::warning,
                       "S720",
                       group.where,
                       std::to_string(group.elements()) + " " + group.element_name +
                           " element(s) left out: MSH has no line of their nodes",
                       {}});
      continue;
    }
    blocks.push_back(side_lines(model, group, order, group.element_numbers));
    if (point) {
      blocks.back().dimension = 0;
      blocks.back().type = kGmshPoint;
    }
    blocks.back().name = unlike(group, {blocks.begin(), blocks.end() - 1});
  }
}

// Nodes that are held, with a direction of each, and that no held edge has.
using HeldDofs = std::set<std::pair<int, std::size_t>>;

HeldDofs held_dofs(const Model& model) {
  HeldDofs held;
  for (const Fixity& f : model.fixities)
    for (std::size_t c = 0; c < 2; ++c)
      if (f.code[c] == FixityCode::fixed) held.insert({f.node, c});
  return held;
}

std::vector<Block> supports(const Model& model, int first_number, int tags_before, HeldDofs& beside) {
  const Activity before_stages(model);
  beside = held_dofs(model);
  std::map<std::pair<std::string, std::size_t>, Block> by_name;
  std::map<std::string, int> tags;
  for (BoundaryEdge& edge : boundary_edges(model)) {
    const std::string name = support_name(before_stages, edge);
    if (name.empty()) continue;
    for (int node : edge.nodes) {
      if (name != "fix_y") beside.erase({node, 0});
      if (name != "fix_x") beside.erase({node, 1});
    }
    const bool corners = model.groups[edge.group].entry->gmsh.type == 0;
    if (corners || gmsh_line_type(edge.nodes.size()) == 0) edge.nodes.resize(2);
    Block& block = by_name[{name, edge.nodes.size()}];
    block.dimension = 1;
    block.type = gmsh_line_type(edge.nodes.size());
    block.name = name;
    block.tag = tags.try_emplace(name, tags_before + static_cast<int>(tags.size()) + 1).first->second;
    std::vector<int> row{first_number++};
    for (int node : edge.nodes) row.push_back(model.mesh.number[node]);
    block.elements.push_back(std::move(row));
  }
  std::vector<Block> blocks;
  for (auto& [key, block] : by_name) blocks.push_back(std::move(block));
  return blocks;
}

std::string clean(std::string name) {
  for (char& c : name)
    if (c == '"') c = '\'';
  return name;
}

// Where the node of the block's first element is.
Vector2 place_of(const Model& model, const Block& block) {
  const auto node = std::ranges::find(model.mesh.number, block.elements.front()[1]) - model.mesh.number.begin();
  return model.mesh.x.col(node);
}

double without_minus_zero(double value) {
  return value + 0.0;
}

void add_entity(MshNumbers& out, const Model& model, const Block& block) {
  constexpr std::size_t kNamed = 1, kBounds = 0;  // one physical group each, whose number is the entity's
  out << block.tag;
  if (block.dimension == 0) {
    const Vector2 at = place_of(model, block);
    out << without_minus_zero(at.x()) << without_minus_zero(at.y()) << 0.0 << kNamed << block.tag;
  } else {
    const Vector2 low = model.mesh.x.rowwise().minCoeff().unaryExpr(&without_minus_zero);
    const Vector2 high = model.mesh.x.rowwise().maxCoeff().unaryExpr(&without_minus_zero);
    out << low[0] << low[1] << 0.0 << high[0] << high[1] << 0.0 << kNamed << block.tag << kBounds;
  }
  out.end_line();
}

void add_entities(std::string& text, MshForm form, const Model& model, const std::vector<Block>& blocks) {
  std::map<std::pair<int, int>, const Block*> known;
  std::array<std::vector<const Block*>, 3> of_dimension;
  for (const Block& block : blocks)
    if (known.try_emplace({block.dimension, block.tag}, &block).second)
      of_dimension[block.dimension].push_back(&block);
  text += "$Entities\n";
  MshNumbers out(text, form);
  for (const auto& some : of_dimension) out << some.size();
  out << std::size_t{0};
  out.end_line();
  for (const auto& some : of_dimension)
    for (const Block* block : some) add_entity(out, model, *block);
  out.end_section("Entities");
}

// A mesh file is a mesh: what else the deck says must be given anew.
void warn_of_the_rest(const Model& model, const HeldDofs& beside, Diagnostics& diagnostics) {
  std::size_t loads = 0, lives = 0, displacements = 0, initials = model.initials.size(), formulations = 0;
  std::set<int> points;
  for (const auto& [node, c] : beside) points.insert(node);
  for (const Group& group : model.groups)
    if (group.solid() && group.elements() > 0 && group.formulation > 0 &&
        group.formulation != group.entry->formulations.front().code)
      ++formulations;
  for (const Stage& stage : model.stages) {
    loads += stage.loads.size() + stage.pressures.size() + (stage.gravity.norm() > 0.0 ? 1u : 0u);
    lives += stage.births.size() + stage.deaths.size();
    displacements += stage.fixities.size();
    initials += stage.initials.size();
  }
  std::string rest;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) rest += fmt::format("{}{} {}", rest.empty() ? "" : ", ", count, what);
  };
  add(model.materials.size(), "material(s)");
  add(model.stages.size(), "stage(s)");
  add(loads, "load(s)");
  add(displacements, "fixities of stages");
  add(lives, "birth(s) and death(s)");
  add(initials, "initial stress(es)");
  add(model.water.size(), "water card(s)");
  add(model.reports.size(), "report(s)");
  add(points.size(), "held node(s) that are no whole edge of the outline");
  add(formulations, "formulation(s) of groups");
  const auto word = [&](bool wanted, const char* what) {
    if (wanted) rest += (rest.empty() ? "" : ", ") + std::string(what);
  };
  word(model.geometry == Geometry::axisymmetric, "axisymmetry (--geometry 2)");
  word(model.large_strain, "large strain");
  word(model.combines_dofs(), "inclined supports and ties");
  word(!model.title.empty(), "title");
  const UnitSystem& units = model.units;
  word(units.length != "-" || units.force != "-" || units.stress != "-" || units.atmospheric_pressure != 0.0 ||
           units.water_unit_weight != 0.0,
       "units");
  word(model.solver != 0, "solver");
  word(std::any_of(model.groups.begin(), model.groups.end(), [](const Group& group) { return group.overlay; }),
       "that groups lie on others");
  if (!rest.empty())
    diagnostics.add({Severity::warning,
                     "S720",
                     {model.file, 0, 0, 0},
                     "a mesh file holds nodes, elements, groups and supports alone; left out: " + rest,
                     {}});
}

// All blocks of a file; `beside`: what is held besides whole edges.
std::vector<Block> blocks_of(const Model& model, Diagnostics& diagnostics, HeldDofs& beside) {
  int largest = 0;
  std::vector<Block> blocks = surfaces(model, diagnostics, largest);
  std::vector<Block> curves = interfaces(model, diagnostics, largest);
  add_structures(model, curves, diagnostics);
  for (std::size_t i = 0; i < curves.size(); ++i) curves[i].tag = static_cast<int>(i) + 1;
  const std::vector<Block> held = supports(model, largest + 1, static_cast<int>(curves.size()), beside);
  blocks.insert(blocks.end(), curves.begin(), curves.end());
  blocks.insert(blocks.end(), held.begin(), held.end());
  return blocks;
}

void add_nodes(std::string& text, MshForm form, const Mesh& mesh) {
  const std::vector<int>& number = mesh.number;
  const auto count = number.size();
  text += "$Nodes\n";
  MshNumbers out(text, form);
  const int largest = number.empty() ? 0 : *std::ranges::max_element(number);
  out << std::size_t{1} << count << std::size_t(number.empty() ? 0 : number.front()) << std::size_t(largest);
  out.end_line();
  out << 2 << 1 << 0 << count;
  out.end_line();
  for (int n : number) {
    out << std::size_t(n);
    out.end_line();
  }
  for (int i = 0; i < mesh.nodes(); ++i) {
    out << without_minus_zero(mesh.x(0, i)) << without_minus_zero(mesh.x(1, i)) << 0.0;
    out.end_line();
  }
  out.end_section("Nodes");
}

void add_elements(std::string& text, MshForm form, const std::vector<Block>& blocks,
                  const std::vector<int>& numbers) {
  const auto [lowest, largest] = std::ranges::minmax_element(numbers);
  const bool none = numbers.empty();
  text += "$Elements\n";
  MshNumbers out(text, form);
  out << blocks.size() << numbers.size() << std::size_t(none ? 0 : *lowest) << std::size_t(none ? 0 : *largest);
  out.end_line();
  for (const Block& block : blocks) {
    out << block.dimension << block.tag << block.type << block.elements.size();
    out.end_line();
    for (const auto& row : block.elements) {
      for (int tag : row) out << std::size_t(tag);
      out.end_line();
    }
  }
  out.end_section("Elements");
}

MshMesh mesh_of(const Model& model, MshForm form, const std::vector<Block>& blocks) {
  std::map<std::pair<int, int>, std::string> names;
  MshMesh mesh;
  for (const Block& block : blocks) {
    names.try_emplace({block.dimension, block.tag}, clean(block.name));
    for (const auto& row : block.elements) mesh.elements.push_back(row[0]);
  }
  std::string& text = mesh.text;
  text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  if (form == MshForm::binary) {
    constexpr int kByteOrder = 1;
    text = "$MeshFormat\n4.1 1 8\n";
    MshNumbers(text, form) << kByteOrder;
    text += "\n$EndMeshFormat\n";
  }
  text += "$PhysicalNames\n" + std::to_string(names.size()) + "\n";
  for (const auto& [key, name] : names) text += fmt::format("{} {} \"{}\"\n", key.first, key.second, name);
  text += "$EndPhysicalNames\n";
  add_entities(text, form, model, blocks);
  add_nodes(text, form, model.mesh);
  add_elements(text, form, blocks, mesh.elements);
  return mesh;
}

}  // namespace

std::string msh_text(const Model& model, Diagnostics& diagnostics) {
  HeldDofs beside;
  const std::vector<Block> blocks = blocks_of(model, diagnostics, beside);
  warn_of_unknowns(model, "MSH", diagnostics);
  warn_of_the_rest(model, beside, diagnostics);
  return mesh_of(model, MshForm::text, blocks).text;
}

MshMesh msh_mesh(const Model& model, MshForm form, Diagnostics& diagnostics) {
  HeldDofs beside;
  return mesh_of(model, form, blocks_of(model, diagnostics, beside));
}

}  // namespace sage

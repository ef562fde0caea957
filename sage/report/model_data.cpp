// The page's model: what was read, as text and as a mesh.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "sage/model/activity.hpp"
#include "sage/model/foreign_element.hpp"
#include "sage/record/extremes.hpp"
#include "sage/record/listing_parts.hpp"
#include "sage/record/nodal_values.hpp"
#include "sage/record/values.hpp"
#include "sage/report/run_data.hpp"

namespace sage::report {

namespace {

const char* kind_name(const Group& group) {
  return group.solid() ? "solid" : group.flow() ? "flow" : group.interface() ? "interface" : "structure";
}

// points x nodes: places of the integration points are these weights times those of the nodes.
std::vector<double> point_weights(const Element& element) {
  const ElementTraits& traits = element.traits();
  std::vector<double> weights;
  Eigen::Matrix2Xd x = Eigen::Matrix2Xd::Zero(2, traits.nodes);
  for (int p = 0; p < traits.points; ++p)
    for (int n = 0; n < traits.nodes; ++n) {
      x.setZero();
      x(0, n) = 1.0;
      weights.push_back(element.position(x, p).x());
    }
  return weights;
}

// A lattice over the parent shape: weights of the nodes at each of its places, and triangles between them.
struct Lattice {
  std::vector<double> weights;
  std::vector<int> triangles;
};

// n cells a side; one cell is divided about its middle.
void lay_square(int n, std::vector<Vector2>& places, std::vector<int>& triangles) {
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) places.emplace_back(2.0 * i / n - 1.0, 2.0 * j / n - 1.0);
  if (n == 1) {
    places.emplace_back(0.0, 0.0);
    triangles = {0, 1, 4, 1, 3, 4, 3, 2, 4, 2, 0, 4};
    return;
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + n + 1;
      for (const int v : {a, a + 1, b + 1, a, b + 1, b}) triangles.push_back(v);
    }
}

void lay_triangle(int n, std::vector<Vector2>& places, std::vector<int>& triangles) {
  std::vector<int> first;
  for (int j = 0; j <= n; ++j) {
    first.push_back(static_cast<int>(places.size()));
    for (int i = 0; i + j <= n; ++i)
      places.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n);
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j < n; ++i) {
      const int a = first[j] + i, b = first[static_cast<std::size_t>(j) + 1] + i;
      for (const int v : {a, a + 1, b}) triangles.push_back(v);
      if (i + j + 1 < n)
        for (const int v : {a + 1, b + 1, b}) triangles.push_back(v);
    }
}

Lattice lattice_of(const Group& group) {
  const ElementTraits& traits = group.element->traits();
  const int n = traits.degree <= 1 ? 1 : std::min(2 * traits.degree, 6);
  std::vector<Vector2> places;
  Lattice lattice;
  if (group.entry->triangle())
    lay_triangle(n, places, lattice.triangles);
  else
    lay_square(n, places, lattice.triangles);
  const auto nodes = static_cast<std::size_t>(traits.nodes);
  std::vector<double> N(nodes), dN(2 * nodes);
  for (const Vector2& place : places) {
    if (!group.element->shape_functions(place, N, dN)) return {};
    lattice.weights.insert(lattice.weights.end(), N.begin(), N.end());
  }
  return lattice;
}

// Sides as lines of local nodes: corner, nodes between, corner.
Json sides_of(const Group& group) {
  Json sides = Json::array();
  for (const std::vector<int>& edge : group.element->edges()) {
    Json side = {edge[0]};
    for (std::size_t i = 2; i < edge.size(); ++i) side.push_back(edge[i]);
    side.push_back(edge[1]);
    sides.push_back(std::move(side));
  }
  if (sides.empty() && group.entry->fills_area())
    for (int c = 0; c < group.entry->corners; ++c) sides.push_back({c, (c + 1) % group.entry->corners});
  return sides;
}

// Local nodes along a structure or the bottom of an interface, end to end.
Json line_of(const Group& group) {
  std::vector<int> nodes = foreign_nodes(*group.entry, group.entry->vtk);
  if (nodes.size() > 2) std::rotate(nodes.begin() + 1, nodes.begin() + 2, nodes.end());
  return nodes;
}

Json group_json(const Model& model, std::size_t index, const NodalLayout& layout) {
  const Group& group = model.groups[index];
  Json json = {{"number", group.number},
               {"name", clean(group.name)},
               {"element", clean(group.element_name)},
               {"kind", kind_name(group)},
               {"material", group.material},
               {"elements", group.elements()},
               {"nodes", group.node_count()},
               {"corners", group.entry->corners},
               {"points", group.element->traits().points},
               {"weights", point_weights(*group.element)},
               {"numbers", packed_integers(group.element_numbers)},
               {"connect", packed_integers(group.nodes, group.node_count())}};
  if (group.entry->fills_area()) {
    const Lattice lattice = lattice_of(group);
    json["lattice"] = lattice.weights;
    json["triangles"] = lattice.triangles;
    json["sides"] = sides_of(group);
    if (!layout.of_group.empty()) json["entries"] = packed_integers(layout.of_group[index], group.node_count());
  } else {
    json["line"] = line_of(group);
  }
  return json;
}

Json material_json(const Model& model, const Material& material) {
  Json parameters = Json::array();
  for (std::size_t i = 0; i < material.parameters.size(); ++i) {
    const bool known = material.entry != nullptr && i < material.entry->parameters.size();
    const Parameter* p = known ? &material.entry->parameters[i] : nullptr;
    parameters.push_back({{"name", p != nullptr ? p->name : "parameter " + std::to_string(i + 1)},
                          {"value", material.parameters[i]},
                          {"unit", p != nullptr ? clean(unit_text(p->dimension, model.units)) : ""},
                          {"meaning", p != nullptr ? p->meaning : ""}});
  }
  return {{"number", material.number},
          {"name", clean(material.name)},
          {"law", clean(material.law_name)},
          {"unit_weight", material.unit_weight},
          // Of structures it is the listing that says what the weight is of.
          {"weight_unit",
           size_of_law(material.law_ref()) == 4 ? clean(unit_text(Dimension::unit_weight, model.units)) : ""},
          {"parameters", std::move(parameters)}};
}

// [node, x, y] of each: 0 unchanged, 1 held, 2 released.
Json fixities_json(const std::vector<Fixity>& fixities) {
  Json list = Json::array();
  for (const Fixity& f : fixities)
    list.push_back({f.node, static_cast<int>(f.code[0]), static_cast<int>(f.code[1]), f.value[0], f.value[1]});
  return list;
}

Json loads_json(const Model& model, const Stage& stage) {
  Json nodes = Json::array(), edges = Json::array();
  for (const NodalLoad& load : stage.loads) nodes.push_back({load.node, load.force.x(), load.force.y()});
  for (const EdgeLoad& load : stage.pressures) {
    const Group& group = model.groups[load.group];
    const std::vector<int>& edge = group.element->edges()[load.edge];
    const int* const of = group.nodes_of(load.element);
    edges.push_back(
        {of[edge[0]], of[edge[1]], load.normal.x(), load.normal.y(), load.shear.x(), load.shear.y()});
  }
  return {{"nodes", std::move(nodes)}, {"edges", std::move(edges)}};
}

std::string trimmed_text(const std::string& text) {
  const std::size_t line = text.find("==="), begin = text.find('\n', line == std::string::npos ? 0 : line);
  return begin == std::string::npos ? "" : text.substr(begin + 1);
}

Json stages_json(const Model& model) {
  Json stages = Json::array();
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    const Stage& stage = model.stages[s];
    std::string text;
    listing::stage(text, model, static_cast<int>(s));
    Json water = Json::array();
    for (const WaterCard& card : model.water) {
      if (card.stage != static_cast<int>(s) || card.line.empty()) continue;
      Json line = Json::array();
      for (const Vector2& x : card.line) line.push_back({x.x(), x.y()});
      water.push_back(std::move(line));
    }
    stages.push_back({{"title", clean(stage.title)},
                      {"text", clean(trimmed_text(text))},
                      {"line", stage.where.line},
                      {"fixities", fixities_json(stage.fixities)},
                      {"loads", loads_json(model, stage)},
                      {"water", std::move(water)}});
  }
  return stages;
}

Activity all_active(const Model& model) {
  Activity activity(model);
  activity.group.assign(model.groups.size(), 1);
  return activity;
}

bool any_interface(const Model& model) {
  return std::ranges::any_of(model.groups, [](const Group& group) { return group.interface(); });
}

}  // namespace

void add_model(const PageRun& run, Json& json) {
  const Model& model = run.model;
  const AxisNames axes = axis_names(model.geometry);
  json["title"] = clean(model.title);
  json["geometry"] = model.geometry == Geometry::axisymmetric ? "axisymmetric" : "plane strain";
  json["axes"] = {axes.x, axes.y};
  json["units"] = {{"length", model.units.length == "-" ? "" : clean(model.units.length)},
                   {"force", clean(model.units.force)},
                   {"stress", clean(model.units.stress)},
                   {"forces_per", clean(forces_per(model))},
                   {"structures_per", clean(structure_forces_per(model))}};
  std::vector<double> x, y;
  for (int n = 0; n < model.mesh.nodes(); ++n) x.push_back(model.mesh.x(0, n)), y.push_back(model.mesh.x(1, n));
  const Precision precision = x.size() > 20000 ? Precision::fine : Precision::whole;
  json["nodes"] = {
      {"number", packed_integers(model.mesh.number)}, {"x", packed(x, precision)}, {"y", packed(y, precision)}};
  NodalLayout layout = nodal_layout(model, all_active(model));
  json["entries"] = layout.entries();
  // Values are averaged over the elements of one material at a node; where no structure parts them, the script knows.
  if (!has_structures(model) && !any_interface(model)) layout.of_group.clear();
  Json groups = Json::array(), materials = Json::array();
  for (std::size_t g = 0; g < model.groups.size(); ++g) groups.push_back(group_json(model, g, layout));
  for (const Material& material : model.materials) materials.push_back(material_json(model, material));
  json["groups"] = std::move(groups);
  json["materials"] = std::move(materials);
  json["fixities"] = fixities_json(model.fixities);
  json["stages"] = stages_json(model);
}

}  // namespace sage::report

#include "sage/model_file/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "sage/messages/near_names.hpp"

namespace sage::model_file {

namespace {

double real_of(Values& values, const toml::table& from, std::string_view key, const std::string& unit,
               double fallback = 0.0) {
  const toml::node* node = from.get(key);
  return node != nullptr ? values.number(*node, std::string(key), unit) : fallback;
}

int code_of(Values& values, const toml::table& from, std::string_view key, std::string_view of) {
  const toml::node* node = from.get(key);
  return node != nullptr ? static_cast<int>(values.code(*node, std::string(key), table(of).find(key)->codes))
                         : 0;
}

int material_of(Values& values, const toml::table& from, std::string_view key) {
  const toml::node* node = from.get(key);
  return node != nullptr ? static_cast<int>(values.one_of(*node, values.materials)) : 0;
}

template <class Names>
std::vector<std::string> keys_of(const Names& names) {
  std::vector<std::string> list;
  for (const auto& [name, value] : names) list.push_back(name);
  return list;
}

}  // namespace

bool Drawing::is_drawn(const toml::table& root) {
  return root.contains("area") || root.contains("mesh") || root.contains("points") || root.contains("line") ||
         root.contains("bar");
}

void Drawing::read_mesh(const toml::table& root) {
  const toml::node* node = root.get("mesh");
  mesh_at_ = node != nullptr ? node->as_table() : nullptr;
  if (mesh_at_ == nullptr) {
    values_.error("S155", values_.where(root), "a drawing needs a table [mesh] with its element and size");
    return;
  }
  const Table& mesh = table("mesh");
  values_.know_keys(*mesh_at_, mesh);
  const std::vector<NewField> given = values_.fields(*mesh_at_, mesh);
  for (const NewField& field : given) {
    if (field.name == "element") element_code_ = field.number;
    if (field.name == "formulation") formulation_ = field.number;
  }
  section_.size = real_of(values_, *mesh_at_, "size", values_.units.length);
  settings_.growth = real_of(values_, *mesh_at_, "growth", {}, settings_.growth);
  settings_.mesher = static_cast<Mesher>(code_of(values_, *mesh_at_, "mesher", "mesh"));
  entry_ = values_.catalogue.elements.find(static_cast<int>(element_code_));
  if (entry_ == nullptr || !entry_->fills_area()) {
    if (entry_ != nullptr) values_.error("S152", values_.where(*mesh_at_), entry_->name + " fills no area");
    entry_ = nullptr;
    return;
  }
  section_.shape = entry_->triangle() ? ElementShape::triangle : ElementShape::quadrilateral;
  section_.nodes_per_edge = entry_->only_corners() ? 2 : 3;
}

void Drawing::read_points(const toml::table& root) {
  const toml::node* node = root.get("points");
  const toml::table* all = node != nullptr ? node->as_table() : nullptr;
  if (node != nullptr && all == nullptr)
    values_.error("S152", values_.where(*node), "points is a table of names and places: [points], A = [0, 0]");
  if (all == nullptr) return;
  for (const auto& [name, place] : *all) {
    SectionPoint point{std::string(name.str())};
    const toml::table* keys = place.as_table();
    const toml::node* at = keys != nullptr ? keys->get("at") : &place;
    const toml::array* pair = at != nullptr ? at->as_array() : nullptr;
    if (pair == nullptr || pair->size() != 2) {
      values_.error("S152", values_.where(place), "a point is [x, y], or {at = [x, y], size = s}");
      continue;
    }
    for (std::size_t c = 0; c < 2; ++c)
      point.x[c] = values_.number((*pair)[c], c == 0 ? "x" : "y", values_.units.length);
    if (keys != nullptr) point.size = real_of(values_, *keys, "size", values_.units.length);
    points_[point.name] = static_cast<int>(section_.points.size());
    section_.points.push_back(point);
  }
}

int Drawing::point_of(const toml::node& node) {
  if (const toml::array* pair = node.as_array(); pair != nullptr && pair->size() == 2) {
    SectionPoint point;
    point.x = {values_.number((*pair)[0], "x", values_.units.length),
               values_.number((*pair)[1], "y", values_.units.length)};
    section_.points.push_back(point);
    return static_cast<int>(section_.points.size()) - 1;
  }
  return find_point(node);
}

int Drawing::find_point(const toml::node& node) {
  const std::string name = node.value_or(std::string());
  if (const auto found = points_.find(name); found != points_.end()) return found->second;
  const bool is_place = node.is_array() && node.as_array()->size() == 2;
  values_.error("S153", values_.where(node),
                is_place ? "a point of the drawing is wanted: give it a name in [points], and that name here"
                : name.empty() ? "a point is a name of [points], or [x, y]"
                               : "[points] has no \"" + name + "\"" + did_you_mean(name, keys_of(points_)));
  return -1;
}

int Drawing::find_line(const toml::node& node) {
  const std::string name = node.value_or(std::string());
  if (const auto found = line_index_.find(name); found != line_index_.end()) return found->second;
  values_.error("S153", values_.where(node),
                "no [[line]] has the name \"" + name + "\"" + did_you_mean(name, keys_of(line_index_)));
  return -1;
}

Drawing::Interface Drawing::read_interface(const toml::node& node) {
  Interface interface;
  const toml::table* keys = node.as_table();
  if (keys == nullptr) {
    values_.error("S152", values_.where(node),
                  "an interface is {side = \"both\", factor = 0.67}, or with a material");
    return interface;
  }
  const Table& table_of = table("line.interface");
  values_.know_keys(*keys, table_of);
  interface.at = &node;
  interface.side = keys->contains("side")
                       ? static_cast<InterfaceSide>(code_of(values_, *keys, "side", "line.interface"))
                       : InterfaceSide::both;
  interface.material = material_of(values_, *keys, "material");
  interface.factor = real_of(values_, *keys, "factor", {});
  interface.thickness = real_of(values_, *keys, "thickness", values_.units.length);
  if ((interface.material != 0) == (interface.factor != 0.0))
    values_.error("S155", values_.where(node),
                  "an interface has either a material or a factor on the strength of the ground beside it");
  else if (interface.factor < 0.0 || interface.factor > 1.0)
    values_.error("S152", values_.where(*keys->get("factor")),
                  "the factor on the strength lies between 0 and 1");
  return interface;
}

// What another shape has means something else than was intended.
void Drawing::check_shape(const toml::table& line, LineShape shape) {
  const std::string of = shape == LineShape::circle ? "a circle"
                         : shape == LineShape::arc  ? "an arc"
                                                    : "a polyline";
  if (shape != LineShape::polyline && !line.contains("centre"))
    values_.error("S155", values_.where(line), of + " needs its centre");
  const auto refuse = [&](std::initializer_list<const char*> keys) {
    for (const char* const key : keys)
      if (const toml::node* const given = line.get(key))
        values_.error("S152", values_.where(*given), of + " has no " + std::string(key));
  };
  if (shape == LineShape::circle)
    refuse({"points"});
  else
    refuse({"radius", "start_angle"});
  if (shape == LineShape::polyline) refuse({"centre", "clockwise"});
}

void Drawing::read_lines(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "line")) {
    values_.know_keys(*one, table("line"));
    SectionLine line;
    Line more;
    more.at = one;
    if (const toml::node* name = one->get("name"))
      line.name = values_.text(*name, "name");
    else
      values_.error("S155", values_.where(*one), "a line needs its name");
    more.name = line.name;
    const int errors = values_.problems.errors();
    line.shape = static_cast<LineShape>(code_of(values_, *one, "shape", "line"));
    if (values_.problems.errors() == errors) check_shape(*one, line.shape);
    if (const toml::node* points = one->get("points")) {
      if (const toml::array* list = points->as_array())
        for (const toml::node& point : *list) line.points.push_back(point_of(point));
      else
        values_.error("S152", values_.where(*points), "the points of a line stand in a list");
    }
    if (const toml::node* centre = one->get("centre")) line.centre = point_of(*centre);
    line.radius = real_of(values_, *one, "radius", values_.units.length);
    line.start_angle = real_of(values_, *one, "start_angle", "deg") * std::numbers::pi / 180.0;
    if (const toml::node* way = one->get("clockwise")) line.clockwise = values_.flag(*way, "direction");
    line.size = real_of(values_, *one, "size", values_.units.length);
    more.beam_material = material_of(values_, *one, "beam");
    more.bar_material = material_of(values_, *one, "bar");
    if (more.beam_material != 0 && more.bar_material != 0)
      values_.error("S152", values_.where(*one), "a line has a beam or a bar, not both");
    line.beam = more.beam_material != 0 || more.bar_material != 0;
    if (const toml::node* interface = one->get("interface")) more.interface = read_interface(*interface);
    line.interface = more.interface.side;
    line.first_end = static_cast<LineEnd>(code_of(values_, *one, "first_end", "line"));
    line.last_end = static_cast<LineEnd>(code_of(values_, *one, "last_end", "line"));
    if (!line_index_.try_emplace(line.name, static_cast<int>(section_.lines.size())).second)
      values_.error("S153", values_.where(*one), "two lines have the name \"" + line.name + "\"");
    section_.lines.push_back(line);
    lines_.push_back(more);
  }
}

Outline Drawing::read_outline(const toml::node& node) {
  Outline outline;
  const toml::array* list = node.as_array();
  if (list == nullptr) {
    values_.error("S152", values_.where(node),
                  "an outline is a list of points, or of lines: [\"A\", \"B\", [2, 3]]");
    return outline;
  }
  for (const toml::node& part : *list) {
    const auto line = line_index_.find(part.value_or(std::string()));
    if (line != line_index_.end())
      outline.push_back({-1, line->second});
    else
      outline.push_back({point_of(part), -1});
  }
  return outline;
}

void Drawing::read_areas(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "area")) {
    values_.know_keys(*one, table("area"));
    SectionArea area;
    for (const char* key : {"name", "outline", "material"})
      if (!one->contains(key))
        values_.error("S155", values_.where(*one), "an area needs its " + std::string(key));
    if (const toml::node* name = one->get("name")) area.name = values_.text(*name, "name");
    if (const toml::node* outline = one->get("outline")) area.outline = read_outline(*outline);
    if (const toml::node* holes = one->get("holes")) {
      if (const toml::array* list = holes->as_array())
        for (const toml::node& hole : *list) area.holes.push_back(read_outline(hole));
      else
        values_.error("S152", values_.where(*holes), "holes are a list of outlines: [[\"A\", \"B\"]]");
    }
    area.size = real_of(values_, *one, "size", values_.units.length);
    area_material_.push_back(material_of(values_, *one, "material"));
    area_second_material_.push_back(material_of(values_, *one, "second_material"));
    section_.areas.push_back(area);
    areas_.push_back(one);
  }
}

SourcePosition Drawing::place_of(SectionItem item, int index) const {
  const auto i = static_cast<std::size_t>(index);
  if (item == SectionItem::line && i < lines_.size()) return values_.where(*lines_[i].at);
  if (item == SectionItem::area && i < areas_.size()) return values_.where(*areas_[i]);
  return values_.where(*mesh_at_);
}

// False after an error.
bool Drawing::mesh_it() {
  if (values_.problems.errors() > 0) return false;
  try {
    mesh_ = mesh_section(section_, settings_);
    meshed_ = true;
  } catch (const SectionError& error) {
    for (const SectionFault& fault : error.faults())
      values_.error(fault.code, place_of(fault.item, fault.index), fault.message);
  }
  for (const NodePair& tie : mesh_.ties) {
    if (tie.kind != NodePair::Kind::end) continue;
    values_.error("S152", place_of(SectionItem::line, tie.line),
                  "line " + section_.lines[tie.line].name +
                      ": the end of a joint inside the ground can be joined only with a beam; leave it open");
    meshed_ = false;
  }
  return meshed_;
}

void Drawing::add_node(int node, const SourcePosition& where) {
  const Vector2& x = mesh_.x[node];
  out_.add(
      "node", where,
      {{"number", static_cast<double>(number_of(node)), {}, {}}, {"x", x.x(), {}, {}}, {"y", x.y(), {}, {}}});
}

int Drawing::add_group(const std::string& name, const std::string& of, double element, int formulation,
                       int material, const SourcePosition& where, int second_material) {
  ++group_;
  std::vector<NewField> card{{"number", static_cast<double>(group_), {}, {}},
                             {"element", element, {}, {}},
                             {"formulation", static_cast<double>(formulation), {}, {}},
                             {"material", static_cast<double>(material), {}, {}}};
  if (!name.empty()) card.push_back({"name", 0.0, {}, name});
  if (second_material != 0) card.push_back({"second_material", static_cast<double>(second_material), {}, {}});
  out_.add("group", where, card);
  values_.groups.by_name.try_emplace(name, group_);
  values_.groups.drawn[of].push_back(group_);
  return group_;
}

void Drawing::add_element(int group, const std::vector<int>& nodes, const SourcePosition& where) {
  std::vector<NewField> card{{"number", static_cast<double>(++element_), {}, {}},
                             {"group", static_cast<double>(group), {}, {}}};
  for (std::size_t n = 0; n < nodes.size(); ++n)
    card.push_back({"n" + std::to_string(n + 1), static_cast<double>(number_of(nodes[n])), {}, {}});
  out_.add("element", where, card);
}

void Drawing::add_areas() {
  const auto size = static_cast<std::size_t>(mesh_.nodes_per_element());
  for (std::size_t a = 0; a < mesh_.areas.size(); ++a) {
    const SourcePosition where = values_.where(*areas_[a]);
    const std::string& name = section_.areas[a].name;
    const int group = add_group(name, name, element_code_, static_cast<int>(formulation_), area_material_[a],
                                where, area_second_material_[a]);
    area_group_.push_back(group);
    first_element_.push_back(element_ + 1);
    const std::vector<int>& nodes = mesh_.areas[a].nodes;
    for (std::size_t at = 0; at < nodes.size(); at += size)
      add_element(group,
                  {nodes.begin() + static_cast<std::ptrdiff_t>(at),
                   nodes.begin() + static_cast<std::ptrdiff_t>(at + size)},
                  where);
  }
}

void Drawing::add_structure(const Line& line, const LineMesh& mesh) {
  const bool beam = line.beam_material != 0;
  const auto step = static_cast<std::size_t>(mesh_.nodes_per_edge - 1);
  const std::string element = std::string(beam ? "beam" : "bar") + (step == 1 ? "2" : "3");
  const SourcePosition where = values_.where(*line.at);
  const int code = values_.catalogue.elements.code_of(element);
  const ElementEntry* const entry = values_.catalogue.elements.find(code);
  const int group =
      add_group(line.name, line.name, code, 0, beam ? line.beam_material : line.bar_material, where);
  for (std::size_t at = 0; at + step < mesh.beam.size(); at += step) {
    std::vector<int> nodes{mesh.beam[at], mesh.beam[at + step]};
    if (step == 2) nodes.push_back(mesh.beam[at + 1]);
    add_element(group, nodes, where);
    for (const ElementUnknown& unknown : entry->unknowns)
      for (std::size_t local = 0; local < nodes.size(); ++local)
        if (unknown.nodes.empty() || std::ranges::count(unknown.nodes, static_cast<int>(local)) > 0)
          nodes_with_[unknown.field.name].insert(number_of(nodes[local]));
  }
}

// Coulomb's law with the strength of the ground times the factor, and stiffnesses of a layer of the ground as thick as
// stated, or a tenth of the element's size.
int Drawing::interface_material(const Line& line, int area) {
  if (line.interface.material != 0) return line.interface.material;
  const int ground = area >= 0 ? area_material_[area] : 0;
  const auto [made, is_new] = joint_materials_.try_emplace({line.name, ground}, 0);
  if (!is_new) return made->second;
  const std::map<std::string, double>& given = values_.parameters[ground];
  const SourcePosition where = values_.where(*line.interface.at);
  const auto parameter = [&](const char* name) -> std::optional<double> {
    const auto found = given.find(name);
    return found == given.end() ? std::nullopt : std::optional(found->second);
  };
  const auto E = parameter("youngs_modulus"), nu = parameter("poissons_ratio"), c = parameter("cohesion"),
             phi = parameter("friction_angle");
  if (!E || !nu || !c || !phi) {
    values_.error(
        "S155", where,
        "the factor needs a law with youngs_modulus, poissons_ratio, cohesion and friction_angle beside line " +
            line.name + ": give the interface a material of its own");
    return 0;
  }
  const double size = section_.lines[line_index_.at(line.name)].size;
  const double thickness =
      line.interface.thickness > 0.0 ? line.interface.thickness : 0.1 * (size > 0.0 ? size : section_.size);
  if (!(thickness > 0.0)) {
    values_.error("S155", where, "give the thickness of the interface, or the size of the line or of the mesh");
    return 0;
  }
  const double shear = *E / (2.0 * (1.0 + *nu)), confined = 2.0 * shear * (1.0 - *nu) / (1.0 - 2.0 * *nu);
  const double degree = std::numbers::pi / 180.0;
  const double angle = std::atan(line.interface.factor * std::tan(*phi * degree)) / degree;
  made->second = ++material_;
  const int owner =
      out_.add("material", where,
               {{"number", static_cast<double>(material_), {}, {}},
                {"law", static_cast<double>(values_.catalogue.materials.code_of("dilating_joint")), {}, {}},
                {"name", 0.0, {}, line.name + " joint"}});
  std::vector<NewField> parameters;
  for (const double one : {shear / thickness, confined / thickness, line.interface.factor * *c, angle})
    parameters.push_back({"values", one, where, {}});
  out_.add("parameters", where, parameters, owner);
  return material_;
}

void Drawing::add_interfaces(const Line& line, const LineMesh& mesh, bool left) {
  const std::vector<InterfaceElement>& all = left ? mesh.left_interfaces : mesh.right_interfaces;
  const std::size_t count = mesh_.nodes_per_edge == 2 ? 4 : 6;
  const SourcePosition where = values_.where(*line.at);
  std::map<int, int> group_of;  // by the area beside it
  for (const InterfaceElement& one : all) {
    const LineSegment& segment = mesh.segments[one.segment];
    const bool on_left = segment.left.there() && (left || !segment.right.there());
    const int area = on_left ? segment.left.area : segment.right.area;
    const auto [group, is_new] = group_of.try_emplace(area, 0);
    if (is_new) {
      const std::string of = area >= 0 ? section_.areas[area].name : std::string();
      group->second = add_group(line.name + (left ? " left " : " right ") + of, line.name,
                                values_.catalogue.elements.code_of(entry_->side_interface), 0,
                                interface_material(line, area), where);
      values_.groups.drawn[of].push_back(group->second);
      joints_beside_[of].push_back(group->second);
    }
    add_element(group->second, {one.nodes.begin(), one.nodes.begin() + static_cast<std::ptrdiff_t>(count)},
                where);
  }
}

std::vector<int> Drawing::joints_beside(int group) const {
  for (std::size_t a = 0; a < area_group_.size(); ++a)
    if (area_group_[a] == group)
      if (const auto found = joints_beside_.find(section_.areas[a].name); found != joints_beside_.end())
        return found->second;
  return {};
}

// The nodes at the ends of all sides along a line: of bodies, of interfaces and of its beam.  Where another line crosses,
// each of them has nodes of its own.
std::set<std::pair<int, int>> Drawing::sides_along(const LineMesh& mesh) const {
  std::set<std::pair<int, int>> sides;
  const auto add = [&](int a, int z) { sides.insert(std::minmax(a, z)); };
  const int corners = entry_->corners;
  for (const LineSegment& segment : mesh.segments)
    for (const AreaEdge& edge : {segment.left, segment.right}) {
      if (!edge.there()) continue;
      const int* const nodes = mesh_.areas[edge.area].nodes.data() +
                               static_cast<std::ptrdiff_t>(edge.element) * mesh_.nodes_per_element();
      add(nodes[edge.edge], nodes[(edge.edge + 1) % corners]);
    }
  for (const auto* const interfaces : {&mesh.left_interfaces, &mesh.right_interfaces})
    for (const InterfaceElement& one : *interfaces) {
      add(one.nodes[0], one.nodes[1]);
      add(one.nodes[2], one.nodes[3]);
    }
  const auto step = static_cast<std::size_t>(mesh_.nodes_per_edge - 1);
  for (std::size_t i = step; i < mesh.beam.size(); i += step) add(mesh.beam[i - step], mesh.beam[i]);
  return sides;
}

void Drawing::add_arc(const SectionLine& line, const LineMesh& mesh) {
  if (line.shape == LineShape::polyline) return;
  const Vector2& centre = section_.points[line.centre].x;
  DeckArc arc{centre.x(), centre.y(), {}};
  for (const auto& [a, z] : sides_along(mesh)) arc.ends.emplace_back(number_of(a), number_of(z));
  if (!arc.ends.empty()) out_.add_arc(std::move(arc));
}

void Drawing::add_lines() {
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const LineMesh& mesh = mesh_.lines[l];
    add_arc(section_.lines[l], mesh);
    if (!mesh.beam.empty()) add_structure(lines_[l], mesh);
    if (lines_[l].interface.side == InterfaceSide::none) continue;
    if (entry_->side_interface.empty()) {
      values_.error("S152", values_.where(*lines_[l].at),
                    entry_->name + " has no interface that fits its sides");
      continue;
    }
    add_interfaces(lines_[l], mesh, true);
    add_interfaces(lines_[l], mesh, false);
  }
}

// Anchors, struts and springs from point to point.
void Drawing::add_bars(const toml::table& root) {
  for (const toml::table* one : values_.entries(root, "bar")) {
    values_.know_keys(*one, table("bar"));
    const SourcePosition where = values_.where(*one);
    std::vector<int> ends;
    for (const char* key : {"from", "to"}) {
      const toml::node* node = one->get(key);
      const auto point = node != nullptr ? points_.find(node->value_or(std::string())) : points_.end();
      if (point == points_.end()) {
        values_.error("S153", node != nullptr ? values_.where(*node) : where,
                      "the bar's " + std::string(key) + " is a name of [points]");
        continue;
      }
      PointMesh& mesh = mesh_.points[point->second];
      if (mesh.nodes.empty()) {  // outside of the ground
        mesh.nodes.push_back(static_cast<int>(mesh_.x.size()));
        mesh_.x.push_back(section_.points[point->second].x);
        add_node(mesh.nodes[0], where);
      }
      ends.push_back(mesh.beam >= 0 ? mesh.beam : mesh.nodes[0]);
    }
    if (ends.size() != 2) continue;
    const toml::node* name = one->get("name");
    const std::string of = name != nullptr ? values_.text(*name, "name") : std::string();
    const toml::node* element = one->get("element");
    std::vector<NewField> code;
    if (element != nullptr) values_.add_value(*table("bar").find("element"), *one, *element, code);
    const double bar = code.empty() ? values_.catalogue.elements.code_of("bar2") : code[0].number;
    add_element(add_group(of, of, bar, 0, material_of(values_, *one, "material"), where), ends, where);
  }
}

void Drawing::add(const toml::table& root) {
  read_mesh(root);
  read_points(root);
  read_lines(root);
  read_areas(root);
  if (entry_ == nullptr || mesh_at_ == nullptr || !mesh_it()) return;
  for (std::size_t i = 0; i < mesh_.x.size(); ++i) add_node(static_cast<int>(i), values_.where(*mesh_at_));
  add_areas();
  add_lines();
  add_bars(root);
}

std::optional<Vector2> Drawing::point_at(const toml::node& node) {
  const int found = find_point(node);
  if (found < 0) return std::nullopt;
  return section_.points[static_cast<std::size_t>(found)].x;
}

std::vector<int> Drawing::nodes_at(const toml::node& node) {
  const int found = find_point(node);
  std::vector<int> numbers;
  if (found < 0 || !meshed_) return numbers;
  for (const int one : mesh_.points[found].nodes) numbers.push_back(number_of(one));
  if (numbers.empty())
    values_.error("S153", values_.where(node),
                  "no node of the mesh lies at the point \"" + node.value_or(std::string()) + "\"");
  return numbers;
}

std::vector<int> Drawing::nodes_along(const toml::node& node) {
  const int found = find_line(node);
  std::vector<int> numbers;
  if (found < 0 || !meshed_) return numbers;
  for (const int one : mesh_.lines[found].nodes) numbers.push_back(number_of(one));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<int> Drawing::with_unknown(std::vector<int> nodes, const std::string& unknown) const {
  if (entry_ == nullptr) return nodes;
  const auto of_structures = nodes_with_.find(unknown);
  std::set<int> have = of_structures != nodes_with_.end() ? of_structures->second : std::set<int>();
  const auto is_wanted = [&](const ElementUnknown& one) { return one.field.name == unknown; };
  if (const auto found = std::ranges::find_if(entry_->unknowns, is_wanted); found != entry_->unknowns.end()) {
    if (found->nodes.empty()) return nodes;
    const auto size = static_cast<std::size_t>(mesh_.nodes_per_element());
    for (const AreaMesh& area : mesh_.areas)
      for (std::size_t at = 0; at < area.nodes.size(); at += size)
        for (const int local : found->nodes)
          have.insert(number_of(area.nodes[at + static_cast<std::size_t>(local)]));
  }
  if (have.empty()) return nodes;  // the model builder says that no element has it
  std::erase_if(nodes, [&](int node) { return !have.contains(node); });
  return nodes;
}

std::vector<DrawnEdge> Drawing::edges_along(const toml::node& node, const toml::node* side) {
  const int found = find_line(node);
  std::vector<DrawnEdge> edges;
  if (found < 0 || !meshed_) return edges;
  const LineMesh& line = mesh_.lines[found];
  const bool any_left = std::ranges::any_of(line.segments, [](const LineSegment& s) { return s.left.there(); });
  const bool any_right =
      std::ranges::any_of(line.segments, [](const LineSegment& s) { return s.right.there(); });
  const std::string wanted = side != nullptr ? side->value_or(std::string()) : any_left ? "left" : "right";
  if (side == nullptr && any_left && any_right) {
    values_.error("S155", values_.where(node),
                  "line " + node.value_or(std::string()) +
                      " has ground on both sides: give the side, \"left\" or \"right\" of its direction");
    return {};
  }
  if (wanted != "left" && wanted != "right") {
    values_.error("S153", values_.where(*side), "the side is \"left\" or \"right\" of the line's direction");
    return {};
  }
  const bool left = wanted == "left";
  const auto step = static_cast<std::size_t>(mesh_.nodes_per_edge - 1);
  const std::vector<int>& nodes = left ? line.left : line.right;
  std::vector<double> at{0.0};  // length from the first point
  for (std::size_t s = 0; s < line.segments.size(); ++s) {
    const int a = nodes[s * step], b = nodes[(s + 1) * step];
    const bool known = a >= 0 && b >= 0;
    at.push_back(at.back() + (known ? (mesh_.x[b] - mesh_.x[a]).norm() : 0.0));
  }
  for (std::size_t s = 0; s < line.segments.size(); ++s) {
    const AreaEdge& edge = left ? line.segments[s].left : line.segments[s].right;
    if (!edge.there()) continue;
    // Counter-clockwise edges run along the line where the body is on its left, against it on its right.
    const double first = at[s] / at.back(), last = at[s + 1] / at.back();
    edges.push_back(
        {first_element_[edge.area] + edge.element, edge.edge + 1, left ? first : last, left ? last : first});
  }
  return edges;
}

}  // namespace sage::model_file

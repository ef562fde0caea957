// The drawing of a model file, [mesh], [points], [[line]], [[area]] and [[bar]], as nodes, groups and elements.  Not part of
// the public interface.
#pragma once

#include <map>
#include <optional>
#include <set>

#include "sage/model_file/values.hpp"
#include "sage/section/section_mesh.hpp"

namespace sage::model_file {

// Edge of an element, with its ends' places on the line that it was found by: 0 at its first point, 1 at its last.
struct DrawnEdge {
  int element = 0, edge = 0;  // numbers of the cards
  double first = 0.0, last = 1.0;
};

class Drawing {
 public:
  // Nodes, groups and elements count on from those numbers.
  Drawing(Values& values, translate::CardWriter& out, int last_material, int last_group, int last_node,
          int last_element)
      : values_(values),
        out_(out),
        material_(last_material),
        group_(last_group),
        node_(last_node),
        element_(last_element) {}

  // Draws, meshes, and adds the cards.  Names of lines and areas become those of groups.
  void add(const toml::table& root);

  // Where a point is, by name.  None, and an error, where there is none of that name.
  std::optional<Vector2> point_at(const toml::node& point);
  // Numbers of the nodes at a point or along a line, by name.  Empty, and an error, where there is none.
  std::vector<int> nodes_at(const toml::node& point);
  std::vector<int> nodes_along(const toml::node& line);
  // Of those nodes the ones that have this unknown: of a lining with joints, the lining's have rotations, the ground's none.
  std::vector<int> with_unknown(std::vector<int> nodes, const std::string& unknown) const;
  // Edges of bodies along a line, on its left, its right, or the only side where there are any.
  std::vector<DrawnEdge> edges_along(const toml::node& line, const toml::node* side);

  // Numbers of the groups of interfaces that have this group's area on their side: they go with it.
  std::vector<int> joints_beside(int group) const;

  static bool is_drawn(const toml::table& root);

 private:
  struct Interface {
    InterfaceSide side = InterfaceSide::none;
    int material = 0;  // number; 0: by the factor
    double factor = 0.0, thickness = 0.0;
    const toml::node* at = nullptr;
  };
  struct Line {
    std::string name;
    int beam_material = 0, bar_material = 0;
    Interface interface;
    const toml::table* at = nullptr;
  };

  void read_mesh(const toml::table& root);
  void read_points(const toml::table& root);
  void check_shape(const toml::table& line, LineShape shape);
  void read_lines(const toml::table& root);
  void read_areas(const toml::table& root);
  Interface read_interface(const toml::node& node);
  Outline read_outline(const toml::node& node);
  int point_of(const toml::node& node);  // a name, or [x, y]
  // Index of what has this name; -1, and an error, where there is none.
  int find_point(const toml::node& name);
  int find_line(const toml::node& name);
  bool mesh_it();
  void add_node(int node, const SourcePosition& where);
  void add_areas();
  void add_lines();
  void add_bars(const toml::table& root);
  void add_structure(const Line& line, const LineMesh& mesh);
  void add_interfaces(const Line& line, const LineMesh& mesh, bool left);
  std::set<std::pair<int, int>> sides_along(const LineMesh& mesh) const;
  void add_arc(const SectionLine& line, const LineMesh& mesh);
  int interface_material(const Line& line, int area);
  // A group's card and its elements' cards, `size` nodes each.
  int add_group(const std::string& name, const std::string& of, double element, int formulation, int material,
                const SourcePosition& where, int second_material = 0);
  void add_element(int group, const std::vector<int>& nodes, const SourcePosition& where);
  int number_of(int node) const { return node_ + 1 + node; }
  SourcePosition place_of(SectionItem item, int index) const;

  Values& values_;
  translate::CardWriter& out_;
  int material_, group_, node_, element_;
  Section section_;
  MeshSettings settings_;
  SectionMesh mesh_;
  bool meshed_ = false;
  double element_code_ = 0.0, formulation_ = 0.0;
  const ElementEntry* entry_ = nullptr;
  std::map<std::string, int> points_, line_index_;
  std::vector<Line> lines_;
  std::vector<const toml::table*> areas_;
  std::vector<int> area_material_, area_second_material_, area_group_, first_element_;  // by area
  std::map<std::string, std::set<int>> nodes_with_;        // of structures, by the name of an unknown
  std::map<std::string, std::vector<int>> joints_beside_;  // groups by name of the area
  std::map<std::pair<std::string, int>, int>
      joint_materials_;  // made by a factor, by line and material of the ground
  const toml::table* mesh_at_ = nullptr;
};

}  // namespace sage::model_file

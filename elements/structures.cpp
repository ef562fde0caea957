// Catalogue entries of bars, springs, rings and beams.
#include <utility>

#include "elements/bar.hpp"
#include "elements/beam.hpp"
#include "elements/beam_halves.hpp"
#include "elements/entries.hpp"

namespace sage {

namespace {

UnknownField rotation(std::string name) {
  UnknownField field{.name = std::move(name), .load = "moment", .load_dimension = Dimension::moment};
  field.balanced = false;  // forces have moments too
  field.turns = true;
  return field;
}

// Ends, then the middle node.
ElementEntry line_entry(ElementEntry entry, int nodes, int law_size) {
  entry.kind = ElementKind::structure;
  entry.shape = ParentShape::line;
  entry.nodes = entry.card_nodes = nodes;
  entry.corners = 2;
  entry.law_size = law_size;
  entry.parent_nodes = {{-1.0, 0.0}, {1.0, 0.0}};
  if (nodes == 3) entry.parent_nodes.push_back({0.0, 0.0});
  entry.vtk = nodes == 3 ? ForeignElement<int>{21, {}} : ForeignElement<int>{3, {}};
  return entry;
}

template <auto force_at>
Choice with_force_at(Choice choice) {
  choice.formulation.force_at = force_at;
  return choice;
}

// Of a bar its nodes share a force by its shape functions.
template <class Line>
void bar_force_at(const NodeCoordinates& /*x*/, double xi, const Vector2& force, std::span<double> f) {
  const Vector<Line::nodes> N = Line::N(xi);
  for (int i = 0; i < Line::nodes; ++i) Vector2::Map(f.data() + 2 * i) += N(i) * force;
}

template <template <class> class Made>
Choice in_both(Formulation formulation, std::string_view full_name, int points) {
  formulation.points = points;
  return {std::move(formulation), [full_name](Geometry geometry) -> std::unique_ptr<Element> {
            if (geometry == Geometry::plane_strain) return std::make_unique<Made<PlaneStrain>>(full_name);
            return std::make_unique<Made<Axisymmetric>>(full_name);
          }};
}

template <class Kinematics>
using Bar2 = Bar<Line2, Kinematics>;
template <class Kinematics>
using Bar3 = Bar<Line3, Kinematics>;

constexpr const char* kBeamSummary = "beam that shears, a wall or lining; in axisymmetry a shell of revolution";

template <Release released>
struct Released {
  template <class Kinematics>
  using Two = Beam2<Kinematics, released>;
  template <class Kinematics>
  using Three = Beam3<Kinematics, released>;
  template <class Kinematics>
  using Halves = BeamHalves<Kinematics, released>;
};

template <Release released = Release::none>
Choice beam2_choice(std::string_view full_name) {
  return with_force_at<Beam2<PlaneStrain, released>::force_at>(in_both<Released<released>::template Two>(
      {1, "exact", "exact at its nodes for one section and even loads; results at both ends"}, full_name, 3));
}
template <Release released = Release::none>
std::vector<Choice> beam3_choices(std::string_view full_name, std::string_view halves_name) {
  Choice halves =
      with_force_at<BeamHalves<PlaneStrain, released>::force_at>(in_both<Released<released>::template Halves>(
          {2, "halves", "two beam2 in a row, for every section that may yield"}, halves_name, 6));
  halves.formulation.yields = true;
  return {with_force_at<Beam3<PlaneStrain, released>::force_at>(in_both<Released<released>::template Three>(
              {1, "reduced", "two Gauss points: does not lock; may be curved"}, full_name, 2)),
          std::move(halves)};
}

// Displacement and rotation of every node.
ElementEntry beam(ElementEntry entry, int nodes) {
  entry = line_entry(std::move(entry), nodes, 5);
  entry.unknowns = {{displacement_field()}, {rotation("rotation")}};
  return entry;
}

// The same, but at node 1 a rotation of its own.
ElementEntry hinged(ElementEntry entry, int nodes) {
  entry = beam(std::move(entry), nodes);
  std::vector<int> others;
  for (int i = 1; i < nodes; ++i) others.push_back(i);
  entry.unknowns = {{displacement_field()}, {rotation("hinge_rotation"), {0}}, {rotation("rotation"), others}};
  return entry;
}

// A rotation of its own at either end: neighbours at one end don't share that of neighbours at another.
ElementEntry pinned(ElementEntry entry, int nodes) {
  entry = beam(std::move(entry), nodes);
  entry.unknowns = {
      {displacement_field()}, {rotation("hinge_rotation"), {0}}, {rotation("hinge_rotation_2"), {1}}};
  if (nodes == 3) entry.unknowns.push_back({rotation("rotation"), {2}});
  return entry;
}

// The first end parts from its node along the line or across it: a motion against the node, and no force.
ElementEntry slipping(ElementEntry entry, int nodes, std::string unknown) {
  entry = beam(std::move(entry), nodes);
  UnknownField slip{std::move(unknown), Dimension::length, "force", Dimension::force};
  slip.balanced = false;
  entry.unknowns.push_back({std::move(slip), {0}});
  return entry;
}

}  // namespace

ElementEntry bar2_entry() {
  ElementEntry entry =
      line_entry({.name = "bar2", .summary = "bar of two nodes: strut, anchor, tie, geotextile"}, 2, 1);
  return element_entry(std::move(entry),
                       {with_force_at<bar_force_at<Line2>>(in_both<Bar2>(
                           {1, "one point", "exact for a straight bar of one section"}, "bar2", 1))});
}

ElementEntry bar3_entry() {
  ElementEntry entry =
      line_entry({.name = "bar3", .summary = "bar of three nodes, beside eight-node elements"}, 3, 1);
  return element_entry(std::move(entry), {with_force_at<bar_force_at<Line3>>(in_both<Bar3>(
                                             {1, "two points", "linear strain; may be curved"}, "bar3", 2))});
}

ElementEntry spring2_entry() {
  ElementEntry entry =
      line_entry({.name = "spring2", .summary = "spring between two nodes, along the line between them"}, 2, 1);
  entry.extends = true;
  return element_entry(
      std::move(entry),
      {in_both<Spring>({1, "one point", "the stiffness is a force per length"}, "spring2", 1)});
}

ElementEntry ring1_entry() {
  ElementEntry entry = line_entry(
      {.name = "ring1", .summary = "bar around the axis of symmetry through one node (waling, hoop)"}, 2, 1);
  entry.nodes = entry.card_nodes = entry.corners = 1;
  entry.parent_nodes = {{0.0, 0.0}};
  entry.vtk = {1, {}};
  Formulation formulation{1, "one point", "hoop strain of its node", 1};
  return element_entry(std::move(entry), {{formulation, [](Geometry geometry) -> std::unique_ptr<Element> {
                                             if (geometry != Geometry::axisymmetric)
                                               throw ParameterError(
                                                   "S210", -1,
                                                   "ring1 is for axisymmetry: it runs around the axis");
                                             return std::make_unique<Ring>("ring1");
                                           }}});
}

ElementEntry beam2_entry() {
  return element_entry(beam({.name = "beam2", .summary = kBeamSummary}, 2), {beam2_choice("beam2")});
}

ElementEntry beam3_entry() {
  return element_entry(beam({.name = "beam3", .summary = kBeamSummary}, 3),
                       beam3_choices("beam3", "beam3 halves"));
}

ElementEntry beam2_hinged_entry() {
  return element_entry(hinged({.name = "beam2_hinged", .summary = "beam2 with a hinge at its first node"}, 2),
                       {beam2_choice("beam2_hinged")});
}

ElementEntry beam3_hinged_entry() {
  return element_entry(hinged({.name = "beam3_hinged", .summary = "beam3 with a hinge at its first node"}, 3),
                       beam3_choices("beam3_hinged", "beam3_hinged halves"));
}

ElementEntry beam2_pinned_entry() {
  return element_entry(pinned({.name = "beam2_pinned", .summary = "beam2 with a hinge at both ends"}, 2),
                       {beam2_choice("beam2_pinned")});
}

ElementEntry beam3_pinned_entry() {
  return element_entry(pinned({.name = "beam3_pinned", .summary = "beam3 with a hinge at both ends"}, 3),
                       beam3_choices("beam3_pinned", "beam3_pinned halves"));
}

ElementEntry beam2_axial_release_entry() {
  return element_entry(
      slipping({.name = "beam2_axial_release",
                .summary = "beam2 whose first end slides along its line: no axial force there"},
               2, "axial_slip"),
      {beam2_choice<Release::axial>("beam2_axial_release")});
}

ElementEntry beam3_axial_release_entry() {
  return element_entry(
      slipping({.name = "beam3_axial_release",
                .summary = "beam3 whose first end slides along its line: no axial force there"},
               3, "axial_slip"),
      beam3_choices<Release::axial>("beam3_axial_release", "beam3_axial_release halves"));
}

ElementEntry beam2_shear_release_entry() {
  return element_entry(
      slipping({.name = "beam2_shear_release",
                .summary = "beam2 whose first end slides across its line: no shear force there"},
               2, "shear_slip"),
      {beam2_choice<Release::shear>("beam2_shear_release")});
}

ElementEntry beam3_shear_release_entry() {
  return element_entry(
      slipping({.name = "beam3_shear_release",
                .summary = "beam3 whose first end slides across its line: no shear force there"},
               3, "shear_slip"),
      beam3_choices<Release::shear>("beam3_shear_release", "beam3_shear_release halves"));
}

ElementEntry rotational_spring1_entry() {
  ElementEntry entry =
      line_entry({.name = "rotational_spring1", .summary = "rotational spring of a hinge, at one node"}, 2, 5);
  entry.nodes = entry.card_nodes = entry.corners = 1;
  entry.parent_nodes = {{0.0, 0.0}};
  entry.vtk = {1, {}};
  entry.unknowns = {{displacement_field()}, {rotation("rotation")}, {rotation("hinge_rotation")}};
  return element_entry(std::move(entry),
                       {in_both<RotationalSpring>({1, "one point", "the stiffness is a moment per radian"},
                                                  "rotational_spring1", 1)});
}

}  // namespace sage

// The rows of the program itself.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sage/core/field.hpp"
#include "sage/core/spaced_members.hpp"

namespace sage {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// In the plane: centre and radius of Mohr's circle, and the angle of the larger compression to +x (radians, in
// (-pi/2, pi/2]).  Rounding beside the stress itself must not turn it: 0 where all directions are the same.
struct Circle {
  const Vector4& stress;
  double centre, radius;
  explicit Circle(const Vector4& s)
      : stress(s), centre(0.5 * (s[0] + s[1])), radius(std::hypot(0.5 * (s[0] - s[1]), s[3])) {}
  double major() const { return centre + radius; }
  double minor() const { return centre - radius; }
  // Apart: it takes longer than all else.
  double angle() const {
    const double rounding = 1e-10 * stress.cwiseAbs().maxCoeff();
    const auto rounded = [&](double x) { return std::abs(x) > rounding ? x : 0.0; };
    return 0.5 * std::atan2(rounded(2.0 * stress[3]), rounded(stress[0] - stress[1]));
  }
};

void principal(const Vector4& s, double* value) {
  const Circle plane(s);
  value[0] = plane.major();
  value[1] = plane.minor();
  value[2] = s[2];
  std::sort(value, value + 3, std::greater<>());
}

void direction(double x, double y, double z, double* value) {
  value[0] = x;
  value[1] = y;
  value[2] = z;
}

// Unit vectors along the largest and the smallest compression.  They have no sense: x (then y) is not negative.
void direction_1(const Vector4& s, double* value) {
  const Circle plane(s);
  const double angle = plane.angle();
  if (s[2] > plane.major())
    direction(0.0, 0.0, 1.0, value);
  else
    direction(std::cos(angle), std::sin(angle), 0.0, value);
}

void direction_3(const Vector4& s, double* value) {
  const Circle plane(s);
  const double angle = plane.angle();
  if (s[2] < plane.minor())
    direction(0.0, 0.0, 1.0, value);
  else if (angle <= 0.0)
    direction(0.0 - std::sin(angle), std::cos(angle), 0.0, value);
  else
    direction(std::sin(angle), -std::cos(angle), 0.0, value);
}

double deviator(const Vector4& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * s[3] * s[3]);
}

double stress_level(const PointView& point) {
  return std::visit(
      [&]<int N>(const Law<N>* law) {
        return law->stress_level(Vector<N>::Map(point.sigma.data()), point.history);
      },
      point.law);
}

// From the history where the law keeps it there; an elastic law of one stiffness has none.
void plastic_strain(const PointView& point, double* value) {
  const auto [quantities, linear] = std::visit(
      [](const auto* law) {
        return std::pair{law->traits().history, has_constant_stiffness(*law)};
      },
      point.law);
  value[0] = value[1] = linear ? 0.0 : kNone;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i].role == QuantityRole::plastic_shear_strain) value[0] = point.history[i];
    if (quantities[i].role == QuantityRole::plastic_volume_strain) value[1] = 0.0 - point.history[i];
  }
}

// Components of a solid; labels over columns of people.
std::vector<FieldComponent> tensor(const char* normal, const char* shear) {
  const auto of = [](const std::string& name, const std::string& plane, const std::string& ring) {
    return FieldComponent{name, {plane, ring}};
  };
  const std::string n = normal, s = shear;
  return {of("xx", n + "-x", n + "-r"), of("yy", n + "-y", n + "-z"), of("zz", n + "-z", n + "-hoop"),
          of("xy", s + "-xy", s + "-rz")};
}

std::vector<FieldComponent> along(const std::string& label) {
  return {{"x", {label + "-x", label + "-r"}}, {"y", {label + "-y", label + "-z"}}};
}

void add_node_fields(std::vector<FieldEntry>& rows) {
  rows.push_back({.name = "displacement",
                  .meaning = "displacement",
                  .dimension = Dimension::length,
                  .value = DisplacementField{[](const Vector2& u, double* v) { Vector2::Map(v) = u; }},
                  .components = along("u"),
                  .shape = FieldShape::vector,
                  .sign = FieldSign::along_axes,
                  .from_start = true,
                  .columns = {"ux", "uy"},
                  .symbol = "u"});
  rows.push_back({.name = "external_force",
                  .meaning = "load",
                  .dimension = Dimension::force,
                  .value = NodeField{[](const NodeView& n, double* v) { Vector2::Map(v) = n.load; }},
                  .components = along("load"),
                  .shape = FieldShape::vector,
                  .sign = FieldSign::along_axes,
                  .columns = {"load_x", "load_y"}});
  rows.push_back({.name = "reaction",
                  .meaning = "reaction of supports",
                  .dimension = Dimension::force,
                  .value = NodeField{[](const NodeView& n, double* v) { Vector2::Map(v) = n.reaction; }},
                  .components = along("react"),
                  .shape = FieldShape::vector,
                  .sign = FieldSign::along_axes,
                  .optional = true});
  rows.push_back({.name = "node",
                  .meaning = "number of the node",
                  .value = NodeField{[](const NodeView& n, double* v) { *v = n.number; }},
                  .form = FieldForm::integer});
}

void add_stress_fields(std::vector<FieldEntry>& rows) {
  constexpr auto kCompression = FieldSign::compression_positive;
  rows.push_back({.name = "stress",
                  .meaning = "stress",
                  .dimension = Dimension::stress,
                  .value = StressField{[](const Vector4& s, double* v) { Vector4::Map(v) = s; }},
                  .components = tensor("sig", "tau"),
                  .shape = FieldShape::tensor,
                  .sign = kCompression,
                  .symbol = "sigma"});
  rows.push_back({.name = "mean_stress",
                  .meaning = "mean stress p",
                  .dimension = Dimension::stress,
                  .value = StressField{[](const Vector4& s, double* v) { *v = (s[0] + s[1] + s[2]) / 3.0; }},
                  .sign = kCompression,
                  .symbol = "mean stress p"});
  rows.push_back({.name = "deviator",
                  .meaning = "deviator stress q",
                  .dimension = Dimension::stress,
                  .value = StressField{[](const Vector4& s, double* v) { *v = deviator(s); }},
                  .arrays = {"q"},
                  .symbol = "deviator q"});
  rows.push_back(
      {.name = "principal_stress",
       .meaning = "principal stress",
       .dimension = Dimension::stress,
       .value = StressField{principal},
       .components = {{"1", {"sig-1", "sig-1"}}, {"2", {"sig-2", "sig-2"}}, {"3", {"sig-3", "sig-3"}}},
       .sign = kCompression});
  rows.push_back({.name = "stress_difference",
                  .meaning = "sigma_1 - sigma_3",
                  .dimension = Dimension::stress,
                  .value = StressField{[](const Vector4& s, double* v) {
                    double all[3];
                    principal(s, all);
                    *v = all[0] - all[2];
                  }}});
  rows.push_back(
      {.name = "principal_angle",
       .meaning = "angle of the larger compression in the plane to the first axis",
       .dimension = Dimension::angle,
       .value = StressField{[](const Vector4& s, double* v) { *v = Circle(s).angle() / kRadiansPerDegree; }},
       .of_mean = true});
  for (const auto& [name, of] : {std::pair{"1", &direction_1}, std::pair{"3", &direction_3}})
    rows.push_back({.name = std::string("principal_direction_") + name,
                    .meaning = std::string("unit vector along sigma_") + name,
                    .value = StressField{of},
                    .components = {{"x"}, {"y"}, {"z"}},
                    .shape = FieldShape::vector,
                    .of_mean = true});
}

void add_strain_fields(std::vector<FieldEntry>& rows) {
  rows.push_back({.name = "strain",
                  .meaning = "strain",
                  .value = StrainField{[](const Vector4& e, double* v) { Vector4::Map(v) = e; }},
                  .components = tensor("eps", "gam"),
                  .shape = FieldShape::tensor,
                  .sign = FieldSign::compression_positive,
                  .from_start = true});
  rows.push_back(
      {.name = "plastic_strain",
       .meaning = "plastic strain",
       .value = PointField{plastic_strain},
       .components = {{"shear", {"eps-p-shear", "eps-p-shear"}}, {"volume", {"eps-p-vol", "eps-p-vol"}}},
       .sign = FieldSign::compression_positive,
       .kind = ElementKind::solid,
       .optional = true});
}

// 0.0 - : the program's tension + becomes compression +, and no -0.
void add_interface_fields(std::vector<FieldEntry>& rows) {
  rows.push_back({.name = "traction",
                  .meaning = "stress of interfaces",
                  .dimension = Dimension::stress,
                  .value = PointField{[](const PointView& p, double* v) {
                    for (std::size_t i = 0; i < 2; ++i) v[i] = 0.0 - p.sigma[i];
                  }},
                  .components = {{"shear"}, {"normal"}},
                  .sign = FieldSign::compression_positive,
                  .kind = ElementKind::interface,
                  .columns = {"shear", "normal"},
                  .arrays = {"interface_shear", "interface_normal"}});
  rows.push_back(
      {.name = "relative_displacement",
       .meaning = "relative displacement of interfaces",
       .dimension = Dimension::length,
       .value = PointField{[](const PointView& p, double* v) {
         for (std::size_t i = 0; i < 2; ++i) v[i] = 0.0 - p.eps[i];
       }},
       .components = {{"shear", {"rel.shear", "rel.shear"}}, {"normal", {"rel.normal", "rel.normal"}}},
       .sign = FieldSign::compression_positive,
       .kind = ElementKind::interface,
       .columns = {"relative_shear", "relative_normal"},
       .arrays = {"interface_relative_shear", "interface_relative_normal"}});
}

// A component of beams, whose laws have three or five; -1: those of three have none.
FieldEntry section_field(std::string name, std::string meaning, Dimension dimension, int of_three, int of_five,
                         double sign) {
  FieldEntry row;
  row.name = std::move(name);
  row.meaning = std::move(meaning);
  row.dimension = dimension;
  row.value = PointField{[=](const PointView& p, double* v) {
    const int at = p.sigma.size() == 5 ? of_five : of_three;
    *v = 0.0 + sign * p.sigma[at];
  }};
  if (sign < 0.0) row.sign = FieldSign::compression_positive;
  row.kind = ElementKind::structure;
  row.has_law = [of_three](LawRef law) {
    const int size = size_of_law(law);
    return size == 5 || (size == 3 && of_three >= 0);
  };
  row.optional = true;
  return row;
}

const SpacedMembers* spaced(LawRef law) {
  const auto* one = std::get_if<const Law<1>*>(&law);
  return one == nullptr ? nullptr : dynamic_cast<const SpacedMembers*>(*one);
}

// The axial force of one bar, where bars stand apart.
FieldEntry force_each() {
  FieldEntry row;
  row.name = "force_each";
  row.meaning = "axial force of one bar";
  row.dimension = Dimension::force;
  row.value =
      PointField{[](const PointView& p, double* v) { *v = 0.0 - p.sigma[0] * spaced(p.law)->spacing(); }};
  row.sign = FieldSign::compression_positive;
  row.kind = ElementKind::structure;
  row.has_law = [](LawRef law) { return spaced(law) != nullptr && spaced(law)->spacing() != 1.0; };
  row.optional = true;
  return row;
}

void add_structure_fields(std::vector<FieldEntry>& rows) {
  rows.push_back({.name = "axial_force",
                  .meaning = "axial force of structures",
                  .dimension = Dimension::force,
                  .value = PointField{[](const PointView& p, double* v) { *v = 0.0 - p.sigma[0]; }},
                  .sign = FieldSign::compression_positive,
                  .kind = ElementKind::structure});
  rows.push_back({.name = "axial_strain",
                  .meaning = "axial strain of structures",
                  .value = PointField{[](const PointView& p, double* v) { *v = 0.0 - p.eps[0]; }},
                  .sign = FieldSign::compression_positive,
                  .kind = ElementKind::structure});
  rows.push_back(section_field("shear_force", "shear force of beams", Dimension::force, 1, 2, 1.0));
  rows.push_back(section_field("bending_moment", "bending moment of beams", Dimension::moment, 2, 3, 1.0));
  rows.push_back(section_field("hoop_force", "hoop force of shells", Dimension::force, -1, 1, -1.0));
  rows.push_back(section_field("hoop_moment", "hoop moment of shells", Dimension::moment, -1, 4, 1.0));
  rows.push_back(force_each());
}

// What a law of water has is tension + as all is inside: the flow is against it.
void add_flow_fields(std::vector<FieldEntry>& rows) {
  rows.push_back({.name = "velocity",
                  .meaning = "velocity of water: volume per area and time",
                  .dimension = Dimension::velocity,
                  .value = PointField{[](const PointView& p, double* v) {
                    for (std::size_t i = 0; i < 2; ++i) v[i] = 0.0 - p.sigma[i];
                  }},
                  .components = {{"x", {"v-x", "v-r"}}, {"y", {"v-y", "v-z"}}},
                  .shape = FieldShape::vector,
                  .sign = FieldSign::along_axes,
                  .kind = ElementKind::flow});
  rows.push_back({.name = "hydraulic_gradient",
                  .meaning = "hydraulic gradient: fall of the head along x and y",
                  .value = PointField{[](const PointView& p, double* v) {
                    for (std::size_t i = 0; i < 2; ++i) v[i] = 0.0 - p.eps[i];
                  }},
                  .components = {{"x", {"i-x", "i-r"}}, {"y", {"i-y", "i-z"}}},
                  .shape = FieldShape::vector,
                  .sign = FieldSign::along_axes,
                  .kind = ElementKind::flow});
}

void pore_pressure(const PointView& p, double* v) {
  *v = p.pore_pressure;
}

void total_stress(const PointView& p, double* v) {
  Vector4::Map(v) = p.effective + p.pore_pressure * Vector4(1.0, 1.0, 1.0, 0.0);
}

void add_state_fields(std::vector<FieldEntry>& rows) {
  rows.push_back({.name = "stress_level",
                  .meaning = "stress level (1 = at strength)",
                  .value = PointField{[](const PointView& p, double* v) { *v = stress_level(p); }},
                  .optional = true,
                  .least = 0.0});
  rows.push_back(
      {.name = "status",
       .meaning = "state of the point (elastic, yielded, ...)",
       .value = PointField{[](const PointView& p, double* v) { *v = static_cast<double>(p.status); }},
       .form = FieldForm::word,
       .words = {"elastic", "unloading", "yielded", "slipping", "open", "apex", "cut_off"}});
  rows.push_back({.name = "yielded",
                  .meaning = "part of the points that yield, slip, are open, at the apex or cut off in tension",
                  .value = PointField{[](const PointView& p, double* v) {
                    *v = p.status == PointStatus::elastic || p.status == PointStatus::unloading ? 0.0 : 1.0;
                  }},
                  .least = 0.0});
}

void add_element_fields(std::vector<FieldEntry>& rows) {
  const auto number = [&](const char* name, int ElementView::*of) {
    rows.push_back({.name = name,
                    .meaning = std::string("number of the ") + name,
                    .value = ElementField{[of](const ElementView& e, double* v) { *v = e.*of; }},
                    .form = FieldForm::integer});
  };
  number("group", &ElementView::group);
  number("material", &ElementView::material);
  number("element", &ElementView::number);
}

// In the order of the columns of STEM.increments.csv.
void add_increment_fields(std::vector<FieldEntry>& rows) {
  using View = IncrementView;
  const auto add = [&](const char* name, const char* meaning, FieldForm form, bool optional, auto of,
                       Dimension dimension = Dimension::none) {
    rows.push_back(
        {.name = name,
         .meaning = meaning,
         .dimension = dimension,
         .value = IncrementField{[of](const View& i, double* v) { *v = static_cast<double>(of(i)); }},
         .form = form,
         .optional = optional});
  };
  constexpr auto kNumber = FieldForm::number, kInteger = FieldForm::integer;
  add("load_factor", "part of the stage applied", kNumber, false, [](const View& i) { return i.load_factor; });
  add("converged", "1: in equilibrium", kInteger, false, [](const View& i) { return i.converged ? 1 : 0; });
  add("iterations", "iterations, those of cut steps included", kInteger, false,
      [](const View& i) { return i.iterations; });
  add("relative_force", "unbalanced force / force scale", kNumber, true, [](const View& i) { return i.force; });
  add("relative_displacement_change", "correction / increment", kNumber, true,
      [](const View& i) { return i.displacement; });
  add("relative_energy", "energy / first energy", kNumber, true, [](const View& i) { return i.energy; });
  add("cuts", "halvings of the step", kInteger, false, [](const View& i) { return i.cuts; });
  add("substeps", "parts of the increment", kInteger, false, [](const View& i) { return i.substeps; });
  constexpr const char* kStates[] = {"elastic", "unloading", "yielded_points", "slipping",
                                     "open",    "apex",      "cut_off"};
  for (std::size_t k = 0; k < std::size(kStates); ++k)
    add(kStates[k], "integration points in that state", kInteger, false,
        [k](const View& i) { return i.points[k]; });
  add("worst_node", "node that is farthest from equilibrium", kInteger, true,
      [](const View& i) { return i.worst_node; });
  add("worst_component",
      "direction of the unbalanced force there (0 x or r, 1 y or z; 2 and up: the further unknowns)",
      FieldForm::word, true, [](const View& i) { return i.worst_component; });
  rows.back().words = {"x", "y"};
  add(
      "worst_residual", "unbalanced force at that node", kNumber, true,
      [](const View& i) { return i.worst_residual; }, Dimension::force);
  add("smallest_pivot_ratio", "smallest pivot / largest", kNumber, true,
      [](const View& i) { return i.pivot_ratio; });
  add("displacement_over_extent",
      "difference of displacements along an axis / the model's extent along it, so far; blank if the "
      "increment did not need all displacements",
      kNumber, true, [](const View& i) { return i.motion; });
  const auto name_in_csv = [&](const char* name, const char* column) {
    for (FieldEntry& row : rows)
      if (row.name == name) row.columns = {column};
  };
  name_in_csv("relative_displacement_change", "relative_displacement");
  name_in_csv("yielded_points", "yielded");
}

}  // namespace

std::vector<FieldEntry> water_fields() {
  std::vector<FieldEntry> rows;
  rows.push_back({.name = "pore_pressure",
                  .meaning = "pore pressure",
                  .dimension = Dimension::stress,
                  .value = PointField{pore_pressure},
                  .sign = FieldSign::compression_positive,
                  .kind = ElementKind::solid,
                  .symbol = "u"});
  rows.push_back({.name = "total_stress",
                  .meaning = "total stress: effective stress and pore pressure",
                  .dimension = Dimension::stress,
                  .value = PointField{total_stress},
                  .components = tensor("tot", "tot-tau"),
                  .shape = FieldShape::tensor,
                  .sign = FieldSign::compression_positive,
                  .kind = ElementKind::solid});
  return rows;
}

const std::vector<FieldEntry>& program_fields() {
  static const std::vector<FieldEntry> rows = [] {
    std::vector<FieldEntry> all;
    add_node_fields(all);
    add_stress_fields(all);
    add_strain_fields(all);
    add_interface_fields(all);
    add_structure_fields(all);
    add_flow_fields(all);
    add_state_fields(all);
    add_element_fields(all);
    add_increment_fields(all);
    return all;
  }();
  return rows;
}

}  // namespace sage

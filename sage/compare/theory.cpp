#include "sage/compare/theory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "materials/drucker_prager.hpp"

namespace sage::compare {

namespace {

double parameter(const Material& material, std::string_view name, double fallback) {
  const int i = material.entry->find(name);
  return i < 0 ? fallback : material.parameters[i];
}

bool is_solid(const Group& group) {
  return group.solid();
}

bool is_elastic(const Material& material) {
  return has_constant_stiffness(material.law_ref()) && material.parameter(ParameterRole::youngs_modulus) &&
         material.parameter(ParameterRole::poissons_ratio);
}

bool is_plastic(const Material& material) {
  return material.law_name == "drucker_prager" || material.law_name == "mohr_coulomb";
}

// Its closed forms are those of small strain.
bool small_strain(const Side& side) {
  return !side.model().large_strain;
}

bool plane(const Side& side) {
  return side.model().geometry == Geometry::plane_strain;
}

const char* name_of(const Side& side) {
  return plane(side) ? "plane strain" : "axisymmetry";
}

// The one material of all solids; null if there are several.
const Material* only_material(const Model& model) {
  const Material* found = nullptr;
  for (const Group& group : model.groups) {
    if (!is_solid(group)) continue;
    const Material* material = &model.material_of(group);
    if (found != nullptr && found != material) return nullptr;
    found = material;
  }
  return found;
}

const Face* find_face(const Side& side, std::string_view name) {
  for (const Face& face : side.faces())
    if (face.name == name) return &face;
  return nullptr;
}

// Part of a face's nodes that are held in a direction at the end.
double held_part(const Side& side, const Face& face, int component) {
  const Activity& activity = *side.last().activity;
  const auto count = std::count_if(face.nodes.begin(), face.nodes.end(),
                                   [&](int node) { return activity.holds(node, component); });
  return static_cast<double>(count) / static_cast<double>(face.nodes.size());
}

enum class Lateral { free, confined, other };

Lateral lateral_of(const Side& side) {
  const Face* right = find_face(side, "right");
  const double held = held_part(side, *right, 0);
  const Face* left = find_face(side, "left");
  if (held == 1.0 && (left == nullptr || held_part(side, *left, 0) == 1.0)) return Lateral::confined;
  const double ends = 2.0 / static_cast<double>(right->nodes.size());  // its corners may belong to rough ends
  return held <= ends ? Lateral::free : Lateral::other;
}

// Supports or interfaces keep an end from widening.
bool restrained_ends(const Side& side) {
  for (const Group& group : side.model().groups)
    if (!is_solid(group)) return true;
  for (const char* name : {"bottom", "top"}) {
    const Face* face = find_face(side, name);
    const double one = 1.0 / static_cast<double>(face->nodes.size());  // the symmetry axis or a pin
    if (held_part(side, *face, 0) > one) return true;
  }
  return false;
}

double elastic_modulus(Geometry geometry, Lateral lateral, double E, double nu) {
  if (lateral == Lateral::confined) return E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  return geometry == Geometry::plane_strain ? E / (1.0 - nu * nu) : E;
}

// Change over a stage of what acts on a face's free nodes along its normal, by the face's area.  Node by node:
// pressures that cancel each other count, and so do those on a side without nodes between its ends.
double free_pressure_change(const Side& side, std::size_t stage, std::size_t face) {
  const FaceState &now = side.stages()[stage].faces[face], &before = side.stages()[stage].faces_before[face];
  double sum = 0.0;
  for (std::size_t i = 0; i < now.normal_force.size(); ++i)
    if (!now.held[i]) sum += std::abs(now.normal_force[i] - before.normal_force[i]);
  return sum <= side.floors().force ? 0.0 : sum / side.faces()[face].area;
}

// All nodes of a face are held across it, as those of a plane of symmetry: it answers what the platens do to
// the rest of the model.
bool held_across(const FaceState& face) {
  return std::all_of(face.held.begin(), face.held.end(), [](char held) { return held != 0; });
}

// The pressure on the upright faces stays as it was over a stage, except where a whole face is held: that on
// nodes which are held judged without the faces' ends, where rough platens hold them.
bool lateral_pressure_constant(const Side& side, std::size_t stage) {
  const StageState& state = side.stages()[stage];
  double lateral = 0.0, axial = 0.0;
  for (std::size_t i = 0; i < state.faces.size(); ++i) {
    const Face& face = side.faces()[i];
    if (face.normal == 0 && held_across(state.faces[i])) continue;
    const Vector2 change = state.faces[i].inner_force - state.faces_before[i].inner_force;
    double stress = std::abs(change[face.normal]) / face.area;
    if (face.normal == 0) stress = std::max(stress, free_pressure_change(side, stage, i));
    (face.normal == 0 ? lateral : axial) = std::max(face.normal == 0 ? lateral : axial, stress);
    if (face.normal == 1)
      axial = std::max(
          axial, std::abs(normal_stress(face, state.faces[i]) - normal_stress(face, state.faces_before[i])));
  }
  return lateral <= 1e-6 * axial;
}

// Both ends stay plane over a stage, as between platens or under an even pressure: not
// under forces on single nodes.
bool ends_stay_plane(const Side& side, std::size_t stage) {
  const StageState& state = side.stages()[stage];
  double spread = 0.0, moved = 0.0;
  for (std::size_t i = 0; i < state.faces.size(); ++i) {
    if (side.faces()[i].normal != 1) continue;
    spread = std::max({spread, state.faces[i].spread.y(), state.faces_before[i].spread.y()});
    moved = std::max(moved, std::abs(state.faces[i].displacement.y() - state.faces_before[i].displacement.y()));
  }
  return spread <= 1e-6 * moved;
}

// What is born, removed or made heavier within a stage strains the model beside its ends.
bool ends_alone_act(const Stage& stage) {
  return stage.births.empty() && stage.deaths.empty() && stage.gravity.isZero(0.0);
}

// The last stage that compresses or stretches the model evenly along y by its ends alone, under constant
// lateral pressure or none of lateral strain.
std::optional<std::size_t> straining_stage(const Side& side, Lateral lateral) {
  for (std::size_t s = side.stages().size(); s-- > 0;)
    if (ends_alone_act(side.model().stages[s]) && !std::isnan(apparent_modulus(side, s)) &&
        ends_stay_plane(side, s) && (lateral == Lateral::confined || lateral_pressure_constant(side, s)))
      return s;
  return std::nullopt;
}

struct Modulus {
  double expected = kUnknown, found = kUnknown;
  Lateral lateral = Lateral::other;
  bool restrained = false;
};

bool fills_box(const Side& side) {
  return std::all_of(side.faces().begin(), side.faces().end(),
                     [](const Face& face) { return face.whole && face.area > 0.0; });
}

std::optional<Modulus> modulus_of(const Side& side) {
  const Material* material = only_material(side.model());
  if (!fills_box(side) || !small_strain(side)) return std::nullopt;
  if (material == nullptr || !is_elastic(*material)) return std::nullopt;
  Modulus m;
  m.lateral = lateral_of(side);
  const auto stage = straining_stage(side, m.lateral);
  if (m.lateral == Lateral::other || !stage) return std::nullopt;
  m.restrained = restrained_ends(side);
  m.expected = elastic_modulus(side.model().geometry, m.lateral,
                               material->parameter(ParameterRole::youngs_modulus).value(),
                               material->parameter(ParameterRole::poissons_ratio).value());
  m.found = apparent_modulus(side, *stage);
  return m;
}

std::string modulus_words(const Side& side, const Modulus& m) {
  const std::string base = m.lateral == Lateral::confined ? "no lateral strain: E(1-nu)/((1+nu)(1-2nu))"
                           : plane(side)                  ? "free lateral strain, eps_zz = 0: E/(1-nu^2)"
                                                          : "free lateral strain: E";
  return base +
         (m.restrained && m.lateral == Lateral::free ? "; the ends are restrained, which adds to it" : "");
}

void add_moduli(std::vector<Expectation>& list, const Side& a, const Side& b) {
  const auto ma = modulus_of(a), mb = modulus_of(b);
  for (const auto& [side, m] : {std::pair{&a, &ma}, std::pair{&b, &mb}})
    if (*m)
      list.push_back({fmt::format("apparent modulus, {} ({})", side == &a ? "A" : "B", name_of(*side)),
                      (*m)->expected, (*m)->found, side->model().units.stress, modulus_words(*side, **m)});
  if (ma && mb)
    list.push_back({"apparent modulus, B / A", mb->expected / ma->expected, mb->found / ma->found, "-",
                    ma->restrained || mb->restrained ? "ratio for frictionless ends; these are restrained"
                                                     : "ratio of the two closed forms"});
}

// What one point of the law answers in each geometry is the expectation for frictionless ends.
void add_triaxial(std::vector<Expectation>& list, const Side& a, const Side& b) {
  for (std::size_t i = 0; i < std::min(a.reports().count(), b.reports().count()); ++i) {
    const auto &ra = a.reports().triaxial(i), &rb = b.reports().triaxial(i);
    if (ra.empty() || rb.empty() || ra.back().stage != rb.back().stage ||
        ra.back().increment != rb.back().increment)
      continue;
    list.push_back({fmt::format("report {}: deviator at the end, B / A", i + 1),
                    rb.back().correct_deviator / ra.back().correct_deviator,
                    rb.back().measured_deviator / ra.back().measured_deviator, "-",
                    "one point of each law in its geometry, frictionless ends"});
  }
}

void add_strengths(std::vector<Expectation>& list, const Side& a, const Side& b) {
  double strength[2] = {kUnknown, kUnknown}, measured[2] = {kUnknown, kUnknown};
  const Side* sides[2] = {&a, &b};
  for (int k = 0; k < 2; ++k) {
    const Model& model = sides[k]->model();
    const Material* material = only_material(model);
    if (material == nullptr || !is_plastic(*material) || !small_strain(*sides[k])) return;
    for (std::size_t i = 0; i < model.reports.size(); ++i) {
      if (model.reports[i].kind != ReportKind::triaxial || sides[k]->reports().triaxial(i).empty()) continue;
      strength[k] = strength_deviator(*material, model.geometry, model.reports[i].cell_pressure);
      measured[k] = sides[k]->reports().triaxial(i).back().measured_deviator;
      break;
    }
    if (std::isnan(strength[k])) return;
    list.push_back({fmt::format("strength, {} ({})", k == 0 ? "A" : "B", name_of(*sides[k])), strength[k],
                    measured[k], model.units.stress,
                    std::isinf(strength[k])
                        ? "this cone has no limit in plane strain (sin phi* >= 1)"
                        : "deviator of a point at failure; reached where the whole specimen yields"});
  }
  if (std::isfinite(strength[0]) && std::isfinite(strength[1]))
    list.push_back({"strength, B / A", strength[1] / strength[0], measured[1] / measured[0], "-",
                    "Mohr-Coulomb: equal in both; Drucker-Prager: by the plane-strain match of its cone"});
}

void add_plane_strain(std::vector<Expectation>& list, const Side& a, const Side& b) {
  for (const Side* side : {&a, &b}) {
    if (!plane(*side)) continue;
    const double defect = plane_strain_defect(*side);
    if (std::isnan(defect)) continue;
    list.push_back({fmt::format("sigma_zz - nu(sigma_xx + sigma_yy), {}", side == &a ? "A" : "B"), 0.0, defect,
                    "-",
                    "changes since the start, elastic plane strain; largest, by the largest stress change"});
  }
}

}  // namespace

PlaneStrainStrength plane_strain_strength(double alpha, double k, double beta) {
  const double root = std::sqrt(std::max(0.0, 1.0 - 3.0 * beta * beta)), below = 1.0 - 3.0 * alpha * beta;
  const double sine = 3.0 * alpha * root / below;
  if (!(sine < 1.0 - 1e-12)) return {kUnknown, kUnknown};
  const double phi = std::asin(sine);
  return {phi, k * root / below / std::cos(phi)};
}

double strength_deviator(const Material& material, Geometry geometry, double sigma3) {
  if (!is_plastic(material)) return kUnknown;
  double c = parameter(material, "cohesion", 0.0),
         phi = parameter(material, "friction_angle", 0.0) * kRadiansPerDegree;
  if (material.law_name == "drucker_prager") {
    const auto match = static_cast<ConeMatch>(static_cast<int>(parameter(material, "cone", 1.0)));
    const Cone cone = match_cone(match, phi, c);
    const double psi = parameter(material, "dilation_angle", 0.0) * kRadiansPerDegree;
    const double beta = parameter(material, "flow", 0.0) == 1.0 ? 0.0 : match_cone(match, psi, 0.0).alpha;
    if (geometry == Geometry::axisymmetric) {
      // q/sqrt 3 = k + alpha (3 sigma3 + q)
      const double below = 1.0 / std::sqrt(3.0) - cone.alpha;
      return below > 0.0 ? (cone.k + 3.0 * cone.alpha * sigma3) / below
                         : std::numeric_limits<double>::infinity();
    }
    const PlaneStrainStrength strength = plane_strain_strength(cone.alpha, cone.k, beta);
    if (std::isnan(strength.phi)) return std::numeric_limits<double>::infinity();
    phi = strength.phi;
    c = strength.c;
  }
  const double N = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
  return sigma3 * (N - 1.0) + 2.0 * c * std::sqrt(N);
}

double apparent_modulus(const Side& side, std::size_t stage) {
  const StageState& state = side.stages()[stage];
  const Face *top = nullptr, *bottom = nullptr;
  std::size_t t = 0, b = 0;
  for (std::size_t i = 0; i < side.faces().size(); ++i) {
    if (side.faces()[i].name == "top") top = &side.faces()[t = i];
    if (side.faces()[i].name == "bottom") bottom = &side.faces()[b = i];
  }
  if (top == nullptr || bottom == nullptr || state.faces.empty()) return kUnknown;
  const auto moved = [&](std::size_t i) {
    return state.faces[i].displacement.y() - state.faces_before[i].displacement.y();
  };
  const double strain = (moved(b) - moved(t)) / top->length;
  if (std::abs(strain) < 1e-14) return kUnknown;
  const double stress = normal_stress(*top, state.faces[t]) - normal_stress(*top, state.faces_before[t]);
  return stress == 0.0 ? kUnknown : stress / strain;
}

bool uniform_ends(const Side& side, std::size_t stage) {
  return !side.stages()[stage].faces.empty() && fills_box(side) && ends_stay_plane(side, stage);
}

double plane_strain_defect(const Side& side) {
  const auto now = side.last().groups(), start = side.first().groups();
  double worst = kUnknown, size = 0.0;
  if (!small_strain(side)) return worst;
  for (std::size_t g = 0; g < now.size(); ++g) {
    const Material& material = side.model().material_of(*now[g].group);
    if (!now[g].active || !start[g].active || !is_solid(*now[g].group) || !is_elastic(material)) continue;
    const double nu = material.parameter(ParameterRole::poissons_ratio).value();
    const std::vector<double>&s1 = now[g].state.committed.sigma, &s0 = start[g].state.committed.sigma;
    for (std::size_t i = 0; i + 3 < s1.size(); i += 4) {
      const double dx = s1[i] - s0[i], dy = s1[i + 1] - s0[i + 1], dz = s1[i + 2] - s0[i + 2];
      const double defect = std::abs(dz - nu * (dx + dy));
      worst = std::isnan(worst) ? defect : std::max(worst, defect);
      size = std::max({size, std::abs(dx), std::abs(dy), std::abs(dz)});
    }
  }
  return size > 0.0 ? worst / size : kUnknown;
}

namespace {

// The same file, geometry and laws: only the numerics differ.
bool same_problem(const Side& a, const Side& b) {
  const Model &ma = a.model(), &mb = b.model();
  if (ma.file != mb.file || ma.geometry != mb.geometry || ma.materials.size() != mb.materials.size())
    return false;
  for (std::size_t i = 0; i < ma.materials.size(); ++i)
    if (ma.materials[i].law_name != mb.materials[i].law_name ||
        ma.materials[i].parameters != mb.materials[i].parameters)
      return false;
  return true;
}

// All nodes of a report, and no others, on the top or the bottom.
bool reports_an_end(const Side& side, const Report& report) {
  for (const char* name : {"top", "bottom"}) {
    const Face* face = find_face(side, name);
    if (face == nullptr || face->nodes.size() != report.nodes.size()) continue;
    std::vector<int> nodes = report.nodes;
    std::sort(nodes.begin(), nodes.end());
    if (std::equal(nodes.begin(), nodes.end(), face->nodes.begin())) return true;
  }
  return false;
}

// Evenly strained elastic bodies: the stress of an end by the ratio of the moduli where its displacement is
// given, the displacement by its inverse where its load is.
ExpectedRatio elastic_ratio(const Side& a, const Side& b, std::size_t i, bool force) {
  const auto ma = modulus_of(a), mb = modulus_of(b);
  const Side* sides[2] = {&a, &b};
  double area[2] = {0.0, 0.0};
  for (std::size_t k = 0; k < 2; ++k) {
    const Side& side = *sides[k];
    const Report& report = side.model().reports[i];
    const Model& model = side.model();
    const bool from_nothing = model.stages.size() == 1 && model.initials.empty() &&
                              model.stages[0].initials.empty() && model.stages[0].gravity.isZero(0.0);
    if (!from_nothing || !reports_an_end(side, report)) return {kUnknown, ""};
    const Face* face = find_face(side, "top");
    const bool held = held_part(side, *face, 1) == 1.0;
    if (held != force) return {kUnknown, ""};  // what is given is no answer
    area[k] = face->area;
  }
  if (!ma || !mb || ma->restrained || mb->restrained) return {kUnknown, ""};
  const double moduli = mb->expected / ma->expected;
  if (!force) return {1.0 / moduli, "uniform elastic bodies under the same pressure: ratio of the moduli"};
  return {moduli * area[1] / area[0], "uniform elastic bodies under the same strain: ratio of moduli x areas"};
}

}  // namespace

ExpectedRatio expected_ratio(const Side& a, const Side& b, std::size_t report, const std::string& column) {
  const ExpectedRatio nothing{kUnknown, "nothing is known"};
  if (!a.has_state() || !b.has_state()) return nothing;
  if (same_problem(a, b)) return {1.0, "the same problem: equal up to the error of the meshes"};
  const ReportKind kind = a.model().reports[report].kind;
  if (kind == ReportKind::triaxial && column == "measured_deviator") {
    const auto &ra = a.reports().triaxial(report), &rb = b.reports().triaxial(report);
    const double ratio =
        ra.empty() || rb.empty() ? kUnknown : rb.back().correct_deviator / ra.back().correct_deviator;
    const bool restrained = restrained_ends(a) || restrained_ends(b);
    if (!std::isfinite(ratio)) return nothing;
    constexpr double kSame = 1e-8;  // strains of two runs differ by rounding
    const double ea = ra.back().axial_strain, eb = rb.back().axial_strain;
    if (std::abs(eb - ea) > kSame * std::abs(ea)) return nothing;
    return {ratio, restrained ? "one point of each law: for frictionless ends, these are restrained"
                              : "one point of each law, frictionless ends"};
  }
  if (kind == ReportKind::nodes && (column == "fy" || column == "uy")) {
    const ExpectedRatio elastic = elastic_ratio(a, b, report, column == "fy");
    if (std::isfinite(elastic.value)) return elastic;
  }
  return nothing;
}

std::vector<Expectation> expectations(const Side& a, const Side& b) {
  std::vector<Expectation> list;
  if (!a.has_state() || !b.has_state()) return list;
  add_plane_strain(list, a, b);
  add_moduli(list, a, b);
  add_triaxial(list, a, b);
  add_strengths(list, a, b);
  return list;
}

}  // namespace sage::compare

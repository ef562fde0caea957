// What was read: the part of the listing before the first stage.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "sage/analysis/dogleg.hpp"
#include "sage/model/spread_loads.hpp"
#include "sage/record/listing_parts.hpp"
#include "sage/record/number.hpp"
#include "sage/record/output.hpp"

namespace sage::listing {

namespace {

void row_of_stars(std::string& text) {
  fmt::format_to(to(text), " {:*<98}\n", "");
}

void boxed(std::string& text, std::string_view line) {
  fmt::format_to(to(text), " *  {:<92}  *\n", line);
}

void parameter(std::string& text, const Model& model, const Material& material, const MaterialEntry* entry,
               std::size_t i) {
  const bool given = i < material.parameters.size();
  const Parameter* p = entry != nullptr && i < entry->parameters.size() ? &entry->parameters[i] : nullptr;
  const double value = given ? material.parameters[i] : p->fallback;
  const std::string name = p != nullptr ? p->name : "parameter " + std::to_string(i + 1);
  fmt::format_to(to(text), "     {:<28}", name);
  std::string number;
  append_plain(number, value, 8);
  fmt::format_to(to(text), "{:>14} {:<12} {}{}\n", number,
                 p != nullptr ? unit_text(p->dimension, model.units) : "", p != nullptr ? p->meaning : "",
                 given ? "" : " (not given: default)");
}

template <class Card>
std::size_t fixity_count(const std::vector<Card>& fixities, FixityCode code) {
  std::size_t count = 0;
  for (const Card& f : fixities)
    for (FixityCode c : f.code) count += c == code ? 1u : 0u;
  return count;
}

std::string group_numbers(const Model& model, const std::vector<int>& groups) {
  std::string text;
  for (int g : groups) text += (text.empty() ? "" : ", ") + std::to_string(model.groups[g].number);
  return text;
}

// "name value, name value", by a list of names.
std::string named(std::initializer_list<std::string_view> names, const double* values) {
  std::string text;
  for (const std::string_view name : names)
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", name, *values++ + 0.0);
  return text;
}

std::string parameter_text(const Model& model, const double* v) {
  std::string text = fmt::format("parameter {:.0f} grows", v[0]);
  if (v[2] != 0.0)
    text += fmt::format(" with depth below {:.6g} by {:.6g} each {}", v[1], v[2], model.units.length);
  if (v[3] != 0.0)
    text += fmt::format("{} by {:.6g} times the effective vertical stress of the start",
                        v[2] != 0.0 ? ", and" : "", v[3]);
  return text;
}

std::string initial_text(const Model& model, const Group& group, const InitialStress& initial) {
  const double* const v = initial.value.data();
  switch (initial.kind) {
    case InitialKind::uniform:
      if (group.interface()) return named({"shear", "normal"}, v);
      if (!group.structure()) return named({"xx", "yy", "zz", "xy"}, v);
      if (group.entry->law_size == 1) return named({"axial force"}, v);
      if (group.entry->law_size == 3) return named({"axial force", "shear force", "moment"}, v);
      return named({"axial force", "hoop force", "shear force", "moment", "hoop moment"}, v);
    case InitialKind::geostatic:
      return named({"geostatic: surface", "unit weight", "K0", "stress at the surface"}, v);
    case InitialKind::at_rest:
      return named({"at rest: K0 at OCR 1", "OCR", "POP", "stress at the surface"}, v);
    case InitialKind::zero:
      return "none";
    case InitialKind::traction:
      return fmt::format("traction of the initial stress of group {:.0f}", v[0]);
    case InitialKind::lock_off:
      return named({"force of one bar at the end of the stage"}, v);
    case InitialKind::material:
      return fmt::format("goes on with material {:.0f}, its stress stays", v[0]);
    case InitialKind::parameter:
      return parameter_text(model, v);
    case InitialKind::history:
      break;
  }
  std::string text = fmt::format("history from quantity {:.0f} on:", v[0]);
  for (std::size_t i = 1; i < initial.value.size() && !std::isnan(v[i]); ++i)
    text += fmt::format(" {:.6g}", v[i]);
  return text;
}

std::string water_text(const Model& model, const WaterCard& card) {
  std::string text;
  switch (card.kind) {
    case WaterKind::dry:
      return "none";
    case WaterKind::line:
      text = "phreatic line";
      for (const Vector2& x : card.line) text += fmt::format(" ({:.6g}, {:.6g})", x.x(), x.y());
      break;
    case WaterKind::drawdown:
      text = fmt::format("rapid drawdown, B-bar {:.6g}, to", card.value);
      for (const Vector2& x : card.line) text += fmt::format(" ({:.6g}, {:.6g})", x.x(), x.y());
      break;
    case WaterKind::ratio:
      return fmt::format("r_u {:.6g}", card.value);
    case WaterKind::nodes:
      text = fmt::format("pressures at {} nodes", card.nodes.size());
      break;
    case WaterKind::heads:
      text = "from the heads at the start of the stage";
      break;
    case WaterKind::undrained:
      return fmt::format("undrained, bulk modulus over porosity {:.6g} {}", card.value, model.units.stress);
    case WaterKind::drained:
      return "drained, what was undrained lets its excess go";
  }
  if (card.group >= 0 && model.groups[card.group].structure())
    return text + (card.value > 0.0 ? ", left side" : card.value < 0.0 ? ", right side" : ", both sides");
  if (card.action == WaterAction::none) text += ", none at free edges";
  if (card.action == WaterAction::force) text += ", as seepage force and buoyancy";
  return text;
}

// A long line goes on indented.
void wrapped(std::string& text, std::string line) {
  constexpr std::size_t kWidth = 97;
  while (line.size() > kWidth) {
    std::size_t at = line.rfind(' ', kWidth);
    if (at == std::string::npos || at < 8) break;
    text += line.substr(0, at) + '\n';
    line = "        " + line.substr(at + 1);
  }
  text += line + '\n';
}

// Prestress, initial stress and water that begin with a stage.
void states_of_stage(std::string& text, const Model& model, int index) {
  const auto name = [&](int g) {
    const Group& group = model.groups[g];
    return fmt::format("group {}{}{}", group.number, group.name.empty() ? "" : " ", group.name);
  };
  const auto initial = [&](const InitialStress& card) {
    const Group& group = model.groups[card.group];
    const char* const what = card.kind == InitialKind::lock_off                       ? "lock-off"
                             : is_about_law(card.kind)                                ? "law"
                             : group.structure() && card.kind == InitialKind::uniform ? "prestress"
                                                                                      : "initial stress";
    wrapped(text, fmt::format("   {}, {}: {}", what, name(card.group), initial_text(model, group, card)));
  };
  if (index == 0) std::ranges::for_each(model.initials, initial);
  std::ranges::for_each(stage_of(model, index).initials, initial);
  for (const WaterCard& card : model.water)
    if (card.stage == index)
      wrapped(text, fmt::format("   water, {}: {}", card.group < 0 ? "all solids" : name(card.group),
                                water_text(model, card)));
}

// Dimension of a weight on a material's card, as its law counts it.
std::string weight_unit(const Material& material, const UnitSystem& units) {
  if (material.entry != nullptr && material.entry->flow) return unit_text(Dimension::unit_weight, units);
  const int size = size_of_law(material.law_ref());
  if (size == 1) return units.force + "/" + units.length;
  if ((size == 3 || size == 5) && !material.parameter(ParameterRole::thickness))
    return units.force + "/" + units.length + "^2";
  return unit_text(Dimension::unit_weight, units);
}

// What of it is the weight along a line.
void weight_of_line(std::string& text, const Material& material, const UnitSystem& units) {
  const std::string each = units.force + "/" + units.length + "^2";
  if (const auto thickness = material.parameter(ParameterRole::thickness))
    fmt::format_to(to(text), "     {:<28}{:>14.8g} {:<12} times the thickness\n", "weight",
                   material.unit_weight * *thickness, each);
  if (const double spacing = spacing_of(material.law_ref()); spacing != 1.0)
    fmt::format_to(to(text), "     {:<28}{:>14.8g} {:<12} over the spacing\n", "weight",
                   material.unit_weight / spacing, each);
}

}  // namespace

void heading(std::string& text, std::string_view title) {
  fmt::format_to(to(text), "\n == {:=<94}\n", fmt::format("{} ", title));
}

void diagnostic(std::string& text, const Diagnostic& diagnostic) {
  text += ' ';
  for (char c : to_string(diagnostic)) {
    text += c;
    if (c == '\n') text += "     ";
  }
  text += '\n';
}

void banner(std::string& text, const Model& model, std::string_view date) {
  row_of_stars(text);
  boxed(text, "SAGEFE " SAGE_VERSION "     two-dimensional geotechnical finite elements");
  boxed(text, model.title);
  row_of_stars(text);
  fmt::format_to(to(text), "   deck      {}\n", model.file);
  if (!date.empty()) fmt::format_to(to(text), "   date      {}\n", date);
}

void description(std::string& text, const Model& model, const Scene& scene, std::string_view solver,
                 int equations) {
  const bool ring = model.geometry == Geometry::axisymmetric;
  heading(text, "UNITS AND SIGN CONVENTION");
  fmt::format_to(to(text), "   geometry: {}\n",
                 ring ? "axisymmetric; x = r (radius), y = z (axis), third component = hoop"
                      : "plane strain in x, y; z is out of plane");
  text += sign_convention(model, "   ");
  if (model.units.atmospheric_pressure > 0.0 || model.units.water_unit_weight > 0.0)
    fmt::format_to(to(text),
                   "   atmospheric pressure {:.7g} {}, unit weight of water {:.7g} {}\n"
                   "   (in hyperbolic laws only, the water's in clough_duncan interfaces {})\n",
                   model.units.atmospheric_pressure, model.units.stress, model.units.water_unit_weight,
                   unit_text(Dimension::unit_weight, model.units),
                   model.water.empty() && !model.has_pores() ? "only: no pore pressure is computed"
                                                             : "and in pore pressures");
  if (!model.water.empty())
    text += "   stress is effective stress; total_stress and pore_pressure are fields of their own\n";
  heading(text, "SCENE");
  fmt::format_to(to(text), "   {}\n   solver {}, {} equations at the start\n", describe(scene), solver,
                 equations);
}

void counts(std::string& text, const Model& model) {
  long elements = 0, points = 0;
  for (const Group& group : model.groups) {
    elements += group.elements();
    points += static_cast<long>(group.elements()) * group.element->traits().points;
  }
  const int made = model.mesh.nodes() - model.mesh.deck_nodes;
  fmt::format_to(
      to(text),
      "   nodes {}{}, elements {}, integration points {}, held directions {}, stages {}, reports {}\n",
      model.mesh.nodes(), made > 0 ? fmt::format(" ({} made by the program)", made) : "", elements, points,
      fixity_count(model.fixities, FixityCode::fixed) + fixity_count(model.turned_fixities, FixityCode::fixed),
      model.stages.size(), model.reports.size());
  if (!model.ties.empty()) fmt::format_to(to(text), "   ties {}\n", model.ties.size());
}

void materials(std::string& text, const Model& model, const Catalogue& catalogue) {
  heading(text, "MATERIALS");
  for (const Material& material : model.materials) {
    if (!material.variants.empty()) continue;  // what its stages do to it stands with them
    const MaterialEntry* entry = catalogue.materials.find(material.code);
    fmt::format_to(to(text), "   {:>4}  {:<24} law {} {}\n", material.number, material.name, material.code,
                   material.law_name);
    const std::size_t known = entry != nullptr ? entry->parameters.size() : 0;
    for (std::size_t i = 0; i < std::max(known, material.parameters.size()); ++i)
      parameter(text, model, material, entry, i);
    if (material.unit_weight != 0.0)
      fmt::format_to(to(text), "     {:<28}{:>14.8g} {}\n", "unit_weight", material.unit_weight,
                     weight_unit(material, model.units));
    if (material.saturated_unit_weight != 0.0)
      fmt::format_to(to(text), "     {:<28}{:>14.8g} {:<12} below phreatic lines\n", "saturated_unit_weight",
                     material.saturated_unit_weight, weight_unit(material, model.units));
    if (material.unit_weight != 0.0) weight_of_line(text, material, model.units);
  }
}

void groups(std::string& text, const Model& model) {
  heading(text, "GROUPS");
  fmt::format_to(to(text), "   {:>6}  {:<20} {:<24} {:>8} {:>8} {:>8}\n", "number", "name", "element",
                 "elements", "points", "material");
  for (const Group& group : model.groups)
    fmt::format_to(to(text), "   {:>6}  {:<20} {:<24} {:>8} {:>8} {:>8}\n", group.number, group.name,
                   group.element_name, group.elements(), group.elements() * group.element->traits().points,
                   model.material_of(group).number);
}

void stage(std::string& text, const Model& model, int index) {
  const Stage& s = stage_of(model, index);
  heading(text, fmt::format("STAGE {} OF {}: {}", index + 1, model.stages.size(), s.title));
  fmt::format_to(
      to(text),
      "   {} increments, {}, tolerance {:.1e} (out-of-balance force / force scale), at most {} iterations\n",
      s.increments, method_name(s.method), held_tolerance(s.method, s.tolerance), s.max_iterations);
  std::string parts;
  const auto add = [&parts](const std::string& part) { parts += (parts.empty() ? "" : "; ") + part; };
  if (!s.births.empty()) add("placed: groups " + group_numbers(model, s.births));
  if (!s.deaths.empty()) add("removed: groups " + group_numbers(model, s.deaths));
  if (!s.gravity.isZero(0.0))
    add(fmt::format("gravity {:.6g}, {:.6g} x unit weight", s.gravity.x(), s.gravity.y()));
  if (!s.pressures.empty()) add(fmt::format("{} edge loads", s.pressures.size()));
  if (!s.loads.empty()) add(fmt::format("{} nodal loads", s.loads.size()));
  if (const auto n = fixity_count(s.fixities, FixityCode::fixed))
    add(fmt::format("{} directions held or moved", n));
  if (const auto n = fixity_count(s.fixities, FixityCode::released))
    add(fmt::format("{} directions released", n));
  if (!s.turned_fixities.empty())
    add(fmt::format("{} directions at an angle held or moved, {} released",
                    fixity_count(s.turned_fixities, FixityCode::fixed),
                    fixity_count(s.turned_fixities, FixityCode::released)));
  const auto by_table = [](const auto& card) { return !card.history.empty(); };
  const auto tables = std::ranges::count_if(s.fixities, by_table) + std::ranges::count_if(s.loads, by_table) +
                      std::ranges::count_if(s.pressures, by_table);
  if (tables > 0) add(fmt::format("{} of these loads and supports follow tables of time", tables));
  if (!parts.empty()) fmt::format_to(to(text), "   {}\n", parts);
  states_of_stage(text, model, index);
}

}  // namespace sage::listing

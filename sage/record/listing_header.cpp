// What was read: the part of the listing before the first stage.
#include <fmt/format.h>

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

std::size_t fixity_count(const std::vector<Fixity>& fixities, FixityCode code) {
  std::size_t count = 0;
  for (const Fixity& f : fixities)
    for (FixityCode c : f.code) count += c == code ? 1u : 0u;
  return count;
}

std::string group_numbers(const Model& model, const std::vector<int>& groups) {
  std::string text;
  for (int g : groups)
    text += (text.empty() ? "" : ", ") + std::to_string(model.groups[static_cast<std::size_t>(g)].number);
  return text;
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
                   model.water.empty() ? "only: no pore pressure is computed" : "and in pore pressures");
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
      fixity_count(model.fixities, FixityCode::fixed), model.stages.size(), model.reports.size());
}

void materials(std::string& text, const Model& model, const Catalogue& catalogue) {
  heading(text, "MATERIALS");
  for (const Material& material : model.materials) {
    const MaterialEntry* entry = catalogue.materials.find(material.code);
    fmt::format_to(to(text), "   {:>4}  {:<24} law {} {}\n", material.number, material.name, material.code,
                   material.law_name);
    const std::size_t known = entry != nullptr ? entry->parameters.size() : 0;
    for (std::size_t i = 0; i < std::max(known, material.parameters.size()); ++i)
      parameter(text, model, material, entry, i);
    if (material.unit_weight != 0.0)
      fmt::format_to(to(text), "     {:<28}{:>14.8g} {}\n", "unit_weight", material.unit_weight,
                     unit_text(Dimension::unit_weight, model.units));
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
      s.increments, method_name(s.method), s.tolerance, s.max_iterations);
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
  if (!parts.empty()) fmt::format_to(to(text), "   {}\n", parts);
}

}  // namespace sage::listing

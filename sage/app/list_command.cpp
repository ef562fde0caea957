// sagefe list: what a deck can ask for, from the same catalogue that the reader uses.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/messages/error.hpp"
#include "sage/model/locking.hpp"

namespace sage::app {

namespace {

// Of the fields, by the place where they have values.
constexpr const char* kFieldPlaces[] = {"nodes", "integration points", "elements", "increments"};

// Of a formulation that some laws get though the deck names none, or another.
std::string laws_that_get(const ElementEntry& entry, const Formulation& formulation) {
  if (formulation.yields) return " (every law that is not linear gets it)";
  try {
    const Formulation& dilating = default_formulation(entry, Geometry::plane_strain, true);
    const bool other = dilating.code != entry.formulations.front().code;
    return other && formulation.code == dilating.code ? " (code 0 for a law that dilates)" : "";
  } catch (const ParameterError&) {  // an element of axisymmetry alone
    return "";
  }
}

void list_elements(const Catalogue& catalogue) {
  fmt::print(
      "code  element, its formulations (code 0 on a group card = the first, unless a line says otherwise)\n");
  for (const auto& [code, entry] : catalogue.elements.entries()) {
    fmt::print("{:4}  {}: {}\n", code, entry.name, entry.summary);
    for (const Formulation& f : entry.formulations)
      fmt::print("      {:4}  {}: {}{}\n", f.code, f.name, f.summary, laws_that_get(entry, f));
  }
}

void list_materials(const Catalogue& catalogue) {
  const UnitSystem generic{"length", "force", "stress", 0.0, 0.0};
  fmt::print("code  law, parameters in the order of the card\n");
  for (const auto& [code, entry] : catalogue.materials.entries()) {
    fmt::print("{:4}  {} ({}): {}\n", code, entry.name, law_words(entry), entry.summary);
    int number = 0;
    for (const Parameter& p : entry.parameters) {
      const std::string otherwise = p.required ? "required" : fmt::format("blank = {:g}", p.fallback);
      fmt::print("      {:4}  {} [{}] {}; {}\n", ++number, p.name, unit_text(p.dimension, generic), p.meaning,
                 otherwise);
    }
    number = 0;
    for (const Quantity& q : entry.history)
      fmt::print("      {:4}  history: {} [{}]\n", ++number, q.name, unit_text(q.dimension, generic));
  }
}

void list_solvers(const Catalogue& catalogue) {
  fmt::print("code  solver (code 0 on the control card = chosen from size and symmetry)\n");
  for (const auto& [code, entry] : catalogue.solvers.entries())
    fmt::print("{:4}  {} ({}): {}\n", code, entry.name, entry.symmetric ? "symmetric" : "unsymmetric",
               entry.summary);
}

void list_fields(const Catalogue& catalogue) {
  const UnitSystem generic{"length", "force", "stress", 0.0, 0.0};
  for (int place = 0; place < 4; ++place) {
    fmt::print("{}: name [unit] (components) meaning\n", kFieldPlaces[place]);
    for (const FieldEntry& row : catalogue.fields.rows()) {
      if (static_cast<int>(row.place()) != place) continue;
      std::string components;
      for (const FieldComponent& c : row.components) components += (components.empty() ? " (" : " ") + c.name;
      fmt::print("      {} [{}]{}{} {}{}\n", row.name, unit_text(row.dimension, generic), components,
                 components.empty() ? "" : ")", row.meaning,
                 row.sign == FieldSign::compression_positive ? ", compression positive" : "");
    }
  }
  fmt::print(
      "and, depending on the deck:\n"
      "      at nodes of flow elements: head, head_inflow, head_reaction, pressure_head, stream_function (any "
      "other\n"
      "      unknown has the same first three, with its own name)\n"
      "      at integration points with water: pore_pressure, total_stress (xx yy zz xy)\n"
      "      at integration points the history variables of the deck's laws, by their names\n"
      "pictures, besides NAME and NAME_COMPONENT:\n"
      "      conf or sigma_3, dev or sigma_1-sigma_3, SL (stress level)\n"
      "      flow_net: the head with lines of equal drops and stream lines\n"
      "      of structures axial_force, bending_moment and the like are diagrams; NAME_envelope: of all "
      "stages\n");
}

Json parameters_json(const MaterialEntry& entry, const UnitSystem& units) {
  Json list = Json::array();
  for (const Parameter& p : entry.parameters)
    list.push_back({{"name", p.name},
                    {"unit", unit_text(p.dimension, units)},
                    {"meaning", json_text(p.meaning)},
                    {"required", p.required},
                    {"fallback", p.required ? Json(nullptr) : Json(p.fallback)}});
  return list;
}

Json elements_json(const Catalogue& catalogue) {
  Json list = Json::array();
  for (const auto& [code, entry] : catalogue.elements.entries()) {
    Json formulations = Json::array();
    for (const Formulation& f : entry.formulations)
      formulations.push_back({{"code", f.code}, {"name", f.name}, {"summary", json_text(f.summary)}});
    list.push_back({{"code", code},
                    {"name", entry.name},
                    {"summary", json_text(entry.summary)},
                    {"nodes", entry.nodes},
                    {"formulations", std::move(formulations)}});
  }
  return list;
}

Json materials_json(const Catalogue& catalogue, const UnitSystem& units) {
  Json list = Json::array();
  for (const auto& [code, entry] : catalogue.materials.entries()) {
    Json history = Json::array();
    for (const Quantity& q : entry.history)
      history.push_back({{"name", std::string(q.name)}, {"unit", unit_text(q.dimension, units)}});
    list.push_back({{"code", code},
                    {"name", entry.name},
                    {"kind", law_words(entry.law_size)},
                    {"summary", json_text(entry.summary)},
                    {"parameters", parameters_json(entry, units)},
                    {"history", std::move(history)}});
  }
  return list;
}

Json solvers_json(const Catalogue& catalogue) {
  Json list = Json::array();
  for (const auto& [code, entry] : catalogue.solvers.entries())
    list.push_back({{"code", code},
                    {"name", entry.name},
                    {"symmetric", entry.symmetric},
                    {"summary", json_text(entry.summary)}});
  return list;
}

Json fields_json(const Catalogue& catalogue, const UnitSystem& units) {
  Json list = Json::array();
  for (const FieldEntry& row : catalogue.fields.rows()) {
    Json components = Json::array();
    for (const FieldComponent& c : row.components) components.push_back(c.name);
    list.push_back({{"name", row.name},
                    {"at", kFieldPlaces[static_cast<int>(row.place())]},
                    {"unit", unit_text(row.dimension, units)},
                    {"components", std::move(components)},
                    {"meaning", json_text(row.meaning)},
                    {"compression_positive", row.sign == FieldSign::compression_positive}});
  }
  return list;
}

Json plugins_json(const Catalogue& catalogue) {
  Json list = Json::array();
  for (const Plugin& plugin : catalogue.plugins)
    list.push_back({{"name", json_text(plugin.name)},
                    {"version", json_text(plugin.version)},
                    {"author", json_text(plugin.author)},
                    {"file", json_text(plugin.file)},
                    {"materials", plugin.materials},
                    {"elements", plugin.elements},
                    {"solvers", plugin.solvers},
                    {"fields", json_list(plugin.fields)}});
  return list;
}

struct ShippedDeck {
  std::filesystem::path file;
  std::string title;
};

// Decks of the program's own layout; those of other programs that are shipped are examples of layouts.
std::vector<ShippedDeck> decks() {
  std::vector<ShippedDeck> list;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shipped_decks())) {
    if (entry.path().filename() != "deck.dat") continue;
    std::ifstream in(entry.path());
    std::string line;
    while (std::getline(in, line) && (line.empty() || line[0] == '*')) {
    }
    list.push_back({entry.path(), line});
  }
  std::ranges::sort(list, {}, &ShippedDeck::file);
  return list;
}

void list_decks() {
  for (const ShippedDeck& deck : decks()) fmt::print("{}\n      {}\n", deck.file.string(), deck.title);
}

Json decks_json() {
  Json list = Json::array();
  for (const ShippedDeck& deck : decks())
    list.push_back({{"deck", json_text(deck.file.string())}, {"title", json_text(deck.title)}});
  return list;
}

Json list_json(const std::string& what, const Catalogue& catalogue) {
  const UnitSystem generic{"length", "force", "stress", 0.0, 0.0};
  if (what == "elements") return elements_json(catalogue);
  if (what == "materials") return materials_json(catalogue, generic);
  if (what == "solvers") return solvers_json(catalogue);
  if (what == "plugins") return plugins_json(catalogue);
  if (what == "decks") return decks_json();
  return fields_json(catalogue, generic);
}

void list_plugins(const Catalogue& catalogue) {
  const auto codes = [](const char* kind, const std::vector<int>& list) {
    std::string text;
    for (const int code : list)
      text += fmt::format("{}{}", text.empty() ? fmt::format("; {} ", kind) : ", ", code);
    return text;
  };
  fmt::print("plug-in, version and author; what it adds; its file\n");
  for (const Plugin& plugin : catalogue.plugins) {
    std::string fields;
    for (const std::string& field : plugin.fields) fields += (fields.empty() ? "; fields " : ", ") + field;
    fmt::print("      {} {} by {}{}{}{}{}; {}\n", plugin.name, plugin.version, plugin.author,
               codes("materials", plugin.materials), codes("elements", plugin.elements),
               codes("solvers", plugin.solvers), fields, plugin.file);
  }
}

}  // namespace

Command list_command(CLI::App& parser, const Catalogue& catalogue) {
  auto what = std::make_shared<std::string>();
  parser
      .add_option("WHAT", *what,
                  "elements, materials, solvers, fields, plugins (that --plugin loads) or decks (that come "
                  "with the program)")
      ->required()
      ->check(CLI::IsMember({"elements", "materials", "solvers", "fields", "plugins", "decks"}));
  return [what, &catalogue] {
    if (Json* json = answer()) (*json)[*what] = list_json(*what, catalogue);
    if (*what == "elements") list_elements(catalogue);
    if (*what == "materials") list_materials(catalogue);
    if (*what == "solvers") list_solvers(catalogue);
    if (*what == "fields") list_fields(catalogue);
    if (*what == "plugins") list_plugins(catalogue);
    if (*what == "decks") list_decks();
    return kOk;
  };
}

}  // namespace sage::app

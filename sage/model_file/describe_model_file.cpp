// The keys of model files for readers: a JSON schema for editors, and a page of the manual.
#include <nlohmann/json.hpp>

#include "sage/model_file/keys.hpp"
#include "sage/model_file/model_file.hpp"
#include "sage/page/page.hpp"

namespace sage {

namespace model_file {

namespace {

using Json = nlohmann::ordered_json;

// A number, or a number and its unit in quotes.
Json number_type() {
  return {"number", "string"};
}

template <class Entry>
Json names_of(const Registry<Entry>& registry) {
  Json names = Json::array();
  for (const auto& [code, entry] : registry.entries()) names.push_back(entry.name);
  return {{"anyOf", {{{"enum", names}}, {{"type", "integer"}}}}};
}

Json array_of(Json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

// A name, or [x, y].
Json place_of() {
  return {{"type", {"string", "array"}}};
}

Json kind_of(const Key& key, const Catalogue& catalogue) {
  switch (key.want) {
    case Want::integer:
      return {{"type", "integer"}};
    case Want::real:
      return {{"type", number_type()}};
    case Want::text:
      return {{"type", "string"}};
    case Want::flag:
      return {{"type", "boolean"}};
    case Want::code: {
      Json names = Json::array();
      for (const CodeName& one : key.codes) names.push_back(one.name);
      return {{"anyOf", {{{"enum", names}}, {{"type", "integer"}}}}};
    }
    case Want::law:
      return names_of(catalogue.materials);
    case Want::element:
      return names_of(catalogue.elements);
    case Want::solver:
      return names_of(catalogue.solvers);
    case Want::formulation:
    case Want::material:
    case Want::group:
      return {{"type", {"string", "integer"}}};
    case Want::groups:
      return array_of({{"type", {"string", "integer"}}});
    case Want::integers:
    case Want::nodes:
      return array_of({{"type", "integer"}});
    case Want::values:
      return array_of({{"type", number_type()}});
    case Want::pairs:
      return array_of(
          {{"type", "array"}, {"items", {{"type", number_type()}}}, {"minItems", 2}, {"maxItems", 2}});
    case Want::point:
      return place_of();
    case Want::points:
      return array_of(place_of());
    case Want::outlines:
      return array_of(array_of(place_of()));
    case Want::table:
      return {{"type", "object"}};
  }
  return {};
}

std::string words_of(const Key& key) {
  std::string words = key.label;
  if (!key.unit.empty()) words += " [" + key.unit + "]";
  if (!key.about.empty()) words += ": " + key.about;
  for (std::size_t i = 0; i < key.codes.size(); ++i) words += (i == 0 ? ": " : ", ") + key.codes[i].name;
  return words;
}

Json schema_of(const Table& table, const Catalogue& catalogue) {
  Json properties = Json::object(), required = Json::array();
  for (const Key& key : table.keys) {
    Json one = kind_of(key, catalogue);
    one["description"] = words_of(key);
    if (key.fallback) one["default"] = *key.fallback;
    properties[key.key] = std::move(one);
    if (key.required && key.key != "number") required.push_back(key.key);
  }
  const bool laws = table.key == "material";  // with the parameters of their laws
  Json schema{{"type", "object"}, {"description", table.about}, {"properties", std::move(properties)}};
  if (laws)
    for (const auto& [code, entry] : catalogue.materials.entries()) {
      for (const Parameter& parameter : entry.parameters)
        schema["properties"][parameter.name] = {{"type", number_type()}, {"description", parameter.meaning}};
      if (entry.open_ended)
        schema["properties"]["props"] = {
            {"type", "array"},
            {"items", {{"type", number_type()}}},
            {"description", "properties of the routine (PROPS), behind the parameters"}};
    }
  schema["additionalProperties"] = table.key == "points";  // names of the user's own
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

const char* kind_word(const Key& key) {
  switch (key.want) {
    case Want::integer:
      return "whole number";
    case Want::real:
      return "number";
    case Want::text:
      return "text";
    case Want::flag:
      return "true or false";
    case Want::code:
      return "name";
    case Want::law:
    case Want::element:
    case Want::solver:
    case Want::formulation:
      return "name that `sagefe list` prints";
    case Want::material:
    case Want::group:
      return "name or number";
    case Want::groups:
      return "list of groups";
    case Want::integers:
    case Want::nodes:
      return "list of numbers";
    case Want::values:
      return "list of values";
    case Want::pairs:
      return "list of pairs";
    case Want::point:
      return "point";
    case Want::points:
      return "list of points";
    case Want::outlines:
      return "list of outlines";
    case Want::table:
      return "table";
  }
  return "";
}

std::string heading_of(const Table& table) {
  if (table.key.empty()) return "The file itself";
  return table.many ? "`[[" + table.key + "]]`" : "`[" + table.key + "]`";
}

}  // namespace
}  // namespace model_file

std::string model_file_schema(const Catalogue& catalogue) {
  using namespace model_file;
  Json schema;
  for (const Table& one : tables()) {
    Json entry = schema_of(one, catalogue);
    if (one.key.empty()) {
      schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"$id", "model_file.schema.json"},
                {"title", "model of sagefe"}};
      schema.update(entry);
      schema["properties"]["plugins"] = array_of({{"type", "string"}});
      continue;
    }
    const std::size_t dot = one.key.find('.');
    Json& properties = dot == std::string::npos
                           ? schema["properties"]
                           : schema["properties"][one.key.substr(0, dot)]["items"]["properties"];
    properties[dot == std::string::npos ? one.key : one.key.substr(dot + 1)] =
        one.many ? array_of(std::move(entry)) : std::move(entry);
  }
  return schema.dump(1) + "\n";
}

std::string model_file_tables() {
  using namespace model_file;
  Page page("Tables and keys of model files");
  page.prose(
      "This page lists the tables and keys of [model files](model_file.md). The parameters of a law are "
      "further "
      "keys of its `[[material]]`: `sagefe list materials` prints them. The other names are printed by "
      "`sagefe list elements` and `sagefe list solvers`. Keys without \"required\" may be left out. So may "
      "each "
      "`number`: materials, groups, nodes and elements then get the next number, in the order of the file. A "
      "`line` or a `point` replaces the required keys `first`, `element` and `edge`. A blank field in a "
      "description is a key that is left out. The page is written from the "
      "fields of [decks of cards](deck_format.md), so some descriptions contain the code numbers of decks. The "
      "names of a key `kind` are in the order of these numbers: from 0, in reports from 1. A unit is in square "
      "brackets.");
  for (const Table& one : tables()) {
    page.heading(2, heading_of(one));
    if (one.card.empty())
      page.prose(one.about);
    else if (!one.key.empty())
      page.prose("The keys are fields of the " +
                 (one.card == "stage_title" ? "cards `stage_title`, `stage`, `birth` and `death`"
                                            : "card `" + one.card + "`") +
                 " of [decks](deck_format.md).");
    page.table({"key", "value", "meaning"});
    for (const Key& key : one.keys)
      page.row({"`" + key.key + "`", std::string(kind_word(key)) + (key.required ? ", required" : ""),
                Page::cell(words_of(key))});
  }
  return page.text();
}

}  // namespace sage

// Values of a model file, with an error at their place where they are not what is wanted.  Not part of the public interface.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/deck/toml_file.hpp"
#include "sage/exchange/translate.hpp"
#include "sage/model_file/keys.hpp"

namespace sage::model_file {

using translate::NewField;

// What may stand for the number of a material or a group.
struct Numbered {
  std::string what;                               // "material"
  std::map<std::string, int> by_name;             // 0: several have it
  std::map<std::string, std::vector<int>> drawn;  // numbers of all that a line or area of the drawing has made
};

class Values {
 public:
  Values(const Deck& from, const Catalogue& all) : catalogue(all), from_(from) {}

  const Catalogue& catalogue;
  UnitSystem units;
  Numbered materials{"material", {}, {}}, groups{"group", {}, {}};
  std::map<int, std::map<std::string, double>> parameters;  // that stand in the file, of each material
  Diagnostics problems;

  SourcePosition where(const toml::node& node) const { return place(node.source()); }
  SourcePosition place(const toml::source_region& region) const;
  void error(Code code, const SourcePosition& at, const std::string& message) {
    problems.add(card_diagnostic(from_, Severity::error, code, at, message));
  }
  const std::string& file() const { return from_.file; }

  // The tables of [[key]], or of key = [{...}, ...].
  std::vector<const toml::table*> entries(const toml::table& given, std::string_view key);
  // An error for each key that is none of the table's, none of its cards and none of the law's parameters.
  void know_keys(const toml::table& given, const Table& table, const MaterialEntry* law = nullptr);
  void list_names(const toml::table& root, Numbered& all);

  // A field for each key of the table that is given, and for those that the layout has a value for.
  std::vector<NewField> fields(const toml::table& given, const Table& table,
                               std::initializer_list<std::string_view> without = {});
  void add_value(const Key& key, const toml::table& given, const toml::node& node, std::vector<NewField>& to);
  double number(const toml::node& node, const std::string& label, const std::string& unit);
  bool flag(const toml::node& node, const std::string& label);
  double integer(const toml::node& node, const std::string& label);
  double code(const toml::node& node, const std::string& label, const std::vector<CodeName>& codes);
  std::string text(const toml::node& node, const std::string& label);
  double one_of(const toml::node& node, const Numbered& all);

 private:
  void add_list(const Key& key, const toml::node& node, std::vector<NewField>& to);
  void add_pairs(const Key& key, const toml::node& node, std::vector<NewField>& to);
  void add_groups(const Key& key, const toml::node& node, std::vector<NewField>& to);
  double with_unit(const toml::node& node, const std::string& text, const std::string& label,
                   const std::string& unit);
  std::string unit_of_key(const Key& key) const;
  double formulation(const toml::table& group, const toml::node& node);

  const Deck& from_;
};

}  // namespace sage::model_file

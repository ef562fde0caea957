// The cards of a deck as tables of a TOML file: the keys of each, and what they hold.  One list for the reader, the writer,
// the page of the manual and the JSON schema.  It is made from the layout sage1_wide: a key is the name of its field,
// but for codes, which have names here, and for counts, which a list tells itself.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sage::model_file {

enum class Want {
  integer,
  real,
  text,
  flag,
  code,  // one of Key::codes, by name or number
  law,   // names of the catalogue, or numbers
  element,
  formulation,
  solver,
  material,  // name or number of a [[material]]
  group,     // name or number of a [[group]]
  groups,    // a list of them
  integers,  // a list
  nodes,     // nodes of an element: a field each, n1 n2 ...
  values,    // numbers: a field each, v1 v2 ...
  pairs,     // [[a, b], ...]: a list of numbers two by two
  point,     // of a drawing: a name of [points], or [x, y]
  points,    // a list of them
  outlines,  // a list of lists
  table,     // a table of its own
};

struct CodeName {
  int code = 0;
  std::string name;
};

struct Key {
  std::string key;    // "x", "nodes"
  std::string field;  // of the card: "x", "n"; empty: of none, for the drawing
  Want want = Want::real;
  bool required = false;
  std::optional<double> fallback;  // of the layout, where the key is left out
  std::string label, unit, about;
  std::vector<CodeName> codes;
};

struct Table {
  std::string key;   // "node"; "stage.load" within [[stage]]; "" the file itself
  std::string card;  // canonical name of its card: "node"
  std::string about;
  bool many = true;  // [[node]], not [units]
  std::vector<Key> keys;

  const Key* find(std::string_view key) const;
};

// In the order in which a file is written.
const std::vector<Table>& tables();
const Table& table(std::string_view key);

}  // namespace sage::model_file

// Elements in other programs' files, from what the catalogue says of them.
#pragma once

#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "sage/model/model.hpp"

namespace sage {

// Local nodes in that program's order; the corners where it has no such element.
template <class Type>
std::vector<int> foreign_nodes(const ElementEntry& entry, const ForeignElement<Type>& element) {
  if (element.type != Type{} && !element.nodes.empty()) return element.nodes;
  std::vector<int> all(static_cast<std::size_t>(element.type != Type{} ? entry.nodes : entry.corners));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// That the elements of a group are written by their corners.  format: "VTU".
inline void warn_of_corners(const Group& group, std::string_view format, Diagnostics& diagnostics) {
  const std::string text = "group " + std::to_string(group.number) + " (" + group.element_name +
                           "): " + std::string(format) + " has no element like " + group.entry->name +
                           ": its elements are written by their corners, and their other nodes belong to none";
  diagnostics.add({Severity::warning, "S720", group.where, text, {}});
}

// Unknowns besides displacement, with their supports and loads, which only our own decks can say.
inline void warn_of_unknowns(const Model& model, std::string_view format, Diagnostics& diagnostics) {
  for (std::size_t i = 1; i < model.unknowns.size(); ++i) {
    const std::string& name = model.unknowns[i].name;
    diagnostics.add({Severity::warning,
                     "S720",
                     {model.file, 0, 0, 0},
                     "the " + name + " of nodes is left out, with its supports, values and loads: " +
                         std::string(format) + " as it is written here knows displacements alone",
                     {}});
  }
}

}  // namespace sage

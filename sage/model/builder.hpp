// Shared by the files that build a model; not part of the public interface.
#pragma once

#include <string>
#include <unordered_map>

#include "sage/deck/deck.hpp"
#include "sage/model/build_model.hpp"
#include "sage/model/model.hpp"

namespace sage::build {

// Where an element of the deck ended up.
struct ElementPlace {
  int group = 0, element = 0;
};

// Everything that the steps of building share.
struct Builder {
  const Deck& deck;
  const Catalogue& catalogue;
  const BuildOptions& options;
  Model model;
  Diagnostics problems;                     // errors; warnings go to model.diagnostics at the end
  std::unordered_map<int, int> node_index;  // deck number -> index
  std::unordered_map<int, int> group_index;
  std::unordered_map<int, int> material_index;
  std::unordered_map<int, ElementPlace> element_place;

  // Adds a message that shows the card.
  void error(const SourcePosition& where, const std::string& message) {
    problems.add(card_diagnostic(deck, Severity::error, where, message));
  }
  void warning(const SourcePosition& where, const std::string& message) {
    model.diagnostics.add(card_diagnostic(deck, Severity::warning, where, message));
  }
  void note(const SourcePosition& where, const std::string& message) {
    model.diagnostics.add(card_diagnostic(deck, Severity::note, where, message));
  }
  // A number that an analysis can use: finite and below 1e100 (its square must not overflow).
  bool usable(const CardView& card, std::string_view field, double value);
  // Index of a deck node; -1 and an error where it doesn't exist.
  int node(const CardView& card, std::string_view field, int number);
};

void build_control(Builder& b);
void build_nodes(Builder& b);
void build_materials(Builder& b);
void build_groups(Builder& b);
void build_elements(Builder& b);
void build_stages(Builder& b);
void build_reports(Builder& b);
// Mid-side and inner nodes that element cards leave blank; fixities are inherited along boundary edges.
void make_mid_nodes(Builder& b);
// Shapes, supports, unused nodes, radii.
void check_model(Builder& b);

}  // namespace sage::build

// What operations on a mesh work on, before there are mid-side nodes.  Not part of the public interface.
#pragma once

#include <string>

#include "sage/core/by_number.hpp"
#include "sage/deck/deck.hpp"
#include "sage/mesh/mesh_options.hpp"
#include "sage/model/model.hpp"

namespace sage::mesh {

struct Work {
  const Deck& deck;
  const Catalogue& catalogue;
  const MeshOptions& meshing;
  Model model = {};
  Diagnostics problems = {};      // errors; warnings go to model.diagnostics at the end
  ByNumber<int> node_index = {};  // deck number -> index

  SourcePosition at_line(int line) const { return {deck.file, line, 0, 0}; }
  // Adds a message that shows the card.
  void error(Code code, const SourcePosition& where, const std::string& message) {
    problems.add(card_diagnostic(deck, Severity::error, code, where, message));
  }
  void warning(Code code, const SourcePosition& where, const std::string& message) {
    model.diagnostics.add(card_diagnostic(deck, Severity::warning, code, where, message));
  }
  void note(Code code, const SourcePosition& where, const std::string& message) {
    model.diagnostics.add(card_diagnostic(deck, Severity::note, code, where, message));
  }
};

// Coarsening, refinement and grading that the options ask for.
void refine_as_asked(Work& b);
// Mid-side and inner nodes that element cards leave blank; fixities are inherited along boundary edges.
void make_mid_nodes(Work& b);

}  // namespace sage::mesh

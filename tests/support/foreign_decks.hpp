// Shipped decks of other programs as models and runs, and what their messages hold.
#pragma once

#include <string>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "tests/support/scratch_folder.hpp"

namespace sage::test {

inline const std::string kInputs = SAGE_SOURCE_DIR "/legacy_inputs/";

inline BuildOptions partial_if(bool partial) {
  BuildOptions options;
  options.partial = partial;
  return options;
}

// deck: below legacy_inputs; layout: its own where empty.
inline Model model_of(const std::string& deck, const std::string& layout = "", bool partial = false) {
  app::InputOptions input;
  input.layout = layout;
  return build_model(app::read_input(kInputs + deck, input), app::full_catalogue(), partial_if(partial));
}

inline app::RunOutcome run_of(const std::string& deck, bool partial = false) {
  app::RunRequest request;
  request.input.build.partial = partial;
  request.deck = kInputs + deck;
  request.quiet = true;
  request.output.folder = scratch_folder("foreign");
  return app::run_deck(request, app::full_catalogue());
}

inline bool mentions(const Diagnostics& diagnostics, Severity severity, const std::string& text) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == severity && d.message.find(text) != std::string::npos) return true;
  return false;
}

}  // namespace sage::test

// A deck that nobody knows; the layout that is guessed for it must load and read it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "sage/deck/layout_names.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/layout_draft/coverage.hpp"
#include "sage/layout_draft/layout_draft.hpp"
#include "sage/messages/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  sage::LayoutDraft guess;
  try {
    guess = sage::draft_layout(text, "fuzz", "guessed");
  } catch (const sage::InputError&) {
    return 0;  // no text
  }
  try {
    const sage::Layout layout = sage::load_checked_layout(guess.toml, "guessed.toml");
    sage::find_coverage(layout, sage::read_deck_text(text, "fuzz", layout));
  } catch (const sage::InputError&) {
    std::abort();
  }
  return 0;
}

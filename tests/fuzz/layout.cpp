// A layout file; if it loads, its manual is written and a short deck is read under it.
#include <cstddef>
#include <cstdint>
#include <string>

#include "sage/deck/read_deck.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const sage::Layout layout = sage::load_layout_text(text, "fuzz.toml");
    sage::layout_manual(layout);
    sage::read_deck_text("title\n    1    2  3.0\nL   1\n'text' 1 2 3 /\nEND\n", "fuzz", layout);
  } catch (const sage::InputError&) {
  }
  return 0;
}

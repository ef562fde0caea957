// The first byte chooses a built-in layout, the rest is a deck.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sage/deck/read_deck.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<sage::Layout> layouts = [] {
    std::vector<sage::Layout> all;
    for (const std::string& name : sage::built_in_layouts()) all.push_back(sage::load_layout(name));
    return all;
  }();
  if (size < 1) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const sage::Deck deck = sage::read_deck_text(text, "fuzz", layouts[data[0] % layouts.size()]);
    sage::echo(deck);
  } catch (const sage::InputError&) {
  }
  return 0;
}

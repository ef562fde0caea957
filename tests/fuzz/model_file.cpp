// A TOML model: what it says is read with a catalogue that has nothing, so that no model and no mesh is made.
#include <cstddef>
#include <cstdint>
#include <string>

#include "sage/deck/read_deck.hpp"
#include "sage/messages/error.hpp"
#include "sage/model_file/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const sage::Catalogue nothing;
  try {
    const sage::Deck deck =
        sage::read_model_file_text({reinterpret_cast<const char*>(data), size}, "fuzz.sage.toml");
    sage::model_file_deck(deck, nothing);
  } catch (const sage::InputError&) {  // says what is wrong
  }
  return 0;
}

// The layouts of legacy_inputs/layouts as the build put them into the library.
#pragma once

#include <span>
#include <string_view>

namespace sage {

struct EmbeddedLayout {
  std::string_view name;
  std::string_view bytes;  // sage/deck/layout_bytes.hpp
  bool has_marks = false;  // decks of this layout can be recognised by their first lines
};

std::span<const EmbeddedLayout> embedded_layouts();

}  // namespace sage

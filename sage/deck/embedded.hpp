// The layouts of legacy_inputs/layouts as the build put them into the library.
#pragma once

#include <span>
#include <string_view>

namespace sage {

struct EmbeddedLayout {
  std::string_view name, text;
};

std::span<const EmbeddedLayout> embedded_layouts();

}  // namespace sage

// The names that give a layout's cards and fields a meaning: those that the model builder asks for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sage/deck/layout.hpp"

namespace sage {

// Throws InputError with every name that nothing uses and that isn't marked as ignored, every name
// that the model builder needs and nobody gives, and every card that doesn't belong to the card
// that it is looked for under.
void check_names(const Layout& layout);

enum class NameUse { program, layout, ignored, nothing };

// What becomes of every field of every card, in the layout's order.
std::vector<std::vector<NameUse>> name_uses(const Layout& layout);

// The same as check_names, from the text of a layout file.  A draft's names are not checked.
Layout load_checked_layout(std::string_view toml, const std::string& file);

}  // namespace sage

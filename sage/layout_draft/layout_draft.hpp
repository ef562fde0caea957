// A first layout for a deck that nobody knows: a draft, which a person finishes.
#pragma once

#include <string>

namespace sage {

struct LayoutDraft {
  std::string toml;        // with a comment at every guess that says why; it loads, and reads the whole deck
  int cards = 0;           // kinds of cards
  int not_understood = 0;  // lines that are read as text, because what was guessed for them did not read
};

// `deck`: the characters of the file `deck_name`.  `layout_name`: what the layout calls itself.
// Time grows with the deck's size.  Throws InputError for what is no text (check_is_text).
LayoutDraft draft_layout(std::string deck, const std::string& deck_name, const std::string& layout_name);

}  // namespace sage

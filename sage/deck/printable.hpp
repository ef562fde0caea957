// Text for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace sage {

// `text` with every character that steers a terminal as an escape: controls (C0 and C1) but for ends of lines and tabs,
// separators of lines, and marks that change the direction of writing become "\u001b"; bytes that are no UTF-8 become
// "\x9b".  Within a string of JSON or TOML "\u001b" is the character itself.  `cut`, where given: receives what the end
// of `text` may cut in two (at most three bytes), which is left out then.
std::string printable(std::string_view text, std::string* cut = nullptr);

}  // namespace sage

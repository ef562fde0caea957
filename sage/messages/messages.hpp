// Every message of the program by its code: what it means, where it comes from and what helps.
#pragma once

#include <span>
#include <string>

#include "sage/messages/code.hpp"

namespace sage {

// Texts are whole sentences for an engineer who knows the deck but not the program.  Messages with one cause and
// one cure share a code.
struct MessageEntry {
  Code code;
  const char* title;  // one line
  const char* cause;  // what it means, in the deck or the model
  const char* cure;   // what to change
};

// In the order of their codes.
std::span<const MessageEntry> messages();

// 104 for S104; nullptr where there is none.
const MessageEntry* find_message(int number);

// "S1: files, cards and layouts": what the messages of its hundred are about.
const char* section_of(const MessageEntry& message);

}  // namespace sage

// The code of a message, such as S104: what `sagefe explain S104` and docs/manual/messages.md are looked up by.
#pragma once

#include <string>

namespace sage {

// Written at the place that makes the message, so that a search for a printed code finds that place.  What it
// means, its cause and its cure, stand in sage/core/messages.cpp; a test holds the two together.
class Code {
 public:
  Code() = default;  // none

  // "S" and three digits; anything else is refused by the compiler.
  // NOLINTNEXTLINE(google-explicit-constructor): a literal is a code wherever one is wanted
  consteval Code(const char (&text)[5]) : number_(number_of(text)) {}

  constexpr bool given() const { return number_ != 0; }
  constexpr int number() const { return number_; }  // 104; 0 = none
  friend constexpr bool operator==(Code, Code) = default;

 private:
  static consteval short number_of(const char (&text)[5]) {
    int number = text[0] == 'S' && text[1] != '0' ? 0 : throw "a code is S and three digits, the first not 0";
    for (int i = 1; i < 4; ++i) {
      if (text[i] < '0' || text[i] > '9') throw "a code is S and three digits";
      number = 10 * number + (text[i] - '0');
    }
    return static_cast<short>(number);
  }

  short number_ = 0;
};

// "S104"; empty where there is none.
std::string to_string(Code code);

// "the message [S104]": how messages are printed.  The code stands at the end of the first line.
std::string with_code(const std::string& message, Code code);

}  // namespace sage

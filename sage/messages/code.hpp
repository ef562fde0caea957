// The code of a message, such as S104: what `sagefe explain S104` and docs/manual/messages.md are looked up by.
#pragma once

#include <optional>
#include <string>

namespace sage {

// Written at the place that makes the message, so that a search for a printed code finds that place.  What it
// means, its cause and its cure, stand in sage/messages/messages.cpp; a test holds the two together.  There is no Code
// without a number: the compiler refuses a message without a code.
class Code {
 public:
  // "S" and three digits; anything else is refused by the compiler.
  // NOLINTNEXTLINE(google-explicit-constructor): a literal is a code wherever one is wanted
  consteval Code(const char (&text)[5]) : number_(number_of(text)) {}

  constexpr int number() const { return number_; }  // 104
  friend constexpr bool operator==(Code, Code) = default;
  friend std::optional<Code> code_in(const std::string& message);

 private:
  explicit constexpr Code(short number) : number_(number) {}

  static consteval short number_of(const char (&text)[5]) {
    int number = text[0] == 'S' && text[1] != '0' ? 0 : throw "a code is S and three digits, the first not 0";
    for (int i = 1; i < 4; ++i) {
      if (text[i] < '0' || text[i] > '9') throw "a code is S and three digits";
      number = 10 * number + (text[i] - '0');
    }
    return static_cast<short>(number);
  }

  short number_;
};

// "S104".
std::string to_string(Code code);

// "the message [S104]": how messages are printed.  The code stands at the end of the first line; a message that
// has one there already stays as it is.
std::string with_code(const std::string& message, Code code);

// The code at the end of a message's first line; none where there is none.
std::optional<Code> code_in(const std::string& message);

}  // namespace sage

// One fixed-width field of a card, read as a Fortran runtime reads it.
// Rules: Fortran 2018, 13.7; where runtimes differ we follow gfortran 12.
#pragma once

#include <cstdint>
#include <string_view>

namespace sage {

// Blanks inside and after a number: skipped, or taken as zeros (FORTRAN 66 habit, BLANK='ZERO').
enum class BlankMode : std::uint8_t { null, zero };

enum class FieldFault : std::uint8_t {
  none,
  bad_character,   // a character that no number may hold
  second_point,    // "1.2.3"
  lone_sign,       // "-" in an integer field
  no_exponent,     // "1.5E"
  exponent_range,  // exponent of more than four digits
  integer_range,   // beyond 32 bits
  no_value,        // list-directed: a value of the wrong type, or a bad repeat count
};

// What a careful reader would wonder about, though it reads.
enum FieldHint : std::uint16_t {
  hint_none = 0,
  hint_inner_blank = 1,      // digits on both sides of a blank
  hint_implied_point = 2,    // no point written and d > 0: the decimals were implied
  hint_not_finite = 4,       // NaN or Infinity spelt out
  hint_overflow = 8,         // a number too large for a double
  hint_comma = 16,           // a comma ended the field early
  hint_lone_mark = 32,       // a sign or point without a digit, taken as zero
  hint_trailing_blank = 64,  // blanks after the last digit (they count as zeros in zero mode)
  hint_cut = 128,            // zero mode, and the record ends inside the field: the zeros are missing
  hint_q_exponent = 256      // "1.5Q3": gfortran's own exponent letter for quadruple precision
};

struct FieldResult {
  double value = 0.0;  // holds every 32-bit integer exactly
  FieldFault fault = FieldFault::none;
  std::uint16_t hints = hint_none;
  bool blank = false;    // nothing but blanks: the value is 0
  std::uint16_t at = 0;  // offset of the character that is to blame
};

// How a number is laid out in its field.
struct NumberForm {
  int decimals = 0;  // the d of Fw.d: where no point is written, the last d digits are decimals
  int scale = 0;     // the k of kP: divides by 10^k where no exponent is written
  BlankMode blanks = BlankMode::null;
  bool free = false;  // list-directed: an exponent of any length gives zero or infinity instead of a fault
};

// A number without blanks inside, exponent and other oddities, as nearly all are: most of the time of reading a
// deck goes here.  Return the place behind it; nullptr where [at, end) does not begin with one, or the general
// functions below are needed.  The value is theirs to the last bit.
const char* read_plain_integer(const char* at, const char* end, double& value);
const char* read_plain_real(const char* at, const char* end, int decimals, double& value);

// Iw.  Leading blanks never count, whatever the mode.
FieldResult read_integer_field(std::string_view text, BlankMode blanks);

// Fw.d, Ew.d, Dw.d, Gw.d: correctly rounded, parsed once.
FieldResult read_real_field(std::string_view text, NumberForm form);

// Lw: optional point, then T or F in either case; the rest is ignored.
FieldResult read_logical_field(std::string_view text);

// "12.5", "1.5D-3", "-7": a number with its ends trimmed, as free format has it.
// `integer` accepts digits only.
FieldResult read_free_number(std::string_view text, bool integer);

// "is not a number": what the fault means, for messages.
const char* fault_text(FieldFault fault);

}  // namespace sage

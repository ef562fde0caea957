// Fortran FORMAT strings for reading: compiled once, walked for every card.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sage {

enum class Edit : std::uint8_t {
  integer,      // Iw, Iw.m
  real,         // Fw.d, Ew.d, Dw.d, ESw.d, ENw.d
  general,      // Gw.d: takes the kind of the value
  logical,      // Lw
  text,         // A, Aw
  tab_to,       // Tn
  tab_by,       // nX, TRn, TLn
  next_record,  // /
  stop,         // : ends the read if no value is left to read
  blanks_null,  // BN
  blanks_zero,  // BZ
  scale,        // kP
  group_begin,
  group_end,
  end  // the closing parenthesis of the FORMAT
};

struct FormatStep {
  Edit edit = Edit::end;
  int repeat = 1;  // data edits and groups
  int width = 0;   // field width (0 = A without a width); columns of T and X; k of P
  int decimals = 0;
  int partner = 0;  // group_end: index of its group_begin, group_begin: index of its end
};

class FormatError : public std::runtime_error {
 public:
  FormatError(int column, const std::string& message) : std::runtime_error(message), column_(column) {}
  int column() const { return column_; }  // 1-based, in the FORMAT text

 private:
  int column_;
};

inline bool is_data(Edit edit) {
  return edit <= Edit::text;
}

struct Format {
  std::string text;
  std::vector<FormatStep> steps;  // the last is `end`
  int revert_to = 0;              // step where reversion goes on: the last top-level group, else the first step
  bool reversion_has_data = false;
};

// Throws FormatError.  Blanks are insignificant, letters of either case, commas may be
// left out as gfortran allows.
Format compile_format(std::string_view text);

// Hands out the steps of a FORMAT one after the other, with repeats and groups unrolled.
class FormatWalker {
 public:
  static constexpr int max_depth = 32;

  explicit FormatWalker(const Format& format) : steps_(format.steps.data()), revert_to_(format.revert_to) {}

  // The next step; `end` again and again at the end.  Group steps are never returned.
  const FormatStep& next();
  // After `end`: go on at the last top-level group.
  void revert();

 private:
  struct Loop {
    int begin, left;
  };
  const FormatStep* steps_;
  int revert_to_;
  int at_ = 0;
  int left_ = 0;  // further repeats of the data edit at `at_`
  int depth_ = 0;
  Loop loops_[max_depth];  // the first depth_ are in use; the rest is not set, since a walker is made for every
                           // card
};

}  // namespace sage

// The sections of a MSH file: their numbers as words of lines, or as their bytes.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

namespace sage {

// As text, or as bytes in the order of this machine.
enum class MshForm { text, binary };

// Adds numbers to a section, each in the width of its own type.
class MshNumbers {
 public:
  MshNumbers(std::string& to, MshForm form) : to_(&to), binary_(form == MshForm::binary) {}

  MshNumbers& operator<<(int value) { return add(value); }
  MshNumbers& operator<<(std::size_t value) { return add(value); }
  MshNumbers& operator<<(double value) { return add(value); }
  void end_line() {
    if (!binary_) to_->back() = '\n';
  }
  void end_section(std::string_view name) {
    fmt::format_to(std::back_inserter(*to_), "{}$End{}\n", binary_ ? "\n" : "", name);
  }

 private:
  template <class Number>
  MshNumbers& add(Number value) {
    if (binary_)
      to_->append(reinterpret_cast<const char*>(&value), sizeof value);
    else
      fmt::format_to(std::back_inserter(*to_), "{} ", value);
    return *this;
  }

  std::string* to_;
  bool binary_;
};

}  // namespace sage

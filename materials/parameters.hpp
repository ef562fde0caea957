// The door of every law: reads the numbers of a deck, refuses what can't be meant, converts degrees once.
// Every refusal is a ParameterError that names the parameter, its value and what was expected.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage {

class Parameters {
 public:
  // `values` may be shorter than `table`: optional parameters then take their fallback.
  Parameters(const std::vector<Parameter>& table, std::span<const double> values, const UnitSystem& units);

  double number(int i) const { return values_[static_cast<std::size_t>(i)]; }
  double positive(int i) const;
  double not_negative(int i) const;
  double between(int i, double lowest, double highest) const;  // both ends allowed
  double poissons_ratio(int i) const;                          // -1 < nu < 0.5
  double angle(int i) const;                                   // degrees in, 0 <= angle < 90; radians out
  int code(int i, std::initializer_list<int> known) const;     // a whole number out of a short list

  double atmospheric_pressure() const;  // p_a > 0 from the unit system
  double water_unit_weight() const;     // gamma_w > 0 from the unit system

  // For relations between parameters: throws ParameterError(i, name + what + value).
  [[noreturn]] void refuse(int i, const std::string& expected) const;

 private:
  const std::vector<Parameter>& table_;
  std::vector<double> values_;
  const UnitSystem& units_;
};

// Rows that several laws share.
Parameter required(std::string name, Dimension dimension, std::string meaning);
Parameter optional(std::string name, Dimension dimension, std::string meaning, double fallback);

}  // namespace sage

// The door of every law: reads the numbers of a deck, refuses what can't be meant, converts degrees once.
// Every refusal is a ParameterError that names the parameter, its value and what was expected.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage {

class Parameters {
 public:
  // `values` may be shorter than `table`: optional parameters then take their fallback.
  Parameters(const std::vector<Parameter>& table, std::span<const double> values, const UnitSystem& units);

  // By the name in the table.  A name that it lacks is a mistake of the programmer: std::logic_error.
  double number(std::string_view name) const { return values_[index(name)]; }
  double positive(std::string_view name) const;
  double not_negative(std::string_view name) const;
  double between(std::string_view name, double lowest, double highest) const;  // both ends allowed
  double poissons_ratio(std::string_view name) const;                          // -1 < nu < 0.5
  double angle(std::string_view name) const;  // degrees in, 0 <= angle < 90; radians out
  int code(std::string_view name,
           std::initializer_list<int> known) const;  // a whole number out of a short list

  double atmospheric_pressure() const;  // p_a > 0 from the unit system
  double water_unit_weight() const;     // gamma_w > 0 from the unit system

  // For relations between parameters: throws ParameterError with the place, name + what + value.
  [[noreturn]] void refuse(std::string_view name, const std::string& expected) const;

 private:
  std::size_t index(std::string_view name) const;

  const std::vector<Parameter>& table_;
  std::vector<double> values_;
  const UnitSystem& units_;
};

// Rows that several laws share.
Parameter required(std::string name, Dimension dimension, std::string meaning,
                   ParameterRole role = ParameterRole::none);
Parameter optional(std::string name, Dimension dimension, std::string meaning, double fallback,
                   ParameterRole role = ParameterRole::none);

}  // namespace sage

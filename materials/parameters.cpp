#include "materials/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace sage {

namespace {

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

}  // namespace

Parameters::Parameters(const std::vector<Parameter>& table, std::span<const double> values,
                       const UnitSystem& units)
    : table_(table), units_(units) {
  if (values.size() > table.size())
    throw ParameterError("S223", -1,
                         "takes at most " + std::to_string(table.size()) + " parameters, " +
                             std::to_string(values.size()) + " given");
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool given = i < values.size();
    if (!given && table[i].required)
      throw ParameterError("S221", static_cast<int>(i), table[i].name + " is missing: " + table[i].meaning);
    values_.push_back(given ? values[i] : table[i].fallback);
    if (!std::isfinite(values_.back())) refuse(table[i].name, "must be a finite number");
  }
}

std::size_t Parameters::index(std::string_view name) const {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (table_[i].name == name) return i;
  throw std::logic_error("the law has no parameter " + std::string(name));
}

void Parameters::refuse(std::string_view name, const std::string& expected) const {
  throw ParameterError(static_cast<int>(index(name)),
                       std::string(name) + " " + expected + "; it is " + text_of(number(name)));
}

double Parameters::positive(std::string_view name) const {
  if (!(number(name) > 0.0)) refuse(name, "must be greater than 0");
  return number(name);
}

double Parameters::not_negative(std::string_view name) const {
  if (number(name) < 0.0) refuse(name, "must not be negative");
  return number(name);
}

double Parameters::between(std::string_view name, double lowest, double highest) const {
  if (number(name) < lowest || number(name) > highest)
    refuse(name, "must lie between " + text_of(lowest) + " and " + text_of(highest));
  return number(name);
}

double Parameters::poissons_ratio(std::string_view name) const {
  if (number(name) >= 0.5)
    refuse(name, "must be below 0.5 (there is no mixed element here; 0.4999999 is safe with B-bar)");
  if (!(number(name) > -1.0)) refuse(name, "must be greater than -1");
  return number(name);
}

double Parameters::angle(std::string_view name) const {
  if (number(name) < 0.0 || number(name) >= 90.0) refuse(name, "must be at least 0 and below 90 degrees");
  return number(name) * kRadiansPerDegree;
}

int Parameters::code(std::string_view name, std::initializer_list<int> known) const {
  std::string list;
  for (const int k : known) {
    if (number(name) == static_cast<double>(k)) return k;
    list += (list.empty() ? "" : ", ") + std::to_string(k);
  }
  refuse(name, "must be one of the codes " + list + " (" + table_[index(name)].meaning + ")");
}

double Parameters::atmospheric_pressure() const {
  if (!(units_.atmospheric_pressure > 0.0))
    throw ParameterError("S247", -1,
                         "needs the atmospheric pressure p_a of the deck's unit system, in " + units_.stress +
                             "; none is given");
  return units_.atmospheric_pressure;
}

double Parameters::water_unit_weight() const {
  if (!(units_.water_unit_weight > 0.0))
    throw ParameterError("S247", -1,
                         "needs the unit weight of water gamma_w of the deck's unit system, in " +
                             unit_text(Dimension::unit_weight, units_) + "; none is given");
  return units_.water_unit_weight;
}

Parameter required(std::string name, Dimension dimension, std::string meaning, ParameterRole role) {
  return {std::move(name), dimension, std::move(meaning), 0.0, true, role};
}

Parameter optional(std::string name, Dimension dimension, std::string meaning, double fallback,
                   ParameterRole role) {
  return {std::move(name), dimension, std::move(meaning), fallback, false, role};
}

}  // namespace sage

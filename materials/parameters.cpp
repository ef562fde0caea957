#include "materials/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
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
    throw ParameterError(-1, "takes at most " + std::to_string(table.size()) + " parameters, " +
                                 std::to_string(values.size()) + " given");
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool given = i < values.size();
    if (!given && table[i].required)
      throw ParameterError(static_cast<int>(i), table[i].name + " is missing: " + table[i].meaning);
    values_.push_back(given ? values[i] : table[i].fallback);
    if (!std::isfinite(values_.back())) refuse(static_cast<int>(i), "must be a finite number");
  }
}

void Parameters::refuse(int i, const std::string& expected) const {
  throw ParameterError(
      i, table_[static_cast<std::size_t>(i)].name + " " + expected + "; it is " + text_of(number(i)));
}

double Parameters::positive(int i) const {
  if (!(number(i) > 0.0)) refuse(i, "must be greater than 0");
  return number(i);
}

double Parameters::not_negative(int i) const {
  if (number(i) < 0.0) refuse(i, "must not be negative");
  return number(i);
}

double Parameters::between(int i, double lowest, double highest) const {
  if (number(i) < lowest || number(i) > highest)
    refuse(i, "must lie between " + text_of(lowest) + " and " + text_of(highest));
  return number(i);
}

double Parameters::poissons_ratio(int i) const {
  if (number(i) >= 0.5)
    refuse(i, "must be below 0.5 (there is no mixed element here; 0.4999999 is safe with B-bar)");
  if (!(number(i) > -1.0)) refuse(i, "must be greater than -1");
  return number(i);
}

double Parameters::angle(int i) const {
  if (number(i) < 0.0 || number(i) >= 90.0) refuse(i, "must be at least 0 and below 90 degrees");
  return number(i) * kRadiansPerDegree;
}

int Parameters::code(int i, std::initializer_list<int> known) const {
  std::string list;
  for (const int k : known) {
    if (number(i) == static_cast<double>(k)) return k;
    list += (list.empty() ? "" : ", ") + std::to_string(k);
  }
  refuse(i, "must be one of the codes " + list + " (" + table_[static_cast<std::size_t>(i)].meaning + ")");
}

double Parameters::atmospheric_pressure() const {
  if (!(units_.atmospheric_pressure > 0.0))
    throw ParameterError(-1, "needs the atmospheric pressure p_a of the deck's unit system, in " +
                                 units_.stress + "; none is given");
  return units_.atmospheric_pressure;
}

double Parameters::water_unit_weight() const {
  if (!(units_.water_unit_weight > 0.0))
    throw ParameterError(-1, "needs the unit weight of water gamma_w of the deck's unit system, in " +
                                 unit_text(Dimension::unit_weight, units_) + "; none is given");
  return units_.water_unit_weight;
}

Parameter required(std::string name, Dimension dimension, std::string meaning) {
  return {std::move(name), dimension, std::move(meaning), 0.0, true};
}

Parameter optional(std::string name, Dimension dimension, std::string meaning, double fallback) {
  return {std::move(name), dimension, std::move(meaning), fallback, false};
}

}  // namespace sage

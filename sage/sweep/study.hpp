// A study of many cases of one deck, as a TOML file describes it (docs/manual/sweep.md).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sage/builder/named_model.hpp"
#include "sage/sweep/random_fields.hpp"

namespace sage::sweep {

// "report1.ratio > 1.1".
struct FailureRule {
  std::string quantity;
  bool above = true;  // fails where it is larger than the limit
  double limit = 0.0;
  double confidence = 0.95;
};

struct Study {
  std::string file;  // of the study
  std::string deck;  // as it is to be opened
  std::string layout;
  std::vector<NamedValue> fixed;   // in all cases
  std::vector<std::string> names;  // of what varies, in the order of columns
  std::vector<std::vector<std::variant<double, std::string>>>
      cases;  // a value for each name; NaN: as in the deck
  std::vector<std::string> collect;
  std::vector<std::string> allowed;  // codes of warnings that are no failures
  std::optional<FailureRule> failure;
  std::vector<std::string> random;  // names of those that are drawn
  // Variables that differ from place to place: their value in a case is the number of the draw.
  std::shared_ptr<const RandomFields> fields;
  std::vector<int> field_of;   // by name: variable of `fields`; -1 = one value everywhere
  std::string plot_x, plot_y;  // empty: the first name, the first quantity

  // Gives a model the value of a case for a name; NaN changes nothing.
  void put(NamedModel& model, std::size_t name, const std::variant<double, std::string>& value) const;
};

// Throws InputError, with the line, for what is wrong or unknown.
Study read_study(const std::string& file);

}  // namespace sage::sweep

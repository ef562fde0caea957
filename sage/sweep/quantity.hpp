// What a sweep collects of each case: "report1.ratio", "report2.uy.max", "safety.factor", "run.increments".
#pragma once

#include <string>
#include <vector>

#include "sage/model/model.hpp"
#include "sage/record/report.hpp"
#include "sage/safety/safety.hpp"

namespace sage::sweep {

struct Quantity {
  enum class Source { report, safety, run };
  enum class Pick { last, first, largest, smallest, mean };
  std::string name;
  Source source = Source::report;
  std::size_t report = 0, column = 0;  // of a report, from 0
  Pick pick = Pick::last;
  int place = 0;  // of the table of its source
};

// Throws InputError (S734, at the file of the study) for a name that no result of the model has, with near ones.
Quantity quantity_of(const std::string& name, const Model& model, const std::string& study_file);

// NaN where the run has no value.
double value_of(const Quantity& quantity, const Reports& reports, const RunResult& run,
                const safety::Safety* found);

}  // namespace sage::sweep

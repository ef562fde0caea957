// What a deck's reports end with, number by number and by name, for those who compare runs.
#pragma once

#include "sage/record/report.hpp"

namespace sage {

// The last value of one column of a report, as its CSV has it; NaN = not known.
struct ReportComponent {
  std::string name;      // "report1.ratio", "report2.fy"
  double value = 0.0;    // signs and units of the report
  double largest = 0.0;  // |value| of this component and its sisters (x and y of a force ...) in all rows
  // What a reader of the report looks at first: the ratio of a triaxial test (its measured deviator where no
  // ratio is known); of nodes the force in the directions in which two or more of the deck's nodes are held,
  // and else the displacement (the reaction of one node alone vanishes with its share of the edge); of a point
  // its displacement and stress, or heads and velocity where water alone flows; of a line the discharge; of a cut all
  // forces and moments.
  bool main = false;
};

// Names of all components of a model's reports, in the order of last_components.
std::vector<std::string> component_names(const Model& model);

// All components of all reports that have a row.
std::vector<ReportComponent> last_components(const Model& model, const Reports& reports);

// Why a report has no value at the end of a complete run: "group 2, which holds the point (0.5;
// 1.5), is removed in stage 2".  Empty for reports of other kinds than points and discharges, for a point that an
// active element holds then, and for a line that water flows through.
std::string why_no_value(const Model& model, std::size_t report);

}  // namespace sage

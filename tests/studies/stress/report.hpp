// Results of the stress test for the terminal, as CSV and as a page with plots.
#pragma once

#include <filesystem>

#include "tests/studies/stress/row.hpp"

namespace sage::stress {

// A line for the row, and below it the trials: all, or only those that failed.
std::string row_text(const Row& row, const RowResult& result, bool all_trials);
std::string heading();

// row,trial,parameter,expected,outcome,error[-],allowed[-],digits_lost[-],verdict
std::string to_csv(const std::vector<Row>& rows, const std::vector<RowResult>& results);

// Digits lost against the swept parameter; empty where the row has no such numbers.
std::string plot(const Row& row, const RowResult& result);

// Markdown with every table; plots go to `folder` (beside the page) and are linked.  No times, no date: two
// runs of the same program give the same page.
std::string to_markdown(const std::vector<Row>& rows, const std::vector<RowResult>& results,
                        const std::string& folder);

}  // namespace sage::stress

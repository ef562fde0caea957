// The page of finished runs (sagefe report, sagefe run --report).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/report/page.hpp"

namespace sage::app {

// The result file that is meant: itself, STEM of STEM.h5, or the only one of a folder.  Throws UsageError.
std::filesystem::path result_file_of(const std::string& name);

// Writes the page of these result files, says what it lacks, and gives its size in bytes.  Throws InputError, UsageError,
// OutputError.
std::uintmax_t write_report_page(const std::vector<std::filesystem::path>& results,
                                 const std::filesystem::path& page, const report::PageOptions& options,
                                 const Catalogue& catalogue);

}  // namespace sage::app

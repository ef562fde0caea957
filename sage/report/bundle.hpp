// The page's script and style, web/report/report.js and report.css as the build put them into the library.
#pragma once

#include <string_view>

namespace sage::report {

std::string_view bundle_script();
std::string_view bundle_style();

}  // namespace sage::report

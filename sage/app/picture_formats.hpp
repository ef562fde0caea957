// Pictures as PDF and PNG besides SVG, by the program rsvg-convert.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace sage::app {

// --format: svg, pdf, png; may be repeated.
void add_format_option(CLI::App& parser, std::vector<std::string>& formats);

// Before anything is computed.  Throws OutputError where a format needs rsvg-convert and there is none.
void require_converter(const std::vector<std::string>& formats);

// The other formats of an SVG file, beside it; gives their names.  Throws OutputError where that fails.
std::vector<std::filesystem::path> convert_picture(const std::filesystem::path& svg,
                                                   const std::vector<std::string>& formats);

}  // namespace sage::app

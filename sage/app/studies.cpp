#include "sage/app/studies.hpp"

#include <unistd.h>

#include <CLI/Option.hpp>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "sage/app/commands.hpp"
#include "sage/app/picture_formats.hpp"
#include "sage/messages/error.hpp"
#include "sage/messages/parse_number.hpp"
#include "sage/platform/module.hpp"

namespace sage::app {

namespace {

constexpr int kFigures = 40;  // of chapter 7

std::string complaint_about_figure(const std::string& text) {
  try {
    figure_from(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

// The option's value is a page, which has a usual name.
void add_page_option(CLI::App& parser, std::string& page, const std::string& about, const std::string& usual) {
  parser.add_option("--write", page, about + " (default " + usual + ")")->expected(0, 1)->default_str(usual);
}

}  // namespace

int figure_from(const std::string& text) {
  const std::string digits = text.starts_with("7.") ? text.substr(2) : text;
  const std::optional<int> figure = parse_number<int>(digits);
  if (!figure || *figure < 1 || *figure > kFigures)
    throw std::invalid_argument("--only " + text + ": wanted a figure from 7.1 to 7.40");
  return *figure;
}

Studies& studies() {
  static Studies all;
  return all;
}

void become_study(const std::string& name, char** words) {
  std::error_code error;
  const std::filesystem::path beside = program_folder();
  const std::string file = (beside / ("sagefe-" + name)).string();
  std::fflush(stdout);
  if (!beside.empty() && std::filesystem::is_regular_file(file, error)) execv(file.c_str(), words);
  const std::string reason = error ? error.message() : std::strerror(errno);
  throw OutputError("S912", "sagefe " + name + " is done by the program " + file + ", which is not there (" +
                                reason + "): it is built by scripts/run --all and scripts/test");
}

Command figures_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<FiguresOptions>();
  parser.add_option("--only", options->only, "a figure, 7.1 to 7.40; may be repeated (default: all)")
      ->allow_extra_args(false)
      ->check(complaint_about_figure);
  parser.add_option("-o,--output", options->folder,
                    "folder for pictures, figures.md and figures.csv (default: figures)");
  add_format_option(parser, options->formats);
  parser.add_flag("--list", options->list,
                  "list the figures and the chapter's sentences with their limits; compute nothing");
  return [options, &catalogue] { return studies().figures(*options, catalogue); };
}

Command stress_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<StressOptions>();
  parser.add_flag("--list", options->list, "list the rows and their references; compute nothing");
  parser.add_option("--only", options->only, "compute only the rows of exactly these names");
  parser.add_flag("--details", options->details, "print every trial of a row, not only those that failed");
  parser.add_option("--csv", options->csv, "write every trial as CSV to this file");
  add_page_option(parser, options->page, "write a Markdown page, and plots into a folder beside it",
                  "docs/stress.md");
  return [options, &catalogue] { return studies().stress(*options, catalogue); };
}

Command verify_command(CLI::App& parser, const Catalogue& catalogue) {
  auto options = std::make_shared<VerifyOptions>();
  parser.add_flag("--list", options->list, "list the cases and their references; compute nothing");
  parser.add_option(
      "--only", options->only,
      "compute only the cases or sections whose name contains this word; a case that takes minutes "
      "only by its whole name");
  parser.add_flag("--rows", options->rows,
                  "print every number of a case, not only the one closest to its limit");
  parser.add_option("--csv", options->csv, "write every number as CSV to this file");
  add_page_option(parser, options->write, "write a Markdown page, and plots into a folder beside it",
                  "docs/verification.md");
  return [options, &catalogue] { return studies().verify(*options, catalogue); };
}

}  // namespace sage::app

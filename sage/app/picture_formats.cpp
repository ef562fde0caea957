#include "sage/app/picture_formats.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "sage/record/out_file.hpp"

extern char** environ;

namespace sage::app {

namespace {

constexpr const char* kConverter = "rsvg-convert";

bool on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

void convert(const std::filesystem::path& svg, const std::filesystem::path& to, const std::string& format) {
  std::string program = kConverter, from = svg.string(), kind = "--format=" + format,
              output = "--output=" + to.string(), options_end = "--";
  char* arguments[] = {program.data(), kind.data(), output.data(), options_end.data(), from.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0 ||
      waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw OutputError("S604", "rsvg-convert could not make " + to.string());
}

}  // namespace

void add_format_option(CLI::App& parser, std::vector<std::string>& formats) {
  parser
      .add_option("--format", formats,
                  "format besides svg: pdf or png (need the program rsvg-convert); may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"svg", "pdf", "png"}));
}

void require_converter(const std::vector<std::string>& formats) {
  for (const std::string& format : formats)
    if (format != "svg" && !on_path(kConverter))
      throw OutputError("S604", "--format " + format + " needs the program rsvg-convert (librsvg2-bin)");
}

std::vector<std::filesystem::path> convert_picture(const std::filesystem::path& svg,
                                                   const std::vector<std::string>& formats) {
  std::vector<std::filesystem::path> files;
  for (const std::string& format : formats) {
    std::filesystem::path to = svg;
    to.replace_extension(format);
    if (format == "svg" || std::ranges::find(files, to) != files.end()) continue;
    convert(svg, to, format);
    files.push_back(to);
  }
  return files;
}

}  // namespace sage::app

#include "sage/app/run_source.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstring>
#include <sstream>

#include "sage/deck/read_deck.hpp"
#include "sage/deck/source.hpp"

namespace sage::app {

namespace {

constexpr const char* kSolver = "--solver-code";  // of the catalogue; `run` takes names

// As add_build_options() reads them, one a line: names of points hold blanks.
std::string words_of(const BuildOptions& build) {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (build.formulation >= 0) add("--formulation", std::to_string(build.formulation));
  if (build.element != 0) add("--element", std::to_string(build.element));
  if (build.coarsen) words.emplace_back("--coarsen");
  if (build.refine != 0) add("--refine", std::to_string(build.refine));
  for (const Grading& g : build.gradings)
    add("--grade", fmt::format("{}:{}:{}", g.node == 0 ? "auto" : std::to_string(g.node), g.layers, g.ratio));
  if (build.refine_graded != 0) add("--refine-graded", std::to_string(build.refine_graded));
  if (build.partial) words.emplace_back("--partial");
  // A name that begins with "-" is none of an option: "=" keeps the two together.
  for (const PointRequest& p : build.points)
    words.push_back(fmt::format("--point={},{}:{}", p.place.x(), p.place.y(), p.name) +
                    (p.group != 0 ? fmt::format(":{}", p.group) : ""));
  for (const PartialFactors& set : build.factors) words.push_back("--factors=" + text_of(set));
  for (const int stage : build.actions.variable) add("--variable", std::to_string(stage));
  for (const int stage : build.actions.structural) add("--structural", std::to_string(stage));
  if (build.geometry != 0) add("--geometry", std::to_string(build.geometry));
  if (build.solver >= 0) add(kSolver, std::to_string(build.solver));
  return fmt::format("{}", fmt::join(words, "\n"));
}

BuildOptions build_options_of(const std::string& text, const Catalogue& catalogue) {
  BuildOptions build;
  CLI::App parser;
  add_build_options(parser, build, catalogue);
  parser.add_option(kSolver, build.solver);
  std::vector<std::string> words;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) words.push_back(line);
  std::ranges::reverse(words);  // as CLI11 takes them
  try {
    parser.parse(words);
  } catch (const CLI::ParseError& error) {
    throw InputError("S640", {"", 0, 0, 0}, std::string("the options of the run: ") + error.what());
  }
  return build;
}

// As the run got them, in the same order.
HeadReader kept_heads(const std::string& kept) {
  return [&kept, at = std::size_t{0}](const HeadRequest& request) mutable {
    std::vector<double> heads(request.nodes.size());
    const std::size_t bytes = heads.size() * sizeof(double);
    if (at + bytes > kept.size())
      throw InputError("S640", {request.file, 0, 0, 0}, "the result file has not kept the heads of all nodes");
    if (bytes > 0) std::memcpy(heads.data(), kept.data() + at, bytes);
    at += bytes;
    return heads;
  };
}

}  // namespace

RunSource source_of(const std::string& deck, const std::string& layout, const std::string& asked_layout,
                    const BuildOptions& build) {
  RunSource source{deck, layout, "", words_of(build)};
  const std::vector<std::string> built_in = built_in_layouts();
  if (asked_layout.empty() || std::ranges::find(built_in, asked_layout) != built_in.end()) return source;
  source.layout = asked_layout;
  source.layout_text = read_file(asked_layout);
  return source;
}

Model model_of(const RunSource& source, const std::string& deck_name, const Catalogue& catalogue) {
  BuildOptions build = build_options_of(source.options, catalogue);
  build.points_outside = true;  // the run accepted its points
  if (!source.heads.empty()) build.heads = kept_heads(source.heads);
  if (source.layout == kModelFile)
    return build_model(read_model_file_text(source.deck, deck_name), catalogue, build);
  const Layout layout = source.layout_text.empty() ? load_layout(source.layout)
                                                   : load_layout_text(source.layout_text, source.layout);
  return build_model(read_deck_text(source.deck, deck_name, layout), catalogue, build);
}

HeadReader keeping_heads(HeadReader heads, std::string& kept) {
  return [heads = std::move(heads), &kept](const HeadRequest& request) {
    std::vector<double> found = heads(request);
    const std::size_t before = kept.size(), bytes = found.size() * sizeof(double);
    kept.resize(before + bytes);
    if (bytes > 0) std::memcpy(kept.data() + before, found.data(), bytes);
    return found;
  };
}

}  // namespace sage::app

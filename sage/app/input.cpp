#include "sage/app/input.hpp"

#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <filesystem>

#include "sage/deck/read_deck.hpp"

namespace sage::app {

void add_input_options(CLI::App& parser, InputOptions& options) {
  parser.add_option("--layout", options.layout,
                    "card layout: a built-in name or a .toml file (default: found from the deck)");
  parser.add_flag("--strict", options.strict, "treat warnings about the deck as errors");
}

void add_build_options(CLI::App& parser, BuildOptions& options) {
  parser.add_option("--formulation", options.formulation, "replace the formulation code of all solid elements");
  parser.add_option("--element", options.element,
                    "replace 4-node quadrilaterals by this element code (mid-side nodes are made)");
  parser.add_option("--geometry", options.geometry, "replace the geometry: 1 plane strain, 2 axisymmetric");
}

Deck read_input(const std::string& path, const InputOptions& options) {
  ReadOptions read;
  read.strict = options.strict;
  return read_deck(path, options.layout.empty() ? layout_for(path) : load_layout(options.layout), read);
}

void print_diagnostics(const Diagnostics& diagnostics) {
  constexpr int kShown = 50;
  int shown = 0;
  for (const Diagnostic& diagnostic : diagnostics.list()) {
    if (++shown > kShown) break;
    fmt::print(stderr, "{}\n", to_string(diagnostic));
  }
  if (shown > kShown) fmt::print(stderr, "and {} more messages\n", diagnostics.list().size() - kShown);
  if (diagnostics.errors() > 0)
    fmt::print(stderr, "{} error{}, {} warning{}\n", diagnostics.errors(), diagnostics.errors() == 1 ? "" : "s",
               diagnostics.warnings(), diagnostics.warnings() == 1 ? "" : "s");
}

std::string case_name(const std::string& path) {
  const std::filesystem::path p(path);
  if (p.stem() == "deck" && !p.parent_path().filename().empty()) return p.parent_path().filename().string();
  return p.stem().string();
}

}  // namespace sage::app

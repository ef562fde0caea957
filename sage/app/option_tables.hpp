// The commands and their options as plain data, out of the tables of the parser itself: what shell completion is
// written from.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage::app {

struct OptionRow {
  std::vector<std::string> names;  // "-o", "--output"; of what stands without a dash its name, "DECK"
  std::string about;
  std::string value;                 // "TEXT"; empty: a flag
  std::vector<std::string> choices;  // the values there are; empty: any, and files are offered
  bool positional = false, required = false, repeated = false;
};

struct CommandRow {
  std::string words;  // "sagefe", "sagefe run", "sagefe layout guess"
  std::string about;
  std::string footer;
  std::vector<OptionRow> options;  // what stands without a dash, too
  std::vector<CommandRow> parts;

  std::string name() const { return words.substr(words.rfind(' ') + 1); }
};

// A parser with all its commands; the catalogue knows the names of solvers, elements and fields.
CommandRow command_row(const CLI::App& parser, const Catalogue& catalogue, const std::string& words);

// For the bash of `complete -F`, zsh's compinit and fish.  shell: "bash", "zsh" or "fish".
std::string completion_script(const CommandRow& program, const std::string& shell);

}  // namespace sage::app

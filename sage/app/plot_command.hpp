// What `sagefe plot` draws: fields of states, curves over them, columns of tables.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/draw/picture.hpp"

namespace sage::app {

struct PlotOptions {
  std::vector<std::string> files;   // results (.h5), or tables (.csv)
  std::string folder, name;         // of the picture; empty = that of the first file, and what fits
  std::vector<std::string> labels;  // of the files
  std::string title;                // empty = the decks'
  std::vector<std::string> pictures;
  std::vector<std::string> at;
  std::vector<std::string> xy;  // X:Y[,Y...]
};

// Where the file NAME.svg goes; its folder is made.  Throws OutputError.
std::filesystem::path plot_path(const PlotOptions& options, const std::string& name);
// The file, said on standard output.
void write_plot(const std::filesystem::path& path, const std::string& svg);

// Two columns of tables against each other, a panel for each of options.xy.  Throws InputError, UsageError.
void plot_columns(const PlotOptions& options);

}  // namespace sage::app

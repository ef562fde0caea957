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
  bool log_x = false;           // of those
  std::string line;             // X,Y:X,Y; empty = none
  bool interface = false;
  PictureOptions look;
  bool sheet = false, own_scales = false;
  std::vector<std::string> formats;  // besides SVG
};

// Where the file NAME.svg goes, or that which --name says; its folder is made.  Throws OutputError.
std::filesystem::path plot_path(const PlotOptions& options, const std::string& name);
// The file and its other formats, said on standard output.
void write_plot(const PlotOptions& options, const std::filesystem::path& path, const std::string& svg);

// Of the pictures of a file; made.  Throws OutputError.
std::filesystem::path plot_folder(const PlotOptions& options, const std::string& file);

// Fields of states, a picture each, or panels of one.  Throws InputError, UsageError, OutputError.
void plot_pictures(const PlotOptions& options, const Catalogue& catalogue);
void plot_sheet(const PlotOptions& options, const Catalogue& catalogue);
// Fields over a line, or over the interfaces: a panel each, a curve a state.
void plot_line(const PlotOptions& options, const Catalogue& catalogue);
void plot_interface(const PlotOptions& options, const Catalogue& catalogue);
// An empty text where `text` is X,Y:X,Y; else what is wanted.
std::string line_error(const std::string& text);
// Two columns of tables against each other, a panel for each of options.xy.  Throws InputError, UsageError.
void plot_columns(const PlotOptions& options);

}  // namespace sage::app

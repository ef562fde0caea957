// Commands that prove the program: `sagefe figures`, `stress` and `verify`.  sagefe knows their options alone; each is done
// by a program of its own, sagefe-NAME, which is built with the tests (tests/studies) and lies in sagefe's folder.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"

namespace sage::app {

struct FiguresOptions {
  std::filesystem::path folder = "figures";
  std::vector<std::string> only, formats;
  bool list = false;
};
struct StressOptions {
  std::vector<std::string> only;
  bool list = false, details = false;
  std::string csv, page;
};
struct VerifyOptions {
  std::string only, csv, write;
  bool list = false, rows = false;
};

// "7.16" or "16".  Throws std::invalid_argument that says what is wanted.
int figure_from(const std::string& text);

// What this program does itself: nothing in sagefe, one of them in each of the others.
struct Studies {
  std::function<int(const FiguresOptions&, const Catalogue&)> figures;
  std::function<int(const StressOptions&, const Catalogue&)> stress;
  std::function<int(const VerifyOptions&, const Catalogue&)> verify;
};
Studies& studies();

// The program sagefe-NAME of the folder that this program lies in, in place of this one and with its words.  Comes
// back only by OutputError, where there is no such program: other folders are not searched.
[[noreturn]] void become_study(const std::string& name, char** words);

}  // namespace sage::app

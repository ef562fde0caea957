// One HTML file that shows finished runs: opens from disk, needs no server and makes no request.  docs/manual/report.md
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/record/stored_result.hpp"

namespace sage::report {

// A run by its result file and the model that this file gives.  Both outlive the page.
struct PageRun {
  std::filesystem::path file;  // STEM.h5; tables, listing and pictures of the run lie beside it
  const StoredResult& stored;
  const Model& model;
};

struct PageOptions {
  std::vector<std::string> fields =
      {};  // the only ones besides the displacement, by name; empty = as many as there is room for
  // Bytes of one run's part, about.  0 = 4 MB, or 80 bytes an element where that is more.
  std::size_t room = 0;
  std::size_t most_points = 1000000;  // above that each element has the mean of its points
};

struct Page {
  std::string html;
  std::vector<std::string> omitted;  // what there was no room for, a sentence each
};

// Names that PageOptions::fields may have, of a model.
std::vector<std::string> page_fields(const Model& model);

// Of one run, or several of which the page shows two side by side.  Throws InputError where a file is damaged.
Page make_page(const std::vector<PageRun>& runs, const PageOptions& options = {});

}  // namespace sage::report

// One HTML file that shows finished runs: opens from disk, needs no server and makes no request.  docs/manual/report.md
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sage/core/catalogue.hpp"
#include "sage/record/stored_result.hpp"

namespace sage::report {

// A run and its states.
struct PageRun {
  struct State {
    int stage = 0, increment = 0;  // stage from 0
  };

  std::filesystem::path file;   // STEM.h5; tables, listing and pictures of the run lie beside it
  const Model& model;           // outlives the page
  std::string deck_name, deck;  // deck: its characters
  std::string failure{};        // why it ended without equilibrium; empty = it has not
  bool goes_on = false;         // is being computed
  std::vector<State> states{};
  std::function<Frame(std::size_t)> frame{};  // by the place in `states`
};
// Of a result file and the model that it gives.  Both outlive the page.
PageRun page_run(const std::filesystem::path& file, const StoredResult& stored, const Model& model);

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

// Of a table of cases (STUDY.sweep.csv): points over any column, and the rows.  Throws InputError.
Page make_table_page(const std::filesystem::path& table);

}  // namespace sage::report

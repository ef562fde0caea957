#include "sage/python/python_sweep.hpp"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "sage/app/stored_heads.hpp"
#include "sage/deck/layout.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/platform/checksum.hpp"
#include "sage/python/python_model.hpp"
#include "sage/record/csv.hpp"
#include "sage/record/out_file.hpp"
#include "sage/sweep/table.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::python {

std::string run_sweep(const std::string& study_file, const std::string& folder, int jobs,
                      const std::vector<std::string>& collect, const std::string& module) {
  const std::shared_ptr<const Catalogue> known = catalogue();
  Signals signals;
  std::string text;
  {
    const py::gil_scoped_release unlocked;
    sweep::Study study = sweep::read_study(study_file);
    for (const std::string& name : collect)
      if (std::ranges::find(study.collect, name) == study.collect.end()) study.collect.push_back(name);
    BuildOptions build;
    build.heads = app::stored_heads(*known);
    const Deck deck =
        study.layout.empty() ? read_deck(study.deck) : read_deck(study.deck, load_layout(study.layout));
    const sweep::Sweep all(std::move(study), deck, *known, build);
    const std::filesystem::path stem = std::filesystem::path(folder) / std::filesystem::path(study_file).stem();
    sweep::Journal journal(folder, stem.filename().string(), 0);
    sweep::SweepOptions options;
    options.threads = jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const auto sum = checksum_of(module);
    options.program = sum ? sum->value() : 0;
    options.stop_asked = signals.stop_asked();
    options.choose_solver = choose_solver;
    // In this thread, which alone sees signals.
    options.progress = [stop = options.stop_asked](std::size_t, std::size_t) { (void)stop(); };
    const sweep::SweepResult result = all.run(journal, options);
    if (result.left == 0) {
      text = sweep::csv_text(all, result, kCsvDigits);
      write_file(stem.string() + ".sweep.csv", text);
      write_file(stem.string() + ".sweep.svg", sweep::plot_text(all, result));
    }
  }
  signals.raise_if_any();
  return text;
}

}  // namespace sage::python

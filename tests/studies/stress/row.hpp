// The stability stress test: every row sweeps one thing towards the edge of what makes sense.  Each trial of a
// row must be right to a stated error, or end with a named diagnostic.  Anything else is a failure.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sage/builder/model_input.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::stress {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();  // of rounding

// One run of a row, judged.
struct Trial {
  std::string label;            // "nu = 0.49"
  double parameter = kUnknown;  // where the plot has it; NaN = not in the plot
  std::string series;           // of the plot; empty = the only one
  std::string expected;         // "right to 1e-9", "says \"outside the yield surface\""
  std::string outcome;          // what happened
  double error = kUnknown;      // relative, against the row's reference
  double allowed = kUnknown;
  bool ok = false;

  // Of 16; NaN where no error was measured.
  double digits_lost() const;
};

// What came of a deck: a finished or stopped run, or a refusal.
struct Ran {
  std::optional<scenes::WholeRun> run;  // none = the input was refused
  std::string refusal;                  // every message of the refusal
  bool completed() const { return run && run->completed(); }
  bool finite() const;  // of all increments; true where nothing was computed
  // All messages of the program: notes, warnings, errors, the page about a failure.
  std::string words() const;
};

// What a row's function works with.
class Sweep {
 public:
  explicit Sweep(const scenes::Workbench& bench) : bench_(&bench) {}

  // InputError and a run that failed become a refusal; whatever else is thrown ends the row as a failure.
  Ran run(const std::string& deck, const BuildOptions& options = {}, const RunSettings& settings = {}) const;
  Ran run(const ModelInput& input) const;
  const Catalogue& catalogue() const { return bench_->catalogue(); }

  // The run must be complete, its numbers finite, and the error within what is allowed.
  Trial& right(const std::string& label, double parameter, const Ran& ran, double error, double allowed);
  // The program must say this; the numbers, if any, must be finite.
  Trial& says(const std::string& label, double parameter, const Ran& ran, const std::string& text);
  // It must not say it.
  Trial& silent(const std::string& label, double parameter, const Ran& ran, const std::string& text);
  // Complete, or stopped with a reason; finite either way.
  Trial& clean(const std::string& label, double parameter, const Ran& ran);
  // A condition in words.
  Trial& holds(const std::string& label, double parameter, bool condition, const std::string& expected,
               const std::string& outcome);

  std::vector<Trial> trials;

 private:
  Trial& add(const std::string& label, double parameter);
  const scenes::Workbench* bench_;
};

struct Row {
  std::string name;       // for --only: "poisson"
  std::string family;     // heading in the report
  std::string title;      // what is swept
  std::string reference;  // against what, and where allowed errors come from
  std::string axis;       // the swept parameter with its unit; empty = no plot
  bool log_axis = false;
  std::function<void(Sweep&)> run;
};

// All rows, by family.
std::vector<Row> all_rows();
std::vector<Row> material_rows();
std::vector<Row> collapse_rows();
std::vector<Row> interface_rows();
std::vector<Row> shape_rows();
std::vector<Row> support_rows();
std::vector<Row> invariance_rows();
std::vector<Row> stage_rows();
std::vector<Row> input_rows();
std::vector<Row> water_rows();
std::vector<Row> structure_rows();
std::vector<Row> clay_rows();
std::vector<Row> pore_rows();

struct RowResult {
  std::vector<Trial> trials;
  std::string thrown;  // an exception that should not have been; empty = none
  double seconds = 0.0;

  bool ok() const;
  double worst_digits() const;  // lost, of all trials; NaN = none measured
};

RowResult evaluate(const Row& row, const scenes::Workbench& bench);

}  // namespace sage::stress

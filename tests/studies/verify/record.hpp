// The verification book: cases that compare the program with closed forms, converged references and published
// values.  A case is a function that fills a Record with rows; a row is one number against its reference.
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "tests/studies/scenes/deck_writer.hpp"
#include "tests/studies/scenes/whole_run.hpp"

namespace sage::verify {

using namespace sage::scenes;

enum class Where { plane_strain, axisymmetric, point };
const char* name_of(Where where);
inline Where where_of(int geometry_code) {
  return geometry_code == 1 ? Where::plane_strain : Where::axisymmetric;
}

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// How sure the reference is.
enum class Grade {
  exact,      // closed form
  computed,   // converged independent computation
  published,  // printed in a named source
  twofold,    // one model computed in two ways that must agree
};
const char* name_of(Grade grade);

struct Row {
  std::string what;
  Where where = Where::plane_strain;
  double computed = kNone, reference = kNone;
  double error = kNone;  // relative to the reference, or absolute where that is 0 or the row says so
  double gate = kNone;   // largest |error| that passes
  double order = kNone, theory = kNone;  // of the error in the mesh or step size; kNone = no sequence
  bool relative = true;
  bool pass = false;
  double used = 0.0;  // |error| / gate, or the wanted over the observed order: above 1 fails
  double seconds = 0.0;
};

// Errors of a sequence, for the plots.
struct Sequence {
  std::string name;
  Where where = Where::plane_strain;
  std::vector<double> size, error;
  double theory = kNone;
};

// What a case writes into.  The time of a row is that since the row before.
class Record {
 public:
  explicit Record(const Workbench& bench) : bench_(bench) {}

  const Workbench& bench() const { return bench_; }
  // Throws std::runtime_error with the program's reason where a run is not completed.
  WholeRun run(const DeckWriter& deck) const;
  WholeRun run(Model model, std::span<Observer* const> others = {}) const;
  // Stopping short of the whole load is an answer too: for collapse loads.
  WholeRun try_run(const DeckWriter& deck, int max_cuts = 12) const;

  // |computed / reference - 1| <= gate.
  void near(Where where, const std::string& what, double computed, double reference, double gate);
  // |computed - reference| <= gate, for differences and for references near zero.
  void within(Where where, const std::string& what, double computed, double reference, double gate);
  // |value| <= gate, where zero is right.
  void small(Where where, const std::string& what, double value, double gate) {
    within(where, what, value, 0.0, gate);
  }
  // Observed order of the last two errors >= theory - slack.  size: of cells or steps, falling.
  void order(Where where, const std::string& what, const std::vector<double>& size,
             const std::vector<double>& error, double theory, double slack = 0.15);
  // A case that stopped.
  void stopped(const std::string& reason);

  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Sequence>& sequences() const { return sequences_; }

 private:
  using Clock = std::chrono::steady_clock;
  Row& add(Where where, const std::string& what);

  const Workbench& bench_;
  std::vector<Row> rows_;
  std::vector<Sequence> sequences_;
  Clock::time_point last_ = Clock::now();
};

struct Case {
  std::string name;    // "lame.order": what --only looks at
  std::string title;   // what is computed
  std::string source;  // of the reference
  Grade grade = Grade::exact;
  std::string gate;  // why the gate is what it is
  std::function<void(Record&)> run;
  bool takes_minutes = false;  // computed for the page, and where --only is its whole name
};

struct Section {
  std::string title;
  std::vector<Case> cases;
};

struct CaseResult {
  const Case* of = nullptr;
  std::vector<Row> rows;
  std::vector<Sequence> sequences;
  double seconds = 0.0;

  bool pass() const;
};

// The limit load that a stopped run prints, as a share of its stage's load; kNone if it prints none.
struct Bracket {
  double from = kNone, to = kNone;
};
Bracket printed_bracket(const WholeRun& run);

// The value between `low`, where stands() is true, and `high`, where it is not, to `width`; no number where the
// ends are otherwise.
double bisect(double low, double high, double width, const std::function<bool(double)>& stands);

// Never throws: what a case throws becomes a failing row.
CaseResult run_case(const Case& one, const Workbench& bench);

}  // namespace sage::verify

// Runs a deck in memory through reader, model builder and analysis, and keeps what a study looks at.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sage/analysis/run.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"

namespace sage::scenes {

// The state at the end of an increment.  Tension positive; one entry a dof.
struct Snapshot {
  int stage = 0;  // from 0
  double load_factor = 0.0;
  int iterations = 0, cuts = 0;
  Eigen::VectorXd u, internal, external;
  std::array<long, kStatuses> points{};
};

// Stresses of a group: law_size x (points of all elements).
using PointStresses = Eigen::MatrixXd;

struct WholeRun {
  std::unique_ptr<Model> model;
  RunResult result;
  std::vector<Snapshot> increments;
  std::vector<PointStresses> stress;  // at the end of the last increment, by group
  std::vector<std::string> warnings;  // of the model and of the run
  double out_of_balance = 0.0;        // largest of all stages
  std::string failure;                // the page for a person

  bool warns(const std::string& words) const;  // some warning contains them
  bool completed() const { return result.status == RunStatus::completed; }
  // Throws AnalysisError where there is none.
  const Snapshot& last() const {
    if (increments.empty()) throw AnalysisError("S501", "no increment was computed: " + failure);
    return increments.back();
  }
  int index(int number) const;  // of a deck node
  Vector2 u(int number) const;  // at the end
  Vector2 position(int number) const;
  // What supports put on a node at the end: internal force minus load.
  Vector2 reaction(int number) const { return reaction(last(), number); }
  Vector2 reaction(const Snapshot& at, int number) const;
  // Sum over nodes of one component of the reaction.
  double reaction(const Snapshot& at, const std::vector<int>& numbers, int component) const;
  double largest_u() const { return last().u.cwiseAbs().maxCoeff(); }
  int iterations() const;  // of all increments
};

// What decks are run with: all elements, laws and solvers, the built-in layout, the rule that picks a solver.
class Workbench {
 public:
  Workbench(Catalogue catalogue, std::function<int(const SystemSize&)> choose_solver);

  const Catalogue& catalogue() const { return catalogue_; }
  // Of a run by hand: with the rule that picks a solver.
  RunSettings settings() const {
    RunSettings settings;
    settings.choose_solver = choose_solver_;
    return settings;
  }
  // Throws InputError for a deck with mistakes.
  Model build(const std::string& deck, const BuildOptions& options = {}) const;
  // A built model, perhaps with loads or places that a card's ten columns can't hold.
  WholeRun run(Model model, const RunSettings& settings = {}, std::span<Observer* const> others = {}) const;
  WholeRun run(const std::string& deck, const BuildOptions& options = {},
               const RunSettings& settings = {}) const;
  // With observers of one's own, and nothing kept besides.
  RunResult run(const Model& model, std::span<Observer* const> observers) const;

 private:
  Catalogue catalogue_;
  Layout layout_;
  std::function<int(const SystemSize&)> choose_solver_;
};

}  // namespace sage::scenes

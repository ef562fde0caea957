// Factor of safety by strength reduction: the largest factor by which the strengths of a model can be divided so
// that it still finds equilibrium.  docs/theory/strength_reduction.md
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sage/analysis/run.hpp"
#include "sage/model/strength.hpp"
#include "sage/platform/profile.hpp"
#include "sage/record/result.hpp"
#include "sage/safety/factor_search.hpp"

namespace sage::safety {

// Where the analysis of a factor begins.
enum class Start {
  carried,  // from the state of the last factor that stands, with the stresses and the history that it has
  anew,     // from the beginning of the deck: every stage is run with the divided strengths
};

struct Options {
  SearchLimits limits;
  DilationRule dilation = DilationRule::reduced;
  Start start = Start::carried;
  int stage = -1;  // the last stage that is run, from 0; negative = the model's last
  std::vector<ModelPart> reduce{ModelPart::soil};  // parts whose strength is divided
  std::vector<int> groups;                         // numbers of those groups of the parts that are; empty = all
  int iterations = 40;                             // of an attempt
  int cuts = 5;                                    // halvings of a factor's way before it is given up

  bool divides(ModelPart part) const { return std::ranges::find(reduce, part) != reduce.end(); }
};

enum class Verdict {
  stands,     // equilibrium
  falls,      // none, and the ground goes on moving
  undecided,  // none, but the ground rests, or is only shaken: perhaps only the iterations failed
};

// One factor that was tried.  Relative forces: beside the sum of what all elements hold, root mean square.
struct FactorTrial {
  double factor = 0.0,
         from = 0.0;  // from: the factor whose state it began with; 0 = from the start of the deck
  Verdict verdict = Verdict::stands;
  bool proved = false;          // of one that falls: the ground moved by the size of the model
  std::string reason;           // why, in one line
  std::string page;             // of a failure: all that the run says of it
  double out_of_balance = 0.0;  // relative force, of the last iteration
  double released =
      1.0;  // share of the forces let go, or of the last stage's loads, that equilibrium was found for
  double displacement =
      0.0;        // largest along an axis since the strengths began to fall; Start::anew: since the run began
  int node = -1;  // where: index
  std::vector<double> displacement_of_groups;  // the same of each group of the deck; empty where nothing moved
  // Of each group of the deck, in the motion of a factor that falls: dissipation.hpp; empty = not known.
  std::vector<double> dissipation;
  int iterations = 0, cuts = 0;
  long yielded = 0;  // points that yield, slip, are open, at the apex or cut off in tension
};

// A group that takes part in the collapse.
struct Failing {
  std::size_t group = 0;  // index
  double share = 0.0;     // of the dissipation of all groups, 0 .. 1
};

struct Safety {
  std::vector<FactorTrial> trials;     // as they were tried
  std::optional<double> lower, upper;  // ends of the bracket, where there are
  // Why the answer is not the bracket that was asked for; empty = it is, and its upper end falls.
  std::string incomplete;
  bool stopped = false;  // as RunSettings::stop_asked wanted
  std::vector<std::string> reduced,
      untouched;  // materials: "1 clay (mohr_coulomb)", of the others with the reason
  // At the upper end that falls: structures that yield, then the others, the largest share first.  Empty = not known.
  std::vector<Failing> failing;
  int stages = 0;          // that were run with factor 1
  double tolerance = 0.0;  // of the relative force
  // Motion and strain of the trial that shows the mechanism, as a state of the model: the upper end's, or where that
  // has none the last that stands; scaled to a displacement of 5 % of the mesh.  Null = no trial moved anything.
  std::unique_ptr<Frame> mechanism;
  std::vector<LawPtr>
      laws;  // of the trials before the last: states, also those of the mechanism, refer to theirs
  double mechanism_factor = 0.0;
  Profile profile;  // of all runs and trials

  bool complete() const { return incomplete.empty() && !stopped; }
  // The last trial of a factor; nullptr = it was not tried.
  const FactorTrial* at(std::optional<double> factor) const;
};

// Behind the chosen stage the model gets one for the trials, and its materials change; it must outlive the result.  settings: as for run().
// Throws InputError (a model in which nothing has strength; a stage or a group that it lacks) and what run() throws.
Safety find_safety(Model& model, const Catalogue& catalogue, const RunSettings& settings,
                   const Options& options);

}  // namespace sage::safety

#include "sage/app/converge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "sage/app/exit_codes.hpp"
#include "sage/output/discretisation.hpp"
#include "sage/output/out_file.hpp"
#include "sage/output/values.hpp"
#include "sage/study/convergence.hpp"

namespace sage::app {

namespace {

using study::Ladder;
using study::Limit;

// One mesh of the ladder as options of the model builder, and as a user would ask for it.
struct Rung {
  BuildOptions build;
  std::string options;
};

struct Quantity {
  std::string name;
  std::vector<double> values;  // one a mesh
  // Its size beside the largest of its kind (displacement, force) in the report's history; of all meshes so far
  // the largest.
  double largest_share = 1.0;
};

struct Row {
  int elements = 0, dofs = 0;
  double seconds = 0.0;
};

int code_of(const Catalogue& catalogue, const std::string& name) {
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.name == name) return code;
  throw std::logic_error("no element " + name);
}

// High degrees pay where the law is linear, and fit where all solids are quadrilaterals without interfaces.
Ladder ladder_for(const Model& model, const Catalogue& catalogue) {
  for (const Group& group : model.groups) {
    const ElementEntry& entry = *catalogue.elements.find(group.element_code);
    const bool quad =
        entry.law_size == 4 && entry.corners == 4 && entry.nodes != 9;  // quad9 cards hold a centre
    const LawRef law = model.material_of(group).law_ref();
    const auto* solid = std::get_if<const SolidLaw*>(&law);
    if (group.elements() > 0 && (!quad || solid == nullptr || !(*solid)->linear())) return Ladder::halving;
  }
  return Ladder::spectral;
}

std::string grade_text(const Grading& g) {
  return fmt::format(" --grade {}:{}:{:.3g}", g.node == 0 ? std::string("auto") : std::to_string(g.node),
                     g.layers, g.ratio);
}

// Degree 4, 6, 8 with 4, 6, 8 layers at the corners; then halved elements of degree 8 and layers of twice as
// gentle a ratio, for the error that degree 8 leaves within a layer does not depend on their number.
Rung spectral_rung(const BuildOptions& asked, const Catalogue& catalogue, int level) {
  static const char* const kNames[] = {"quad25", "quad49", "quad81"};
  Rung rung{asked, {}};
  const std::string name = kNames[std::min(level, 2)];
  rung.build.element = code_of(catalogue, name);
  rung.build.formulation = -1;
  rung.build.refine = asked.refine + std::max(0, level - 2);
  if (rung.build.gradings.empty()) rung.build.gradings.push_back({});
  rung.options = "--element " + name;
  if (rung.build.refine > 0) rung.options += fmt::format(" --refine {}", rung.build.refine);
  for (Grading& g : rung.build.gradings) {
    g.layers = 4 + 2 * level;
    for (int i = 2; i < level; ++i) {
      g.ratio = std::sqrt(g.ratio);
      g.layers = std::min(2 * g.layers, 30);
    }
    rung.options += grade_text(g);
  }
  return rung;
}

Rung halving_rung(const BuildOptions& asked, int level) {
  Rung rung{asked, {}};
  rung.build.refine = asked.refine + level;
  rung.options = fmt::format("--refine {}", rung.build.refine);
  for (const Grading& g : asked.gradings) rung.options += grade_text(g);
  return rung;
}

bool is_held(const Model& model, const Report& report, std::size_t c) {
  const auto holds = [&](const Fixity& f) {
    return f.code[c] == FixityCode::fixed &&
           std::find(report.nodes.begin(), report.nodes.end(), f.node) != report.nodes.end();
  };
  for (const Stage& stage : model.stages)
    if (std::any_of(stage.fixities.begin(), stage.fixities.end(), holds)) return true;
  return std::any_of(model.fixities.begin(), model.fixities.end(), holds);
}

// Nodes of a report that the deck lists.
int deck_nodes(const Model& model, const Report& report) {
  return static_cast<int>(std::count_if(report.nodes.begin(), report.nodes.end(),
                                        [&](int node) { return node < model.mesh.deck_nodes; }));
}

// The last value of each report: a triaxial ratio; of a node report the force where the nodes (two or more) are
// held and the displacement where they are free, in each direction.
std::vector<Quantity> quantities_of(const RunOutcome& outcome) {
  std::vector<Quantity> all;
  const Model& model = *outcome.model;
  for (std::size_t i = 0; i < model.reports.size(); ++i) {
    const std::string name = "report" + std::to_string(i + 1);
    if (model.reports[i].kind == ReportKind::triaxial) {
      const auto& rows = outcome.reports->triaxial(i);
      if (rows.empty()) continue;
      const bool known = std::isfinite(rows.back().ratio);
      all.push_back({name + (known ? ".ratio" : ".measured_deviator"),
                     {known ? rows.back().ratio : rows.back().measured_deviator}});
      continue;
    }
    const auto& rows = outcome.reports->nodes(i);
    if (rows.empty()) continue;
    static const char* const kNames[2][2] = {{".ux", ".uy"}, {".fx", ".fy"}};
    for (std::size_t c = 0; c < 2; ++c) {
      const bool held = is_held(model, model.reports[i], c);
      // The reaction of one node is that of its share of the edge, which shrinks with the mesh.
      if (held && deck_nodes(model, model.reports[i]) < 2) continue;
      double largest = 0.0;
      for (const NodesRow& row : rows)
        for (double v : held ? row.force : row.displacement) largest = std::max(largest, std::abs(v));
      const double value = (held ? rows.back().force : rows.back().displacement)[c];
      all.push_back({name + kNames[held ? 1 : 0][c], {value}, largest > 0.0 ? std::abs(value) / largest : 0.0});
    }
  }
  return all;
}

double relative(const Limit& limit) {
  return limit.error / std::max(std::abs(limit.value), std::numeric_limits<double>::min());
}

// What symmetry makes zero has no relative error: rounding, or the error of the mesh, beside the report's other
// values.
bool is_zero(const Quantity& quantity, Ladder ladder) {
  constexpr double kRounding = 1e-9, kSmall = 1e-4, kCertain = 0.1;
  if (quantity.largest_share <= kRounding) return true;
  if (quantity.largest_share > kSmall) return false;
  return !(relative(study::limit_of(quantity.values, ladder)) < kCertain);
}

// Relative error of the quantity that is least certain.  The one shown counts always.
double worst_of(const std::vector<Quantity>& quantities, std::size_t shown, Ladder ladder) {
  double worst = 0.0;
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (i == shown || !is_zero(quantities[i], ladder))
      worst = std::max(worst, relative(study::limit_of(quantities[i].values, ladder)));
  return worst;
}

// Appends a mesh's values.  False where a quantity has none on it.
bool append(std::vector<Quantity>& quantities, const std::vector<Quantity>& now) {
  for (Quantity& q : quantities) {
    const auto same = std::find_if(now.begin(), now.end(), [&](const Quantity& n) { return n.name == q.name; });
    if (same == now.end()) return false;
    q.values.push_back(same->values.front());
    q.largest_share = std::max(q.largest_share, same->largest_share);
  }
  return true;
}

// The one that the table shows: on the first mesh the first that is more than zero.
std::size_t shown_of(const std::vector<Quantity>& quantities) {
  for (double least : {1e-4, 1e-9})
    for (std::size_t i = 0; i < quantities.size(); ++i)
      if (quantities[i].largest_share > least) return i;
  return quantities.size();
}

// Screen and CSV side by side.
class Table {
 public:
  Table(const Model& model, const std::string& quantity, const std::filesystem::path& path) : file_(path) {
    fmt::print("{}\n  {:>4} {:>9} {:>9} {:>18} {:>12} {:>9}  {}\n", model.title, "mesh", "elements", "dofs",
               quantity, "error", "seconds", "options");
    file_.text() = "# " + model.title +
                   "\n# finer meshes until the reports are certain; error: estimate, see the manual\n" +
                   "mesh,elements,dofs,value,error,seconds,options\n";
  }
  void row(std::size_t mesh, const Row& row, const Limit& limit, double value, const std::string& options) {
    fmt::print("  {:>4} {:>9} {:>9} {:>18.10g} {:>12} {:>9.3f}  {}\n", mesh, row.elements, row.dofs, value,
               std::isfinite(limit.error) ? fmt::format("{:.1e}", limit.error) : "-", row.seconds, options);
    std::fflush(stdout);
    file_.text() +=
        fmt::format("{},{},{},{:.12g},{},{:.4f},{}\n", mesh, row.elements, row.dofs, value,
                    std::isfinite(limit.error) ? fmt::format("{:.3g}", limit.error) : "", row.seconds, options);
  }
  void finish(const std::string& last) {
    file_.text() += "# " + last + "\n";
    file_.finish();
    fmt::print("  {}\n  files     {}\n", last, file_.path().string());
  }

 private:
  OutFile file_;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int converge(const RunRequest& request, const ConvergeOptions& options, const Catalogue& catalogue) {
  const auto start = std::chrono::steady_clock::now();
  require_file(request.deck, "--converge");
  const Deck deck = read_input(request.deck, request.input);
  const Model first = build_model(deck, catalogue, request.input.build);
  print_diagnostics(first.diagnostics);
  if (first.reports.empty())
    throw InputError({request.deck, 0, 0, 0},
                     "--converge needs a report card: it says which number must be certain");
  const Ladder ladder = ladder_for(first, catalogue);
  ResultFiles results(request.output.folder, case_name(request.deck),
                      {request.deck, checksum(*deck.source), "convergence"});

  std::vector<Quantity> quantities;
  std::optional<Table> table;
  std::string stopped;
  std::size_t shown_index = 0;
  double last_seconds = 0.0;
  for (int level = 0; stopped.empty(); ++level) {
    const Rung rung = ladder == Ladder::spectral ? spectral_rung(request.input.build, catalogue, level)
                                                 : halving_rung(request.input.build, level);
    // Four times the elements cost four times and more.
    if (seconds_since(start) + 4.0 * last_seconds > options.max_seconds) {
      stopped =
          fmt::format("the next mesh would pass the limit of {:g} s (--max-seconds)", options.max_seconds);
      break;
    }
    RunRequest one = request;
    one.input.build = rung.build;
    one.input.build.say = {};  // the table says it
    one.quiet = true;
    one.results = &results;
    one.restart = false;
    one.checkpoint_seconds = -1.0;
    one.output = {};
    one.output.folder = request.output.folder;
    one.output.listing = one.output.increments = false;
    one.max_dofs = options.max_dofs;
    const RunOutcome outcome = run_deck(one, catalogue);
    if (outcome.too_large) {
      stopped = fmt::format("the next mesh has {} dofs, more than the limit of {} (--max-dofs)",
                            outcome.model->dofs(), options.max_dofs);
      break;
    }
    if (outcome.exit_code != kOk) {
      const std::string& reason = outcome.record.result.reason;
      stopped = "no equilibrium with " + rung.options + ": " + reason.substr(0, reason.find('\n'));
      break;
    }
    last_seconds = outcome.record.seconds;
    const std::vector<Quantity> now = quantities_of(outcome);
    if (quantities.empty()) {
      quantities = now;
      shown_index = shown_of(quantities);
      if (shown_index == quantities.size())
        throw InputError({request.deck, 0, 0, 0}, "the deck's reports have no value that can converge");
    } else if (!append(quantities, now)) {
      stopped = "the reports of the next mesh lack a value that the others have";
      break;
    }
    const Quantity& shown = quantities[shown_index];
    if (!table)
      table.emplace(*outcome.model, shown.name,
                    request.output.folder / (case_name(request.deck) + ".convergence.csv"));
    table->row(shown.values.size(), {outcome.record.scene.elements, outcome.model->dofs(), last_seconds},
               study::limit_of(shown.values, ladder), shown.values.back(), rung.options);
    if (worst_of(quantities, shown_index, ladder) <= options.tolerance) break;
  }
  if (!table) throw InputError({request.deck, 0, 0, 0}, "--converge: " + stopped);
  std::string last;
  for (const Quantity& q : quantities) {
    if (&q != &quantities[shown_index] && is_zero(q, ladder)) continue;
    const Limit limit = study::limit_of(q.values, ladder);
    last += (last.empty() ? "result    " : "; ") + q.name + " ";
    last += std::isfinite(limit.error) ? with_error(limit.value, limit.error)
                                       : fmt::format("{:.6g}, error unknown", limit.value);
    if (limit.rate) last += fmt::format(" (extrapolated, rate {:.2f})", *limit.rate);
  }
  last += fmt::format("; {:.3g} s", seconds_since(start));
  if (!first.left_out.empty()) last += "; PARTIAL: " + left_out_words(first);
  if (!stopped.empty())
    last += fmt::format("; NOT REACHED: relative error {:.1g} asked for; {}", options.tolerance, stopped);
  table->finish(last);
  results.close();
  return stopped.empty() ? kOk : kNotConverged;
}

}  // namespace sage::app

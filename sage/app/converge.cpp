#include "sage/app/converge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "sage/app/answer_run.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/surroundings.hpp"
#include "sage/app/wrap.hpp"
#include "sage/convergence/convergence.hpp"
#include "sage/deck/optional_file.hpp"
#include "sage/model/arc_sides.hpp"
#include "sage/record/discretisation.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/report_components.hpp"
#include "sage/record/values.hpp"

namespace sage::app {

namespace {

using convergence::Limit;
using convergence::MeshSequence;

// One mesh of the sequence as options of the model builder, and as a user would ask for it.
struct MeshOptions {
  BuildOptions build;
  std::string options;
};

// What a mesh cost, and the report files that it wrote.
struct Row {
  int elements = 0, dofs = 0;
  double seconds = 0.0;
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  MeshOptions mesh;
  std::shared_ptr<RunOutcome> run = {};  // where results are kept: each mesh has fewer elements than the next
};

// Quadrilaterals of rising degree that take the cards of 4- and 8-node ones.
std::vector<int> rising_degrees(const Catalogue& catalogue) {
  std::vector<int> codes;
  for (const auto& [code, entry] : catalogue.elements.entries())
    if (entry.solid() && entry.square() && entry.makes_nodes()) codes.push_back(code);
  std::ranges::sort(codes, {}, [&](int code) { return catalogue.elements.find(code)->nodes; });
  return codes;
}

// The elements are halved.
MeshSequence halving(const Model& model) {
  int degree = 0;
  for (const Group& group : model.groups)
    if ((group.solid() || group.flow()) && group.elements() > 0 &&
        (degree == 0 || group.element->traits().degree < degree))
      degree = group.element->traits().degree;
  return {.kind = MeshSequence::halving, .most = std::pow(4.0, std::max(degree, 1))};
}

// High degrees pay where the law is linear, and fit where all solids are quadrilaterals without interfaces.
MeshSequence sequence_for(const Model& model, const Catalogue& catalogue) {
  const std::vector<int> degrees = rising_degrees(catalogue);
  if (degrees.empty()) return halving(model);
  for (const Group& group : model.groups) {
    const bool quad =
        group.entry->unknowns.empty() && can_replace(catalogue.elements.find(degrees.front()), *group.entry);
    const LawRef law = model.material_of(group).law_ref();
    const auto* solid = std::get_if<const SolidLaw*>(&law);
    if (group.elements() > 0 && (!quad || solid == nullptr || !has_constant_stiffness(**solid)))
      return halving(model);
  }
  return {MeshSequence::spectral, degrees.size()};
}

std::string grade_text(const Grading& g) {
  return fmt::format(" --grade {}:{}:{:.3g}", g.node == 0 ? std::string("auto") : std::to_string(g.node),
                     g.layers, g.ratio);
}

// Layers of a mesh: 4, 6, 8 ... of the ratio asked for.  Behind the mesh of the highest degree two in place of each, for
// the error that degree 8 leaves within a layer does not depend on their number; deeper ones than 1e-12 of the mesh would
// be rounding.
void set_layers(Grading& grading, int level, int highest) {
  constexpr int kMostLayers = 30;
  grading.layers = 4 + 2 * std::min(level, highest + 2);
  if (level <= highest) return;
  grading.ratio = std::sqrt(grading.ratio);
  grading.layers = std::min(2 * grading.layers, kMostLayers);
}

// Rising degrees (4, 6, 8) with layers at the corners, then halved elements of the highest, and with the layers of those
// the whole mesh halved: only so no two meshes have the same elements around any place.
MeshOptions spectral_mesh(const BuildOptions& asked, const Catalogue& catalogue, int level) {
  const std::vector<int> degrees = rising_degrees(catalogue);
  const int highest = static_cast<int>(degrees.size()) - 1;
  MeshOptions mesh{asked, {}};
  mesh.build.element = degrees[std::min(level, highest)];
  const std::string& name = catalogue.elements.find(mesh.build.element)->name;
  mesh.build.formulation = -1;
  mesh.build.refine = asked.refine + (level > highest ? 1 : 0);
  mesh.build.refine_graded = asked.refine_graded + std::max(0, level - highest - 1);
  if (mesh.build.gradings.empty()) mesh.build.gradings.push_back({});
  mesh.options = (asked.coarsen ? "--coarsen --element " : "--element ") + name;
  if (mesh.build.refine > 0) mesh.options += fmt::format(" --refine {}", mesh.build.refine);
  for (Grading& g : mesh.build.gradings) {
    set_layers(g, level, highest);
    mesh.options += grade_text(g);
  }
  if (mesh.build.refine_graded > 0)
    mesh.options += fmt::format(" --refine-graded {}", mesh.build.refine_graded);
  return mesh;
}

MeshOptions halving_mesh(const BuildOptions& asked, int level) {
  MeshOptions mesh{asked, {}};
  mesh.build.refine = asked.refine + level;
  mesh.options = fmt::format("--refine {}", mesh.build.refine);
  for (const Grading& g : asked.gradings) mesh.options += grade_text(g);
  if (asked.refine_graded > 0) mesh.options += fmt::format(" --refine-graded {}", asked.refine_graded);
  return mesh;
}

double relative(const Limit& limit) {
  return limit.error / std::max(std::abs(limit.value), std::numeric_limits<double>::min());
}

// A component of a report over all meshes so far.
struct Quantity {
  std::string name;
  std::vector<double> values, largest;  // one a mesh; largest: of its sisters too, see ReportComponent
  std::vector<double> around;           // of a point: LocalErrors; NaN = none

  void append(const ReportComponent& now, double local) {
    name = now.name;
    values.push_back(now.value);
    largest.push_back(now.largest);
    around.push_back(local);
  }
  // Displacements, heads and the forces of sections converge by themselves; the derivatives of a point do so around it, and at
  // it by chance.
  convergence::Around errors() const {
    const std::string column = name.substr(name.find('.') + 1);
    const bool itself = column == "ux" || column == "uy" || column == "head" || column == "pressure_head" ||
                        column.ends_with("_force") || column.ends_with("_moment");
    return {around, !itself};
  }
  Limit limit(MeshSequence sequence) const { return convergence::limit_of(values, sequence, errors()); }
  Limit limit_after(std::size_t meshes, MeshSequence sequence) const {
    return convergence::limit_after(values, meshes, sequence, errors());
  }
  double share() const { return largest.back() > 0.0 ? std::abs(values.back()) / largest.back() : 0.0; }
};

// The quantities that must become certain, and how certain they are.
class Follower {
 public:
  // names: those asked for; empty = the main ones.
  Follower(std::vector<std::string> names, MeshSequence sequence, double tolerance)
      : names_(std::move(names)), sequence_(sequence), tolerance_(tolerance) {}

  // A mesh's values, and what is known of each one's error around its point.  False where one that is followed has none
  // on it.
  bool append(const std::vector<ReportComponent>& components, const std::vector<double>& local);
  std::size_t meshes() const { return quantities_.empty() ? 0 : quantities_.front().values.size(); }
  // The one that the table shows.
  const Quantity& shown() const { return quantities_[shown_]; }
  Limit shown_limit() const { return shown().limit(sequence_); }
  // Whether a mesh (from 1) is as certain as asked, later ones considered.
  bool certain(std::size_t mesh) const { return enough(worst(mesh)); }
  // The mesh (from 1) whose least certain quantity is the most certain.
  std::size_t best() const;
  // No mesh of the last two is better than one before, and all agree: only rounding is left.
  bool exhausted() const;
  std::string result() const;
  // On the best mesh; see Convergence.
  std::vector<ConvergedValue> values() const;
  // Why a quantity does not count, a line each.
  std::vector<std::string> left_out() const;

 private:
  bool enough(double error) const { return error <= tolerance_ * (1.0 + 1e-12); }
  bool follow(const ReportComponent& component) const;
  std::string why_left_out(std::size_t i) const;
  double worst(std::size_t mesh) const;
  void choose_shown();
  void append_others(const std::vector<ReportComponent>& components, const std::vector<double>& local);

  std::vector<std::string> names_;
  MeshSequence sequence_;
  double tolerance_;
  std::vector<Quantity> quantities_;  // followed
  std::vector<Quantity> others_;      // not followed: their limits are reported, and decide nothing
  std::size_t shown_ = 0;
};

bool Follower::follow(const ReportComponent& component) const {
  return names_.empty() ? component.main
                        : std::find(names_.begin(), names_.end(), component.name) != names_.end();
}

// The first asked for, or the first that is not small beside its sisters, or the largest.
void Follower::choose_shown() {
  constexpr double kNotSmall = 0.1;
  const auto by_name = [&](const Quantity& q) { return !names_.empty() && q.name == names_.front(); };
  const auto large = [&](const Quantity& q) { return q.share() >= kNotSmall; };
  auto found = std::find_if(quantities_.begin(), quantities_.end(), by_name);
  if (found == quantities_.end()) found = std::find_if(quantities_.begin(), quantities_.end(), large);
  if (found == quantities_.end())
    found = std::max_element(quantities_.begin(), quantities_.end(),
                             [](const Quantity& a, const Quantity& b) { return a.share() < b.share(); });
  shown_ = static_cast<std::size_t>(found - quantities_.begin());
}

const ReportComponent* find_component(const std::vector<ReportComponent>& components, const std::string& name) {
  const auto same = std::find_if(components.begin(), components.end(),
                                 [&](const ReportComponent& c) { return c.name == name; });
  return same == components.end() || !std::isfinite(same->value) ? nullptr : &*same;
}

// One without a value on some mesh goes.
void Follower::append_others(const std::vector<ReportComponent>& components, const std::vector<double>& local) {
  std::erase_if(others_, [&](Quantity& q) {
    const ReportComponent* now = find_component(components, q.name);
    if (now == nullptr) return true;
    q.append(*now, local[now - components.data()]);
    return false;
  });
}

bool Follower::append(const std::vector<ReportComponent>& components, const std::vector<double>& local) {
  if (quantities_.empty()) {
    for (std::size_t i = 0; i < components.size(); ++i)
      if (std::isfinite(components[i].value))
        (follow(components[i]) ? quantities_ : others_).emplace_back().append(components[i], local[i]);
    for (const std::string& name : names_)
      if (std::none_of(quantities_.begin(), quantities_.end(),
                       [&](const Quantity& q) { return q.name == name; }))
        return false;
    choose_shown();
    return !quantities_.empty();
  }
  std::vector<const ReportComponent*> now;
  for (const Quantity& q : quantities_) {
    now.push_back(find_component(components, q.name));
    if (now.back() == nullptr) return false;
  }
  append_others(components, local);
  for (std::size_t i = 0; i < now.size(); ++i)
    quantities_[i].append(*now[i], local[now[i] - components.data()]);
  return true;
}

// Nothing of what was asked for by name, nor the one that is shown.  A component that is zero or tends to it
// has no relative error: what the tolerance leaves of its sisters is more.
std::string Follower::why_left_out(std::size_t i) const {
  constexpr double kRounding = 1e-9, kSmall = 1e-4, kCertain = 0.1, kTending = 0.05;
  if (!names_.empty() || i == shown_) return {};
  const Quantity& q = quantities_[i];
  const double share = q.share(), least = std::max(tolerance_, kRounding);
  const std::string beside =
      fmt::format("{:.3g} beside {:.3g} in its report", q.values.back(), q.largest.back());
  if (share <= least) return fmt::format("{}, less than {:.1g} of it", beside, least);
  const double error = relative(q.limit(sequence_));
  if (share <= kSmall && !(error < kCertain)) return beside + ", as small as the error of the mesh";
  const std::size_t n = q.values.size();
  const bool falls = n >= 3 && std::abs(q.values[n - 1]) < std::abs(q.values[n - 2]) &&
                     std::abs(q.values[n - 2]) < std::abs(q.values[n - 3]);
  return share <= kTending && falls && !(error < 1.0) ? beside + ", and it tends to zero" : std::string();
}

// Relative error of the quantity that is least certain.
double Follower::worst(std::size_t mesh) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    if (why_left_out(i).empty()) worst = std::max(worst, relative(quantities_[i].limit_after(mesh, sequence_)));
  return worst;
}

std::size_t Follower::best() const {
  std::size_t best = meshes();
  for (std::size_t mesh = meshes(); mesh-- > 1;)
    if (worst(mesh) < worst(best)) best = mesh;
  return best;
}

bool Follower::exhausted() const {
  constexpr double kNearlyCertain = 1e-6;
  return sequence_.kind == MeshSequence::spectral && best() + 2 <= meshes() && worst(best()) <= kNearlyCertain;
}

std::string Follower::result() const {
  const std::size_t mesh = best();
  std::string text;
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    if (!why_left_out(i).empty()) continue;
    const Limit limit = quantities_[i].limit_after(mesh, sequence_);
    text += (text.empty() ? "result    " : "; ") + quantities_[i].name + " ";
    text += std::isfinite(limit.error) ? with_error(limit.value, limit.error)
                                       : fmt::format("{:.6g}, error unknown", limit.value);
    if (limit.rate) text += fmt::format(" (extrapolated, rate {:.2f})", *limit.rate);
  }
  if (mesh < meshes()) text += fmt::format("; mesh {} is the best", mesh);
  return text;
}

std::vector<ConvergedValue> Follower::values() const {
  std::vector<ConvergedValue> all;
  const std::size_t mesh = best();
  const auto add = [&](const Quantity& q, bool decides) {
    const Limit limit = q.limit_after(mesh, sequence_);
    if (decides || std::isfinite(limit.error))
      all.push_back({q.name, limit.value, limit.error, !decides || enough(relative(limit))});
  };
  for (std::size_t i = 0; i < quantities_.size(); ++i) add(quantities_[i], why_left_out(i).empty());
  for (const Quantity& q : others_) add(q, false);
  return all;
}

std::vector<std::string> Follower::left_out() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    if (const std::string why = why_left_out(i); !why.empty())
      lines.push_back(fmt::format("left out  {}: {}", quantities_[i].name, why));
  return lines;
}

// Screen and CSV side by side.
class Table {
 public:
  Table(std::FILE* screen, const std::string& title, const std::string& quantity,
        const std::filesystem::path& path)
      : screen_(screen), file_(path) {
    const ProgressPause pause;
    fmt::print(screen_, "{}\n  {:>4} {:>8} {:>8} {:>16} {:>8} {:>9}  {}\n", title, "mesh", "elements", "dofs",
               quantity, "error", "seconds", "options");
    file_.text() = "# " + title +
                   "\n# finer meshes until the reports are certain; error: estimate, see the manual\n" +
                   "mesh,elements,dofs,value,error,seconds,options\n";
  }
  void row(std::size_t mesh, const Row& row, const Limit& limit, double value, const std::string& options) {
    const ProgressPause pause;
    // Options that do not fit beside the numbers stand below them.
    const std::string numbers =
        fmt::format("  {:>4} {:>8} {:>8} {:>16.10g} {:>8} {:>9.3f}", mesh, row.elements, row.dofs, value,
                    std::isfinite(limit.error) ? fmt::format("{:.1e}", limit.error) : "-", row.seconds);
    const bool fits = numbers.size() + 2 + options.size() <= static_cast<std::size_t>(kHelpColumns);
    fmt::print(screen_, "{}{}{}\n", numbers, fits ? "  " : "\n       ", options);
    std::fflush(screen_);
    file_.text() +=
        fmt::format("{},{},{},{:.12g},{},{:.4f},{}\n", mesh, row.elements, row.dofs, value,
                    std::isfinite(limit.error) ? fmt::format("{:.3g}", limit.error) : "", row.seconds, options);
  }
  void note(const std::string& text) {
    file_.text() += "# " + text + "\n";
    fmt::print(screen_, "  {}\n", text);
  }
  void finish(const std::string& last, const std::vector<std::filesystem::path>& reports) {
    note(last);
    file_.finish();
    fmt::print(screen_, "  files     {}\n", file_.path().string());
    for (const std::filesystem::path& report : reports)
      fmt::print(screen_, "            {}\n", report.string());
  }

  const std::filesystem::path& path() const { return file_.path(); }

 private:
  std::FILE* screen_;
  OutFile file_;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Meshes of the sequence, one after the other.
class ConvergenceStudy {
 public:
  ConvergenceStudy(const RunRequest& request, const ConvergeOptions& options, const Catalogue& catalogue);
  Convergence run();

 private:
  MeshSequence choose_sequence();
  std::string why_not_graded(const Deck& deck) const;
  int graded_elements(const Deck& deck, bool coarsen) const;
  std::optional<RunOutcome> run_mesh(const MeshOptions& mesh, SurroundingsReader& reader);
  std::string why_unusable(const RunOutcome& outcome, const MeshOptions& mesh,
                           std::vector<Surroundings> around);
  void find_blanks(const Model& model, const std::vector<ReportComponent>& components);
  bool add_mesh(int level);
  bool refine_until_converged();
  bool refine_and_close();
  Convergence outcome(bool reached) const;
  bool out_of_time();
  RunRequest request_for(const MeshOptions& mesh);
  void start_table(const std::string& quantity);
  void keep_best_files() const;

  RunRequest request_;
  const ConvergeOptions& options_;
  const Catalogue& catalogue_;
  const Clock::time_point start_ = Clock::now();
  std::string title_;    // of the deck
  std::string partial_;  // what the deck has and the model lacks
  bool curved_ = false;  // it has curved sides
  std::uint64_t deck_sum_ = 0;
  MeshSequence sequence_;
  std::optional<ResultFiles> own_;
  ResultFiles& results_;
  Follower follower_;
  LocalErrors local_errors_;
  std::optional<Table> table_;
  std::vector<Row> rows_;
  std::vector<std::string> blanks_;                 // reports without a value at the end, and why
  std::optional<MeshOptions> without_equilibrium_;  // the first mesh, where that found none
  std::string stopped_;                             // why the next mesh isn't there
  std::shared_ptr<RunOutcome> without_run_;         // of that mesh, where results are kept
};

ConvergenceStudy::ConvergenceStudy(const RunRequest& request, const ConvergeOptions& options,
                                   const Catalogue& catalogue)
    : request_(request),
      options_(options),
      catalogue_(catalogue),
      sequence_(choose_sequence()),
      results_(request.results != nullptr ? *request.results
                                          : own_.emplace(request.output.folder, stem_of(request),
                                                         ResultOwner{request.deck, deck_sum_, "convergence"})),
      follower_(options.follow, sequence_, options.tolerance),
      local_errors_(sequence_) {}

// Degrees and layers start from the coarsest mesh that means the same as the deck's.
MeshSequence ConvergenceStudy::choose_sequence() {
  const Deck deck = read_input(request_.deck, request_.input);
  deck_sum_ = checksum(*deck.source.text());
  BuildOptions& build = request_.input.build;
  Model first = build_model(deck, catalogue_, build);
  for (Report& report : first.reports) report.fields = request_.output.fields;
  print_diagnostics(first.diagnostics);
  // Once, of the deck's mesh: what finer ones warn of is their own.
  if (request_.input.strict && first.diagnostics.warnings() > 0)
    throw InputError("S906", {request_.deck, 0, 0, 0}, "warnings count as errors (--strict)");
  request_.input.strict = false;
  title_ = first.title;
  curved_ = has_parabolic_sides(first);
  if (first.reports.empty())
    throw InputError("S907", {request_.deck, 0, 0, 0},
                     "--converge needs a report card: it says which number must be certain");
  if (!first.left_out.empty()) partial_ = left_out_words(first);
  const std::vector<std::string> known = component_names(first);
  for (const std::string& name : options_.follow)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError("S907", {request_.deck, 0, 0, 0},
                       fmt::format("--follow {}: the deck's reports have no such number, "
                                   "only {}",
                                   name, fmt::join(known, ", ")));
  const MeshSequence sequence = sequence_for(first, catalogue_);
  if (sequence.kind == MeshSequence::spectral && (build.element > 0 || build.formulation >= 0))
    say_note(request_.deck,
             "for quadrilaterals with linear laws and without interfaces --converge chooses elements and "
             "formulation itself: --element and "
             "--formulation are not used",
             "S909");
  if (sequence.kind == MeshSequence::halving) return sequence;
  if (first.combines_dofs()) {
    say_note(
        request_.deck,
        "the deck's own elements are halved: which corners are singular is known for supports along x and y "
        "alone",
        "S403");
    return halving(first);
  }
  const bool coarsen = build.coarsen;
  if (!coarsen) {
    BuildOptions coarse = build;
    coarse.coarsen = true;
    coarse.say = {};
    build.coarsen = build_model(deck, catalogue_, coarse).mesh.deck_nodes < first.mesh.deck_nodes ||
                    graded_elements(deck, true) != graded_elements(deck, false);
  }
  if (const std::string why = why_not_graded(deck); !why.empty()) {
    build.coarsen = coarsen;
    say_note(request_.deck, "the deck's own elements are halved, for layers at its corners do not fit: " + why,
             "S403");
    return halving(first);
  }
  return sequence;
}

// Of the first mesh of high degree; 0 where it can't be made.
int ConvergenceStudy::graded_elements(const Deck& deck, bool coarsen) const {
  BuildOptions build = spectral_mesh(request_.input.build, catalogue_, 0).build;
  build.coarsen = coarsen;
  build.say = {};
  int elements = 0;
  try {
    const Model model = build_model(deck, catalogue_, build);
    for (const Group& group : model.groups) elements += group.elements();
  } catch (const InputError&) {  // why_not_graded says it
  }
  return elements;
}

// Why the first mesh of high degree can't be made of a deck whose own mesh can: a support that its layers would
// cut off, say.  Empty: it can.
std::string ConvergenceStudy::why_not_graded(const Deck& deck) const {
  BuildOptions build = spectral_mesh(request_.input.build, catalogue_, 0).build;
  build.say = {};
  try {
    build_model(deck, catalogue_, build);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(0, what.find('\n'));
  }
  return {};
}

RunRequest ConvergenceStudy::request_for(const MeshOptions& mesh) {
  RunRequest one = request_;
  one.input.build = mesh.build;
  one.input.build.say = {};  // the table says it
  one.quiet = true;
  one.results = &results_;
  one.restart = false;
  one.checkpoint_seconds = -1.0;
  one.output = {};
  one.output.folder = request_.output.folder;
  one.output.fields = request_.output.fields;
  one.output.listing = one.output.increments = false;
  one.max_dofs = options_.max_dofs;
  one.stop_asked = [asked = request_.stop_asked, start = start_, limit = options_.max_seconds] {
    return seconds_since(start) > limit || (asked && asked());
  };
  return one;
}

// Four times the elements cost four times and more; the next degree twice.
bool ConvergenceStudy::out_of_time() {
  const double last = rows_.empty() ? 0.0 : rows_.back().seconds;
  if (seconds_since(start_) + (sequence_.kind == MeshSequence::halving ? 4.0 : 2.0) * last <=
      options_.max_seconds)
    return false;
  stopped_ = fmt::format("the next mesh would pass the limit of {:g} s (--max-seconds)", options_.max_seconds);
  return true;
}

// The first mesh must be possible; what only a finer one can't do is no fault of the deck.
std::optional<RunOutcome> ConvergenceStudy::run_mesh(const MeshOptions& mesh, SurroundingsReader& reader) {
  try {
    RunRequest one = request_for(mesh);
    one.watch = &reader;
    return run_deck(one, catalogue_);
  } catch (const InputError& error) {
    if (rows_.empty()) throw;
    const std::string what = error.what();
    stopped_ = "the next mesh can't be made: " + what.substr(0, what.find('\n'));
  } catch (const AnalysisError& error) {
    if (rows_.empty()) throw;
    stopped_ = std::string("the next mesh can't be computed: ") + error.what();
  }
  return {};
}

std::string ConvergenceStudy::why_unusable(const RunOutcome& outcome, const MeshOptions& mesh,
                                           std::vector<Surroundings> around) {
  const RunResult& result = outcome.record.result;
  if (outcome.too_large)
    return fmt::format("the next mesh has {} dofs, more than the limit of {} (--max-dofs)",
                       DofMap(*outcome.model).dofs(), options_.max_dofs);
  if (result.status == RunStatus::stopped)
    return seconds_since(start_) > options_.max_seconds
               ? fmt::format("the limit of {:g} s (--max-seconds) came within the next mesh",
                             options_.max_seconds)
               : result.reason;
  if (outcome.exit_code != kOk) {
    // Of a finer mesh it is no news of the deck; of the first one it is the answer.
    if (rows_.empty()) {
      say_error(request_.deck, result.reason, *result.code);
      without_equilibrium_ = mesh;
    }
    return "no equilibrium with " + mesh.options + ": " + result.reason.substr(0, result.reason.find('\n'));
  }
  const std::vector<ReportComponent> components = last_components(*outcome.model, *outcome.reports);
  if (rows_.empty()) find_blanks(*outcome.model, components);
  if (follower_.append(components, local_errors_.after(*outcome.model, components, std::move(around))))
    return {};
  if (!rows_.empty()) return "the reports of the next mesh lack a value that the others have";
  throw InputError("S907", {request_.deck, 0, 0, 0},
                   "--converge: no report has a value at the end of the run" +
                       (blanks_.empty() ? std::string() : fmt::format(": {}", fmt::join(blanks_, "; "))));
}

// Reports without a value at the end: listed with the result, or a mistake where one is to be followed.
void ConvergenceStudy::find_blanks(const Model& model, const std::vector<ReportComponent>& components) {
  for (const std::string& name : options_.follow)
    if (find_component(components, name) == nullptr) {
      const std::size_t report = std::stoul(name.substr(std::string("report").size())) - 1;
      const std::string why = why_no_value(model, report);
      throw InputError("S907", model.reports[report].where,
                       fmt::format("--follow {}: it has no value at the end of the run{}", name,
                                   why.empty() ? "" : ": " + why));
    }
  for (std::size_t i = 0; i < model.reports.size(); ++i)
    if (const std::string why = why_no_value(model, i); !why.empty())
      blanks_.push_back(fmt::format("report{}: no value at the end of the run: {}", i + 1, why));
}

// False: it can't be used, and stopped_ says why.
bool ConvergenceStudy::add_mesh(int level) {
  const MeshOptions mesh = sequence_.kind == MeshSequence::spectral
                               ? spectral_mesh(request_.input.build, catalogue_, level)
                               : halving_mesh(request_.input.build, level);
  SurroundingsReader reader(local_errors_.earlier());
  std::optional<RunOutcome> outcome = run_mesh(mesh, reader);
  if (outcome) stopped_ = why_unusable(*outcome, mesh, std::move(reader.found));
  const bool first_without = outcome && without_equilibrium_ && rows_.empty();
  if (!stopped_.empty()) {
    if (first_without && request_.keep_result) without_run_ = std::make_shared<RunOutcome>(std::move(*outcome));
    return false;
  }
  Row row{outcome->record.scene.elements, DofMap(*outcome->model).dofs(), outcome->record.seconds, {}, mesh};
  for (const std::filesystem::path& file : outcome->files)
    row.files.emplace_back(file, read_file(file.string()));
  if (!table_) start_table(follower_.shown().name);
  table_->row(follower_.meshes(), row, follower_.shown_limit(), follower_.shown().values.back(), mesh.options);
  if (request_.keep_result) row.run = std::make_shared<RunOutcome>(std::move(*outcome));
  rows_.push_back(std::move(row));
  return true;
}

void ConvergenceStudy::start_table(const std::string& quantity) {
  table_.emplace(options_.screen, title_, quantity,
                 request_.output.folder / (stem_of(request_) + ".convergence.csv"));
}

// Later meshes have written over them.
void ConvergenceStudy::keep_best_files() const {
  for (const auto& [path, bytes] : rows_[follower_.best() - 1].files)
    if (read_file_if_any(path) != bytes) write_file(path, bytes);
}

// True if the tolerance was reached.
bool ConvergenceStudy::refine_until_converged() {
  Task task("converge " + case_name(request_.deck));
  for (int level = 0; !out_of_time() && add_mesh(level); ++level) {
    if (follower_.certain(follower_.best())) return true;
    if (follower_.exhausted()) {
      stopped_ = "finer meshes no longer improve it: only rounding is left";
      break;
    }
  }
  return false;
}

bool ConvergenceStudy::refine_and_close() {
  try {
    return refine_until_converged();
  } catch (...) {
    if (own_) own_->close();
    throw;
  }
}

Convergence ConvergenceStudy::outcome(bool reached) const {
  Convergence result;
  result.exit_code = reached ? kOk : kNotConverged;
  result.table = table_->path();
  if (!reached)
    result.not_reached = fmt::format("relative error {:.1g} asked for; {}", options_.tolerance, stopped_);
  if (!rows_.empty()) result.values = follower_.values();
  if (curved_)
    result.geometry =
        "curved sides stay the parabolas of the deck: no error holds their distance from the true curve";
  const MeshOptions* best = !rows_.empty()         ? &rows_[follower_.best() - 1].mesh
                            : without_equilibrium_ ? &*without_equilibrium_
                                                   : nullptr;
  if (best != nullptr) {
    result.options = best->options;
    result.best_run = rows_.empty() ? without_run_ : rows_[follower_.best() - 1].run;
  }
  if (!rows_.empty())
    for (const auto& [path, bytes] : rows_[follower_.best() - 1].files) result.reports.push_back(path);
  return result;
}

Convergence ConvergenceStudy::run() {
  const bool reached = refine_and_close();
  std::string last = "result    none";
  if (!table_) {
    start_table("value");  // not even the first mesh has one
  } else {
    keep_best_files();
    if (options_.follow.empty())
      for (const std::string& line : blanks_) table_->note("left out  " + line);
    for (const std::string& line : follower_.left_out()) table_->note(line);
    last = follower_.result();
  }
  const Convergence result = outcome(reached);
  if (!result.geometry.empty()) table_->note("geometry  " + result.geometry);
  last += fmt::format("; {:.3g} s", seconds_since(start_));
  if (!partial_.empty()) last += "; PARTIAL: " + partial_;
  if (!reached) last += "; NOT REACHED: " + result.not_reached;
  table_->finish(last, result.reports);
  if (own_) say_left(request_.deck, own_->close());
  return result;
}

}  // namespace

void add_converge_options(CLI::App& parser, ConvergeOptions& options, const std::string& whose) {
  parser
      .add_option("--converge", options.tolerance,
                  "refine the mesh until the relative error of the reports is below this, e.g. 1e-5")
      ->check(number_in(convergence::kLeastError, 0.5, "a relative error from 1e-10 to 0.5"));
  parser
      .add_option("--follow", options.follow,
                  "with --converge: a value to which the error applies, such as report1.fy (may be repeated; "
                  "default: the main values of all reports, without those that are small beside the others)")
      ->allow_extra_args(false);
  parser
      .add_option("--max-dofs", options.max_dofs,
                  "with --converge: " + whose + "largest model (default 400000)")
      ->check(CLI::PositiveNumber);
  parser
      .add_option("--max-seconds", options.max_seconds,
                  "with --converge: " + whose + "time limit, which also interrupts a mesh (default 120)")
      ->check(number_in(1e-3, 1e9, "a number of seconds from 1e-3 to 1e9"));
}

Convergence refine_until_converged(const RunRequest& request, const ConvergeOptions& options,
                                   const Catalogue& catalogue) {
  require_file(request.deck, "--converge");
  return ConvergenceStudy(request, options, catalogue).run();
}

Json convergence_json(const Convergence& found) {
  Json values = Json::array();
  for (const ConvergedValue& value : found.values)
    values.push_back({{"name", json_text(value.name)},
                      {"value", value.value},
                      {"error", value.error},
                      {"reached", value.reached}});
  return {{"reached", found.not_reached.empty()},
          {"not_reached", json_text(found.not_reached)},
          {"options", json_text(found.options)},
          {"geometry", json_text(found.geometry)},
          {"values", std::move(values)}};
}

int converge(const RunRequest& request, const ConvergeOptions& options, const Catalogue& catalogue,
             Json* answer_of_deck) {
  const Convergence found = refine_until_converged(request, options, catalogue);
  if (answer_of_deck != nullptr) {
    std::vector<std::filesystem::path> files{found.table};
    files.insert(files.end(), found.reports.begin(), found.reports.end());
    *answer_of_deck = {{"convergence", convergence_json(found)}, {"files", files_json(files)}};
  }
  if (!found.not_reached.empty()) say_error(request.deck, "NOT REACHED: " + found.not_reached, "S408");
  return found.exit_code;
}

}  // namespace sage::app

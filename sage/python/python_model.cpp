#include "sage/python/python_model.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include "sage/app/stored_heads.hpp"
#include "sage/builder/model_input.hpp"
#include "sage/deck/layout.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::python {

namespace {

RunSettings settings_of(const RunOptions& options) {
  RunSettings settings;
  settings.threads = options.threads;
  settings.choose_solver = choose_solver;
  return settings;
}

// Keeps states, warnings and what the run says of itself.
class Keeper final : public Observer {
 public:
  Keeper(Run& run, const std::string& keep) : run_(run), all_(keep == "all"), none_(keep == "none") {}

  void on_warning(const Diagnostic& diagnostic) override { run_.warnings.push_back(diagnostic); }
  void on_start(const Model&, const Scene&, std::string_view solver, int equations) override {
    run_.solver = solver;
    run_.equations = equations;
  }
  void on_stage_start(const Model& model, int stage, const Solution& now) override {
    StepReport report;
    report.stage = stage;
    report.increments = model.stages[stage].increments;
    if (stage == 0 && wants_states(model, report)) add(model, report, now);
  }
  void on_increment(const Model& model, const StepReport& report, const Solution& now) override {
    if (wants_states(model, report)) add(model, report, now);
  }
  // The last state in equilibrium, where it lies within an increment.
  void on_failure(const Model& model, const StepReport& report, const std::string&,
                  const Solution& now) override {
    if (!none_) add(model, report, now);
  }
  bool wants_states(const Model&, const StepReport& report) const override {
    return all_ || (!none_ && report.increment == report.increments);
  }
  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return wants_states(model, report);
  }

 private:
  void add(const Model& model, const StepReport& report, const Solution& now) {
    run_.frames.push_back(std::make_shared<const Frame>(model, report, now));
  }
  Run& run_;
  bool all_, none_;
};

template <class T>
T attribute(const py::handle& object, const char* name) {
  return object.attr(name).cast<T>();
}

FixityCode fixity_of(const py::handle& object, const char* name) {
  const auto word = attribute<std::string>(object, name);
  if (word.empty()) return FixityCode::unchanged;
  if (word == "fixed") return FixityCode::fixed;
  if (word == "released") return FixityCode::released;
  throw py::value_error("a support is \"fixed\" or \"released\" along " + std::string(name) + ", not \"" +
                        word + "\"");
}

SupportInput support_of(const py::handle& object) {
  return {attribute<std::vector<int>>(object, "nodes"),
          fixity_of(object, "x"),
          fixity_of(object, "y"),
          attribute<double>(object, "x_value"),
          attribute<double>(object, "y_value"),
          attribute<std::string>(object, "unknown"),
          {},
          false,
          attribute<double>(object, "angle")};
}

TieInput tie_of(const py::handle& object) {
  return {attribute<std::vector<int>>(object, "nodes"), attribute<int>(object, "to"),
          attribute<bool>(object, "x"), attribute<bool>(object, "y"), attribute<int>(object, "to_step")};
}

LoadInput load_of(const py::handle& object) {
  return {attribute<std::vector<int>>(object, "nodes"), attribute<double>(object, "x"),
          attribute<double>(object, "y"), attribute<std::string>(object, "unknown")};
}

PressureInput pressure_of(const py::handle& object) {
  return {attribute<std::vector<int>>(object, "elements"),
          attribute<int>(object, "edge"),
          attribute<double>(object, "normal1"),
          attribute<double>(object, "normal2"),
          attribute<double>(object, "shear1"),
          attribute<double>(object, "shear2")};
}

template <class Kind>
Kind kind_of(const py::handle& object, std::initializer_list<std::pair<const char*, Kind>> kinds) {
  const auto word = attribute<std::string>(object, "kind");
  std::string known;
  for (const auto& [name, kind] : kinds) {
    if (word == name) return kind;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw py::value_error("there is no kind \"" + word + "\"; known: " + known);
}

InitialInput initial_of(const py::handle& object) {
  return {attribute<int>(object, "group"),
          kind_of<InitialKind>(object, {{"uniform", InitialKind::uniform},
                                        {"geostatic", InitialKind::geostatic},
                                        {"zero", InitialKind::zero},
                                        {"traction", InitialKind::traction},
                                        {"history", InitialKind::history},
                                        {"lock off", InitialKind::lock_off},
                                        {"material", InitialKind::material},
                                        {"parameter", InitialKind::parameter},
                                        {"at rest", InitialKind::at_rest}}),
          attribute<std::vector<double>>(object, "values")};
}

template <class T, class Make>
std::vector<T> list_of(const py::handle& object, const char* name, const Make& make) {
  std::vector<T> list;
  for (const py::handle& one : object.attr(name)) list.push_back(make(one));
  return list;
}

StageInput stage_of(const py::handle& object) {
  StageInput stage;
  stage.title = attribute<std::string>(object, "title");
  stage.increments = attribute<int>(object, "increments");
  const auto method = attribute<std::string>(object, "method");
  bool known = false;
  for (const auto& [name, one] : {std::pair{"newton", Method::newton},
                                  {"modified_newton", Method::modified_newton},
                                  {"initial_stiffness", Method::initial_stiffness},
                                  {"dogleg", Method::dogleg}})
    if (method == name) {
      stage.method = one;
      known = true;
    }
  if (!known)
    throw py::value_error("there is no method \"" + method +
                          "\"; known: newton, modified_newton, initial_stiffness, dogleg");
  stage.max_iterations = attribute<int>(object, "max_iterations");
  stage.tolerance = attribute<double>(object, "tolerance");
  const auto gravity = attribute<std::pair<double, double>>(object, "gravity");
  stage.gravity = {gravity.first, gravity.second};
  stage.duration = attribute<double>(object, "duration");
  stage.supports = list_of<SupportInput>(object, "supports", support_of);
  stage.loads = list_of<LoadInput>(object, "loads", load_of);
  stage.pressures = list_of<PressureInput>(object, "pressures", pressure_of);
  stage.initials = list_of<InitialInput>(object, "initials", initial_of);
  stage.births = attribute<std::vector<int>>(object, "activated");
  stage.deaths = attribute<std::vector<int>>(object, "removed");
  return stage;
}

ReportInput report_of(const py::handle& object) {
  ReportInput report;
  report.kind = kind_of<ReportKind>(object, {{"triaxial", ReportKind::triaxial},
                                             {"nodes", ReportKind::nodes},
                                             {"point", ReportKind::point},
                                             {"discharge", ReportKind::discharge},
                                             {"uplift", ReportKind::uplift},
                                             {"section", ReportKind::section}});
  report.nodes = attribute<std::vector<int>>(object, "nodes");
  report.group = attribute<int>(object, "group");
  report.stage = attribute<int>(object, "stage");
  report.height = attribute<double>(object, "height");
  report.area = attribute<double>(object, "area");
  report.cell_pressure = attribute<double>(object, "cell_pressure");
  const auto place = attribute<std::pair<double, double>>(object, "place");
  report.place = {place.first, place.second};
  report.name = attribute<std::string>(object, "name");
  const auto end = attribute<std::pair<double, double>>(object, "end");
  report.end = {end.first, end.second};
  return report;
}

MaterialInput material_of(const py::handle& object) {
  return {attribute<std::string>(object, "law"), attribute<std::map<std::string, double>>(object, "parameters"),
          attribute<double>(object, "unit_weight"), attribute<std::string>(object, "name"),
          attribute<double>(object, "saturated_unit_weight")};
}

GroupInput group_of(const py::handle& object) {
  GroupInput group{.element = attribute<std::string>(object, "element"), .elements = {}};
  group.material = attribute<int>(object, "material");
  group.elements = attribute<std::vector<std::vector<int>>>(object, "elements");
  group.formulation = attribute<std::string>(object, "formulation");
  group.name = attribute<std::string>(object, "name");
  group.overlay = attribute<bool>(object, "overlay");
  return group;
}

std::vector<Vector2> points_of(const py::handle& object) {
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const Array array = Array::ensure(object);
  if (!array) throw py::error_already_set();
  if (array.ndim() != 2 || array.shape(1) != 2) throw py::value_error("nodes must have the shape (number, 2)");
  std::vector<Vector2> points;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) points.emplace_back(array.at(i, 0), array.at(i, 1));
  return points;
}

ModelInput input_of(const py::object& object) {
  ModelInput input;
  input.name = attribute<std::string>(object, "name");
  input.title = attribute<std::string>(object, "title");
  const auto geometry = attribute<std::string>(object, "geometry");
  if (geometry != "plane_strain" && geometry != "axisymmetric")
    throw py::value_error("the geometry is \"plane_strain\" or \"axisymmetric\", not \"" + geometry + "\"");
  input.geometry = geometry == "axisymmetric" ? Geometry::axisymmetric : Geometry::plane_strain;
  const auto units = attribute<std::vector<std::string>>(object, "units");
  if (units.size() != 3) throw py::value_error("units must name those of length, force and stress");
  input.units = {units[0], units[1], units[2], attribute<double>(object, "atmospheric_pressure"),
                 attribute<double>(object, "water_unit_weight")};
  input.solver = attribute<std::string>(object, "solver");
  input.nodes = points_of(object.attr("nodes"));
  input.materials = list_of<MaterialInput>(object, "materials", material_of);
  input.groups = list_of<GroupInput>(object, "groups", group_of);
  input.supports = list_of<SupportInput>(object, "supports", support_of);
  input.ties = list_of<TieInput>(object, "ties", tie_of);
  input.initials = list_of<InitialInput>(object, "initials", initial_of);
  input.stages = list_of<StageInput>(object, "stages", [](const py::handle& one) { return stage_of(one); });
  input.reports = list_of<ReportInput>(object, "reports", report_of);
  return input;
}

}  // namespace

struct Signals::State {
  std::thread::id main;  // that runs the analysis
  std::atomic<bool> came{false};
  std::chrono::steady_clock::time_point next{};
  std::exception_ptr raised;

  // In the thread that runs alone.
  void look() {
    constexpr std::chrono::milliseconds kPause(20);
    const auto now = std::chrono::steady_clock::now();
    if (now < next) return;
    next = now + kPause;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() == 0) return;
    try {
      throw py::error_already_set();
    } catch (...) {
      raised = std::current_exception();
    }
    came = true;
  }
};

Signals::Signals() : state_(std::make_shared<State>()) {
  state_->main = std::this_thread::get_id();
}

StopAsked Signals::stop_asked() {
  return [state = state_] {
    if (!state->came && std::this_thread::get_id() == state->main) state->look();
    return state->came.load();
  };
}

void Signals::thread_changed() {
  state_->main = std::this_thread::get_id();
}

void Signals::raise_if_any() const {
  if (!state_->came) return;
  const std::exception_ptr raised = std::exchange(state_->raised, nullptr);
  state_->came = false;
  if (raised) std::rethrow_exception(raised);
}

PythonModel::PythonModel(NamedModel named, std::shared_ptr<const Catalogue> its_catalogue)
    : catalogue_(std::move(its_catalogue)),
      named_(std::move(named)),
      model_(std::make_shared<const Model>(named_.build())) {}

PythonModel PythonModel::read(const std::string& file, const std::string& layout, bool partial) {
  const std::shared_ptr<const Catalogue> known = catalogue();
  const py::gil_scoped_release unlocked;
  const Deck deck = layout.empty() ? read_deck(file) : read_deck(file, load_layout(layout));
  BuildOptions options;
  options.partial = partial;
  options.heads = app::stored_heads(*known);
  return {NamedModel(deck, *known, options), known};
}

PythonModel PythonModel::from_input(const py::object& object) {
  const std::shared_ptr<const Catalogue> known = catalogue();
  const ModelInput input = input_of(object);
  const py::gil_scoped_release unlocked;
  return {NamedModel(make_deck(input, *known), *known, {}), known};
}

PythonModel PythonModel::with_values(const std::vector<NamedValue>& values) const {
  std::vector<std::string> names;
  for (const NamedValue& value : values) names.push_back(value.name);
  named_.expect_apart(names);
  NamedModel other = named_;
  for (const NamedValue& value : values) other.set(value);
  return {std::move(other), catalogue_};
}

std::shared_ptr<Run> PythonModel::run(const RunOptions& options) const {
  auto run = std::make_shared<Run>();
  run->model = model_;
  run->catalogue = catalogue_;
  Signals signals;
  {
    const py::gil_scoped_release unlocked;
    RunSettings settings = settings_of(options);
    settings.stop_asked = signals.stop_asked();
    Keeper keeper(*run, options.keep);
    Observer* const observers[] = {&keeper, &run->reports};
    run->result = sage::run(*model_, *catalogue_, settings, observers);
  }
  signals.raise_if_any();
  raise_error_of_laws(*model_);
  return run;
}

class PythonAnalysis::Watch {
 public:
  Watch(Run& run, const std::string& keep) : keeper_(run, keep), observers_{&keeper_, &run.reports} {}
  std::span<Observer* const> observers() const { return observers_; }

 private:
  Keeper keeper_;
  std::array<Observer*, 2> observers_;
};

PythonAnalysis::PythonAnalysis(const PythonModel& model, const RunOptions& options)
    : model_(std::make_shared<Model>(model.named().build())), run_(std::make_shared<Run>()) {
  run_->model = model_;
  run_->catalogue = model.its_catalogue();
  watch_ = std::make_unique<Watch>(*run_, options.keep);
  RunSettings settings = settings_of(options);
  settings.stop_asked = signals_.stop_asked();
  analysis_ = std::make_unique<Analysis>(*model_, *run_->catalogue, std::move(settings), watch_->observers());
  {
    const py::gil_scoped_release unlocked;
    ended_ = !analysis_->open();
  }
  signals_.raise_if_any();
  raise_error_of_laws(*model_);
}

PythonAnalysis::~PythonAnalysis() = default;

void PythonAnalysis::expect_open() const {
  if (closed_) throw py::value_error("the analysis is closed");
}

namespace {

// One thread at a time.
class Use {
 public:
  explicit Use(std::mutex& lock) : held_(lock, std::try_to_lock) {
    if (!held_) throw std::runtime_error("another thread uses this analysis");
  }

 private:
  std::unique_lock<std::mutex> held_;
};

}  // namespace

bool PythonAnalysis::advance() {
  const Use use(in_use_);
  expect_open();
  if (ended_) return false;
  bool taken = false;
  signals_.thread_changed();
  {
    const py::gil_scoped_release unlocked;
    taken = analysis_->advance();
  }
  ended_ = !taken;
  signals_.raise_if_any();
  raise_error_of_laws(*model_);
  return taken;
}

std::shared_ptr<const Frame> PythonAnalysis::state() {
  const Use use(in_use_);
  expect_open();
  const py::gil_scoped_release unlocked;
  const Solution now = analysis_->state();
  StepReport report;
  report.stage = stage() - 1;
  report.increment = increment();
  report.increments = model_->stages[report.stage].increments;
  report.load_factor = now.load_factor;
  return std::make_shared<const Frame>(*model_, report, now);
}

Stage& PythonAnalysis::stage_of(int number) {
  if (ended_ || is_complete()) throw py::value_error("no increment is left that could take other loads");
  if (number < 1 || number > static_cast<int>(model_->stages.size()))
    throw py::value_error("there is no stage " + std::to_string(number) + ": the model has " +
                          std::to_string(model_->stages.size()));
  return model_->stages[number - 1];
}

// At the end of a stage the analysis is at the start of the next one.
int PythonAnalysis::stage() const {
  const int number = analysis_->stage() + 1;
  return analysis_->increment() == 0 && number > 1 ? number - 1 : number;
}

int PythonAnalysis::increment() const {
  if (analysis_->increment() > 0 || analysis_->stage() == 0) return analysis_->increment();
  return model_->stages[analysis_->stage() - 1].increments;
}

// Loads of stages that are not open yet are read when they are.
void PythonAnalysis::loads_changed(int number) {
  if (number <= stage()) analysis_->take_loads();
}

void PythonAnalysis::set_pressure(int number, double normal, double shear, const std::vector<int>& elements) {
  const Use use(in_use_);
  expect_open();
  Stage& stage = stage_of(number);
  std::size_t changed = 0;
  for (EdgeLoad& load : stage.pressures) {
    const Group& group = model_->groups[load.group];
    const int element = group.element_numbers[load.element];
    if (!elements.empty() && std::ranges::find(elements, element) == elements.end()) continue;
    load.normal = Vector2(normal, normal);
    load.shear = Vector2(shear, shear);
    ++changed;
  }
  if (changed == 0 || changed < elements.size())
    throw py::value_error("the stage has no pressure on " +
                          std::string(elements.empty() ? "any element" : "one of these elements"));
  loads_changed(number);
}

void PythonAnalysis::set_load(int number, const std::vector<int>& nodes, double x, double y) {
  const Use use(in_use_);
  expect_open();
  Stage& stage = stage_of(number);
  std::vector<NodalLoad> loads;
  for (const int node : nodes) {
    const auto found = std::ranges::find(model_->mesh.number, node);
    if (found == model_->mesh.number.end())
      throw py::value_error("the model has no node " + std::to_string(node));
    loads.push_back({static_cast<int>(found - model_->mesh.number.begin()), Vector2(x, y), 0});
  }
  std::erase_if(stage.loads, [&](const NodalLoad& old) {
    return std::ranges::any_of(loads, [&](const NodalLoad& one) { return one.node == old.node; });
  });
  stage.loads.insert(stage.loads.end(), loads.begin(), loads.end());
  loads_changed(number);
}

void PythonAnalysis::scale_loads(int number, double factor) {
  const Use use(in_use_);
  expect_open();
  Stage& stage = stage_of(number);
  for (EdgeLoad& load : stage.pressures) {
    load.normal *= factor;
    load.shear *= factor;
  }
  for (NodalLoad& load : stage.loads) load.force *= factor;
  for (FieldLoad& load : stage.field_loads) load.value *= factor;
  stage.gravity *= factor;
  loads_changed(number);
}

std::shared_ptr<Run> PythonAnalysis::close() {
  const Use use(in_use_);
  if (!closed_) run_->result = analysis_->close();
  closed_ = true;
  return run_;
}

}  // namespace sage::python

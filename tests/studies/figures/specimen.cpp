#include "tests/studies/figures/specimen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sage/record/nodal_values.hpp"

namespace sage::figures {

namespace {

using scenes::SpecimenEnd;

constexpr auto kPlaten = SpecimenEnd::platen, kPinned = SpecimenEnd::pinned, kSmooth = SpecimenEnd::smooth;
constexpr double kYieldStress = 150.0;  // q = 2 sin(phi) / (1 - sin(phi)) 50 psi at phi = 36.87 degrees

// E of the second modulus and nu = .4999 for 'one half' are this program's choice (measures.hpp).
constexpr Scene kScenes[] = {
    {"pinned1", 1, kPinned},
    {"pinned1_soft", 1, kPinned, 0, false, 0.495, 1500},
    {"pinned1_nu0", 1, kPinned, 0, false, 0.0},
    {"pinned1_nu25", 1, kPinned, 0, false, 0.25},
    {"pinned1_nu333", 1, kPinned, 0, false, 1.0 / 3},
    {"pinned1_nu4999", 1, kPinned, 0, false, 0.4999},
    {"pinned2", 2, kPinned},
    {"pinned2_soft", 2, kPinned, 0, false, 0.495, 1500},
    {"pinned2_nu0", 2, kPinned, 0, false, 0.0},
    {"pinned2_nu25", 2, kPinned, 0, false, 0.25},
    {"pinned2_nu333", 2, kPinned, 0, false, 1.0 / 3},
    {"pinned2_nu4999", 2, kPinned, 0, false, 0.4999},
    {"conv", 2, kPlaten},
    {"conv_nu25", 2, kPlaten, 28.5, false, 0.25},
    {"lub", 2, kPlaten, 0.8},
    {"lub_nu25", 2, kPlaten, 0.8, false, 0.25},
    {"lub_nu333", 2, kPlaten, 0.8, false, 1.0 / 3},
    {"free", 2, kSmooth},
    {"free_nu25", 2, kSmooth, 0, false, 0.25},
    {"dp_conv", 2, kPlaten, 28.5, true},
    {"dp_lub", 2, kPlaten, 0.8, true},
    {"dp_free", 2, kSmooth, 0, true},
};

constexpr double kElasticStrains[] = {2, 4, 5, 10},
                 kPlasticStrains[] = {2, 4, 4.5, 4.95, 5, 5.05, 5.1, 5.5, 10, 15};

bool same_strain(double a, double b) {
  return std::abs(a - b) < 1e-6;
}

// Keeps what figures show; asks for states at their strains alone.
class Watcher final : public Observer {
 public:
  Watcher(SpecimenRun& run, const scenes::SpecimenDeck& deck) : run_(&run), deck_(&deck) {}

  bool wants_states(const Model& model, const StepReport& report) const override {
    return of_loading(model, report) && kept(strain_of(report));
  }

  bool wants_nodes(const Model& model, const StepReport& report, std::span<const char>) const override {
    return of_loading(model, report);
  }

  void on_increment(const Model& model, const StepReport& report, const Solution& now) override {
    if (!of_loading(model, report)) return;
    const double strain = strain_of(report);
    run_->strain.push_back(strain);
    run_->measured.push_back(measured(model, now));
    const std::span<const long> points = report.points;
    long solid = 0;
    for (const Group& group : model.groups)
      if (group.solid()) solid += group.elements() * group.element->traits().points;
    const auto count = [&](PointStatus status) { return points[static_cast<std::size_t>(status)]; };
    run_->yielded.push_back(static_cast<double>(count(PointStatus::yielded) + count(PointStatus::apex) +
                                                count(PointStatus::cut_off)) /
                            static_cast<double>(solid));
    State state;
    keep_joint(model, now, state);
    run_->joint_most.push_back(state.joint_level.empty() ? 0.0 : std::ranges::max(state.joint_level));
    if (kept(strain)) keep_state(model, report, now, strain, state);
    if (report.increment == report.increments) keep_mesh(model, now);
  }

  void on_failure(const Model&, const StepReport&, const std::string& reason, const Solution&) override {
    throw AnalysisError("S501", "figures: " + std::string(run_->scene->name) + ": " + reason);
  }

 private:
  // Before it comes the cell pressure.
  static bool of_loading(const Model& model, const StepReport& report) {
    return report.stage + 1 == static_cast<int>(model.stages.size());
  }
  double strain_of(const StepReport& report) const {
    return 100.0 * deck_->axial_strain * report.increment / report.increments;
  }
  bool kept(double strain) const {
    return std::ranges::any_of(kept_strains(*run_->scene), [&](double s) { return same_strain(s, strain); });
  }
  static int index(const Model& model, int number) {
    return static_cast<int>(std::ranges::find(model.mesh.number, number) - model.mesh.number.begin());
  }

  // What the platen feels without the cell pressure, which acts on the end besides.
  double measured(const Model& model, const Solution& now) {
    if (loaded_.empty())
      for (int n : deck_->platen()) loaded_.push_back(index(model, n));
    double force = 0.0;
    for (int n : loaded_) {
      const int dof = DofMap::displacement(n, 1);
      force += (*now.internal)[dof] - (*now.external)[dof];
    }
    return -force / (kPi * deck_->radius * deck_->radius);
  }

  static void keep_joint(const Model& model, const Solution& now, State& state) {
    const FieldTable table = fields_of(model);
    const FieldEntry &traction = *table.find("traction"), &level = *table.find("stress_level");
    for (const GroupData& data : now.groups()) {
      if (!data.group->interface()) continue;
      const std::size_t points =
          static_cast<std::size_t>(data.group->elements() * data.group->element->traits().points);
      for (std::size_t p = 0; p < points; ++p) {
        const PointState point(model.mesh, data, p);
        double t[2], sl = 0.0;
        read_field(traction, point, t);
        read_field(level, point, &sl);
        state.joint_shear.push_back(t[0]);
        state.joint_normal.push_back(t[1]);
        state.joint_level.push_back(sl);
      }
    }
  }

  void keep_state(const Model& model, const StepReport& report, const Solution& now, double strain,
                  State& state) {
    const FieldTable table = fields_of(model);
    const std::vector<double> means =
        element_average(model.mesh, now.groups()[0], fields_named(table, {"stress"}));
    const auto& difference = std::get<StressField>(table.find("stress_difference")->value);
    const auto& principal = std::get<StressField>(table.find("principal_stress")->value);
    state.strain = strain;
    state.at_elements.assign(6, std::vector<double>(means.size() / 4));
    for (std::size_t e = 0; e < means.size() / 4; ++e) {
      const Vector4 mean = Vector4::Map(means.data() + 4 * e);
      double dev = 0.0, sigma[3];
      difference.of(mean, &dev);
      principal.of(mean, sigma);
      const double six[] = {mean[0], mean[2], mean[1], mean[3], dev, sigma[2]};
      for (std::size_t q = 0; q < 6; ++q) state.at_elements[q][e] = six[q];
    }
    state.level = levels_of_means(model, now.groups()[0], *table.find("stress_level"));
    state.frame = std::make_shared<const Frame>(model, report, now);
    run_->states.push_back(std::move(state));
  }

  // As every stress of a figure: that of the element's mean stress, which is no more than 1 where no point is, since
  // a yield surface is convex.
  static std::vector<double> levels_of_means(const Model& model, const GroupData& data,
                                             const FieldEntry& level) {
    constexpr std::size_t kPoints = 4;
    std::vector<double> levels;
    for (std::size_t e = 0; e < static_cast<std::size_t>(data.group->elements()); ++e) {
      Vector4 mean = Vector4::Zero();
      for (std::size_t p = 0; p < kPoints; ++p)
        mean += Vector4::Map(PointState(model.mesh, data, kPoints * e + p).view.sigma.data()) / kPoints;
      PointState point(model.mesh, data, kPoints * e);
      point.view.sigma = {mean.data(), 4};
      double value = 0.0;
      read_field(level, point, &value);
      levels.push_back(std::isnan(value) ? 0.0 : std::min(value, 1.0));
    }
    return levels;
  }

  std::size_t nodes() const { return static_cast<std::size_t>((deck_->columns + 1) * (deck_->rows + 1)); }

  bool at_corner(int column, int row) const { return column >= deck_->columns - 2 && row >= deck_->rows - 2; }

  void keep_mesh(const Model& model, const Solution& now) {
    const int columns = deck_->columns, rows = deck_->rows;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        run_->cells.push_back({(i + 0.5) / columns, (j + 0.5) / rows, 1.0 / (columns * rows), at_corner(i, j)});
    for (int n = 0; n < static_cast<int>(nodes()); ++n) {
      run_->largest_radius = std::max(run_->largest_radius, model.mesh.x(0, n));
      run_->largest_height = std::max(run_->largest_height, model.mesh.x(1, n));
    }
    const double moved = -deck_->axial_strain * deck_->height;
    for (int n : loaded_)
      run_->flatness = std::max(run_->flatness, std::abs((*now.u)[DofMap::displacement(n, 1)] / moved - 1.0));
    keep_joint_places(model);
  }

  // Row-sum integration has its points at the pairs of nodes.
  void keep_joint_places(const Model& model) {
    for (const Group& group : model.groups)
      for (int e = 0; group.interface() && e < group.elements(); ++e)
        for (int p = 0; p < 2; ++p) run_->joint_r.push_back(model.mesh.x(0, group.nodes_of(e)[p]));
  }

  SpecimenRun* run_;
  const scenes::SpecimenDeck* deck_;
  std::vector<int> loaded_;
};

}  // namespace

double Scene::correct(double strain) const {
  const double elastic = E * strain / 100.0;
  return plastic ? std::min(elastic, kYieldStress) : elastic;
}

double Scene::correct(Quantity quantity, double strain) const {
  switch (quantity) {
    case Quantity::sigma_r:
    case Quantity::sigma_theta:
    case Quantity::conf:
      return cell();
    case Quantity::sigma_z:
      return cell() + correct(strain);
    case Quantity::dev:
      return correct(strain);
    case Quantity::level:
      return correct(strain) / kYieldStress;
    default:
      return 0.0;
  }
}

std::span<const Scene> scene_list() {
  return kScenes;
}

const Scene& scene_named(const std::string& name) {
  for (const Scene& scene : kScenes)
    if (name == scene.name) return scene;
  throw std::out_of_range("no scene is called " + name);
}

const std::vector<double>& State::values(Quantity quantity) const {
  switch (quantity) {
    case Quantity::level:
      return level;
    case Quantity::joint_normal:
      return joint_normal;
    case Quantity::joint_shear:
      return joint_shear;
    case Quantity::joint_level:
      return joint_level;
    default:
      return at_elements.at(static_cast<std::size_t>(quantity) - static_cast<std::size_t>(Quantity::sigma_r));
  }
}

const State& SpecimenRun::state(double at) const {
  for (const State& one : states)
    if (same_strain(one.strain, at)) return one;
  throw std::out_of_range(fmt::format("{} at {:g} percent was not kept", scene->name, at));
}

std::vector<double> SpecimenRun::ratios() const {
  std::vector<double> all;
  for (std::size_t i = 0; i < strain.size(); ++i) all.push_back(measured[i] / scene->correct(strain[i]));
  return all;
}

double SpecimenRun::ratio(double at) const {
  for (std::size_t i = 0; i < strain.size(); ++i)
    if (same_strain(strain[i], at)) return measured[i] / scene->correct(at);
  throw std::out_of_range(fmt::format("{} has no increment at {:g} percent", scene->name, at));
}

std::span<const double> kept_strains(const Scene& scene) {
  return scene.plastic ? std::span<const double>(kPlasticStrains) : std::span<const double>(kElasticStrains);
}

scenes::SpecimenDeck specimen_deck(const Scene& scene, Elements elements, double k_j, int increments) {
  scenes::SpecimenDeck deck;
  deck.columns = scene.slenderness == 1.0 ? 20 : 14;
  deck.rows = scene.slenderness == 1.0 ? 20 : 28;
  deck.radius = scene.radius();
  deck.height = scene.height();
  deck.cell = scene.cell();
  deck.young = scene.E;
  deck.poisson = scene.nu;
  deck.formulation = elements == Elements::full ? 1 : 2;
  deck.drucker_prager = scene.plastic;
  deck.elastic_beyond_apex = true;
  deck.end = scene.end;
  deck.axial_strain = scene.last_strain() / 100.0;
  deck.increments = increments > 0 ? increments : static_cast<int>(std::lround(scene.last_strain() / 0.05));
  deck.friction =
      scene.lubricated() ? scenes::PlatenFriction{0.8, k_j, 1.0} : scenes::PlatenFriction{28.5, 5000.0, 0.9};
  return deck;
}

SpecimenRun run_specimen(const scenes::Workbench& bench, const Scene& scene, Elements elements, double k_j,
                         int increments) {
  const scenes::SpecimenDeck deck = specimen_deck(scene, elements, k_j, increments);
  SpecimenRun run;
  run.scene = &scene;
  run.elements = elements;
  run.k_j = scene.lubricated() ? k_j : 0.0;
  run.columns = deck.columns;
  run.rows = deck.rows;
  auto model = std::make_shared<Model>(bench.build(deck.text()));
  model->units.length = "in";
  model->units.force = "lbf";
  model->units.stress = "psi";
  run.model = model;
  Watcher watcher(run, deck);
  Observer* observers[] = {&watcher};
  const RunResult result = bench.run(*model, observers);
  if (result.status != RunStatus::completed)
    throw AnalysisError("S501", "figures: " + std::string(scene.name) + ": " + result.reason);
  return run;
}

const SpecimenRun& Runs::get(const std::string& name, Elements elements, double k_j) {
  const Scene& scene = scene_named(name);
  const std::string key = fmt::format("{} {} {:.17g}", name, elements == Elements::full ? "full" : "b-bar",
                                      scene.lubricated() ? k_j : 0.0);
  const auto found = runs_.find(key);
  if (found != runs_.end()) return found->second;
  return runs_.emplace(key, run_specimen(*bench_, scene, elements, k_j)).first->second;
}

}  // namespace sage::figures

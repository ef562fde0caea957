#include "tests/studies/scenes/whole_run.hpp"

#include <algorithm>
#include <stdexcept>

namespace sage::scenes {

namespace {

class Keeper final : public Observer {
 public:
  explicit Keeper(WholeRun& run) : run_(&run) {}

  void on_warning(const Diagnostic& d) override { run_->warnings.push_back(d.message); }
  void on_increment(const Model&, const StepReport& report, const Solution& now) override {
    run_->increments.push_back({report.stage, report.load_factor, report.total_iterations, report.cuts, *now.u,
                                *now.internal, *now.external, report.points});
    keep_stress(*now.assembly);
  }
  void on_stage_end(const Model&, int, const EquilibriumAudit& audit, const Solution&) override {
    run_->out_of_balance = std::max(run_->out_of_balance, audit.out_of_balance);
  }
  void on_failure(const Model&, const StepReport& report, const std::string& reason,
                  const Solution& now) override {
    run_->failure = reason;
    run_->increments.push_back({report.stage, report.load_factor, report.total_iterations, report.cuts, *now.u,
                                *now.internal, *now.external, report.points});
    keep_stress(*now.assembly);
  }

 private:
  void keep_stress(const Assembly& assembly) {
    run_->stress.clear();
    for (const GroupData& data : assembly.groups()) {
      const std::vector<double>& sigma = data.state.committed.sigma;
      const int rows = data.state.law_size();
      run_->stress.emplace_back(Eigen::Map<const Eigen::MatrixXd>(
          sigma.data(), rows, static_cast<Eigen::Index>(sigma.size()) / rows));
    }
  }

  WholeRun* run_;
};

}  // namespace

bool WholeRun::warns(const std::string& words) const {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

int WholeRun::index(int number) const {
  for (int i = 0; i < model->mesh.nodes(); ++i)
    if (model->mesh.number[i] == number) return i;
  throw std::out_of_range("node " + std::to_string(number));
}

Vector2 WholeRun::u(int number) const {
  return last().u.segment<2>(DofMap::displacement(index(number)));
}

Vector2 WholeRun::position(int number) const {
  return model->mesh.x.col(index(number));
}

Vector2 WholeRun::reaction(const Snapshot& at, int number) const {
  const int dof = DofMap::displacement(index(number));
  return at.internal.segment<2>(dof) - at.external.segment<2>(dof);
}

double WholeRun::reaction(const Snapshot& at, const std::vector<int>& numbers, int component) const {
  double sum = 0.0;
  for (int number : numbers) sum += reaction(at, number)[component];
  return sum;
}

int WholeRun::iterations() const {
  int sum = 0;
  for (const Snapshot& s : increments) sum += s.iterations;
  return sum;
}

Workbench::Workbench(Catalogue catalogue, std::function<int(const SystemSize&)> choose_solver)
    : catalogue_(std::move(catalogue)),
      layout_(load_layout("sage1")),
      choose_solver_(std::move(choose_solver)) {}

Model Workbench::build(const std::string& deck, const BuildOptions& options) const {
  return build_model(read_deck_text(deck, "deck", layout_), catalogue_, options);
}

WholeRun Workbench::run(Model model, const RunSettings& settings, std::span<Observer* const> others) const {
  WholeRun run;
  run.model = std::make_unique<Model>(std::move(model));
  for (const Diagnostic& d : run.model->diagnostics.list())
    if (d.severity == Severity::warning) run.warnings.push_back(d.message);
  RunSettings with_choice = settings;
  with_choice.choose_solver = choose_solver_;
  Keeper keeper(run);
  std::vector<Observer*> observers{&keeper};
  observers.insert(observers.end(), others.begin(), others.end());
  run.result = sage::run(*run.model, catalogue_, with_choice, observers);
  if (run.result.status == RunStatus::failed) run.failure = run.result.reason;
  return run;
}

WholeRun Workbench::run(const std::string& deck, const BuildOptions& options,
                        const RunSettings& settings) const {
  return run(build(deck, options), settings);
}

RunResult Workbench::run(const Model& model, std::span<Observer* const> observers) const {
  RunSettings settings;
  settings.choose_solver = choose_solver_;
  return sage::run(model, catalogue_, settings, observers);
}

}  // namespace sage::scenes

#include "sage/compare/side.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "sage/analysis/shown_status.hpp"
#include "sage/record/values.hpp"

namespace sage::compare {

std::vector<Face> faces_of(const Model& model) {
  std::vector<char> used(static_cast<std::size_t>(model.mesh.nodes()), 0);
  for (const Group& group : model.groups)
    for (int node : group.nodes) used[node] = 1;
  const double infinite = std::numeric_limits<double>::infinity();
  Vector2 low(infinite, infinite), high(-infinite, -infinite);
  for (int n = 0; n < model.mesh.nodes(); ++n)
    if (used[n]) {
      low = low.cwiseMin(model.mesh.x.col(n));
      high = high.cwiseMax(model.mesh.x.col(n));
    }
  const Vector2 size = high - low;
  const double tolerance = 1e-6 * size.maxCoeff();
  const bool ring = model.geometry == Geometry::axisymmetric;
  std::vector<Face> faces;
  const auto add = [&](const char* name, int normal, double outward) {
    const double place = outward < 0.0 ? low[normal] : high[normal];
    if (ring && normal == 0 && std::abs(place) <= tolerance) return;
    Face face{name, normal, outward, {}, {}, 0.0, size[normal]};
    for (int n = 0; n < model.mesh.nodes(); ++n)
      if (used[n] && std::abs(model.mesh.x(normal, n) - place) <= tolerance) {
        const double along = model.mesh.x(1 - normal, n);
        face.nodes.push_back(n);
        face.at_end.push_back(std::min(along - low[1 - normal], high[1 - normal] - along) <= tolerance ? 1 : 0);
      }
    double from = infinite, to = -infinite;
    for (int n : face.nodes) {
      from = std::min(from, model.mesh.x(1 - normal, n));
      to = std::max(to, model.mesh.x(1 - normal, n));
    }
    face.area = !ring         ? to - from
                : normal == 0 ? 2.0 * kPi * std::abs(place) * (to - from)
                              : kPi * (to * to - from * from);
    face.whole = to - from >= size[1 - normal] - tolerance;
    faces.push_back(std::move(face));
  };
  add("bottom", 1, -1.0);
  add("top", 1, 1.0);
  add("left", 0, -1.0);
  add("right", 0, 1.0);
  return faces;
}

double normal_stress(const Face& face, const FaceState& state) {
  if (!(face.area > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return 0.0 - face.outward * state.force[face.normal] / face.area;
}

double shear_stress(const Face& face, const FaceState& state) {
  if (!(face.area > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return state.force[1 - face.normal] / face.area;
}

PointCounts count_points(const Mesh& mesh, const Solution& solution) {
  PointCounts counts;
  for (const GroupData& data : solution.groups()) {
    if (!data.active || data.group->structure()) continue;
    const bool solid = data.group->solid();
    for (std::size_t p = 0; p < data.state.committed.status.size(); ++p) {
      const PointStatus status = shown_status(mesh, data, p);
      ++(solid ? counts.solids : counts.interfaces);
      if (solid) {
        const bool apex = status == PointStatus::apex, cut_off = status == PointStatus::cut_off;
        counts.yielded += status == PointStatus::yielded || apex || cut_off ? 1 : 0;
        counts.apex += apex ? 1 : 0;
        counts.cut_off += cut_off ? 1 : 0;
      } else {
        counts.slipping += status == PointStatus::slipping ? 1 : 0;
        counts.open += status == PointStatus::open ? 1 : 0;
      }
    }
  }
  return counts;
}

Side::Side(std::string label, Model model, const std::filesystem::path& folder, const std::string& stem)
    : label_(std::move(label)),
      model_(std::make_unique<Model>(std::move(model))),
      reports_(std::make_unique<Reports>(folder, stem)),
      faces_(faces_of(*model_)) {}

Side::Side(std::string label, std::unique_ptr<Model> model, std::unique_ptr<Reports> reports, RunRecord record,
           Result result)
    : label_(std::move(label)),
      model_(std::move(model)),
      reports_(std::move(reports)),
      record_(std::move(record)),
      faces_(faces_of(*model_)),
      result_(std::move(result)) {
  if (record_.result.status != RunStatus::completed) error_ = record_.result.reason;
  read_result();
}

void Side::run(const Catalogue& catalogue, const RunSettings& settings, std::span<Observer* const> watching) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Observer*> observers{&record_, reports_.get(), &result_};
  observers.insert(observers.end(), watching.begin(), watching.end());
  try {
    const RunResult result = sage::run(*model_, catalogue, settings, observers);
    if (result.status != RunStatus::completed) error_ = result.reason;
    if (result.status == RunStatus::stopped || result.status == RunStatus::failed) reports_->stop(error_);
  } catch (const OutputError&) {
    throw;
  } catch (const std::exception& error) {
    error_ = message_of(error);
    reports_->stop(error_);
  }
  read_result();
  record_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Side::read_result() {
  for (std::size_t i = 0; i < result_.starts().size(); ++i) {
    const Frame& start = result_.starts()[i];
    StageState& state = stages_.emplace_back();
    state.stage = start.report().stage;
    state.faces_before = face_states(start.view());
    if (i < result_.ends().size()) close_stage(state, result_.ends()[i]);
  }
}

std::vector<FaceState> Side::face_states(const Solution& now) const {
  std::vector<FaceState> states;
  for (const Face& face : faces_) {
    FaceState state;
    Vector2 least = Vector2::Constant(std::numeric_limits<double>::infinity()), most = -least;
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
      const int node = face.nodes[i];
      const Vector2 force = now.internal->segment<2>(DofMap::displacement(node));
      state.force += force;
      if (!face.at_end[i]) state.inner_force += force;
      state.normal_force.push_back(force[face.normal]);
      state.held.push_back(now.activity->holds(node, face.normal));
      const Vector2 u = now.u->segment<2>(DofMap::displacement(node));
      state.displacement += u / static_cast<double>(face.nodes.size());
      least = least.cwiseMin(u);
      most = most.cwiseMax(u);
    }
    state.spread = most - least;
    states.push_back(state);
  }
  return states;
}

void Side::close_stage(StageState& state, const Frame& end) {
  const Solution now = end.view();
  state.load_factor = end.report().load_factor;
  state.faces = face_states(now);
  const DofMap& map = now.activity->dof_map;
  for (int dof = 0; dof < map.displacements(); ++dof) {
    const int c = map.at(dof).component;
    state.applied[c] += (*now.external)[dof];
    if (now.activity->has_reaction(dof)) state.reactions[c] += reaction(now, dof);
  }
  raise_floors(stage_of(*model_, state.stage), end);
}

void Side::raise_floors(const Stage& stage, const Frame& end) {
  const double tolerance = stage.tolerance;
  const Solution now = end.view();
  const int n = now.activity->dof_map.displacements();
  floors_.force =
      std::max(floors_.force, tolerance * now.internal->head(n).norm() * std::sqrt(static_cast<double>(n)));
  floors_.displacement = std::max(floors_.displacement, tolerance * now.u->head(n).lpNorm<Eigen::Infinity>());
  floors_.stress = std::max(floors_.stress, tolerance * end.largest_stress());
}

}  // namespace sage::compare

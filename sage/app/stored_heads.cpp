#include "sage/app/stored_heads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sage/app/input.hpp"
#include "sage/app/run_source.hpp"
#include "sage/model/locate.hpp"
#include "sage/record/stored_result.hpp"

namespace sage::app {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// One state of the run of flow.
class HeadField {
 public:
  HeadField(const Model& model, const Frame& frame)
      : model_(model),
        head_(static_cast<std::size_t>(model.mesh.nodes()), kNone),
        active_(frame.view().activity->group),
        locator_(model, ElementKind::flow) {
    const Solution now = frame.view();
    const DofMap& map = now.activity->dof_map;
    const int field = find_unknown(model.unknowns, "head");
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      if (active_[g] == 0 || !model.groups[g].flow()) continue;
      for (const int node : model.groups[g].nodes)
        if (const int dof = map.of(node, field); dof >= 0) head_[at(node)] = (*now.u)[dof];
    }
    for (int node = 0; node < model.mesh.nodes(); ++node)
      if (!std::isnan(head_[at(node)])) nodes_[{model.mesh.x(0, node), model.mesh.x(1, node)}].push_back(node);
  }

  // inside: to which side of the place the node belongs, where the mesh has a slit there.
  double head(const Vector2& place, const Vector2& inside) const {
    const auto same = nodes_.find({place.x(), place.y()});
    if (same != nodes_.end() && same->second.size() == 1) return head_[at(same->second.front())];
    constexpr double kStep = 1e-3;  // towards the inside
    const std::vector<Location> found = active(place);
    if (found.size() > 1)
      for (const Location& beside : active(place + kStep * (inside - place)))
        for (const Location& one : found)
          if (one.group == beside.group && one.element == beside.element) return head(one);
    return found.empty() ? kNone : head(found.front());
  }

 private:
  static std::size_t at(int node) { return static_cast<std::size_t>(node); }

  std::vector<Location> active(const Vector2& place) const {
    std::vector<Location> found = locator_.at(place);
    std::erase_if(found, [&](const Location& one) { return active_[one.group] == 0; });
    return found;
  }

  double head(const Location& one) const {
    const int* const nodes = model_.groups[one.group].nodes_of(one.element);
    double sum = 0.0;
    for (std::size_t i = 0; i < one.N.size(); ++i) sum += one.N[i] * head_[at(nodes[i])];
    return sum;
  }

  const Model& model_;
  std::vector<double> head_;  // by node; NaN where nothing flows
  std::vector<char> active_;
  std::map<std::pair<double, double>, std::vector<int>> nodes_;  // by their place
  Locator locator_;
};

[[noreturn]] void refuse(const HeadRequest& request, const std::string& why) {
  throw InputError("S250", {request.file, 0, 0, 0}, why);
}

// The last state of the stage.
std::size_t state_of(const HeadRequest& request, const StoredResult& stored) {
  const auto& states = stored.states();
  if (!stored.failure().empty()) refuse(request, "its run ended without equilibrium: " + stored.failure());
  for (std::size_t i = states.size(); i-- > 0;)
    if (request.stage == 0 || states[i].stage + 1 == request.stage) return i;
  refuse(request, states.empty() ? "it holds no state"
                                 : fmt::format("it has no stage {}; its last is {}", request.stage,
                                               states.back().stage + 1));
}

// What its deck lacks is of no use to a reader of this one: lines and cards are those of the other.
Model model_in(const HeadRequest& request, const StoredResult& stored, const Catalogue& catalogue) {
  try {
    return app::model_of(stored.source(), stored.deck_name(), catalogue);
  } catch (const InputError& error) {
    std::string first;
    for (const Diagnostic& d : error.diagnostics().list())
      if (d.severity == Severity::error && first.empty()) first = d.message;
    refuse(request, "the deck that it keeps, " + stored.deck_name() +
                        ", makes no model: the file is damaged, or of another version of the program (there: " +
                        first + ")");
  }
}

void expect_same_kind(const HeadRequest& request, const Model& model) {
  const auto words = [](const Model& m) {
    return m.geometry == Geometry::axisymmetric ? "axisymmetric" : "in plane strain";
  };
  if (find_unknown(model.unknowns, "head") < 0) refuse(request, "its run solves for no heads");
  if (model.geometry != request.model->geometry)
    refuse(request, fmt::format("its run is {}, this deck {}", words(model), words(*request.model)));
  if (model.units.length != request.model->units.length)
    refuse(request, fmt::format("its lengths are in {}, those of this deck in {}", model.units.length,
                                request.model->units.length));
}

std::vector<double> read_heads(const HeadRequest& request, const Catalogue& catalogue) {
  keep_input(request.file);
  const StoredResult stored(request.file);
  const Model model = model_in(request, stored, catalogue);
  stored.expect_model(model);
  expect_same_kind(request, model);
  const Frame frame = stored.frame(model, state_of(request, stored));
  const HeadField field(model, frame);
  std::vector<double> heads;
  heads.reserve(request.nodes.size());
  for (std::size_t i = 0; i < request.nodes.size(); ++i)
    heads.push_back(field.head(request.model->mesh.x.col(request.nodes[i]), request.inside[i]));
  return heads;
}

}  // namespace

HeadReader stored_heads(const Catalogue& catalogue) {
  return [&catalogue](const HeadRequest& request) {
    // A run whose heads come from a run whose heads ... : a file that names itself would go on without end.
    constexpr int kDeepest = 3;
    static thread_local int nested = 0;
    if (nested >= kDeepest) refuse(request, "its run takes its heads from another run, and that from another");
    ++nested;
    struct Leave {
      ~Leave() { --nested; }
    } leave;
    return read_heads(request, catalogue);
  };
}

}  // namespace sage::app

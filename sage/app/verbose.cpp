#include "sage/app/verbose.hpp"

#include <fmt/format.h>

#include "sage/app/screen.hpp"
#include "sage/record/profile_text.hpp"
#include "solvers/choose_kernels.hpp"
#include "solvers/choose_solver.hpp"

namespace sage::app {

void Verbose::tell(const std::string& text) const {
  say_detail(request_->deck, text);
}

std::string Verbose::why_solver(const Model& model, int equations, bool symmetric) const {
  if (!request_->solver.empty()) return "asked for by --solver";
  if (model.solver != 0) return fmt::format("the deck's code {}", model.solver);
  const int limit = profile_equations({equations, symmetric, model.has_pores()});
  return fmt::format("{} laws; {} {} equations{}", symmetric ? "symmetric" : "unsymmetric",
                     equations < limit ? "a profile solver below" : "multifrontal from", limit,
                     model.has_pores() ? " of models with pore water" : "");
}

void Verbose::on_start(const Model& model, const Scene& scene, std::string_view solver, int equations) {
  tell(fmt::format("model: {} nodes, {} elements, {} groups, {} materials, {} stages", model.mesh.nodes(),
                   scene.elements, model.groups.size(), model.materials.size(), model.stages.size()));
  tell("scene: " + describe(scene));
  tell(fmt::format("solver: {} for {} equations ({})", solver, equations,
                   why_solver(model, equations, scene.symmetric)));
  tell(fmt::format(
      "threads: up to {} ({})", threads_for(request_->threads),
      request_->threads > 0 ? "asked for by --threads" : "one for each processor, where that gains"));
  tell(fmt::format("kernels: {} ({})", choose_kernels(request_->kernels).name,
                   request_->kernels == Kernels::automatic ? "the fastest that this processor has"
                                                           : "asked for by --kernels"));
  for (const SkipName& skip : kSkipNames)
    tell(fmt::format("skip {}: {} ({})", skip.name,
                     request_->skips.*skip.flag ? "on, where the scene allows it" : "off, by --without",
                     skip.what));
}

void Verbose::on_increment(const Model& model, const StepReport& report, const Solution&) {
  std::string text = fmt::format("stage {} of {}, increment {} of {}: {} iterations, {} cuts", report.stage + 1,
                                 model.stages.size(), report.increment, report.increments,
                                 report.total_iterations, report.cuts);
  if (!report.iterations.empty()) text += fmt::format(", residual {:.1e}", report.iterations.back().force);
  tell(text);
}

void Verbose::say_times(const Profile& profile) const {
  tell("times\n" + profile_table(profile));
}

}  // namespace sage::app

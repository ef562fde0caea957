// sagefe figures: the source chapter's figures 7.1 to 7.40.
#include <fmt/format.h>

#include <CLI/Option.hpp>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/figures/verdict.hpp"

namespace sage::app {

namespace {

int run_figures(const Catalogue& catalogue) {
  const scenes::Workbench bench = make_workbench(catalogue);
  figures::Runs runs(bench);
  const double fit = figures::fitted_k_j(bench);
  fmt::print("fitted {}\n", fit);
  for (const figures::Result& r :
       figures::evaluate(runs, figures::checks(), {{"120", 120}, {"5", 5}, {"fit", fit}})) {
    fmt::print("7.{} | {} | {}{}\n", r.check->figure, r.check->quote, figures::name_of(r.verdict),
               r.b_bar_only ? " (B-bar only)" : "");
    for (const figures::Outcome& o : r.outcomes)
      fmt::print("      [{} {}] kj {:.4g} {}: full {:.5g} {:.5g} bbar {:.5g} {:.5g}\n", r.check->low,
                 r.check->high, o.k_j, figures::name_of(figures::judge(o)), o.number[0][0], o.number[0][1],
                 o.number[1][0], o.number[1][1]);
    fmt::print("      seen: {}\n", r.shown_to_fail);
  }
  return kOk;
}

}  // namespace

Command figures_command(CLI::App&, const Catalogue& catalogue) {
  return [&catalogue] { return run_figures(catalogue); };
}

}  // namespace sage::app

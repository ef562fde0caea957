// The smallest program with sage: one element, pressed by 100 kPa.
#include <cstdio>

#include "elements/register_elements.hpp"
#include "materials/register_materials.hpp"
#include "sage/analysis/run.hpp"
#include "sage/builder/build_model.hpp"
#include "sage/deck/read_deck.hpp"
#include "solvers/choose_solver.hpp"
#include "solvers/register_solvers.hpp"

constexpr const char* kDeck =
    "one element\nm       kN      kPa\n"
    "    1    0    4    0    1    1    1    2    0    1    0\n"
    "    1                  0.        0.\n    2                  1.        0.\n"
    "    3                  0.        1.\n    4                  1.        1.\n"
    "    1    1    2          \n     1000.        0.\n    1    1    0    1\n"
    "    1    1    1    2    4    3\n"
    "    1    2    1    0    1\n    1    3    2    1    0\n"
    "press\n    1    0    0    0    0    0    1\n    1    3                100.      100.\nEND\n";

struct Settlement : sage::Observer {
  void on_stage_end(const sage::Model&, int, const sage::EquilibriumAudit&, const sage::Solution& s) override {
    std::printf("settlement %.6f m\n", -(*s.u)[7]);
  }
};

int main() {
  sage::Catalogue catalogue;
  sage::register_elements(catalogue);
  sage::register_materials(catalogue);
  sage::register_solvers(catalogue);
  const sage::Deck deck = sage::read_deck_text(kDeck, "one.dat", sage::load_layout("sage1"));
  sage::RunSettings settings;
  settings.choose_solver = sage::choose_solver;
  Settlement settlement;
  sage::Observer* observers[] = {&settlement};
  const sage::RunResult result = run(build_model(deck, catalogue), catalogue, settings, observers);
  return result.status == sage::RunStatus::completed ? 0 : 1;
}

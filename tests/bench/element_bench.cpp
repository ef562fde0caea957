// Time and allocations of geometry() and evaluate() for 392 elements, the size of the source chapter's mesh.
#include <benchmark/benchmark.h>

#include <cmath>

#include "materials/linear_elastic.hpp"
#include "sage/conformance/allocations.hpp"
#include "sage/conformance/sample_laws.hpp"
#include "tests/support/elements.hpp"

namespace sage::test {
namespace {

constexpr std::size_t kElements = 392;

struct Mesh {
  std::unique_ptr<Element> element;
  std::vector<Eigen::Matrix2Xd> x;
  std::vector<ElementRun> runs;
  Eigen::VectorXd du;
};

Mesh make_mesh(const ElementCase& c, LawRef law) {
  Mesh mesh;
  mesh.element = c.make();
  for (std::size_t i = 0; i < kElements; ++i) {
    Eigen::Matrix2Xd x = sample_shape(*c.entry);
    x.row(0).array() += 0.01 * static_cast<double>(i);
    mesh.runs.emplace_back(*mesh.element, x, law);
    mesh.x.push_back(x);
  }
  mesh.du.resize(mesh.element->traits().dofs);
  for (int i = 0; i < mesh.du.size(); ++i) mesh.du(i) = 1e-3 * std::sin(static_cast<double>(i));
  return mesh;
}

void report(benchmark::State& state, std::size_t allocated) {
  state.counters["allocations"] = static_cast<double>(allocated);
}

void evaluate(benchmark::State& state, const ElementCase& c, LawRef law, bool want_stiffness) {
  Mesh mesh = make_mesh(c, law);
  const std::size_t before = allocations();
  for (auto _ : state)
    for (ElementRun& run : mesh.runs) benchmark::DoNotOptimize(run.evaluate(mesh.du, want_stiffness));
  report(state, allocations() - before);
}

void geometry(benchmark::State& state, const ElementCase& c, LawRef law) {
  Mesh mesh = make_mesh(c, law);
  const std::size_t before = allocations();
  for (auto _ : state)
    for (std::size_t i = 0; i < kElements; ++i) mesh.element->geometry(mesh.x[i], mesh.runs[i].geometry);
  report(state, allocations() - before);
}

}  // namespace
}  // namespace sage::test

int main(int argc, char** argv) {
  using namespace sage;
  using namespace sage::test;
  const LinearElastic elastic(moduli_from_young(1000.0, 0.3));
  const SmoothLaw<4> smooth;
  const LinearLaw<2> interface = interface_law(1.0, 2.0);
  for (const ElementCase& c : element_cases()) {
    if (!c.axisymmetric() || c.entry->structure()) continue;
    const bool solid = c.entry->solid();
    const LawRef law = solid ? LawRef(static_cast<const SolidLaw*>(&elastic))
                             : LawRef(static_cast<const InterfaceLaw*>(&interface));
    benchmark::RegisterBenchmark(("f_and_K/" + c.name).c_str(), evaluate, c, law, true)
        ->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark(("f/" + c.name).c_str(), evaluate, c, law, false)
        ->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark(("geometry/" + c.name).c_str(), geometry, c, law)
        ->Unit(benchmark::kMicrosecond);
    if (solid)
      benchmark::RegisterBenchmark(("nonlinear_f_and_K/" + c.name).c_str(), evaluate, c,
                                   LawRef(static_cast<const SolidLaw*>(&smooth)), true)
          ->Unit(benchmark::kMicrosecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}

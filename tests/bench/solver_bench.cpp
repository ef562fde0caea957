// Prints what every solver of the catalogue takes for an n x 2n mesh of Q4 elements:
// milliseconds, best of some runs.
//   solver_bench [n ...] [--cpu] [--unsymmetric-only] [--solver name] [--threads n] [--kernels avx2]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "sage/conformance/solver_systems.hpp"
#include "solvers/register_solvers.hpp"

namespace {

using sage::conformance::System;
using Clock = std::chrono::steady_clock;

int threads = 1;
sage::Kernels kernels = sage::Kernels::automatic;
bool processor_time = false;  // of all threads; for machines that are busy otherwise

double now_ms() {
  if (!processor_time)
    return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count();
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

struct Times {
  double analyse = 1e300, add = 1e300, factorise = 1e300, solve = 1e300;  // ms
};

template <class F>
void time_into(double& best, F&& work) {
  const double begin = now_ms();
  work();
  best = std::min(best, now_ms() - begin);
}

void run_once(sage::LinearSolver& solver, const System& system, std::vector<double>& x, Times& times) {
  const std::vector<double> b(x.size(), 1.0);
  time_into(times.add, [&] {
    solver.clear();
    for (int e = 0; e < system.elements.count(); ++e) solver.add(e, system.K[e].data());
  });
  time_into(times.factorise, [&] { solver.factorise(); });
  time_into(times.solve, [&] { static_cast<void>(solver.solve(b, x)); });
}

double residual(const sage::LinearSolver& solver, const std::vector<double>& x) {
  std::vector<double> r(x.size());
  const auto& matrix = sage::conformance::offered_by<sage::KeptMatrix>(solver);
  matrix.multiply(x, r);
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    worst = std::max(worst, std::abs(r[i] - 1.0));
    largest = std::max(largest, std::abs(x[i]));
  }
  return worst / (matrix.norm1() * largest + 1.0);
}

void bench(const sage::SolverEntry& entry, int n) {
  const System system =
      sage::conformance::q4_mesh({.columns = n, .rows = 2 * n, .unsymmetric = entry.symmetric ? 0.0 : 0.5});
  const auto solver = entry.make();
  solver->configure({.threads = threads, .kernels = kernels});
  Times times;
  std::vector<double> x(static_cast<std::size_t>(system.equations));
  const int analyses = n <= 28 ? 20 : 1;
  for (int i = 0; i < analyses; ++i)
    time_into(times.analyse, [&] { solver->analyse(system.equations, system.elements); });
  // About a second for small systems; at least three runs.
  const auto begin = Clock::now();
  int runs = 0;
  while (runs < 3 || (runs < 2000 && Clock::now() - begin < std::chrono::milliseconds(500))) {
    run_once(*solver, system, x, times);
    ++runs;
  }
  const sage::FactorReport report = solver->report();
  std::printf("%4d %8d %-13s %9.3f %9.3f %10.3f %9.3f %11.3f %9.1f %9.1e\n", n, system.equations,
              entry.name.c_str(), times.analyse, times.add, times.factorise, times.solve,
              times.factorise + times.solve, static_cast<double>(report.memory_bytes) / 1e6,
              residual(*solver, x));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  sage::Catalogue catalogue;
  sage::register_solvers(catalogue);
  std::vector<int> sizes;
  std::string only;
  bool unsymmetric_only = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--unsymmetric-only") == 0)
      unsymmetric_only = true;
    else if (std::strcmp(argv[i], "--cpu") == 0)
      processor_time = true;
    else if (std::strcmp(argv[i], "--solver") == 0 && i + 1 < argc)
      only = argv[++i];
    else if (std::strcmp(argv[i], "--threads") == 0 && i + 1 < argc)
      threads = std::atoi(argv[++i]);
    else if (std::strcmp(argv[i], "--kernels") == 0 && i + 1 < argc)
      kernels = std::strcmp(argv[++i], "avx2") == 0 ? sage::Kernels::avx2 : sage::Kernels::avx512;
    else
      sizes.push_back(std::atoi(argv[i]));
  }
  if (sizes.empty()) sizes = {14, 28, 56, 112, 224};
  std::printf(
      "   n equations solver          analyse       add     factor     solve factor+solve      MB  residual\n");
  for (const int n : sizes)
    for (const auto& [code, entry] : catalogue.solvers.entries()) {
      const bool profile = entry.name.starts_with("skyline");
      if ((!only.empty() && entry.name != only) || (unsymmetric_only && entry.symmetric)) continue;
      if (profile && n > 224) continue;  // 12 GB and minutes
      bench(entry, n);
    }
}

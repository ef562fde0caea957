// Compares orderings on n x 2n meshes of Q4: own nested dissection, AMD and METIS, all factorised by
// CHOLMOD's supernodal Cholesky, so that nothing but the ordering differs.  Milliseconds of
// processor time, best of three.
//   ordering_bench [n ...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

#include <cholmod.h>

#include "sage/conformance/solver_systems.hpp"
#include "solvers/assembled_matrix.hpp"
#include "solvers/library/long_columns.hpp"
#include "solvers/nested_dissection.hpp"
#include "solvers/profile_numbering.hpp"

namespace {

using namespace sage;

double now_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

struct Result {
  double order = 1e300, factorise = 1e300;  // ms
  double fill = 0.0, work = 0.0;            // terms of L, floating-point operations
};

std::vector<SuiteSparse_long> own_order(const EquationGraph& graph) {
  const std::vector<int> order = expand(graph, nested_dissection(graph, 16).groups.item);
  return {order.begin(), order.end()};
}

// ordering: CHOLMOD's code; CHOLMOD_GIVEN = own.
Result measure(const EquationGraph& graph, cholmod_sparse& K, int ordering) {
  Result result;
  for (int run = 0; run < 3; ++run) {
    cholmod_common common;
    cholmod_l_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = ordering;
    common.postorder = 1;
    double begin = now_ms();
    std::vector<SuiteSparse_long> own;
    if (ordering == CHOLMOD_GIVEN) own = own_order(graph);
    cholmod_factor* L = cholmod_l_analyze_p(&K, own.empty() ? nullptr : own.data(), nullptr, 0, &common);
    result.order = std::min(result.order, now_ms() - begin);
    result.fill = common.lnz;
    result.work = common.fl;
    begin = now_ms();
    cholmod_l_factorize(&K, L, &common);
    result.factorise = std::min(result.factorise, now_ms() - begin);
    cholmod_l_free_factor(&L, &common);
    cholmod_l_finish(&common);
  }
  return result;
}

void bench(int n) {
  const conformance::System system = conformance::q4_mesh({.columns = n, .rows = 2 * n});
  const EquationGraph graph = make_equation_graph(system.equations, system.elements);
  AssembledMatrix matrix;
  matrix.analyse(graph, system.elements, true);
  matrix.clear();
  for (int e = 0; e < system.elements.count(); ++e) matrix.add(e, system.K[e].data());
  LongColumns columns(matrix);
  cholmod_sparse K{};
  K.nrow = K.ncol = static_cast<std::size_t>(system.equations);
  K.nzmax = columns.row.size();
  K.p = columns.start.data();
  K.i = columns.row.data();
  K.x = const_cast<double*>(matrix.value().data());
  K.stype = 1;
  K.itype = CHOLMOD_LONG;
  K.xtype = CHOLMOD_REAL;
  K.dtype = CHOLMOD_DOUBLE;
  K.sorted = K.packed = 1;
  const std::pair<const char*, int> orderings[] = {
      {"own", CHOLMOD_GIVEN}, {"amd", CHOLMOD_AMD}, {"metis", CHOLMOD_METIS}};
  for (const auto& [name, code] : orderings) {
    const Result r = measure(graph, K, code);
    std::printf("%4d %8d %-6s %10.2f %10.2f %10.1f %10.1f\n", n, system.equations, name, 1e-6 * r.fill,
                1e-9 * r.work, r.order, r.factorise);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  if (sizes.empty()) sizes = {14, 56, 112, 224};
  std::printf("   n equations order  Mterms of L      GFlop   order ms  factor ms\n");
  for (const int n : sizes) bench(n);
}

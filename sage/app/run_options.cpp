// Options of all commands that run decks.
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <map>
#include <thread>

#include "sage/app/commands.hpp"
#include "sage/app/run_deck.hpp"
#include "solvers/choose_kernels.hpp"

namespace sage::app {

void add_threads_option(CLI::App& parser, int& threads) {
  parser
      .add_option("--threads", threads,
                  "threads of the linear solver and of large nonlinear groups (default: one for each "
                  "processor, where that gains); results are the same to the last bit")
      ->check(CLI::Range(0, 256));
}

void add_kernels_option(CLI::App& parser, Kernels& kernels) {
  static const std::map<std::string, Kernels> names{
      {"auto", Kernels::automatic}, {"avx2", Kernels::avx2}, {"avx512", Kernels::avx512}};
  const auto suits = [](const std::string& name) {
    const auto found = names.find(name);
    return found == names.end() ? "expected auto, avx2 or avx512" : why_no_kernels(found->second);
  };
  parser
      .add_option_function<std::string>(
          "--kernels", [&kernels](const std::string& name) { kernels = names.at(name); },
          "instructions of the processor that the solvers use: auto (default, the fastest it has), avx2, "
          "avx512; results are the same to the last bit")
      ->check(suits);
}

int threads_for(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace sage::app

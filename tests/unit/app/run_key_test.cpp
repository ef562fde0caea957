// A checkpoint belongs to a run with the same options, but for those that can change neither results nor files.
#include <gtest/gtest.h>

#include <functional>

#include "sage/app/run_key.hpp"

namespace sage::app {
namespace {

using Change = std::function<void(RunRequest&)>;

std::string key_after(const Change& change) {
  RunRequest request;
  change(request);
  return options_key(request);
}

TEST(RunKey, DependsOnEveryOptionOfResultsAndFiles) {
  const std::vector<Change> changes{
      [](RunRequest& r) { r.solver = "skyline"; },
      [](RunRequest& r) { r.refinement = 1; },
      [](RunRequest& r) { r.condition = true; },
      [](RunRequest& r) { r.keep_result = true; },
      [](RunRequest& r) { r.output.listing = false; },
      [](RunRequest& r) { r.output.tables = Tables::all; },
      [](RunRequest& r) { r.output.increments = false; },
      [](RunRequest& r) { r.output.nodes = true; },
      [](RunRequest& r) { r.output.points = true; },
      [](RunRequest& r) { r.output.digits = 9; },
      [](RunRequest& r) { r.output.error = true; },
      [](RunRequest& r) { r.output.vtu = true; },
      [](RunRequest& r) { r.output.msh_text = true; },
      [](RunRequest& r) { r.output.msh = true; },
      [](RunRequest& r) { r.output.result = true; },
      [](RunRequest& r) { r.output.pictures = {"conf"}; },
      [](RunRequest& r) { r.output.states = {"conf"}; },
      [](RunRequest& r) { r.output.fields = {"conf"}; },
      [](RunRequest& r) {
        r.output.fields = {"co", "nf"};
      },
  };
  std::vector<std::string> keys{options_key({})};
  for (const Change& change : changes) keys.push_back(key_after(change));
  for (const SkipName& skip : kSkipNames)
    keys.push_back(key_after([&](RunRequest& r) { r.skips.*skip.flag = false; }));
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(keys[i], keys[j]) << i << ", " << j;
}

TEST(RunKey, IgnoresHowARunIsWatchedAndStopped) {
  const std::vector<Change> changes{
      [](RunRequest& r) { r.threads = 3; },
      [](RunRequest& r) { r.kernels = Kernels::avx2; },
      [](RunRequest& r) { r.quiet = true; },
      [](RunRequest& r) { r.profile = true; },
      [](RunRequest& r) { r.restart = true; },
      [](RunRequest& r) { r.checkpoint_seconds = 0.0; },
      [](RunRequest& r) { r.interrupt_patience = 1.0; },
      [](RunRequest& r) { r.max_dofs = 10; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) EXPECT_EQ(key_after(changes[i]), options_key({})) << i;
}

}  // namespace
}  // namespace sage::app

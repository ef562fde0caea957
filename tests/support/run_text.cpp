#include "tests/support/run_text.hpp"

#include "sage/app/commands.hpp"
#include "tests/studies/workbench.hpp"

namespace sage::test {

WholeRun run_text(const std::string& deck, const BuildOptions& options, const RunSettings& settings) {
  static const Workbench workbench = app::make_workbench();
  return workbench.run(deck, options, settings);
}

}  // namespace sage::test

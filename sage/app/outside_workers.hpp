// Parts of a sweep as processes that others schedule: GNU parallel and Slurm.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sage::app {

// Cases at a time: what was asked for, or one for each processor where that is 0.
int threads_for_cases(int asked);

// Starts the parts and waits for them.  What they did not finish is left to the caller.  A warning where a part failed;
// throws UsageError (S737) where there is no such tool.
void run_parallel(const std::string& study, const std::filesystem::path& folder,
                  const std::vector<std::string>& collect, int parts);
// Writes FOLDER/NAME.slurm.sh, submits it and waits.
void run_slurm(const std::string& study, const std::string& name, const std::filesystem::path& folder,
               const std::vector<std::string>& collect, int parts);

}  // namespace sage::app

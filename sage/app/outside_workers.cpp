#include "sage/app/outside_workers.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

bool is_there(const std::string& tool) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / tool).c_str(), X_OK) == 0) return true;
  return false;
}

// In quotes that a shell undoes.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string own_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).string();
}

// The command of a part, for a shell: its number is what the shell makes of `number`.
std::string worker(const std::string& study, const std::filesystem::path& folder,
                   const std::vector<std::string>& collect, const std::string& number, int parts) {
  std::string command = fmt::format("{} sweep {} -q -j 1 -o {}", shell_quoted(own_program()),
                                    shell_quoted(std::filesystem::absolute(study).string()),
                                    shell_quoted(std::filesystem::absolute(folder).string()));
  for (const std::string& names : collect) command += " --collect " + shell_quoted(names);
  return command + fmt::format(" --part {}/{}", number, parts);
}

int run_tool(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw UsageError("S737", words.front() + " can't be started");
  if (child == 0) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

void warn_of_tool(const std::string& study, const std::string& tool, int code) {
  if (code != 0)
    say_warning(
        study,
        fmt::format("{} ended with exit code {}: cases that its workers have not finished are computed here",
                    tool, code),
        "S737");
}

void expect_tool(const std::string& tool, const std::string& option) {
  if (!is_there(tool))
    throw UsageError("S737", fmt::format("{}: there is no {} on this machine", option, tool));
}

}  // namespace

int threads_for_cases(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void run_parallel(const std::string& study, const std::filesystem::path& folder,
                  const std::vector<std::string>& collect, int parts) {
  expect_tool("parallel", "--parallel");
  std::vector<std::string> words{
      "parallel", "--will-cite", "--jobs", std::to_string(parts), worker(study, folder, collect, "{}", parts),
      ":::"};
  for (int i = 1; i <= parts; ++i) words.push_back(std::to_string(i));
  warn_of_tool(study, "parallel", run_tool(words));
}

void run_slurm(const std::string& study, const std::string& name, const std::filesystem::path& folder,
               const std::vector<std::string>& collect, int parts) {
  expect_tool("sbatch", "--slurm");
  const std::filesystem::path script = folder / (name + ".slurm.sh");
  write_file(
      script,
      fmt::format("#!/bin/sh\n#SBATCH --job-name=sagefe\n#SBATCH --array=1-{}\n#SBATCH --cpus-per-task=1\n"
                  "#SBATCH --output={}\nexec {}\n",
                  parts, (std::filesystem::absolute(folder) / (name + ".slurm.%a.log")).string(),
                  worker(study, folder, collect, "\"$SLURM_ARRAY_TASK_ID\"", parts)));
  warn_of_tool(study, "sbatch", run_tool({"sbatch", "--wait", script.string()}));
}

}  // namespace sage::app

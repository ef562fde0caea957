// sagefe completion: what shells know of the commands, from the parser's own tables.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/option_tables.hpp"

namespace sage::app {

namespace {

CommandRow whole_program(const Catalogue& catalogue) {
  CLI::App root;
  add_all_commands(root, catalogue);
  return command_row(root, catalogue, "sagefe");
}

}  // namespace

Command completion_command(CLI::App& parser, const Catalogue& catalogue) {
  auto shell = std::make_shared<std::string>();
  parser.add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  parser.footer(
      "An installed sagefe has completion already.  Otherwise, for this shell:\n"
      "  bash: . <(sagefe completion bash)      fish: sagefe completion fish | source\n"
      "  zsh:  . <(sagefe completion zsh)       (behind compinit)");
  return [shell, &catalogue] {
    const std::string script = completion_script(whole_program(catalogue), *shell);
    if (Json* json = answer()) *json = {{"shell", *shell}, {"script", script}};
    fmt::print("{}", script);
    return kOk;
  };
}

}  // namespace sage::app

// sagefe completion, sagefe manpages: what shells and `man` know of the commands, from the parser's own tables.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/option_tables.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

CommandRow whole_program(const Catalogue& catalogue) {
  CLI::App root;
  add_all_commands(root, catalogue);
  return command_row(root, catalogue, "sagefe");
}

int write_man_pages(const std::filesystem::path& folder, const Catalogue& catalogue) {
  for (const ManPage& page : man_pages(whole_program(catalogue), SAGE_VERSION)) {
    write_file(folder / page.file, page.text);
    answer_file(folder / page.file);
  }
  return kOk;
}

}  // namespace

Command completion_command(CLI::App& parser, const Catalogue& catalogue) {
  auto shell = std::make_shared<std::string>();
  parser.add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  parser.footer(
      "An installed program brings them along.  Else, for this shell:\n"
      "  bash: . <(sagefe completion bash)      fish: sagefe completion fish | source\n"
      "  zsh:  . <(sagefe completion zsh)       (behind compinit)");
  return [shell, &catalogue] {
    const std::string script = completion_script(whole_program(catalogue), *shell);
    if (Json* json = answer()) *json = {{"shell", *shell}, {"script", script}};
    fmt::print("{}", script);
    return kOk;
  };
}

Command manpages_command(CLI::App& parser, const Catalogue& catalogue) {
  auto folder = std::make_shared<std::string>();
  parser.add_option("FOLDER", *folder, "where sagefe.1 and a page for each command go")->required();
  parser.footer(
      "man -l FOLDER/sagefe-run.1 shows one; an installed program brings them along: man sagefe-run.");
  return [folder, &catalogue] { return write_man_pages(*folder, catalogue); };
}

}  // namespace sage::app

// The same tables of options in the languages of three shells.
#include <fmt/format.h>

#include "sage/app/option_tables.hpp"

namespace sage::app {

namespace {

std::string joined(const std::vector<std::string>& list, const char* between = " ") {
  std::string text;
  for (const std::string& one : list) text += (text.empty() ? "" : between) + one;
  return text;
}

// A few words that fit beside an option: the first clause.
std::string short_about(const std::string& about) {
  constexpr std::size_t kFewest = 12, kMost = 70;
  std::string text = about.substr(0, about.find('\n'));
  for (const char* end : {"; ", " (", ": "}) {
    const std::size_t at = text.find(end, kFewest);
    if (at != std::string::npos) text.resize(at);
  }
  if (text.size() <= kMost) return text;
  return text.substr(0, text.rfind(' ', kMost)) + " ...";
}

// In single quotes of a shell; the three agree on that.
std::string shell_quoted(const std::string& text, const char* quote) {
  std::string out = "'";
  for (char c : text)
    if (c == '\'')
      out += quote;
    else
      out += c;
  return out + "'";
}

std::string quoted(const std::string& text) {
  return shell_quoted(text, "'\\''");
}

// -------------------------------------------------------------------------------------------------------- bash

std::vector<std::string> dashed_names(const CommandRow& command) {
  std::vector<std::string> names;
  for (const OptionRow& option : command.options)
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

// What can stand where no option does: parts of the command, or choices of its first word.
std::vector<std::string> plain_words(const CommandRow& command) {
  std::vector<std::string> words;
  for (const CommandRow& part : command.parts) words.push_back(part.name());
  for (const OptionRow& option : command.options)
    if (option.positional) words.insert(words.end(), option.choices.begin(), option.choices.end());
  return words;
}

void bash_command(std::string& text, const CommandRow& command) {
  text +=
      fmt::format("    {})\n      options={}\n", quoted(command.words), quoted(joined(dashed_names(command))));
  text += fmt::format("      words={}\n", quoted(joined(plain_words(command))));
  text += "      case \"$previous\" in\n";
  for (const OptionRow& option : command.options)
    if (!option.positional && !option.value.empty())
      text += fmt::format("        {}) values={}; valued=1 ;;\n", joined(option.names, "|"),
                          quoted(joined(option.choices)));
  text += "      esac ;;\n";
  for (const CommandRow& part : command.parts) bash_command(text, part);
}

void bash_parts(std::string& text, const CommandRow& command) {
  for (const CommandRow& part : command.parts) {
    text +=
        fmt::format("      {}) command={} ;;\n", quoted(command.words + ":" + part.name()), quoted(part.words));
    bash_parts(text, part);
  }
}

// Where nothing matches, `complete -o default` offers files: decks, results, values that are names of files.
std::string bash_script(const CommandRow& program) {
  std::string text = "# bash completion of sagefe; written by: sagefe completion bash\n_sagefe() {\n";
  text += R"(  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}
  local command=sagefe options= words= values= valued= at
  # bash takes --option=value for three words.
  if [[ $current == "=" ]]; then
    current=
  elif [[ $previous == "=" ]]; then
    previous=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for ((at = 1; at < COMP_CWORD; ++at)); do
    case "$command:${COMP_WORDS[at]}" in
)";
  bash_parts(text, program);
  text += "    esac\n  done\n  case \"$command\" in\n";
  bash_command(text, program);
  text += R"(  esac
  if [[ -n $valued ]]; then
    COMPREPLY=($(compgen -W "$values" -- "$current"))
  elif [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}
complete -o default -F _sagefe sagefe
)";
  return text;
}

// --------------------------------------------------------------------------------------------------------- zsh

// In the description of an argument brackets and colons have a meaning.
std::string zsh_escaped(const std::string& about) {
  std::string out;
  for (char c : about) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_value(const OptionRow& option) {
  const std::string what = ":" + zsh_escaped(option.value) + ":";
  return what + (option.choices.empty() ? "_files" : "(" + joined(option.choices) + ")");
}

std::string zsh_option(const OptionRow& option) {
  if (option.positional) return quoted((option.repeated ? "*" : "") + zsh_value(option));
  const std::string rest =
      "[" + zsh_escaped(short_about(option.about)) + "]" + (option.value.empty() ? "" : zsh_value(option));
  if (option.repeated || option.names.size() == 1) {
    std::string text;
    for (const std::string& name : option.names)
      text += (text.empty() ? "" : " ") + quoted((option.repeated ? "*" : "") + name + rest);
    return text;
  }
  return quoted("(" + joined(option.names) + ")") + "{" + joined(option.names, ",") + "}" + quoted(rest);
}

// The function of a command calls that of the part that is chosen.
void zsh_function(std::string& text, const CommandRow& command) {
  std::string function = "_" + command.words;
  for (char& c : function)
    if (c == ' ') c = '_';
  text += function + "() {\n";
  if (!command.parts.empty()) {
    text += "  local line state\n  local -a commands=(\n";
    for (const CommandRow& part : command.parts)
      text += "    " + quoted(part.name() + ":" + zsh_escaped(short_about(part.about))) + "\n";
    text += "  )\n";
  }
  text += "  _arguments -s";
  if (!command.parts.empty()) text += " -C";
  for (const OptionRow& option : command.options) text += " \\\n    " + zsh_option(option);
  if (command.parts.empty()) {
    text += "\n}\n";
    return;
  }
  text += " \\\n    '1: :->command' \\\n    '*:: :->words'\n  case $state in\n";
  text += "    command) _describe command commands ;;\n    words)\n      case $line[1] in\n";
  for (const CommandRow& part : command.parts)
    text += fmt::format("        {0}) {1}_{0} ;;\n", part.name(), function);
  text += "      esac ;;\n  esac\n}\n";
  for (const CommandRow& part : command.parts) zsh_function(text, part);
}

std::string zsh_script(const CommandRow& program) {
  std::string text = "#compdef sagefe\n# zsh completion of sagefe; written by: sagefe completion zsh\n";
  zsh_function(text, program);
  return text + "if [ \"$funcstack[1]\" = _sagefe ]; then _sagefe \"$@\"; else compdef _sagefe sagefe; fi\n";
}

// -------------------------------------------------------------------------------------------------------- fish

std::string fish_quoted(const std::string& text) {
  return shell_quoted(text, "\\'");
}

// `where`: the condition under which the command's options are offered.
void fish_command(std::string& text, const CommandRow& command, const std::string& where) {
  const std::string start = "complete -c sagefe -n " + fish_quoted(where);
  for (const OptionRow& option : command.options) {
    if (option.positional) {
      if (!option.choices.empty())
        text += fmt::format("{} -f -a {}\n", start, fish_quoted(joined(option.choices)));
      continue;
    }
    text += start;
    for (const std::string& name : option.names)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty())
      text += option.choices.empty() ? " -r -F" : " -x -a " + fish_quoted(joined(option.choices));
    text += " -d " + fish_quoted(short_about(option.about)) + "\n";
  }
  std::string others;
  for (const CommandRow& part : command.parts) others += " " + part.name();
  for (const CommandRow& part : command.parts) {
    text += fmt::format(
        "{} -f -a {} -d {}\n",
        "complete -c sagefe -n " + fish_quoted(where + "; and not __fish_seen_subcommand_from" + others),
        part.name(), fish_quoted(short_about(part.about)));
    fish_command(
        text, part,
        (command.words == "sagefe" ? "" : where + "; and ") + ("__fish_seen_subcommand_from " + part.name()));
  }
}

std::string fish_script(const CommandRow& program) {
  std::string text = "# fish completion of sagefe; written by: sagefe completion fish\n";
  fish_command(text, program, "true");
  return text;
}

}  // namespace

std::string completion_script(const CommandRow& program, const std::string& shell) {
  return shell == "zsh" ? zsh_script(program) : shell == "fish" ? fish_script(program) : bash_script(program);
}

}  // namespace sage::app

// Man pages out of the tables of options.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "sage/app/option_tables.hpp"

namespace sage::app {

namespace {

// For a line of text: dashes that can be copied, no backslash, and no request where a line begins with a point.
std::string roff(const std::string& text) {
  std::string out;
  if (text.starts_with('.') || text.starts_with('\'')) out = "\\&";
  for (char c : text) {
    if (c == '-')
      out += "\\-";
    else if (c == '\\')
      out += "\\e";
    else
      out += c;
  }
  return out;
}

// As an argument of a macro.
std::string roff_quoted(const std::string& text) {
  std::string out;
  for (char c : roff(text)) out += c == '"' ? "\\(dq" : std::string(1, c);
  return "\"" + out + "\"";
}

// Lines of at most 78 characters, as editors and `diff` like them.
std::string paragraph(const std::string& text) {
  constexpr std::size_t kWidth = 78;
  std::istringstream words(text);
  std::string out, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > kWidth) {
      out += roff(line) + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return out + roff(line) + "\n";
}

// Lines as they are, such as a list of exit codes.
std::string as_it_is(const std::string& text) {
  std::istringstream lines(text);
  std::string out = ".nf\n";
  for (std::string line; std::getline(lines, line);) out += line.empty() ? ".sp\n" : roff(line) + "\n";
  return out + ".fi\n";
}

std::string page_name(const CommandRow& command) {
  std::string name = command.words;
  for (char& c : name)
    if (c == ' ') c = '-';
  return name;
}

std::string bold_names(const OptionRow& option) {
  if (option.positional) return "\\fI" + roff(option.names.front()) + "\\fR";
  std::string text;
  for (const std::string& name : option.names)
    text += (text.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
  return option.value.empty() ? text : text + " \\fI" + roff(option.value) + "\\fR";
}

std::string synopsis(const CommandRow& command) {
  std::string text = ".B " + roff(command.words) + "\n";
  if (!command.parts.empty())
    text += "\\fICOMMAND\\fR [\\fIOPTION\\fR]...\n";
  else
    text += "[\\fIOPTION\\fR]...\n";
  for (const OptionRow& option : command.options)
    if (option.positional)
      text += (option.required ? "" : "[") + ("\\fI" + roff(option.names.front()) + "\\fR") +
              (option.required ? "" : "]") + (option.repeated ? "...\n" : "\n");
  return text;
}

// What stands without a dash first.
std::vector<OptionRow> in_order(std::vector<OptionRow> options) {
  std::stable_partition(options.begin(), options.end(),
                        [](const OptionRow& option) { return option.positional; });
  return options;
}

std::string sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text.ends_with('.') ? text : text + ".";
}

std::string option_list(const CommandRow& command) {
  std::string text;
  for (const OptionRow& option : in_order(command.options)) {
    text += ".TP\n" + bold_names(option) + "\n";
    std::string about = option.about.empty() ? option.names.front() : option.about;
    constexpr std::size_t kFew = 12;  // more are listed by a command, or by the description
    if (!option.choices.empty() && option.choices.size() <= kFew &&
        about.find(option.choices.back()) == std::string::npos)
      about += ": " + fmt::format("{}", fmt::join(option.choices, ", "));
    text += paragraph(about + (option.required && !option.positional ? " (required)" : "") +
                      (option.repeated && !option.positional && about.find("repeated") == std::string::npos &&
                               about.find("more than once") == std::string::npos
                           ? "; may be repeated"
                           : ""));
  }
  return text;
}

std::string head(const CommandRow& command, const std::string& version) {
  std::string title = page_name(command);
  for (char& c : title)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return fmt::format(".TH {} 1 \"{}\" {} {}\n", roff_quoted(title), SAGE_DATE, roff_quoted("sagefe " + version),
                     roff_quoted("User Commands"));
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// A command of a command, such as `sagefe layout guess`, within the page of that.
std::string part_section(const CommandRow& part) {
  return ".SS " + roff_quoted(part.words) + "\n" + paragraph(sentence(part.about)) + ".PP\n" + synopsis(part) +
         option_list(part) + (part.footer.empty() ? "" : ".PP\n" + as_it_is(part.footer));
}

std::string page_of(const CommandRow& command, const std::string& version) {
  std::string text = head(command, version);
  text += ".SH NAME\n" + roff(page_name(command)) + " \\- " + roff(first_line(command.about)) + "\n";
  text += ".SH SYNOPSIS\n" + synopsis(command);
  text += ".SH DESCRIPTION\n" + paragraph(sentence(command.about));
  text += ".SH OPTIONS\n" + option_list(command);
  if (!command.parts.empty()) text += ".SH COMMANDS\n";
  for (const CommandRow& part : command.parts) text += part_section(part);
  if (!command.footer.empty()) text += ".SH NOTES\n" + as_it_is(command.footer);
  return text + ".SH SEE ALSO\n.BR sagefe (1)\n";
}

std::string page_of_program(const CommandRow& program, const std::string& version) {
  const std::string name = first_line(program.about);
  const std::size_t colon = name.find(": ");
  std::string text = head(program, version);
  text += ".SH NAME\nsagefe \\- " + roff(colon == std::string::npos ? name : name.substr(colon + 2)) + "\n";
  text += ".SH SYNOPSIS\n" + synopsis(program);
  text += ".SH DESCRIPTION\n" + as_it_is(program.about);
  text += ".SH COMMANDS\n";
  for (const CommandRow& part : program.parts)
    text += ".TP\n.BR " + roff(page_name(part)) + " (1)\n" + paragraph(part.about);
  text += ".SH OPTIONS\n" + option_list(program);
  text += ".SH NOTES\n" + as_it_is(program.footer);
  text += ".SH SEE ALSO\n";
  for (std::size_t i = 0; i < program.parts.size(); ++i)
    text += ".BR " + roff(page_name(program.parts[i])) + " (1)" + (i + 1 < program.parts.size() ? ",\n" : "\n");
  return text;
}

}  // namespace

std::vector<ManPage> man_pages(const CommandRow& program, const std::string& version) {
  std::vector<ManPage> pages{{"sagefe.1", page_of_program(program, version)}};
  for (const CommandRow& part : program.parts)
    pages.push_back({page_name(part) + ".1", page_of(part, version)});
  return pages;
}

}  // namespace sage::app

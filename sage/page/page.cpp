#include "sage/page/page.hpp"

namespace sage {

void Page::begin() {
  if (!text_.empty()) text_ += "\n";
  in_list_ = false;
}

void Page::heading(int level, const std::string& words) {
  begin();
  line(std::string(static_cast<std::size_t>(level), '#') + " " + words);
}

void Page::paragraph(const std::string& words) {
  begin();
  line(words);
}

std::string Page::filled(std::string_view text) {
  constexpr std::size_t kColumns = 100;
  std::string out;
  std::size_t used = 0;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    for (bool code = false; end < text.size() && (code || (text[end] != ' ' && text[end] != '\n')); ++end)
      code = code != (text[end] == '`');
    const std::string_view word = text.substr(at, end - at);
    if (used > 0) out += used + 1 + word.size() > kColumns ? '\n' : ' ';
    used = used > 0 && used + 1 + word.size() <= kColumns ? used + 1 + word.size() : word.size();
    out += word;
    at = end + 1;
  }
  return out;
}

void Page::note(const std::string& words) {
  paragraph("<!-- " + words + " -->");
}

void Page::figure(const std::string& title, const std::string& file) {
  paragraph("![" + title + "](" + file + ")");
}

void Page::code(const std::string& lines) {
  paragraph("```\n" + lines + "```");
}

std::string Page::row_of(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& one : cells) text += one.empty() ? "  |" : " " + one + " |";
  return text;
}

void Page::table(const std::vector<std::string>& head) {
  begin();
  std::string titles = "|", rule = "|";
  for (const std::string& title : head) {
    titles += title.empty() ? " |" : " " + title + " |";
    rule += "---|";
  }
  line(titles);
  line(rule);
}

void Page::item(const std::string& words, int depth) {
  if (!in_list_) begin();
  in_list_ = true;
  line(std::string(static_cast<std::size_t>(2 * depth), ' ') + "- " + words);
}

std::string Page::cell(std::string words) {
  for (std::size_t at = 0; (at = words.find('|', at)) != std::string::npos; at += 2) words.insert(at, "\\");
  return words;
}

}  // namespace sage

// A page of Markdown.  Its parts stand one blank line apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sage {

class Page {
 public:
  explicit Page(const std::string& title) { heading(1, title); }

  void heading(int level, const std::string& words);
  void paragraph(const std::string& words);
  // A paragraph in lines of at most 100 columns, whatever lines `words` has; code in `...` is not broken.
  void prose(const std::string& words) { paragraph(filled(words)); }
  // For those who look at the source of the page; readers don't see it.
  void note(const std::string& words);
  void figure(const std::string& title, const std::string& file);
  // Lines as they are, such as a card.  They end in a newline.
  void code(const std::string& lines);

  // Begins a table; rows follow.
  void table(const std::vector<std::string>& head);
  void row(const std::vector<std::string>& cells) { line(row_of(cells)); }
  // Begins a list or goes on with it; depth: 0 = no list within another.
  void item(const std::string& words, int depth = 0);

  // One line more in the part under way, such as words directly below a heading.
  void line(const std::string& words) { text_ += words + "\n"; }
  // One blank line more.
  void gap() { text_ += "\n"; }

  const std::string& text() const { return text_; }

  // For a cell: a bar would end it.
  static std::string cell(std::string words);

 private:
  void begin();
  static std::string filled(std::string_view text);
  static std::string row_of(const std::vector<std::string>& cells);

  std::string text_;
  bool in_list_ = false;
};

}  // namespace sage

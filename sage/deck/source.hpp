// A text file as records: lines without their ends, found once.  A copy shares them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sage {

class SourceText {
 public:
  SourceText() : SourceText({}, {}) {}
  SourceText(std::string text, std::string name);

  const std::string& name() const { return name_; }
  const std::shared_ptr<const std::string>& text() const { return text_; }
  int line_count() const { return static_cast<int>(starts_->size()); }
  // 1-based; without LF, CR LF or CR.  Empty for a line that doesn't exist.
  std::string_view line(int number) const;
  // Offset of each line's first character.
  const std::vector<std::uint32_t>& starts() const { return *starts_; }

 private:
  std::string name_;
  std::shared_ptr<const std::string> text_;  // at most 2 GiB
  std::shared_ptr<const std::vector<std::uint32_t>> starts_;
};

// The whole file.  Throws InputError: missing, a directory, unreadable.
std::string read_file(const std::string& path);

// Throws InputError for a text that can't be a deck: empty, binary, a document of another kind.
void check_is_text(std::string_view text, const std::string& name);

}  // namespace sage

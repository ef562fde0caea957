// Lists in one text, such as the values of an option.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

namespace sage {

// The parts between separators, as views of the text.  "a,,b" and "a," have empty parts; an empty text is one empty part.
inline std::vector<std::string_view> split_at(char separator, std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

}  // namespace sage

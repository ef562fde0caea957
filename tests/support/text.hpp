// Words of texts that tests look at.
#pragma once

#include <string>
#include <vector>

namespace sage::test {

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Parts between marks, empty ones too; at least one.
inline std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (char c : text)
    if (c == mark)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace sage::test

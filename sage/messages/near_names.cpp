#include "sage/messages/near_names.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace sage {

namespace {

std::string lower(std::string_view text) {
  std::string word(text);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

}  // namespace

std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    next[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      next[j + 1] = std::min({row[j + 1] + 1, next[j] + 1, row[j] + (a[i] == b[j] ? 0 : 1)});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
    }
    before = std::exchange(row, next);
  }
  return row[b.size()];
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() < 3) return {};  // chance
  const std::string wanted = lower(name);
  const std::string* best = nullptr;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& one : known) {
    const bool begins = wanted.size() >= 3 && lower(one).starts_with(wanted);
    const std::size_t far = begins ? 1 : distance(wanted, lower(one));
    if (far < least) best = &one, least = far;
  }
  return best == nullptr ? std::string() : "; did you mean " + *best + "?";
}

}  // namespace sage

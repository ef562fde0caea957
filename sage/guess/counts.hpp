// Integers of cards that stand alone: what may count the blocks that follow.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sage::guess {

class Counts {
 public:
  struct Source {
    int card = 0;  // in the order of adding
    int field = 0;
    int line = 0;  // of the deck
    int value = 0;
    std::string name;  // "control.field3"
    bool used = false;
  };

  void add(int card, int field, int line, double value, const std::string& name);
  // The one that says `value`: of those not used yet the next behind the last one used, else any; marks it.
  // `card`: only one of this card; -1 = of any.
  std::optional<Source> take(double value, int card = -1);
  // The one right behind the last one used, if it says `value` and stands on the same card.
  std::optional<Source> take_next(double value);
  bool has(double value) const;
  // Others that say the same.
  std::vector<std::string> also(const Source& source) const;
  bool used(int card) const;

 private:
  std::map<int, std::vector<std::size_t>> by_value_;  // into sources_
  std::vector<Source> sources_;
  std::size_t last_ = 0;
};

}  // namespace sage::guess

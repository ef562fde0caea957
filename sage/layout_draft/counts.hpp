// Integers of cards that stand alone: what may count the blocks that follow.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sage::layout_draft {

class Counts {
 public:
  struct Source {
    int card = 0;  // in the order of adding
    int field = 0;
    int line = 0;  // of the deck
    int value = 0;
    std::string name;  // "control.field3"
    bool used = false;
    bool again = false;     // it counted other lines before
    bool backward = false;  // counts behind it were used before it
  };

  void add(int card, int field, int line, double value, const std::string& name);
  // The one that says `value`: of those not used yet the next behind the last one used, else any; marks it.
  // `card`: only one of this card; -1 = of any.
  std::optional<Source> take(double value, int card = -1);
  // The one right behind the last one used, if it says `value` and stands on the same card.
  std::optional<Source> take_next(double value);
  bool has(double value) const;
  // Why the agreement may be chance: "; it may be chance: a small number, ..."; empty where nothing speaks for that.
  // `control`: the card whose numbers are counts; -1 = not known.
  std::string chance(const Source& source, int control) const;
  bool used(int card) const;

 private:
  double share_around(int value) const;

  std::map<int, std::vector<std::size_t>> by_value_;  // into sources_
  std::vector<Source> sources_;
  std::size_t last_ = 0;
};

}  // namespace sage::layout_draft

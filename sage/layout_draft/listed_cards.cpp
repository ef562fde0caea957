// Cards of list-directed decks: counts with the items behind them, lists of coordinates, lines of one kind.
#include <algorithm>
#include <cmath>
#include <optional>

#include "sage/deck/text.hpp"
#include "sage/layout_draft/cards.hpp"
#include "sage/layout_draft/counts.hpp"

namespace sage::layout_draft {

namespace {

constexpr std::size_t kLargestItem = 12, kMostFields = 24;

struct Value {
  Kind kind = Kind::integer;
  double number = 0.0;
};

std::vector<FieldDraft> plain_fields(const std::vector<Kind>& kinds) {
  std::vector<FieldDraft> fields;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    fields.push_back({"field" + std::to_string(k + 1), "", kinds[k], 0, 0, 0, -1, false, ""});
  return fields;
}

class ListedBuilder {
 public:
  explicit ListedBuilder(const Scan& scan) : scan_(scan) {}

  std::vector<CardDraft> build() {
    while (at_ < scan_.lines.size()) {
      if (cards_.size() >= kMostCards) {
        add_rest();
        break;
      }
      const Sort sort = scan_.lines[at_].sort;
      if (sort == Sort::comment) {
        ++at_;
      } else if (sort == Sort::blank) {
        ++blanks_;
        ++at_;
      } else if (sort == Sort::words) {
        add_words();
      } else if (!add_items() && !add_long_list()) {
        add_like_lines();
      }
    }
    return std::move(cards_);
  }

 private:
  const Line& line(std::size_t i) const { return scan_.lines[i]; }

  // Next line of numbers from `i` on, blanks and comments passed over; nothing at words or the end.
  std::optional<std::size_t> numbers_from(std::size_t i) const {
    while (i < scan_.lines.size() && (line(i).sort == Sort::blank || line(i).sort == Sort::comment)) ++i;
    if (i == scan_.lines.size() || line(i).sort != Sort::numbers) return std::nullopt;
    return i;
  }

  // Looking ahead in vain costs: all of it together at most so many times the deck.
  bool may_look(std::size_t tokens) {
    looked_ += tokens + 1;
    return looked_ <= 40 * scan_.lines.size() + 1000000;
  }

  // ---- N, then N items of k values each, up to the end of a line

  bool add_items() {
    const Line& head = line(at_);
    if (head.tokens.size() != 1 || head.tokens[0].kind != Kind::integer) return false;
    const double count = head.tokens[0].value;
    if (!(count >= 1.0 && count <= 1e7)) return false;
    const auto n = static_cast<std::size_t>(count);
    std::vector<Value> values;
    std::vector<std::pair<std::size_t, std::size_t>> ends;  // values so far, and the line that ends there
    for (auto i = numbers_from(at_ + 1); i && values.size() < kLargestItem * n; i = numbers_from(*i + 1)) {
      if (!may_look(line(*i).tokens.size())) return false;
      for (const Token& token : line(*i).tokens) {
        if (token.quoted) return false;
        values.push_back({token.kind, token.value});
      }
      ends.emplace_back(values.size(), *i);
      if (n == 1) break;
    }
    for (std::size_t k = kLargestItem; k >= 1; --k) {
      const auto end = std::find_if(ends.begin(), ends.end(), [&](auto& e) { return e.first == n * k; });
      if (end == ends.end() || !are_items(values, n, k)) continue;
      add_item_card(values, n, k, end->second);
      return true;
    }
    return false;
  }

  // The same kinds in every item; of several values the first is a number that ascends.
  static bool are_items(const std::vector<Value>& values, std::size_t n, std::size_t k) {
    for (std::size_t j = 0; j < k; ++j) {
      bool integers = false, reals = false;
      for (std::size_t i = 0; i < n; ++i) (values[i * k + j].kind == Kind::integer ? integers : reals) = true;
      if (integers && reals && j == 0) return false;
    }
    if (k == 1) return n > 1;
    if (n == 1) return k >= 3 && values[0].kind == Kind::integer;
    for (std::size_t i = 0; i < n; ++i) {
      if (values[i * k].kind != Kind::integer) return false;
      if (i > 0 && values[i * k].number <= values[(i - 1) * k].number) return false;
    }
    return true;
  }

  static std::string chance_of_items(std::size_t n) {
    return n <= 3 ? "; it may be chance: a small number" : "";
  }

  void add_item_card(const std::vector<Value>& values, std::size_t n, std::size_t k, std::size_t last) {
    CardDraft card = begin_card("count");
    card.fields = plain_fields({Kind::integer});
    card.fields[0].name = "count";
    card.fields[0].known = true;
    if (k == 1) {
      Kind kind = Kind::integer;
      for (const Value& value :
           std::vector<Value>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n)))
        kind = std::max(kind, value.kind);
      card.fields.push_back({"values", "", kind, 0, 0, 0, -1, false, "\"count\""});
      card.reasons.push_back(std::to_string(n) + " values fill the lines up to line " +
                             std::to_string(line(last).number) + " exactly" + chance_of_items(n));
      return finish(card, last);
    }
    CardDraft item;
    std::vector<Kind> kinds(k, Kind::integer);
    bool codes = k >= 3;
    for (std::size_t i = 0; i < n * k; ++i) {
      if (values[i].kind == Kind::real) kinds[i % k] = Kind::real;
      if (i % k > 0) codes = codes && (values[i].number == 0.0 || values[i].number == 1.0);
    }
    item.fields = plain_fields(kinds);
    item.reasons.push_back(number_text(static_cast<double>(n)) + " items of " + std::to_string(k) +
                           " values fill the lines up to line " + std::to_string(line(last).number) +
                           " exactly" + chance_of_items(n));
    name_item(item, kinds, codes && kinds.back() == Kind::integer);
    card.items_count = "\"count\"";
    card.items.push_back(std::move(item));
    finish(card, last);
  }

  void name_item(CardDraft& item, const std::vector<Kind>& kinds, bool codes) {
    const auto set = [&](std::size_t k, const char* name) {
      item.fields[k].name = name;
      item.fields[k].known = true;
    };
    const bool forces =
        kinds.size() == 3 && kinds[0] == Kind::integer && kinds[1] == Kind::real && kinds[2] == Kind::real;
    if (codes) {
      item.name = names_.unique("fixity");
      set(0, "first");
      set(1, "x_code");
      set(2, "y_code");
      item.reasons.push_back("looks like fixities: a node's number and codes 0 and 1 (is 1 fixed or free?)");
    } else if (forces) {
      item.name = names_.unique("load");
      set(0, "first");
      set(1, "x_force");
      set(2, "y_force");
      item.reasons.push_back("looks like loads: a node's number and two reals");
    } else {
      item.name = names_.unique("item");
    }
  }

  // ---- Reals that go up or down over one or more lines, as many as an integer further up says (or one more)

  bool add_long_list() {
    std::size_t values = 0;
    double before = 0.0, last = 0.0;
    std::size_t best_line = 0, best_count = 0;
    double best_plus = 0.0;
    for (auto i = std::optional<std::size_t>(at_); i; i = numbers_from(*i + 1)) {
      if (!may_look(line(*i).tokens.size())) break;
      for (const Token& token : line(*i).tokens) {
        if (token.kind != Kind::real) return finish_list(best_line, best_count, best_plus);
        const bool turns = values > 1 && (token.value - last) * (last - before) <= 0.0;
        if (turns) return finish_list(best_line, best_count, best_plus);
        before = last;
        last = token.value;
        ++values;
      }
      const auto count = static_cast<double>(values);
      if (values >= 2 && (counts_.has(count - 1.0) || (values > 2 && counts_.has(count)))) {
        best_line = *i;
        best_count = values;
        best_plus = counts_.has(count - 1.0) ? 1.0 : 0.0;
      }
    }
    return finish_list(best_line, best_count, best_plus);
  }

  bool finish_list(std::size_t last, std::size_t count, double plus) {
    if (count == 0) return false;
    const auto source = counts_.take(static_cast<double>(count) - plus);
    ++lists_;
    const bool mesh = plus > 0.0 && lists_ <= 2;
    CardDraft card = begin_card(!mesh ? "list" : lists_ == 1 ? "rectangle_x" : "rectangle_y");
    const std::string expression = source->name + (plus > 0.0 ? " + 1" : "");
    const char* name = !mesh ? "values" : lists_ == 1 ? "x" : "y";
    card.fields = {{name, "", Kind::real, 0, 0, 0, -1, mesh, "\"" + expression + "\""}};
    if (mesh) card.reasons.push_back("looks like the edges of a rectangle whose mesh is numbered by rule");
    card.reasons.push_back(std::to_string(count) + " reals that go one way, as coordinates do: " + expression +
                           ", line " + std::to_string(source->line) + (mesh ? "" : counts_.chance(*source, 0)));
    finish(card, last);
    return true;
  }

  // ---- Lines of the same kinds

  void add_like_lines() {
    std::vector<Kind> kinds = kinds_of(at_);
    std::size_t last = at_, lines = 1;
    for (auto i = numbers_from(at_ + 1); i; i = numbers_from(*i + 1)) {
      const std::vector<Kind> next = kinds_of(*i);
      if (next.size() != kinds.size() || kinds.size() < 2 || !like(kinds, next)) break;
      for (std::size_t k = 0; k < kinds.size(); ++k)
        if (next[k] == Kind::real) kinds[k] = Kind::real;
      last = *i;
      ++lines;
    }
    CardDraft card = begin_card("card");
    if (kinds.size() > kMostFields)
      one_list(card, kinds);
    else
      card.fields = plain_fields(kinds);
    if (lines > 1)
      count_lines(card, lines);
    else
      offer_counts(card);
    finish(card, last);
  }

  std::vector<Kind> kinds_of(std::size_t i) const {
    std::vector<Kind> kinds;
    for (const Token& token : line(i).tokens) kinds.push_back(token.kind);
    return kinds;
  }

  // An integer may stand for a real, but not in the first place, where numbers stand.
  static bool like(const std::vector<Kind>& a, const std::vector<Kind>& b) {
    for (std::size_t k = 0; k < a.size(); ++k)
      if (a[k] != b[k] && (k == 0 || a[k] == Kind::text || b[k] == Kind::text)) return false;
    return true;
  }

  static void one_list(CardDraft& card, const std::vector<Kind>& kinds) {
    Kind kind = Kind::integer;
    for (const Kind one : kinds) kind = std::max(kind, one);
    card.fields = {{"values", "", kind, 0, 0, 0, -1, false, std::to_string(kinds.size())}};
    card.reasons.push_back(std::to_string(kinds.size()) + " values on one line: a list? Put its count here");
  }

  void count_lines(CardDraft& card, std::size_t lines) {
    const auto n = static_cast<double>(lines);
    if (const auto source = counts_.take(n)) {
      card.repeat = "\"" + source->name + "\"";
      card.reasons.push_back(source->name + " (line " + std::to_string(source->line) + ") agrees with these " +
                             std::to_string(lines) + " lines" + counts_.chance(*source, 0));
      return;
    }
    card.repeat = std::to_string(lines);
    card.reasons.push_back("no number of the deck was found that says how many lines: put the count here");
  }

  void offer_counts(const CardDraft& card) {
    const Line& head = line(at_);
    for (std::size_t k = 0; k < head.tokens.size() && k < card.fields.size(); ++k)
      if (head.tokens[k].kind == Kind::integer && card.fields[k].count.empty())
        counts_.add(static_cast<int>(cards_.size()), static_cast<int>(k), head.number, head.tokens[k].value,
                    card.name + "." + card.fields[k].name);
  }

  // ---- Words, and what all have in common

  void add_words() {
    std::size_t last = at_, lines = 1;
    while (last + 1 < scan_.lines.size() && line(last + 1).sort == Sort::words) {
      ++last;
      ++lines;
    }
    CardDraft card = text_card(names_.unique(cards_.empty() && lines == 1 ? "title" : "text"), lines);
    card.headings =
        static_cast<int>(blanks_);  // a FORMAT takes blank lines, a list-directed READ passes over them
    finish(card, last);
  }

  CardDraft begin_card(const std::string& name) {
    CardDraft card;
    card.name = names_.unique(name);
    card.format = "*";
    return card;
  }

  void finish(CardDraft& card, std::size_t last) {
    card.first_line = line(at_).number;
    card.last_line = line(last).number;
    blanks_ = 0;
    at_ = last + 1;
    cards_.push_back(std::move(card));
  }

  void add_rest() {
    std::size_t records = 0;
    for (std::size_t i = at_; i < scan_.lines.size(); ++i)
      if (line(i).sort != Sort::comment) ++records;
    CardDraft card = text_card(names_.unique("text"), records);
    card.headings = static_cast<int>(blanks_);
    card.reasons.push_back("more than " + std::to_string(kMostCards) + " cards: the rest was not looked at");
    finish(card, scan_.lines.size() - 1);
  }

  const Scan& scan_;
  std::size_t at_ = 0, blanks_ = 0, looked_ = 0, lists_ = 0;
  Counts counts_;
  CardNames names_;
  std::vector<CardDraft> cards_;
};

}  // namespace

std::vector<CardDraft> listed_cards(const Scan& scan) {
  return ListedBuilder(scan).build();
}

}  // namespace sage::layout_draft

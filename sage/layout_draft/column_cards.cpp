// Cards of decks whose numbers stand in columns: blocks, what counts them, what ends them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "sage/deck/text.hpp"
#include "sage/layout_draft/cards.hpp"
#include "sage/layout_draft/counts.hpp"

namespace sage::layout_draft {

namespace {

constexpr std::size_t kLongestPeriod = 4;

// Runs [first, first + period * times) are the same cards again and again.
struct Period {
  std::size_t length = 1, times = 1;
};

std::size_t values_in(const Run& run) {
  std::size_t count = 0;
  for (const Cluster& cluster : run.clusters) count += cluster.count();
  return count;
}

constexpr std::size_t kMostRecords = 3;  // of a card of like lines

// Every p-th line bears the next number, the lines between do not: cards of p lines each.
bool numbers_every(const Run& run, const Scan& scan, std::size_t p, std::size_t cards) {
  const auto first = [&](std::size_t i) -> const Token& { return scan.lines[run.lines[i]].tokens.front(); };
  for (std::size_t i = 0; i < p * cards; ++i) {
    if (scan.lines[run.lines[i]].tokens.empty() || first(i).kind != Kind::integer) return false;
    if (i > 0 && i % p == 0 && first(i).value != first(i - p).value + 1.0) return false;
  }
  // Numbers that go on from line to line are those of cards of one line.
  for (std::size_t i = 1; i < p * cards; ++i)
    if (i % p != 0 && first(i).value == first(i - 1).value + 1.0 &&
        (i + 1 == p * cards || first(i + 1).value == first(i).value + 1.0))
      return false;
  return true;
}

bool all_real(const Run& run) {
  return !run.words && !run.clusters.empty() &&
         std::all_of(run.clusters.begin(), run.clusters.end(), [](auto& c) { return c.kind() == Kind::real; });
}

class CardBuilder {
 public:
  CardBuilder(const Scan& scan, std::vector<Run> runs) : scan_(scan), runs_(std::move(runs)) {}

  std::vector<CardDraft> build() {
    join_counted();
    nodes_ = find_nodes(runs_, scan_);
    for (std::size_t i = 0; i < runs_.size();) {
      if (cards_.size() >= kMostCards) {
        add_rest(i);
        break;
      }
      const Period period = find_period(i);
      if (period.times > 1)
        add_block(i, period);
      else
        cards_.push_back(make_card(i, true));
      i += period.length * period.times;
    }
    return std::move(cards_);
  }

 private:
  // ---- Runs that a count of the deck joins

  // All integers of single lines further up.
  void join_counted() {
    Counts counts;
    std::vector<std::size_t> control;  // counts of the control card, in its order
    std::vector<Run> joined;
    for (Run& run : runs_) {
      if (!joined.empty() && may_join(joined.back(), run)) {
        const double whole = static_cast<double>(joined.back().lines.size() + run.lines.size());
        if (counts.has(whole) && !counts.has(static_cast<double>(run.lines.size()))) {
          for (const std::size_t line : run.lines) add_line(joined.back(), scan_, line);
          joined.back().blanks_behind = run.blanks_behind;
          find_column_facts(joined.back(), scan_);
          continue;
        }
      }
      if (run.lines.size() == 1) {
        std::vector<std::size_t> integers;
        for (const ColumnFacts& column : run.columns)
          if (column.count == 1 && column.integers) {
            counts.add(0, 0, 0, column.low, "");
            if (column.low >= 1.0 && column.low < 1e8) integers.push_back(static_cast<std::size_t>(column.low));
          }
        if (control.empty() && integers.size() >= 2 && integers.size() == run.columns.size())
          control = integers;
      }
      while (const std::size_t lines = counted_head(run, counts, control))
        joined.push_back(cut_behind(run, lines));
      if (const std::size_t cards = set_records(run, counts);
          cards * run.records < run.lines.size() && cards > 0)
        joined.push_back(cut_behind(run, cards * run.records));
      joined.push_back(std::move(run));
    }
    runs_ = std::move(joined);
  }

  // Lines at the head of a run that a count of the control card gives, where the run as a whole agrees with none and
  // another kind of line begins behind them, or another of its counts gives the rest; 0 = none.
  std::size_t counted_head(const Run& run, const Counts& counts,
                           const std::vector<std::size_t>& control) const {
    const std::size_t lines = run.lines.size();
    if (run.words || !run.format.empty() || lines < 3 || counts.has(static_cast<double>(lines))) return 0;
    const auto is_count = [&](std::size_t n) { return std::ranges::find(control, n) != control.end(); };
    std::size_t found = 0;
    for (const std::size_t head : control) {
      if (head < 2 || head >= lines) continue;
      const std::size_t rest = lines - head;
      const bool change = changes_at(run, head);
      if (change && is_count(rest)) return head;
      if (found == 0 && (change || (is_count(rest) && head > 3 && rest > 3))) found = head;
    }
    return found;
  }

  // All lines before this one are of one pattern of kinds, and it and those behind are of another.
  bool changes_at(const Run& run, std::size_t at) const {
    const auto pattern = [&](std::size_t i) {
      std::string kinds;
      for (const Token& token : scan_.lines[run.lines[i]].tokens)
        kinds += static_cast<char>('a' + static_cast<int>(token.kind));
      return kinds;
    };
    const std::string before = pattern(0), behind = pattern(at);
    if (before == behind) return false;
    for (std::size_t i = 0; i < run.lines.size(); ++i)
      if (pattern(i) != (i < at ? before : behind)) return false;
    return true;
  }

  // Like lines that no count fits, but every second or third of which begins with the next number: how many such
  // cards a count gives (0: none), and how many lines each takes.
  std::size_t set_records(Run& run, const Counts& counts) const {
    const std::size_t lines = run.lines.size();
    if (run.words || !run.format.empty() || lines < 4 || counts.has(static_cast<double>(lines))) return 0;
    for (std::size_t p = 2; p <= kMostRecords; ++p)
      for (std::size_t cards = lines / p; cards >= 2; --cards) {
        if (!counts.has(static_cast<double>(cards)) || !numbers_every(run, scan_, p, cards)) continue;
        run.records = p;
        return cards;
      }
    return 0;
  }

  // The run's first lines; the rest is left in it and is another card.
  Run cut_behind(Run& run, std::size_t lines) const {
    Run head = run;
    const auto at = static_cast<std::ptrdiff_t>(lines);
    head.lines.erase(head.lines.begin() + at, head.lines.end());
    head.blanks_behind = 0;
    run.lines.erase(run.lines.begin(), run.lines.begin() + at);
    run.headings.clear();
    run.comment = run.title = -1;
    run.records = 1;
    for (Run* part : {&head, &run}) find_clusters(*part);
    return head;
  }

  void find_clusters(Run& run) const {
    const std::vector<std::size_t> lines = std::exchange(run.lines, {});
    run.clusters.clear();
    for (const std::size_t line : lines) add_line(run, scan_, line);
    find_column_facts(run, scan_);
  }

  bool may_join(const Run& a, const Run& b) const {
    return !a.words && !b.words && a.blanks_behind == 0 && b.headings.empty() && b.format.empty() &&
           a.format.empty() && alike(a, b);
  }

  // ---- Periods

  Period find_period(std::size_t first) const {
    Period best;
    for (std::size_t length = 2; length <= kLongestPeriod; ++length) {
      std::size_t times = 1;
      while (repeats(first, length, times)) ++times;
      if (times > 1 && length * times > best.length * best.times) best = {length, times};
    }
    return best;
  }

  bool repeats(std::size_t first, std::size_t length, std::size_t times) const {
    if (first + length * (times + 1) > runs_.size()) return false;
    for (std::size_t k = 0; k < length; ++k) {
      const Run &a = runs_[first + k], &b = runs_[first + length * times + k];
      if (a.records != 1 || b.records != 1) return false;
      if (a.headings.size() != b.headings.size() || a.blanks_behind > 0 || b.blanks_behind > 0) return false;
      if (!alike(a, b)) return false;
      if (a.lines.size() != b.lines.size() && !(all_real(a) && k > 0)) return false;
      if (a.words && b.words && length < 2) return false;
    }
    const Run &one = runs_[first], &two = runs_[first + 1];
    return !alike(one, two) || one.clusters.size() != two.clusters.size();
  }

  // One run of all that stand at this place of the period.
  Run joined_run(std::size_t first, const Period& period, std::size_t k) const {
    Run all = runs_[first + k];
    for (std::size_t t = 1; t < period.times; ++t)
      for (const std::size_t line : runs_[first + t * period.length + k].lines) add_line(all, scan_, line);
    find_column_facts(all, scan_);
    return all;
  }

  void add_block(std::size_t first, const Period& period) {
    CardDraft block;
    std::vector<Run> inner;
    for (std::size_t k = 0; k < period.length; ++k) inner.push_back(joined_run(first, period, k));
    for (std::size_t k = 0; k < period.length; ++k) {
      CardDraft card = card_of(inner, k, inner[k]);
      card.headings = static_cast<int>(inner[k].headings.size());
      if (!repeat_inner(first, period, inner, block, card)) join_lines(first, period, k, inner[k], card);
      block.inner.push_back(std::move(card));
    }
    block.name = names_.unique("block of " + block.inner[0].name);
    const std::size_t end = first + period.length * period.times;
    span_lines(block, runs_[first], runs_[end - 1]);
    block.reasons.push_back("these " + std::to_string(period.length) + " kinds of lines follow each other " +
                            std::to_string(period.times) + " times");
    count_by(block, static_cast<double>(period.times), "blocks");
    if (block.repeat.empty()) {
      block.repeat = std::to_string(period.times);
      block.reasons.push_back("no number of the deck was found that says how often: put the count here");
    }
    cards_.push_back(std::move(block));
  }

  // Lines or values of an inner card that a field of a card before it in the block counts.
  // False where several lines come together and nothing counts them.
  bool repeat_inner(std::size_t first, const Period& period, const std::vector<Run>& inner,
                    const CardDraft& block, CardDraft& card) {
    const std::size_t k = block.inner.size();
    std::vector<double> lines, values;
    for (std::size_t t = 0; t < period.times; ++t) {
      const Run& run = runs_[first + t * period.length + k];
      lines.push_back(static_cast<double>(run.lines.size()));
      values.push_back(static_cast<double>(values_in(run)));
    }
    const bool several = *std::max_element(lines.begin(), lines.end()) > 1.0;
    const bool uneven = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
    for (std::size_t j = 0; j < k; ++j)
      for (const FieldDraft& field : block.inner[j].fields) {
        if (field.cluster < 0) continue;
        const Cluster& place = inner[j].clusters[field.cluster];
        const std::vector<double> given = column_values(first, period, j, place);
        const std::string name = "\"" + block.inner[j].name + "." + field.name + "\"";
        // A number that is the same in every block agrees in all as easily as in one.
        const bool same = std::ranges::all_of(given, [&](double one) { return one == given[0]; });
        const std::string chance = same ? "; it may be chance: it is the same in every block" : "";
        if (all_real(runs_[first + k]) && given == values && (several || uneven)) {
          make_list(card, name, chance);
          return true;
        }
        if (several && given == lines) {
          card.repeat = name;
          card.reasons.push_back(name + " agrees with the number of these lines in every block" + chance);
          return true;
        }
      }
    return !several;
  }

  // Lines that come together in every block and that nothing counts: one card of as many records.
  void join_lines(std::size_t first, const Period& period, std::size_t k, const Run& all, CardDraft& card) {
    const std::size_t records = runs_[first + k].lines.size();
    if (records > kMostRecords || all.words || !all.format.empty()) {
      card.repeat = std::to_string(records);
      card.reasons.push_back("no number of the block says how many of these lines come together");
      return;
    }
    const std::string name = card.name;
    card = card_of_records(all, records);
    card.name = name;
    card.headings = static_cast<int>(all.headings.size());
    card.reasons.push_back("these " + std::to_string(records) + " lines of " + std::to_string(period.times) +
                           " blocks come together: taken as one card; if each is a card, take one line of the "
                           "FORMAT and repeat = " +
                           std::to_string(records));
  }

  // The value of a column in every block; empty where one has none.
  std::vector<double> column_values(std::size_t first, const Period& period, std::size_t j,
                                    const Cluster& place) const {
    std::vector<double> values;
    for (std::size_t t = 0; t < period.times; ++t) {
      const Run& run = runs_[first + t * period.length + j];
      if (run.lines.size() != 1) return {};
      for (const Token& token : scan_.lines[run.lines[0]].tokens)
        if (token.kind == Kind::integer && token.last >= place.first && token.first <= place.last)
          values.push_back(token.value);
      if (values.size() != t + 1) return {};
    }
    return values;
  }

  static void make_list(CardDraft& card, const std::string& count, const std::string& chance) {
    FieldDraft list = card.fields.front();
    list.name = "values";
    list.label.clear();
    list.count = count;
    card.fields = {list};
    card.reasons.push_back(count + " agrees with the number of these values in every block" + chance);
  }

  // ---- One card

  // A card that takes several lines, which may be alike: each line has its own fields.
  CardDraft card_of_records(const Run& run, std::size_t records) {
    CardDraft card;
    std::vector<Run> parts(records, run);
    for (Run& part : parts) part.lines.clear();
    for (std::size_t i = 0; i < run.lines.size(); ++i) parts[i % records].lines.push_back(run.lines[i]);
    for (Run& part : parts) find_clusters(part);
    NodeFacts nodes = nodes_;
    nodes.run = -1;
    for (std::size_t r = 0; r < records; ++r) {
      CardDraft line;
      find_format(parts[r], scan_, line);
      if (r == 0) {
        const Role role = find_role(parts, 0, nodes, scan_, line);
        card.name = name_of(role, run);
        card.reasons = line.reasons;
      }
      card.format += (r == 0 ? "(" : "/") + line.format.substr(1, line.format.size() - 2);
      for (FieldDraft& field : line.fields) {
        field.record = static_cast<int>(r) + 1;
        field.cluster = -1;  // none of the whole run
        if (!field.known) field.name = "field" + std::to_string(card.fields.size() + 1);
        card.fields.push_back(std::move(field));
      }
    }
    card.format += ')';
    return card;
  }

  CardDraft card_of(const std::vector<Run>& runs, std::size_t i, const Run& run) {
    CardDraft card;
    find_format(run, scan_, card);
    NodeFacts nodes = nodes_;
    if (&runs != &runs_) nodes.run = -1;
    const Role role = find_role(runs, i, nodes, scan_, card);
    card.name = names_.unique(name_of(role, run));
    return card;
  }

  std::string name_of(Role role, const Run& run) {
    if (const char* name = role_name(role)) return name;
    if (run.words) return cards_.empty() && run.lines.size() == 1 ? "title" : "text";
    const bool integers = run.lines.size() == 1 && run.clusters.size() >= 2 &&
                          std::all_of(run.clusters.begin(), run.clusters.end(),
                                      [](const Cluster& c) { return c.kind() == Kind::integer; });
    if (!integers || control_ >= 0) return "card";
    control_ = static_cast<int>(cards_.size());
    return "control";
  }

  CardDraft make_card(std::size_t i, bool counted) {
    const Run& run = runs_[i];
    const int index = static_cast<int>(cards_.size());
    CardDraft card = run.records > 1 ? card_of_records(run, run.records) : card_of(runs_, i, run);
    if (run.records > 1) {
      card.name = names_.unique(card.name);
      card.reasons.push_back("every " + std::string(run.records == 2 ? "second" : "third") +
                             " line begins with the next number: cards of " + std::to_string(run.records) +
                             " lines");
    }
    card.headings = static_cast<int>(run.headings.size());
    span_lines(card, run, run);
    if (counted) end_run(i, card);
    if (run.lines.size() == 1)
      for (std::size_t f = 0; f < card.fields.size(); ++f) {
        const int k = card.fields[f].cluster;
        if (k < 0 || !run.columns[static_cast<std::size_t>(k)].integers) continue;
        const ColumnFacts& column = run.columns[static_cast<std::size_t>(k)];
        if (column.count == 1)
          counts_.add(index, static_cast<int>(f), scan_.lines[run.lines[0]].number, column.low,
                      card.name + "." + card.fields[f].name);
      }
    return card;
  }

  // Lines from the first heading to the last card, and the blank that ends them.
  void span_lines(CardDraft& card, const Run& first, const Run& last) const {
    const std::size_t begin = first.headings.empty() ? first.lines.front() : first.headings.front();
    card.first_line = scan_.lines[begin].number;
    card.last_line = scan_.lines[last.lines.back()].number;
  }

  void end_run(std::size_t i, CardDraft& card) {
    const Run& run = runs_[i];
    const std::size_t cards = run.lines.size() / run.records;
    const auto lines = static_cast<double>(cards);
    if (run.lines.size() == 1 && !run.words) count_one(card);
    if (run.lines.size() > 1) {
      if (static_cast<int>(i) == nodes_.run) end_by_number(run, card);
      if (card.until.empty() && (!run.words || run.lines.size() >= 10))
        count_by(card, lines, run.records > 1 ? "cards" : "lines");
      if (card.repeat.empty() && card.until.empty()) end_by_mark(run, card);
      if (card.repeat.empty() && card.until.empty() && run.blanks_behind > 0) return end_by_blank(i, card);
      if (card.repeat.empty() && card.until.empty()) end_by_number(run, card);
      if (card.repeat.empty() && card.until.empty()) list_or_number(run, card);
    }
    give_blank_away(i);
  }

  void count_by(CardDraft& card, double count, const std::string& what) {
    // Small numbers stand everywhere.
    const bool small = count <= 3.0;
    if (small && control_ < 0) return;
    const auto source = counts_.take(count, small ? control_ : -1);
    if (!source) return;
    card.repeat = "\"" + source->name + "\"";
    card.reasons.push_back(source->name + " (line " + std::to_string(source->line) + ") is " +
                           number_text(count) + " and agrees with these " + number_text(count) + " " + what +
                           counts_.chance(*source, control_));
  }

  // The counts of a control card come in the order of their blocks: the next one says 1, and here is one line.
  void count_one(CardDraft& card) {
    if (control_ < 0) return;
    const auto source = counts_.take_next(1.0);
    if (!source) return;
    card.repeat = "\"" + source->name + "\"";
    card.reasons.push_back(source->name + " (line " + std::to_string(source->line) +
                           "), the next count, is 1, and here is one line; it may be chance");
  }

  // A letter that stands on the last card only.
  void end_by_mark(const Run& run, CardDraft& card) const {
    if (run.clusters.empty() || run.clusters[0].texts != 1 || run.clusters[0].count() != 1) return;
    const Line& last = scan_.lines[run.lines.back()];
    if (last.tokens.empty() || last.tokens[0].kind != Kind::text || run.columns.empty()) return;
    const std::string mark(
        last.record.substr(static_cast<std::size_t>(last.tokens[0].first) - 1,
                           static_cast<std::size_t>(last.tokens[0].last - last.tokens[0].first + 1)));
    if (mark.find('\'') != std::string::npos || mark.find('"') != std::string::npos) return;
    card.until = "\"" + card.fields[0].name + " == '" + mark + "'\"";
    card.reasons.push_back("\"" + mark + "\" stands on the last of these lines only");
  }

  void end_by_blank(std::size_t i, CardDraft& card) {
    const FieldDraft& field = card.fields.front();
    card.until_dropped = "\"" + field.name + (field.kind == Kind::text ? " == ''\"" : " == 0\"");
    card.reasons.push_back("a blank line ends these lines (it reads as zeros)");
    card.last_line = scan_.lines[blank_behind(i)].number;
  }

  // Generated numbers: the last card bears the number that a card further up gives.
  void end_by_number(const Run& run, CardDraft& card) {
    for (const FieldDraft& field : card.fields) {
      if (field.kind != Kind::integer || field.cluster < 0) continue;
      const ColumnFacts& column = run.columns[field.cluster];
      if (!column.ascending || column.count != run.lines.size() || column.last < 3.0) return;
      const bool gaps = column.last - column.low + 1.0 > static_cast<double>(run.lines.size());
      if (!gaps) return;
      const auto source = counts_.take(column.last);
      if (!source) return;
      card.until = "\"" + field.name + " == " + source->name + "\"";
      card.reasons.push_back("the last of these lines bears the number of " + source->name + " (line " +
                             std::to_string(source->line) + "): numbers between them are generated" +
                             counts_.chance(*source, control_));
      return;
    }
  }

  void list_or_number(const Run& run, CardDraft& card) {
    const auto values = static_cast<double>(values_in(run));
    const bool one_kind = std::all_of(run.clusters.begin(), run.clusters.end(), [&](const Cluster& c) {
      return c.kind() == run.clusters[0].kind() && c.kind() != Kind::text;
    });
    if (one_kind && run.clusters.size() > 1 && values > static_cast<double>(run.lines.size()) && values > 4.0 &&
        values < static_cast<double>(run.lines.size() * run.clusters.size()))
      if (const auto source = counts_.take(values)) {
        FieldDraft list = card.fields.front();
        list.name = "values";
        list.count = "\"" + source->name + "\"";
        card.fields = {list};
        card.reasons.push_back(source->name + " (line " + std::to_string(source->line) + ") agrees with the " +
                               number_text(values) + " values of these lines" +
                               counts_.chance(*source, control_));
        return;
      }
    card.repeat = std::to_string(run.lines.size() / run.records);
    card.reasons.push_back(
        "no number of the deck and no mark was found that says how many: put the count here");
  }

  // A blank that ends nothing is passed over before the next card.
  void give_blank_away(std::size_t i) {
    if (runs_[i].blanks_behind == 0 || i + 1 >= runs_.size()) return;
    Run& next = runs_[i + 1];
    next.headings.insert(next.headings.begin(), blank_behind(i));
  }

  std::size_t blank_behind(std::size_t i) const {
    std::size_t line = runs_[i].lines.back() + 1;
    while (scan_.lines[line].sort != Sort::blank) ++line;
    return line;
  }

  void add_rest(std::size_t i) {
    const std::size_t begin = runs_[i].headings.empty() ? runs_[i].lines.front() : runs_[i].headings.front();
    std::size_t records = 0;
    for (std::size_t n = begin; n < scan_.lines.size(); ++n)
      if (scan_.lines[n].sort != Sort::comment) ++records;
    CardDraft rest = text_card(names_.unique("text"), records);
    rest.reasons.push_back("more than " + std::to_string(kMostCards) + " blocks: the rest was not looked at");
    rest.first_line = scan_.lines[begin].number;
    rest.last_line = scan_.lines.back().number;
    cards_.push_back(std::move(rest));
  }

  const Scan& scan_;
  std::vector<Run> runs_;
  NodeFacts nodes_;
  Counts counts_;
  CardNames names_;
  std::vector<CardDraft> cards_;
  int control_ = -1;  // the first card of integers alone
};

}  // namespace

std::vector<CardDraft> column_cards(Scan& scan) {
  return CardBuilder(scan, find_runs(scan)).build();
}

}  // namespace sage::layout_draft

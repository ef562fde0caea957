// Cards of decks whose cards bear names.
#include <algorithm>
#include <map>

#include "sage/layout_draft/cards.hpp"

namespace sage::layout_draft {

namespace {

// Cards of one name that follow each other.
struct Stretch {
  std::size_t name = 0;             // index into names
  std::size_t first = 0, last = 0;  // lines of the scan
};

class NamedBuilder {
 public:
  explicit NamedBuilder(const Scan& scan) : scan_(scan) {
    for (const Run& run : named_runs(scan)) add_stretch(run);
    for (Run& run : all_) find_column_facts(run, scan_);
    nodes_ = find_nodes(all_, scan_);
  }

  std::vector<CardDraft> build() {
    std::vector<CardDraft> cards;
    for (std::size_t i = 0; i < stretches_.size();) {
      const std::size_t end = block_end(i);
      if (end == i + 1) {
        cards.push_back(card_of(stretches_[i].name));
        place(cards.back(), i, i);
      } else {
        cards.push_back(block_of(i, end));
      }
      i = end;
    }
    return cards;
  }

 private:
  void add_stretch(const Run& run) {
    const std::string_view name = scan_.lines[run.lines.front()].name;
    const auto [at, added] = index_.try_emplace(name, all_.size());
    if (added) all_.emplace_back();
    Run& all = all_[at->second];
    for (const std::size_t line : run.lines) {
      const Sort sort = scan_.lines[line].sort;
      if (sort == Sort::words) all.words = true;
      add_line(all, scan_, line);
    }
    stretches_.push_back({at->second, run.lines.front(), run.lines.back()});
    last_[at->second] = stretches_.size() - 1;
  }

  // Behind the last stretch of every name that stands from here on in between.
  std::size_t block_end(std::size_t begin) const {
    std::size_t end = last_.at(stretches_[begin].name) + 1;
    for (std::size_t i = begin; i < end; ++i) end = std::max(end, last_.at(stretches_[i].name) + 1);
    return end;
  }

  CardDraft card_of(std::size_t name) {
    const Run& run = all_[name];
    CardDraft card;
    if (run.words) {
      card = text_card("", 1);
    } else {
      find_format(run, scan_, card);
      if (const char* role = role_name(find_role(all_, name, nodes_, scan_, card))) card.as = role;
    }
    const std::string_view label = scan_.lines[run.lines.front()].name;
    card.name = names_.unique(label.empty() ? "blank" : std::string(label));
    card.label = std::string(label);
    card.repeat = "\"named\"";
    if (const std::string mark = mark_on_last(run); !mark.empty()) {
      card.fields[0].name = "limit";
      card.fields[0].known = true;
      card.until = "\"" + card.fields[0].name + " == '" + mark + "'\"";
      card.reasons.push_back("\"" + mark + "\" stands on the last of these cards only");
    }
    return card;
  }

  std::string mark_on_last(const Run& run) const {
    if (run.words || run.lines.size() < 2 || run.clusters.empty()) return {};
    const Cluster& first = run.clusters[0];
    const Line& last = scan_.lines[run.lines.back()];
    if (first.count() != 1 || first.texts != 1 || first.last > 2 || last.tokens.empty() ||
        last.tokens[0].kind != Kind::text)
      return {};
    const auto column = static_cast<std::size_t>(first.first) - 1;
    const std::string mark(last.record.substr(column, static_cast<std::size_t>(first.last) - column));
    return mark.find_first_of("'\"\\") == std::string::npos ? mark : std::string();
  }

  CardDraft block_of(std::size_t begin, std::size_t end) {
    CardDraft block;
    std::vector<bool> seen(all_.size(), false);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t name = stretches_[i].name;
      if (seen[name]) continue;
      seen[name] = true;
      CardDraft card = card_of(name);
      if (block.inner.empty()) {
        card.repeat.clear();
        if (!card.until.empty()) block.until = "\"[" + card.name + "]." + card.until.substr(1);
        card.until.clear();
      }
      block.inner.push_back(std::move(card));
    }
    block.name = names_.unique("block of " + block.inner.front().name);
    block.repeat = "\"named\"";
    block.reasons.push_back("these cards follow each other again and again");
    place(block, begin, end - 1);
    return block;
  }

  void place(CardDraft& card, std::size_t first, std::size_t last) const {
    card.first_line = scan_.lines[stretches_[first].first].number;
    card.last_line = scan_.lines[stretches_[last].last].number;
  }

  const Scan& scan_;
  std::map<std::string_view, std::size_t> index_;
  std::vector<Run> all_;  // of each name
  std::vector<Stretch> stretches_;
  std::map<std::size_t, std::size_t> last_;  // last stretch of each name
  NodeFacts nodes_;
  CardNames names_;
};

}  // namespace

std::vector<CardDraft> named_cards(const Scan& scan) {
  return NamedBuilder(scan).build();
}

}  // namespace sage::layout_draft

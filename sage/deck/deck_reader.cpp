#include "sage/deck/deck_reader.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "sage/deck/card_formats.hpp"
#include "sage/deck/text.hpp"
#include "sage/deck/unknown_deck.hpp"
#include "sage/deck/wide_layout.hpp"

namespace sage {

namespace {

constexpr int most_errors = 1000;  // reading stops there

}  // namespace

DeckReader::DeckReader(const SourceText& source, const Layout& layout, const ReadOptions& options)
    : source_(source),
      layout_(layout),
      records_(source, layout.records),
      log_(deck_, options),
      whole_(options.whole),
      aligned_(options.aligned),
      texts_(std::make_shared<std::deque<std::string>>()),
      latest_(layout.cards.size(), -1),
      previous_(layout.cards.size(), -1),
      latest_fields_(layout.cards.size()),
      previous_fields_(layout.cards.size()),
      entry_of_(layout.cards.size(), nullptr),
      opens_(layout.cards.size(), 0),
      followers_(layout.cards.size()),
      counts_(layout.cards.size(), 0),
      summed_(layout.cards.size()),
      made_limit_(100'000 + 64 * source.text()->size()) {
  deck_.file = source.name();
  deck_.layout = layout.name;
  deck_.draft = layout.draft;
  deck_.source = source;
  deck_.cards.reserve(source.starts().size());
  deck_.numbers.reserve(source.text()->size() / 2);  // for short cards; pages not used cost nothing
  auto formats = std::make_shared<CardFormats>();
  formats->records = layout.records;
  for (const CardRule& rule : layout.cards) {
    deck_.specs.push_back(rule.spec);
    formats->formats.push_back(rule.format);
    formats->lists.push_back(!rule.rules.empty() && !rule.rules.back().count.empty());
    const bool plain = std::all_of(rule.rules.begin(), rule.rules.end(), [](const FieldRule& r) {
      return r.map.empty() && !r.restricted() && r.must_equal.empty();
    });
    plain_.push_back(plain);
    computes_.push_back(std::ranges::any_of(rule.spec.fields, [](const FieldSpec& f) { return f.computed; }));
    plain_cards_.push_back(plain_card(rule, layout.records));
  }
  deck_.formats = std::move(formats);
  find_entries(layout.entries);
  for_each_expression(layout, [this](const Expression& expression) {
    for (const ExpressionNode& node : expression.nodes)
      if (node.kind == ExpressionNode::Kind::sum && sums_.try_emplace({node.card, node.field}, 0.0).second)
        summed_[node.card].push_back(node.field);
  });
}

void DeckReader::find_entries(const std::vector<LayoutEntry>& entries) {
  for (const LayoutEntry& entry : entries) {
    if (entry.card >= 0) entry_of_[entry.card] = &entry;
    if (entry.card >= 0 && entry.opens) opens_[entry.card] = 1;
    if (entry.made_from >= 0) followers_[entry.made_from].push_back(&entry);
    // The first card of a block is counted by the block.
    if (entry.card < 0 && entry.entries.front().card >= 0) {
      find_entries(entry.entries);
      if (entry.entries.front().run == LayoutEntry::Run::once) entry_of_[entry.entries.front().card] = &entry;
    } else {
      find_entries(entry.entries);
    }
  }
}

Deck DeckReader::read(Diagnostics* problems) {
  read_entries(layout_.entries, -1);
  if (!stopped_) note_list_rest();
  if (!stopped_) check_after_end();
  if (log_.errors() == 0) note_blanks();
  deck_.texts = texts_;
  try {
    log_.finish();
  } catch (const InputError& error) {
    if (!problems) throw;
    *problems = error.diagnostics();
  }
  return std::move(deck_);
}

// ---- The sequence of cards

void DeckReader::read_entries(const std::vector<LayoutEntry>& entries, int owner) {
  for (const LayoutEntry& entry : entries) {
    if (stopped_ || end_run_) return;
    if (entry.made_from >= 0) continue;  // stands behind its card
    read_entry(entry, owner);
    if (entry.opens && entry.card >= 0) owner = latest_[entry.card];
  }
}

void DeckReader::read_entry(const LayoutEntry& entry, int owner) {
  if (!entry.when.empty()) {
    if (is_faulty(entry.when))
      return stop("whether " + a_card(card_name(entry)) + " follows is not known: reading stops here",
                  records_.line());
    if (!truth(entry.when)) return;
  }
  const RunState outer = run_;
  // The first card of a block counts as the block.
  const bool opens_block = entry.run == LayoutEntry::Run::once && run_.entry && run_.entry->card < 0 &&
                           &entry == &run_.entry->entries.front();
  if (!opens_block) run_ = {&entry, 0, 0};
  const int before = deck_.cards.empty() ? -1 : deck_.cards.back().spec;
  if (entry.card >= 0 && before != entry.card) previous_rule_ = before;
  for (int i = 0; i < entry.headings && !stopped_; ++i)
    if (!records_.next()) truncated(entry);
  switch (entry.run) {
    case LayoutEntry::Run::once:
      read_one(entry, owner);
      break;
    case LayoutEntry::Run::counted:
      read_counted(entry, owner);
      break;
    case LayoutEntry::Run::named:
      read_named(entry, owner);
      break;
    case LayoutEntry::Run::until:
      read_until(entry, owner);
      break;
  }
  run_ = outer;
}

void DeckReader::read_counted(const LayoutEntry& entry, int owner) {
  int count = 0;
  if (!count_of(entry.count, card_text(card_name(entry)) + "s", count)) return;
  run_.wanted = count;
  const bool reads = is_read(entry);
  for (int i = 0; i < count && !stopped_; ++i) {
    run_.done = i;
    if (reads && records_.at_end()) return truncated(entry);
    const Place before = place();
    const std::size_t made = made_values_;
    read_one(entry, owner);
    if (end_run_ || (place() == before && made_values_ == made))
      break;  // a block of which nothing is to be read
  }
  end_run_ = false;
}

bool DeckReader::is_read(const LayoutEntry& entry) const {
  return entry.card >= 0 ? !rule_of(entry.card).spec.made
                         : std::ranges::any_of(entry.entries, [this](const auto& e) { return is_read(e); });
}

void DeckReader::read_named(const LayoutEntry& entry, int owner) {
  const int first = entry.card >= 0 ? entry.card : entry.entries.front().card;
  bool flagged = entry.until.empty();
  while (!stopped_ && !records_.at_end() && name_matches(rule_of(first))) {
    const Place before = place();
    read_one(entry, owner);
    ++run_.done;
    if (place() == before) return;
    if (entry.until.empty()) continue;
    flagged = truth(entry.until);
    if (flagged) return;
  }
  if (!flagged && run_.done > 0 && !stopped_)
    log_.add(Severity::warning, "S114", log_.line(records_.line()),
             "this is the last " + card_text(card_name(entry)) + ", but it is not marked as such (" +
                 entry.until.source + ")");
}

void DeckReader::read_until(const LayoutEntry& entry, int owner) {
  for (;;) {
    if (stopped_) return;
    if (records_.at_end()) return truncated(entry);
    const std::size_t cards = deck_.cards.size();
    const Place before = place();
    read_one(entry, owner);
    ++run_.done;
    if (!stopped_ && place() == before)
      return fail_and_stop(log_.line(records_.next_line()), "no card of this block can be read here");
    if (stopped_ || !truth(entry.until)) continue;
    if (entry.drop_last && deck_.cards.size() > cards) drop_cards(cards);
    return;
  }
}

// As if the cards behind so many had not been read.
void DeckReader::drop_cards(std::size_t cards) {
  for (std::size_t i = cards; i < deck_.cards.size(); ++i) {
    count_card(deck_.cards[i], -1);
    const auto rule = static_cast<std::size_t>(deck_.cards[i].spec);
    latest_[rule] = previous_[rule] = -1;
    latest_fields_[rule].card = previous_fields_[rule].card = -1;
  }
  list_sums_.clear();
  deck_.cut_back(cards);
}

void DeckReader::read_one(const LayoutEntry& entry, int owner) {
  if (entry.card < 0) return read_entries(entry.entries, owner);
  if (rule_of(entry.card).spec.made) return make_card(entry, owner, records_.line());
  if (records_.at_end()) return truncated(entry);
  const CardRule& rule = rule_of(entry.card);
  if (!layout_.card_separator.empty() && !name_matches(rule)) {
    const std::string_view line = trimmed(records_.peek_line());
    log_.add(Severity::error, "S110", log_.line(records_.next_line()),
             "card " + rule.spec.label + " is missing: " + quoted(line.substr(0, 30)) + " stands here");
    return stop("reading stops here", records_.next_line());
  }
  read_card(entry.card, owner);
  if (log_.errors() > most_errors) stop("too many errors: reading stops here", records_.line());
}

// A layout whose cards bear names: "B-*" stands for every name that begins so, "|" separates alternatives.
bool DeckReader::name_matches(const CardRule& rule) {
  const std::string_view line = records_.peek_line();
  const auto width = static_cast<std::size_t>(layout_.card_name_columns);
  const bool named =
      line.size() >= width && line.substr(width, layout_.card_separator.size()) == layout_.card_separator;
  const std::string_view name = trimmed(named ? line.substr(0, width) : line);
  std::string_view wanted = rule.spec.label;
  for (;;) {
    const std::size_t bar = std::min(wanted.find('|'), wanted.size());
    const std::string_view one = wanted.substr(0, bar);
    const bool open = !one.empty() && one.back() == '*';
    if (open ? named && name.substr(0, one.size() - 1) == one.substr(0, one.size() - 1) : name == one)
      return true;
    if (bar == wanted.size()) return false;
    wanted.remove_prefix(bar + 1);
  }
}

// ---- One card

void DeckReader::read_card(int index, int owner) {
  const CardRule& rule = rule_of(index);
  Card card;
  card.spec = index;
  card.owner = owner;
  own_rule_ = index;
  fields_.clear();
  flaws_.clear();
  const bool complete = rule.list_directed ? read_listed(rule, card) : read_formatted(rule, card);
  own_rule_ = -1;
  if (!complete && !stopped_ && run_.entry) truncated(*run_.entry);
}

template <class Read>
bool DeckReader::read_fields(Read& read, const CardRule& rule) {
  for (std::size_t i = 0; i < rule.rules.size(); ++i) {
    if (rule.spec.fields[i].computed) {  // its place; the value comes when the card is complete
      if (!rule.rules[i].count.empty() || rule.rules[i].values.size() > 1) return true;
      FieldValue& value = fields_.emplace_back();
      value.line = records_.line();
      value.kind = rule.spec.fields[i].kind;
      continue;
    }
    if (!rule.rules[i].count.empty()) return read_list(read, rule, i);
    const ReadEnd end = read.read(rule.spec.fields[i].kind, fields_, flaws_);
    if (end == ReadEnd::ended_by_slash) return true;
    if (end != ReadEnd::complete) return false;
  }
  return true;
}

template <class Read>
bool DeckReader::read_list(Read& read, const CardRule& rule, std::size_t field) {
  int count = 0;
  if (!count_of(rule.rules[field].count, rule.spec.fields[field].label, count)) return true;
  if (!fits_the_file(count, rule.list_directed || rule.is_item)) {
    fail_and_stop(log_.line(records_.line()), std::to_string(count) + " values of " +
                                                  rule.spec.fields[field].label + " can't be in a deck of " +
                                                  std::to_string(source_.text()->size()) + " characters (" +
                                                  count_source(rule.rules[field].count) + ")");
    return true;
  }
  for (int i = 0; i < count; ++i) {
    const ReadEnd end = read.read(rule.spec.fields[field].kind, fields_, flaws_);
    if (end == ReadEnd::ended_by_slash) return true;
    if (end != ReadEnd::complete) return false;
    if (static_cast<int>(flaws_.size()) > most_errors) return true;
  }
  return true;
}

// Nothing behind the last field that a message would speak of (check_rest).
bool DeckReader::ends_plainly(std::size_t last_field_end) const {
  const std::string_view beyond = records_.beyond();
  if (!beyond.empty() && (beyond.front() != ' ' || (!overlong_noted_ && !all_blank(beyond)))) return false;
  std::string_view record = records_.record();
  const auto first = static_cast<std::size_t>(layout_.first_sequence_column);
  const auto last = static_cast<std::size_t>(layout_.last_sequence_column);
  if (last > 0 && last_field_end >= first && record.size() >= last && !sequence_noted_) return false;
  if (first > 0 && record.size() >= first) record = record.substr(0, first - 1);
  return last_field_end >= record.size() || all_blank(record.substr(last_field_end));
}

// The short way, for a card of plain numbers; false, and nothing has happened, where the long one is needed.
bool DeckReader::read_plainly(Card card) {
  const std::optional<PlainCard>& plain = plain_cards_[card.spec];
  const auto rule = static_cast<std::size_t>(card.spec);
  if (!plain || !followers_[rule].empty() || !records_.next()) return false;
  card.line = records_.line();
  card.first_value = static_cast<std::int32_t>(deck_.numbers.size());
  if (!ends_plainly(plain->end) || !read_plain(*plain, records_.record(), deck_.numbers)) {
    records_.rewind_to(card.line);
    return false;
  }
  card.value_count = static_cast<std::int32_t>(deck_.numbers.size()) - card.first_value;
  previous_[rule] = std::exchange(latest_[rule], static_cast<int>(deck_.cards.size()));
  deck_.cards.push_back(card);
  count_card(card, 1);
  return true;
}

bool DeckReader::read_formatted(const CardRule& rule, Card& card) {
  if (read_plainly(card)) return true;
  for (;;) {
    seams_.clear();
    FormattedRead read(records_, rule.format, &seams_);
    if (read.begin() != ReadEnd::complete) return false;
    card.line = records_.line();
    const bool complete = read_fields(read, rule);
    const std::size_t last_field_end = read.last_field_end();
    read.finish();
    const bool list = records_.line() != card.line;
    if (complete && !stopped_ && aligned_ != nullptr) {
      if (is_beside_columns(rule, card.line, last_field_end) && align_line(rule, card.line)) continue;
    } else if (complete && !stopped_ && is_doubtful_line(rule, card.line) && take_moved(rule, card.line)) {
      continue;
    }
    const bool cut = complete && list && cut_list(rule, card);
    Misplaced misplaced = Misplaced::no;
    if (complete && !stopped_ && !list && is_doubtful(rule)) misplaced = check_place(rule, card);
    if (misplaced == Misplaced::no) {
      // Before the errors that a slip causes.
      const bool slip = complete && !stopped_ && !cut && !seams_.empty() && check_seams(rule);
      close_card(rule, card, complete);
      if (!complete || stopped_ || cut) return complete;
      check_rest(rule, last_field_end, slip);
      return complete;
    }
    // Another kind of card: it is reported and left out, so that the cards behind it can be read.
    fields_.clear();
    flaws_.clear();
    if (misplaced == Misplaced::belongs_later) return true;
  }
}

bool DeckReader::read_listed(const CardRule& rule, Card& card) {
  if (!rule.same_read || !list_read_) {
    note_list_rest();
    list_read_.emplace(records_, *texts_);
    if (list_read_->begin() != ReadEnd::complete) return false;
  }
  ListRead& read = *list_read_;
  card.line = records_.line();
  const bool complete = read_fields(read, rule);
  if (!fields_.empty()) card.line = fields_.front().line;
  close_card(rule, card, complete);
  if (!complete || stopped_) return complete;
  return rule.items_card < 0 || read_items(rule, read);
}

// The rest of the READ: n items, each a card of its own.
bool DeckReader::read_items(const CardRule& rule, ListRead& read) {
  int count = 0;
  const CardRule& item = rule_of(rule.items_card);
  if (!count_of(rule.items_count, item.spec.label + " items", count)) return true;
  const int owner = latest_[&rule - layout_.cards.data()];  // others may be made behind it
  if (!fits_the_file(count, true)) {
    fail_and_stop(log_.line(records_.line()), std::to_string(count) + " " + item.spec.label +
                                                  " items can't be in a deck of " +
                                                  std::to_string(source_.text()->size()) + " characters (" +
                                                  count_source(rule.items_count) + ")");
    return true;
  }
  for (int i = 0; i < count && !stopped_; ++i) {
    Card card;
    card.spec = rule.items_card;
    card.owner = owner;
    fields_.clear();
    flaws_.clear();
    own_rule_ = rule.items_card;
    const bool complete = read_fields(read, item);
    own_rule_ = -1;
    if (read.ended_by_slash() && fields_.empty()) return true;
    card.line = fields_.empty() ? records_.line() : fields_.front().line;
    close_card(item, card, complete);
    if (!complete) {
      run_.wanted = count;
      run_.done = i;
      return false;
    }
    if (log_.errors() > most_errors) stop("too many errors: reading stops here", records_.line());
  }
  return true;
}

// ---- Entry points

namespace {

// A text without what an editor puts before column 1.  Throws where it can't be a deck.
SourceText source_of(std::string text, const std::string& name) {
  check_is_text(text, name);
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);
  return {std::move(text), name};
}

// by_itself: nobody named the layout, and the deck bears the marks of none.
[[noreturn]] void throw_with_other_layouts(const SourceText& source, const Layout& layout,
                                           const InputError& error, bool by_itself) {
  Diagnostics all = error.diagnostics();
  std::optional<Diagnostic> others = other_layouts_that_read(source, layout.name);
  if (!others && by_itself) others = read_as_standard(source, layout, all);
  if (others) all.add(*std::move(others));
  throw InputError(std::move(all));
}

}  // namespace

Deck read_deck_text(std::string text, const std::string& name, const Layout& layout,
                    const ReadOptions& options) {
  const SourceText source = source_of(std::move(text), name);
  return DeckReader(source, layout, options).read();
}

bool is_model_file(std::string_view path) {
  return path.ends_with(".sage.toml");
}

Deck read_model_file_text(std::string text, const std::string& name) {
  Deck deck;
  deck.source = source_of(std::move(text), name);
  deck.file = name;
  deck.layout = kModelFile;
  return deck;
}

Deck read_what_can_be(std::string text, const std::string& name, const Layout& layout,
                      const ReadOptions& options, Diagnostics& problems) {
  const SourceText source = source_of(std::move(text), name);
  return DeckReader(source, layout, options).read(&problems);
}

Deck read_deck(const std::string& path, const ReadOptions& options) {
  if (is_model_file(path)) return read_model_file_text(read_file(path), path);
  const SourceText source = source_of(read_file(path), path);
  const std::string recognised = recognised_layout(*source.text(), path);
  const Layout layout = load_layout(recognised.empty() ? std::string(kStandardLayout) : recognised);
  try {
    return DeckReader(source, layout, options).read();
  } catch (const InputError& error) {
    // Marks may be those of several programs: 'plane' opens decks of seepage too.
    std::optional<Diagnostics> unknown =
        recognised.empty() ? no_layout_fits(source, layout, error.diagnostics()) : outside_of_scope(source);
    if (unknown) throw InputError(*std::move(unknown));
    throw_with_other_layouts(source, layout, error, recognised.empty());
  }
}

Deck read_deck(const std::string& path, const Layout& layout, const ReadOptions& options) {
  const SourceText source = source_of(read_file(path), path);
  try {
    return DeckReader(source, layout, options).read();
  } catch (const InputError& error) {
    throw_with_other_layouts(source, layout, error, false);
  }
}

}  // namespace sage

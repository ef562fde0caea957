#include "sage/deck/deck_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sage {

namespace {

constexpr int most_errors = 1000;  // reading stops there
constexpr double largest_count = 1e9;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool all_blank(std::string_view text) {
  return text.find_first_not_of(" \t\x1a") == std::string_view::npos;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace

DeckReader::DeckReader(const SourceText& source, const Layout& layout, const ReadOptions& options)
    : source_(source),
      layout_(layout),
      records_(source, layout.records),
      log_(deck_, options),
      texts_(std::make_shared<std::deque<std::string>>()),
      latest_(layout.cards.size(), -1),
      suggested_(layout.cards.size(), 0) {
  deck_.file = source.name();
  deck_.layout = layout.name;
  deck_.source = source.text();
  deck_.line_starts = source.starts();
  for (const CardRule& rule : layout.cards) {
    deck_.specs.push_back(rule.spec);
    const bool plain = std::all_of(rule.rules.begin(), rule.rules.end(),
                                   [](const FieldRule& r) { return r.map.empty() && r.must_equal.empty(); });
    plain_.push_back(plain);
  }
}

Deck DeckReader::read() {
  read_entries(layout_.entries, -1);
  if (!stopped_) check_after_end();
  deck_.texts = texts_;
  log_.finish();
  return std::move(deck_);
}

// ---- The sequence of cards
// -------------------------------------------------------------------------------------

void DeckReader::read_entries(const std::vector<LayoutEntry>& entries, int owner) {
  for (const LayoutEntry& entry : entries) {
    if (stopped_) return;
    read_entry(entry, owner);
    if (entry.opens && entry.card >= 0) owner = latest_[static_cast<std::size_t>(entry.card)];
  }
}

void DeckReader::read_entry(const LayoutEntry& entry, int owner) {
  if (!entry.when.empty() && !truth(entry.when)) return;
  const RunState outer = run_;
  run_ = {&entry, 0, 0};
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
  if (!count_of(entry.count, card_name(entry) + " cards", count)) return;
  run_.wanted = count;
  for (int i = 0; i < count && !stopped_; ++i) {
    run_.done = i;
    if (records_.at_end()) return truncated(entry);
    read_one(entry, owner);
  }
}

void DeckReader::read_named(const LayoutEntry& entry, int owner) {
  const int first = entry.card >= 0 ? entry.card : entry.entries.front().card;
  while (!stopped_ && !records_.at_end() && name_matches(rule_of(first))) read_one(entry, owner);
}

void DeckReader::read_until(const LayoutEntry& entry, int owner) {
  for (;;) {
    if (stopped_) return;
    if (records_.at_end()) return truncated(entry);
    const std::size_t cards = deck_.cards.size(), values = deck_.values.size();
    read_one(entry, owner);
    ++run_.done;
    if (stopped_ || !truth(entry.until)) continue;
    if (entry.drop_last && deck_.cards.size() > cards) {
      if (entry.card >= 0) latest_[static_cast<std::size_t>(entry.card)] = -1;
      deck_.cards.resize(cards);
      deck_.values.resize(values);
    }
    return;
  }
}

void DeckReader::read_one(const LayoutEntry& entry, int owner) {
  if (entry.card < 0) return read_entries(entry.entries, owner);
  if (records_.at_end()) return truncated(entry);
  const CardRule& rule = rule_of(entry.card);
  if (!layout_.card_separator.empty() && !name_matches(rule)) {
    const std::string_view line = trimmed(records_.peek_line());
    log_.add(Severity::error, log_.line(records_.next_line()),
             "card " + rule.key + " is missing: " + quoted(line.substr(0, 30)) + " stands here");
    return stop("reading stops here", records_.next_line());
  }
  read_card(entry.card, owner);
  if (log_.errors() > most_errors) stop("too many errors: reading stops here", records_.line());
}

// A layout whose cards bear names: "B-*" stands for every name that begins so.
bool DeckReader::name_matches(const CardRule& rule) {
  const std::string_view line = records_.peek_line();
  const auto width = static_cast<std::size_t>(layout_.card_name_columns);
  const bool named =
      line.size() >= width && line.substr(width, layout_.card_separator.size()) == layout_.card_separator;
  const std::string_view name = trimmed(named ? line.substr(0, width) : line);
  const std::string& wanted = rule.spec.label;
  if (!wanted.empty() && wanted.back() == '*')
    return named && name.substr(0, wanted.size() - 1) == wanted.substr(0, wanted.size() - 1);
  return name == wanted;
}

// ---- Expressions
// ------------------------------------------------------------------------------------------------

const FieldValue* DeckReader::field_value(int card, int field) const {
  int index = latest_[static_cast<std::size_t>(card)];
  std::size_t first = 0, count = 0;
  if (card == own_rule_ && own_card_ >= 0) {  // the card being read isn't closed yet
    first = static_cast<std::size_t>(own_card_);
    count = deck_.values.size() - first;
  } else if (index >= 0) {
    const Card& read = deck_.cards[static_cast<std::size_t>(index)];
    first = static_cast<std::size_t>(read.first_value);
    count = static_cast<std::size_t>(read.value_count);
  }
  return static_cast<std::size_t>(field) < count ? &deck_.values[first + static_cast<std::size_t>(field)]
                                                 : nullptr;
}

ExpressionValue DeckReader::value_of(int card, int field) const {
  const FieldValue* value = field_value(card, field);
  if (!value) return {};
  const FieldSpec& spec = rule_of(card).spec.fields[static_cast<std::size_t>(field)];
  const double number = value->blank && spec.has_fallback ? spec.fallback : value->number;
  return {number, trimmed(value->text)};
}

bool DeckReader::truth(const Expression& expression) const {
  return evaluate(expression, [this](int card, int field) { return value_of(card, field); }) != 0.0;
}

// The value of a count; false, and reading stops, if it can't be one.
bool DeckReader::count_of(const Expression& expression, const std::string& what, int& count) {
  for (const ExpressionNode& node : expression.nodes) {
    if (node.kind != ExpressionNode::Kind::field) continue;
    const FieldValue* value = field_value(node.card, node.field);
    if (value &&
        std::binary_search(faulty_.begin(), faulty_.end(), static_cast<int>(value - deck_.values.data()))) {
      stop("the number of " + what + " is not known: reading stops here", records_.line());
      return false;
    }
  }
  const double number = evaluate(expression, [this](int card, int field) { return value_of(card, field); });
  if (number >= 0.0 && number <= largest_count && number == std::floor(number)) {
    count = static_cast<int>(number);
    return true;
  }
  SourcePosition where = log_.line(records_.line());
  for (const ExpressionNode& node : expression.nodes)
    if (node.kind == ExpressionNode::Kind::field)
      if (const FieldValue* value = field_value(node.card, node.field)) where = log_.where(*value);
  log_.add(
      Severity::error, where,
      "the number of " + what + " can't be " + quoted(std::to_string(number)) + " (" + expression.source + ")");
  stopped_ = true;
  return false;
}

// "nodes of the control card, line 4" for a count that is a single field.
std::string DeckReader::count_source(const Expression& expression) const {
  for (const ExpressionNode& node : expression.nodes)
    if (node.kind == ExpressionNode::Kind::field)
      if (const FieldValue* value = field_value(node.card, node.field)) {
        const CardRule& rule = rule_of(node.card);
        return rule.spec.fields[static_cast<std::size_t>(node.field)].label + " of the " + rule.key +
               " card, line " + std::to_string(value->line);
      }
  return expression.source;
}

// ---- One card
// -----------------------------------------------------------------------------------------------------

void DeckReader::read_card(int index, int owner) {
  const CardRule& rule = rule_of(index);
  const auto slot = static_cast<std::size_t>(index);
  Card card;
  card.spec = index;
  card.owner = owner;
  card.first_value = static_cast<std::int32_t>(deck_.values.size());
  own_card_ = card.first_value;
  own_rule_ = index;
  flaws_.clear();
  latest_[slot] = static_cast<int>(deck_.cards.size());
  const bool complete = rule.list_directed ? read_listed(rule, card) : read_formatted(rule, card);
  own_card_ = own_rule_ = -1;
  if (!complete && !stopped_ && run_.entry) truncated(*run_.entry);
}

template <class Read>
bool DeckReader::read_fields(Read& read, const CardRule& rule) {
  for (std::size_t i = 0; i < rule.rules.size(); ++i) {
    if (!rule.rules[i].count.empty()) return read_list(read, rule, i);
    const ReadEnd end = read.read(rule.spec.fields[i].kind, deck_.values, flaws_);
    if (end == ReadEnd::ended_by_slash) return true;
    if (end != ReadEnd::complete) return false;
  }
  return true;
}

template <class Read>
bool DeckReader::read_list(Read& read, const CardRule& rule, std::size_t field) {
  int count = 0;
  if (!count_of(rule.rules[field].count, rule.spec.fields[field].label, count)) return true;
  const std::size_t left = source_.text()->size();
  if (!rule.list_directed && static_cast<std::size_t>(count) > left) {
    log_.add(Severity::error, log_.line(records_.line()),
             std::to_string(count) + " values of " + rule.spec.fields[field].label + " can't be in a deck of " +
                 std::to_string(left) + " characters (" + count_source(rule.rules[field].count) + ")");
    stopped_ = true;
    return true;
  }
  for (int i = 0; i < count; ++i) {
    const ReadEnd end = read.read(rule.spec.fields[field].kind, deck_.values, flaws_);
    if (end == ReadEnd::ended_by_slash) return true;
    if (end != ReadEnd::complete) return false;
    if (static_cast<int>(flaws_.size()) > most_errors) return true;
  }
  return true;
}

bool DeckReader::read_formatted(const CardRule& rule, Card& card) {
  FormattedRead read(records_, rule.format);
  if (read.begin() != ReadEnd::complete) return false;
  card.line = records_.line();
  const bool complete = read_fields(read, rule);
  const std::size_t last_field_end = read.last_field_end();
  read.finish();
  close_card(rule, card);
  if (complete) check_rest(rule, card, last_field_end);
  return complete;
}

bool DeckReader::read_listed(const CardRule& rule, Card& card) {
  ListRead read(records_, *texts_);
  if (read.begin() != ReadEnd::complete) return false;
  card.line = records_.line();
  const bool complete = read_fields(read, rule);
  if (deck_.values.size() > static_cast<std::size_t>(card.first_value))
    card.line = deck_.values[static_cast<std::size_t>(card.first_value)].line;
  close_card(rule, card);
  if (!complete || stopped_) return complete;
  return rule.items_card < 0 || read_items(rule, read);
}

// The rest of the READ: n items, each a card of its own.
bool DeckReader::read_items(const CardRule& rule, ListRead& read) {
  int count = 0;
  const CardRule& item = rule_of(rule.items_card);
  if (!count_of(rule.items_count, item.key + " items", count)) return true;
  const int owner = static_cast<int>(deck_.cards.size()) - 1;
  for (int i = 0; i < count && !stopped_; ++i) {
    Card card;
    card.spec = rule.items_card;
    card.owner = owner;
    card.first_value = static_cast<std::int32_t>(deck_.values.size());
    flaws_.clear();
    own_card_ = card.first_value;
    own_rule_ = rule.items_card;
    const bool complete = read_fields(read, item);
    own_card_ = own_rule_ = -1;
    const auto first = static_cast<std::size_t>(card.first_value);
    if (read.ended_by_slash() && deck_.values.size() == first) return true;
    card.line = deck_.values.size() > first ? deck_.values[first].line : records_.line();
    latest_[static_cast<std::size_t>(rule.items_card)] = static_cast<int>(deck_.cards.size());
    close_card(item, card);
    if (!complete) {
      run_.wanted = count;
      run_.done = i;
      return false;
    }
    if (log_.errors() > most_errors) stop("too many errors: reading stops here", records_.line());
  }
  return true;
}

void DeckReader::close_card(const CardRule& rule, Card card) {
  card.value_count = static_cast<std::int32_t>(deck_.values.size()) - card.first_value;
  deck_.cards.push_back(card);
  if (!flaws_.empty()) report_flaws(rule, card);
  check_values(rule, card);
}

void DeckReader::report_flaws(const CardRule& rule, const Card& card) {
  const int before = log_.errors();
  bool blanks_inside = false;
  for (const FieldFlaw& flaw : flaws_) {
    const auto at = static_cast<std::size_t>(flaw.value);
    const std::size_t field =
        std::min(at - static_cast<std::size_t>(card.first_value), rule.spec.fields.size() - 1);
    const int errors = log_.errors();
    FieldValue& value = deck_.values[at];
    // A map may take what isn't a number.
    if (!rule.rules[field].map.empty() && flaw.fault != FieldFault::none) continue;
    log_.flaw(rule, rule.spec.fields[field], value, flaw);
    if (log_.errors() > errors) {
      faulty_.push_back(flaw.value);
      value.number = 0.0;
    }
    blanks_inside = blanks_inside || (flaw.hints & hint_inner_blank) != 0;
  }
  if (log_.errors() > before || blanks_inside) suggest_count(rule, card);
}

void DeckReader::check_values(const CardRule& rule, const Card& card) {
  const auto first = static_cast<std::size_t>(card.first_value);
  const auto count = std::min(static_cast<std::size_t>(card.value_count), rule.rules.size());
  bool missing = false;
  for (std::size_t i = 0; i < count; ++i) {
    FieldValue& value = deck_.values[first + i];
    const FieldSpec& spec = rule.spec.fields[i];
    if (value.blank && spec.required) {
      log_.add(Severity::error, value.first_column ? log_.where(value) : log_.line(card.line),
               "a value is missing " + field_text(rule, spec));
      faulty_.push_back(static_cast<int>(first + i));
      missing = true;
    }
    if (plain_[static_cast<std::size_t>(card.spec)]) continue;
    if (!rule.rules[i].map.empty()) apply_map(rule, i, value);
    const std::string& wanted = rule.rules[i].must_equal;
    if (!wanted.empty() && lower_case(trimmed(value.text)) != lower_case(wanted)) {
      log_.add(Severity::error, value.first_column ? log_.where(value) : log_.line(card.line),
               "the " + rule.key + " card must read " + wanted + ", not " + quoted(trimmed(value.text)));
      missing = true;
    }
  }
  if (missing) suggest_count(rule, card);
}

void DeckReader::apply_map(const CardRule& rule, std::size_t field, FieldValue& value) {
  if (value.blank && value.kind != FieldKind::text) return;
  const std::string_view text = trimmed(value.text);
  for (const auto& [code, number] : rule.rules[field].map)
    if (code == text) {
      value.number = number;
      return;
    }
  std::string known;
  for (const auto& [code, number] : rule.rules[field].map) known += (known.empty() ? "" : ", ") + code;
  log_.add(
      Severity::error, log_.where(value),
      quoted(text) + " is not a known code " + field_text(rule, rule.spec.fields[field]) + "; known: " + known);
}

// ---- What stands beyond the fields, and counts that don't fit
// -----------------------------------------------------

void DeckReader::check_rest(const CardRule& rule, const Card& card, std::size_t last_field_end) {
  const std::string_view beyond = records_.beyond();
  if (!overlong_noted_ && !beyond.empty() && !all_blank(beyond)) {
    overlong_noted_ = true;
    const int first = layout_.records.record_length + 1;
    log_.add(Severity::note, {deck_.file, records_.line(), first, first + static_cast<int>(beyond.size()) - 1},
             "characters beyond column " + std::to_string(first - 1) + " are ignored (said once)");
  }
  if (layout_.last_sequence_column > 0 &&
      last_field_end >= static_cast<std::size_t>(layout_.first_sequence_column))
    check_sequence_number(rule, card, last_field_end);
  std::string_view record = records_.record();
  const auto sequence = static_cast<std::size_t>(layout_.first_sequence_column);
  if (sequence > 0 && record.size() >= sequence) record = record.substr(0, sequence - 1);
  if (last_field_end >= record.size() || all_blank(record.substr(last_field_end))) return;
  const std::size_t first = last_field_end + record.substr(last_field_end).find_first_not_of(" \t\x1a");
  const int offset = records_.skipped() + 1;
  log_.add(Severity::note,
           {deck_.file, records_.line(), offset + static_cast<int>(first),
            offset + static_cast<int>(record.find_last_not_of(" \t\x1a"))},
           "characters behind the last field of the " + rule.key + " card are ignored");
}

// Eight digits in 73-80 with blanks before them, where fields reach that far: likely no data.
void DeckReader::check_sequence_number(const CardRule& rule, const Card& card, std::size_t) {
  if (sequence_noted_) return;
  const std::string_view record = records_.record();
  const auto first = static_cast<std::size_t>(layout_.first_sequence_column) - 1;
  const auto size = static_cast<std::size_t>(layout_.last_sequence_column) - first;
  if (record.size() < first + size || first < 2) return;
  const FieldSpec& last = rule.spec.fields.back();
  const std::string_view number = record.substr(first, size);
  const bool digits = std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || last.kind == FieldKind::text || !all_blank(record.substr(first - 2, 2))) return;
  sequence_noted_ = true;
  log_.add(Severity::warning,
           {deck_.file, records_.line(), layout_.first_sequence_column, layout_.last_sequence_column},
           quoted(number) + " looks like a sequence number, but the fields of the " + rule.key +
               " card reach into columns " + std::to_string(layout_.first_sequence_column) + "-" +
               std::to_string(layout_.last_sequence_column) + " (said once)");
  static_cast<void>(card);
}

// A card that doesn't fit its place may be one of its neighbours' kind: then a count is wrong.
void DeckReader::suggest_count(const CardRule& rule, const Card& card) {
  const int own = card.spec;
  if (rule.list_directed || rule.is_item || suggested_[static_cast<std::size_t>(own)]) return;
  suggested_[static_cast<std::size_t>(own)] = 1;
  std::vector<int> candidates;
  if (previous_rule_ >= 0) candidates.push_back(previous_rule_);
  for (int next = own + 1; next < static_cast<int>(layout_.cards.size()) && next <= own + 3; ++next)
    candidates.push_back(next);
  for (const int other : candidates) {
    if (other == own || !reads_well(rule_of(other), card.line)) continue;
    const bool earlier = other == previous_rule_;
    std::string hint = "this card reads well as a " + rule_of(other).key + " card: ";
    if (earlier)
      hint += "is the count of " + rule_of(other).key + " cards too small?";
    else if (run_.wanted > 0)
      hint += "is the count of " + rule.key + " cards too large? (" + std::to_string(run_.wanted) +
              " wanted: " + count_source(run_.entry->count) + "; this is number " +
              std::to_string(run_.done + 1) + ")";
    else
      hint += "is a card missing?";
    return log_.add_hint(hint);
  }
}

bool DeckReader::reads_well(const CardRule& rule, int line) const {
  if (rule.list_directed || rule.is_item || !rule.rules.back().count.empty()) return false;
  const bool numbers = std::any_of(rule.spec.fields.begin(), rule.spec.fields.end(),
                                   [](const FieldSpec& s) { return s.kind != FieldKind::text; });
  if (!numbers) return false;
  RecordSource records = records_;
  records.rewind_to(line);
  FormattedRead read(records, rule.format);
  if (read.begin() != ReadEnd::complete || all_blank(records.record())) return false;
  std::vector<FieldValue> values;
  std::vector<FieldFlaw> flaws;
  for (const FieldSpec& spec : rule.spec.fields) {
    if (read.read(spec.kind, values, flaws) != ReadEnd::complete || records.line() != line) return false;
    if (spec.required && values.back().blank) return false;
  }
  if (!flaws.empty()) return false;
  const std::size_t end = read.last_field_end();
  return records.record().size() <= end ||
         all_blank(records.record().substr(end, 72 - std::min<std::size_t>(end, 72)));
}

// ---- The end
// ------------------------------------------------------------------------------------------------------

std::string DeckReader::card_name(const LayoutEntry& entry) const {
  const LayoutEntry* at = &entry;
  while (at->card < 0) at = &at->entries.front();
  return rule_of(at->card).key;
}

void DeckReader::truncated(const LayoutEntry& entry) {
  std::string message = "the deck ends here, but a " + card_name(entry) + " card was expected";
  if (run_.wanted > 0) {
    message += " (" + std::to_string(run_.done) + " of " + std::to_string(run_.wanted) + " read, " +
               std::to_string(run_.wanted - run_.done) + " missing";
    if (!entry.count.empty()) message += "; " + count_source(entry.count);
    message += ")";
  }
  log_.add(Severity::error, log_.line(source_.line_count()), message);
  stopped_ = true;
}

void DeckReader::stop(const std::string& why, int line) {
  log_.add(Severity::note, log_.line(line), why);
  stopped_ = true;
}

void DeckReader::check_after_end() {
  while (records_.next()) {
    if (all_blank(records_.record())) continue;
    const bool separator = !layout_.card_separator.empty();
    log_.add(separator ? Severity::error : Severity::warning, log_.line(records_.line()),
             separator ? "this card has no place here"
                       : "the deck is complete, but more lines follow: they are ignored");
    return;
  }
}

// ---- Entry points
// ---------------------------------------------------------------------------------------------------

Deck read_deck_text(std::string text, const std::string& name, const Layout& layout,
                    const ReadOptions& options) {
  check_is_text(text, name);
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);  // an editor's mark, no part of column 1
  const SourceText source(std::move(text), name);
  return DeckReader(source, layout, options).read();
}

Layout layout_for(const std::string& path) {
  const std::string text = read_file(path);
  check_is_text(text, path);
  return load_layout(detect_layout(text));
}

Deck read_deck(const std::string& path, const Layout& layout, const ReadOptions& options) {
  return read_deck_text(read_file(path), path, layout, options);
}

}  // namespace sage

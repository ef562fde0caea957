// How many cards of a kind follow: counts of the deck, and what to say where they don't fit.
#include <algorithm>
#include <cmath>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr double largest_count = 1e9;

}  // namespace

std::string DeckReader::a_card(const std::string& name) {
  const bool vowel = !name.empty() && std::string_view("aeioAEIO").find(name[0]) != std::string_view::npos;
  return (vowel ? "an " : "a ") + card_text(name);
}

bool DeckReader::is_faulty(std::size_t card, std::size_t value) const {
  return std::find(faulty_.begin(), faulty_.end(), std::pair(card, value)) != faulty_.end();
}

// True where the field has an error, which has been reported.
bool DeckReader::is_faulty(const ExpressionNode& node) const {
  if (node.field < 0 || faulty_.empty()) return false;
  const auto field = static_cast<std::size_t>(node.field);
  if (node.card == own_rule_) return is_faulty(deck_.cards.size(), field);
  const int card = latest_[node.card];
  return card >= 0 && is_faulty(static_cast<std::size_t>(card), field);
}

bool DeckReader::is_faulty(const Expression& expression) const {
  return std::ranges::any_of(expression.nodes, [this](const ExpressionNode& node) { return is_faulty(node); });
}

// The value of a count; false, and reading stops, if it can't be one.
bool DeckReader::count_of(const Expression& expression, const std::string& what, int& count) {
  for (const ExpressionNode& node : expression.nodes) {
    if (node.kind != ExpressionNode::Kind::field) continue;
    const FieldValue* value = field_value(node.card, node.field);
    if (!value && log_.errors() > 0) {
      stop("the " + card_text(rule_of(node.card).spec.label) + " is missing: reading stops here",
           records_.next_line());
      return false;
    }
    if (value && is_faulty(node)) {
      stop("the number of " + what + " is not known: reading stops here", records_.line());
      return false;
    }
  }
  const double number = number_of(expression);
  if (stopped_) return false;
  if (number >= 0.0 && number <= largest_count && number == std::floor(number)) {
    count = static_cast<int>(number);
    return true;
  }
  SourcePosition where = log_.line(records_.line());
  for (const ExpressionNode& node : expression.nodes)
    if (node.kind == ExpressionNode::Kind::field)
      if (const FieldValue* value = field_value(node.card, node.field)) where = log_.where(*value);
  const std::string computed = expression.nodes.size() > 1 ? expression.source + " with " : "";
  fail_and_stop(where, "the number of " + what + " can't be " + number_text(number) + " (" + computed +
                           count_source(expression) + ")");
  return false;
}

// "nodes of the control card, line 4" for a count that is a single field.
std::string DeckReader::count_source(const Expression& expression) const {
  const auto is_field = [](const ExpressionNode& node) { return node.kind == ExpressionNode::Kind::field; };
  if (std::ranges::none_of(expression.nodes, is_field)) return "given by the layout";
  for (const ExpressionNode& node : expression.nodes)
    if (is_field(node))
      if (const FieldValue* value = field_value(node.card, node.field)) {
        const CardRule& rule = rule_of(node.card);
        return rule.spec.fields[node.field].label + " of the " + card_text(rule.spec.label) + ", line " +
               std::to_string(value->line);
      }
  return expression.source;
}

// Faults, blanks inside numbers, missing values or the wrong word: the card may be of another kind.
bool DeckReader::is_doubtful(const CardRule& rule) const {
  for (const FieldFlaw& flaw : flaws_)
    if (flaw.fault != FieldFault::none || (flaw.hints & hint_inner_blank)) return true;
  const std::size_t count = std::min(fields_.size(), rule.rules.size());
  for (std::size_t i = 0; i < count; ++i) {
    const FieldValue& value = fields_[i];
    if (value.blank && rule.spec.fields[i].required) return true;
    const std::string& wanted = rule.rules[i].must_equal;
    if (!wanted.empty() && lower_case(trimmed(value.text)) != lower_case(wanted)) return true;
  }
  return false;
}

// A required number that was left out before others that stand there: a slip on a card of the right kind.
bool DeckReader::has_a_gap(const CardRule& rule) const {
  if (!flaws_.empty()) return false;
  const std::size_t count = std::min(fields_.size(), rule.rules.size());
  bool missing = false;
  for (std::size_t i = 0; i < count; ++i) {
    const FieldValue& value = fields_[i];
    missing = missing || (value.blank && rule.spec.fields[i].required);
    if (missing && !value.blank && value.kind != FieldKind::text) return true;
  }
  return false;
}

// The card that closes the deck by its word (END), if this line is it; -1 otherwise.
int DeckReader::closing_card(int line) const {
  const std::string text = lower_case(trimmed(source_.line(line)));
  for (std::size_t i = 0; i < layout_.cards.size(); ++i) {
    const CardRule& rule = layout_.cards[i];
    if (rule.rules.size() == 1 && !rule.rules[0].must_equal.empty() &&
        text == lower_case(rule.rules[0].must_equal))
      return static_cast<int>(i);
  }
  return -1;
}

// "a fill card was expected: 0 of 1 read (number of fill cards of the control card, line 3)".
std::string DeckReader::expected_card(const CardRule& rule) const {
  std::string text = a_card(rule.spec.label) + " was expected";
  if (run_.wanted > 0)
    text += ": " + std::to_string(run_.done) + " of " + std::to_string(run_.wanted) + " read (" +
            count_source(run_.entry->count) + ")";
  return text;
}

// A card that doesn't fit its place but reads well as one of its neighbours' kind: then a count is wrong.
DeckReader::Misplaced DeckReader::check_place(const CardRule& rule, const Card& card) {
  const int own = card.spec;
  if (closing_card(card.line) > own) {
    log_.add(Severity::error, "S110", log_.line(card.line),
             quoted(trimmed(source_.line(card.line))) + " closes the deck, but " + expected_card(rule),
             "cards are missing, or a count further up is too large");
    stopped_ = true;
    return Misplaced::belongs_later;
  }
  if (has_a_gap(rule)) return Misplaced::no;
  const int earliest = previous_rule_ >= 0 && previous_rule_ < own ? previous_rule_ : own - 1;
  const int latest = std::min(static_cast<int>(layout_.cards.size()) - 1, own + 3);
  for (int other = earliest; other <= latest; ++other) {
    if (other < 0 || other == own || !reads_well(rule_of(other), card.line)) continue;
    const std::string reads = "this reads as " + a_card(rule_of(other).spec.label);
    if (other < own) {
      log_.add(Severity::error, "S111", log_.line(card.line), reads + ", but " + announced(other));
      return Misplaced::left_over;
    }
    if (run_.wanted == 0 && run_.entry && run_.entry->run != LayoutEntry::Run::once) return Misplaced::no;
    log_.add(Severity::error, "S111", log_.line(card.line), reads + ", but " + expected_card(rule),
             run_.wanted > 0 ? "where that count is right, one further up is too large" : "");
    records_.rewind_to(card.line);
    end_run_ = run_.wanted > 0;
    return Misplaced::belongs_later;
  }
  return Misplaced::no;
}

// A list that runs into cards of another kind: it is cut before the first of them.
bool DeckReader::cut_list(const CardRule& rule, const Card& card) {
  for (const FieldFlaw& flaw : flaws_) {
    const int line = fields_[flaw.value].line;
    if (line == card.line || (flaw.fault == FieldFault::none && !(flaw.hints & hint_inner_blank))) continue;
    for (int other = card.spec - 1; other <= card.spec + 3 && other < static_cast<int>(layout_.cards.size());
         ++other) {
      if (other < 0 || other == card.spec || !reads_well(rule_of(other), line)) continue;
      const std::size_t wanted = fields_.size();
      std::size_t kept = 0;
      while (fields_[kept].line < line) ++kept;
      log_.add(Severity::error, "S111", log_.line(line),
               "this reads as " + a_card(rule_of(other).spec.label) + ", but the " +
                   card_text(rule.spec.label) + " goes on: " + std::to_string(kept) + " of " +
                   std::to_string(wanted) + " values read (" + count_source(rule.rules.back().count) + ")");
      fields_.resize(kept);
      std::erase_if(flaws_, [&](const FieldFlaw& f) { return static_cast<std::size_t>(f.value) >= kept; });
      records_.rewind_to(line);
      return true;
    }
  }
  return false;
}

// "one is read only where report.kind == 3, and the kind ... of line 9 is 2 (codes)".
std::string DeckReader::unmet(const LayoutEntry& entry) const {
  std::string text = "one is read only where " + entry.when.source;
  for (const ExpressionNode& node : entry.when.nodes) {
    if (node.kind != ExpressionNode::Kind::field) continue;
    const FieldValue* value = field_value(node.card, node.field);
    if (!value) continue;
    const std::string& codes = rule_of(node.card).rules[node.field].codes;
    text += ", and the " + count_source(entry.when) + ", is " +
            (value->kind == FieldKind::text ? quoted(trimmed(value->text)) : number_text(value->number)) +
            (codes.empty() ? "" : " (" + codes + ")");
    break;
  }
  return text;
}

// "the 4 that were announced (...) are read", for a card that came too late.
std::string DeckReader::announced(int rule) {
  const LayoutEntry* entry = entry_of_[rule];
  if (entry && !entry->when.empty() && !truth(entry->when)) return unmet(*entry);
  if (!entry || entry->run != LayoutEntry::Run::counted) return "its place is earlier";
  const double count = number_of(entry->count);
  const std::string source = " (" + count_source(entry->count) + ")";
  if (count == 0.0) return "none was announced" + source;
  if (count == 1.0) return "the one that was announced" + source + " has been read";
  return "the " + number_text(count) + " that were announced" + source + " have been read";
}

bool DeckReader::reads_well(const CardRule& rule, int line) const {
  if (rule.list_directed || rule.is_item || rule.spec.made || !rule.rules.back().count.empty()) return false;
  if (rule.spec.fields.front().kind == FieldKind::text) return false;  // reads anything
  RecordSource records = records_;
  records.rewind_to(line);
  FormattedRead read(records, rule.format);
  if (read.begin() != ReadEnd::complete || all_blank(records.record())) return false;
  std::vector<FieldValue> values;
  std::vector<FieldFlaw> flaws;
  int given = 0;
  for (const FieldSpec& spec : rule.spec.fields) {
    if (spec.computed) continue;
    if (read.read(spec.kind, values, flaws) != ReadEnd::complete || records.line() != line) return false;
    if (spec.required && values.back().blank) return false;
    if (!values.back().blank) ++given;
  }
  if (!flaws.empty() || given < 3) return false;  // one or two numbers fit everywhere
  const std::size_t end = read.last_field_end();
  return records.record().size() <= end ||
         all_blank(records.record().substr(end, 72 - std::min<std::size_t>(end, 72)));
}

std::string DeckReader::card_name(const LayoutEntry& entry) const {
  const LayoutEntry* at = &entry;
  while (at->card < 0) at = &at->entries.front();
  return rule_of(at->card).spec.label;
}

void DeckReader::truncated(const LayoutEntry& entry) {
  std::string message = "the deck ends here, but " + a_card(card_name(entry)) + " was expected";
  if (run_.wanted > 0) {
    message += " (" + std::to_string(run_.done) + " of " + std::to_string(run_.wanted) + " read, " +
               std::to_string(run_.wanted - run_.done) + " missing";
    if (!entry.count.empty()) message += "; " + count_source(entry.count);
    message += ")";
  }
  log_.add(Severity::error, "S110", log_.line(source_.line_count()), message);
  stopped_ = true;
}

void DeckReader::stop(const std::string& why, int line) {
  log_.add(Severity::note, "S132", log_.line(line), why);
  stopped_ = true;
}

void DeckReader::fail_and_stop(const SourcePosition& where, const std::string& message) {
  log_.add(Severity::error, "S111", where, message);
  stopped_ = true;
}

// Memory grows with the file, not with what a count says: a value takes a character, but repeats ("500*1") may
// give more.
bool DeckReader::fits_the_file(int count, bool repeats) const {
  const double size = static_cast<double>(source_.text()->size());
  return count <= (repeats ? 1e5 + 2.0 * size : size);
}

void DeckReader::check_after_end() {
  while (records_.next()) {
    if (all_blank(records_.record())) continue;
    if (!layout_.card_separator.empty())
      return log_.add(Severity::error, "S112", log_.line(records_.line()), "this card has no place here");
    const auto closes = [this](const Card& last) {
      const CardRule& rule = rule_of(last.spec);
      return !rule.rules.empty() && !rule.rules[0].must_equal.empty();
    };
    const bool closed = !deck_.cards.empty() && closes(deck_.cards.back());
    const std::string_view record = records_.record();
    const std::size_t first = record.find_first_not_of(" \t,");
    if (closed || first == std::string_view::npos || !begins_with_number(record.substr(first)))
      return log_.add(Severity::warning, "S113", log_.line(records_.line()),
                      "the deck is complete, but more lines follow: they are ignored");
    return log_.add(unread_number(), "S119", log_.line(records_.line()),
                    "the deck is complete, but numbers follow that nothing reads",
                    "a count before them is too small, a line too many stands before them, or another program "
                    "reads this deck");
  }
}

}  // namespace sage

// How many cards of a kind follow: counts of the deck, and what to say where they don't fit.
#include <algorithm>
#include <cmath>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

constexpr double largest_count = 1e9;

// "a node card", "an element card".
std::string a_card(const std::string& name) {
  const bool vowel = !name.empty() && std::string_view("aeiouAEIO").find(name[0]) != std::string_view::npos;
  return (vowel ? "an " : "a ") + name + " card";
}

}  // namespace

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
        return rule.spec.fields[static_cast<std::size_t>(node.field)].label + " of the " + rule.spec.label +
               " card, line " + std::to_string(value->line);
      }
  return expression.source;
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
    std::string hint = "this card reads well as " + a_card(rule_of(other).spec.label) + ": ";
    if (earlier)
      hint += "is the count of " + rule_of(other).spec.label + " cards too small?";
    else if (run_.wanted > 0)
      hint += "is the count of " + rule.spec.label + " cards too large? (" + std::to_string(run_.wanted) +
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

// ------------------------------------------------------------------------------------------------------

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

}  // namespace sage

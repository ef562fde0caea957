// Fields that stand on no card and cards that stand in no record: their values are expressions over what was read.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

double number_in(const FieldValue& value, const FieldSpec& spec) {
  return value.blank && spec.has_fallback ? spec.fallback : value.number;
}

bool is_list(const FieldRule& rule) {
  return !rule.count.empty() || rule.values.size() > 1;
}

}  // namespace

// ---- What expressions find

// A card whose places are not kept is read again for them, once.
const std::vector<FieldValue>& DeckReader::fields_of(std::vector<CardFields>& kept, int rule, int card) const {
  CardFields& fields = kept[rule];
  if (fields.card != card) fields = {card, deck_.values(deck_.cards[card])};
  return fields.values;
}

// Of the card being read, or of the last of its kind.
const FieldValue* DeckReader::field_value(int card, int field) const {
  const int latest = latest_[card];
  if (!is_own(card) && latest < 0) return nullptr;
  const std::vector<FieldValue>& values = is_own(card) ? fields_ : fields_of(latest_fields_, card, latest);
  return static_cast<std::size_t>(field) < values.size() ? &values[field] : nullptr;
}

ExpressionValue DeckReader::value_of(int card, int field) const {
  const FieldValue* value = field_value(card, field);
  if (!value) return {};
  return {number_in(*value, rule_of(card).spec.fields[field]), trimmed(value->text)};
}

ExpressionValue DeckReader::value_of(const ExpressionNode& node, double operand) const {
  using Kind = ExpressionNode::Kind;
  const auto number = [](double x) { return ExpressionValue{x, {}}; };
  switch (node.kind) {
    case Kind::field:
      return value_of(node.card, node.field);
    case Kind::blank: {
      const FieldValue* value = field_value(node.card, node.field);
      return number(!value || value->blank ? 1.0 : 0.0);
    }
    case Kind::previous:
      return previous_value(node);
    case Kind::sum:
      return number(sum_of(node));
    case Kind::count:
      return number(counts_[node.card]);
    case Kind::order:
      return number(counts_[node.card] + (is_own(node.card) ? 1 : 0));
    case Kind::index:
      return number(list_index_);
    case Kind::item:
      return item_of(node, operand);
    default:
      return number(sum_of_first(node, operand));
  }
}

// While a card is being read, the latest of its kind is the one before.
ExpressionValue DeckReader::previous_value(const ExpressionNode& node) const {
  const int index = previous_[node.card];
  const int latest = latest_[node.card];
  const int wanted = is_own(node.card) ? latest : index;
  if (wanted < 0) return {};
  std::vector<CardFields>& kept = is_own(node.card) ? latest_fields_ : previous_fields_;
  const std::vector<FieldValue>& values = fields_of(kept, node.card, wanted);
  if (static_cast<std::size_t>(node.field) >= values.size()) return {};
  const FieldValue& value = values[node.field];
  return {number_in(value, rule_of(node.card).spec.fields[node.field]), trimmed(value.text)};
}

// The values of a field; of the last of a card all that follow.
std::span<const FieldValue> DeckReader::list_of(int card, int field) const {
  const FieldValue* first = field_value(card, field);
  if (!first) return {};
  if (static_cast<std::size_t>(field) + 1 < rule_of(card).spec.fields.size()) return {first, 1};
  const std::vector<FieldValue>& values = is_own(card) ? fields_ : latest_fields_[card].values;
  return std::span(values).subspan(field);
}

// NaN where the list has no such place.
ExpressionValue DeckReader::item_of(const ExpressionNode& node, double place) const {
  const std::span<const FieldValue> list = list_of(node.card, node.field);
  if (!(place >= 1.0 && place <= static_cast<double>(list.size()) && place == std::floor(place)))
    return {std::numeric_limits<double>::quiet_NaN(), {}};
  const FieldValue& value = list[static_cast<std::size_t>(place) - 1];
  return {number_in(value, rule_of(node.card).spec.fields[node.field]), trimmed(value.text)};
}

double DeckReader::sum_of(const ExpressionNode& node) const {
  double sum = sums_.at({node.card, node.field});
  if (is_own(node.card))
    for (const FieldValue& value : list_of(node.card, node.field))
      sum += number_in(value, rule_of(node.card).spec.fields[node.field]);
  return sum;
}

// Goes on from where the last sum of this list ended, so that all running sums of a list take one pass.
double DeckReader::sum_of_first(const ExpressionNode& node, double count) const {
  const std::span<const FieldValue> list = list_of(node.card, node.field);
  if (!(count >= 0.0 && count <= static_cast<double>(list.size()) && count == std::floor(count)))
    return std::numeric_limits<double>::quiet_NaN();
  if (list.empty()) return 0.0;
  ListSum& last = list_sums_[{node.card, node.field}];
  const std::size_t card =
      is_own(node.card) ? deck_.cards.size() : static_cast<std::size_t>(latest_[node.card]);
  const auto wanted = static_cast<std::size_t>(count);
  if (last.card != card || last.count > wanted) last = {card, 0, 0.0};
  const FieldSpec& spec = rule_of(node.card).spec.fields[node.field];
  for (; last.count < wanted; ++last.count) last.sum += number_in(list[last.count], spec);
  return last.sum;
}

// Of a value that the expression takes from the deck: the first on the last line of them, that of the card's own
// record where it takes one from there.  Line 0 where it takes none.
SourcePosition DeckReader::where_of(const Expression& expression) const {
  const FieldValue* last = nullptr;
  for (const ExpressionNode& node : expression.nodes) {
    const FieldValue* value = node.field >= 0 ? field_value(node.card, node.field) : nullptr;
    if (value && value->line > (last ? last->line : 0)) last = value;
  }
  return last ? log_.where(*last) : SourcePosition{deck_.file, 0, 0, 0};
}

void DeckReader::fault(const SourcePosition& where, const std::string& what, const Expression& expression,
                       const ExpressionResult& result) {
  const std::string number =
      std::string_view(result.fault).find("number") != std::string_view::npos && result.fault_number != 0.0
          ? ", " + number_text(result.fault_number) + ","
          : "";
  log_.add(Severity::error, "S131", where.line > 0 ? where : log_.line(records_.line()),
           what + " can't be computed: " + result.fault + number + " in \"" + expression.source + "\" (" +
               layout_.file + ", line " + std::to_string(expression.line) + ")");
}

// Of a condition or a count; an error, and the end of reading, where it can't be computed.
double DeckReader::number_of(const Expression& expression) {
  const ExpressionResult result = evaluate(expression, *this);
  if (!result.fault) return result.value.number;
  fault(where_of(expression), "what follows", expression, result);
  stopped_ = true;
  return 0.0;
}

// ---- Computed fields

// The position of the value that it is computed from.
void DeckReader::take_place(const Expression& expression, FieldValue& value) const {
  const SourcePosition where = where_of(expression);
  if (where.line == 0) return;
  value.line = where.line;
  value.first_column = static_cast<std::uint16_t>(where.first_column);
  value.last_column = static_cast<std::uint16_t>(where.last_column);
}

void DeckReader::set_number(const CardRule& rule, std::size_t field, const Expression& expression,
                            double number, FieldValue& value) {
  const FieldSpec& spec = rule.spec.fields[field];
  value.number = number;
  if (spec.kind != FieldKind::integer) return;
  const double whole = std::round(number);
  if (std::abs(number - whole) <= 1e-9 * std::max(1.0, std::abs(number)) && std::abs(whole) < 2147483648.0) {
    value.number = whole;
    return;
  }
  log_.add(Severity::error, "S131", value.line > 0 ? log_.where(value) : log_.line(records_.line()),
           "the value " + number_text(number) + " is no integer " + field_text(rule, spec) + ": " +
               expression.source + " (" + layout_.file + ", line " + std::to_string(expression.line) + ")");
  mark_faulty(static_cast<std::size_t>(&value - fields_.data()));
}

// A field that only bears another's name is left blank where that is, so that the program can ask for it.
bool DeckReader::copies_blank(const Expression& expression) const {
  if (expression.nodes.size() != 1 || expression.nodes[0].kind != ExpressionNode::Kind::field) return false;
  const ExpressionNode& node = expression.nodes[0];
  const FieldValue* value = field_value(node.card, node.field);
  return value && value->blank && !rule_of(node.card).spec.fields[node.field].has_fallback;
}

void DeckReader::compute(const CardRule& rule, std::size_t field, const Expression& expression,
                         FieldValue& value) {
  const FieldSpec& spec = rule.spec.fields[field];
  value.kind = spec.kind;
  value.blank = false;
  take_place(expression, value);
  if (!faulty_.empty() && is_faulty(expression)) {  // which has been reported
    mark_faulty(static_cast<std::size_t>(&value - fields_.data()));
    return;
  }
  const ExpressionResult result = evaluate(expression, *this);
  if (result.fault) {
    fault(log_.where(value), "the " + spec.label + " of the " + card_text(rule.spec.label), expression, result);
    mark_faulty(static_cast<std::size_t>(&value - fields_.data()));
    return;
  }
  if (spec.kind != FieldKind::text) {
    value.blank = copies_blank(expression);
    return set_number(rule, field, expression, result.value.number, value);
  }
  value.text = result.value.text;
  value.blank = value.text.empty();
  for (const ExpressionNode& node : expression.nodes) {  // the layout's own text doesn't outlive it
    if (node.kind != ExpressionNode::Kind::text || node.text.data() != value.text.data()) continue;
    const auto [kept, added] = kept_texts_.try_emplace(node.text.data());
    if (added) kept->second = texts_->emplace_back(node.text);
    value.text = kept->second;
  }
}

// The values of a list that is computed stand behind all others of the card.
void DeckReader::compute_list(const CardRule& rule, std::size_t field, int line) {
  const FieldRule& one = rule.rules[field];
  auto count = static_cast<int>(one.values.size());
  if (!one.count.empty() && !count_of(one.count, rule.spec.fields[field].label, count)) return;
  if (!may_make(static_cast<std::size_t>(count), line)) return;
  for (int i = 0; i < count && !stopped_; ++i) {
    list_index_ = i + 1;
    FieldValue value;  // values may move where one is added
    value.line = line;
    fields_.push_back(value);
    const Expression& expression = one.values[one.count.empty() ? static_cast<std::size_t>(i) : 0];
    compute(rule, field, expression, fields_.back());
    if (one.restricted()) check_allowed(rule, field, fields_.size() - 1);
  }
}

void DeckReader::compute_fields(const CardRule& rule, int line) {
  const std::size_t fields = rule.rules.size() - (is_list(rule.rules.back()) ? 1 : 0);
  for (std::size_t i = fields_.size(); i < fields; ++i) {  // a slash ended the READ early
    FieldValue& value = fields_.emplace_back();
    value.line = line;
    value.kind = rule.spec.fields[i].kind;
  }
  for (std::size_t i = 0; i < rule.rules.size() && !stopped_; ++i) {
    if (!rule.spec.fields[i].computed) continue;
    if (is_list(rule.rules[i])) {
      compute_list(rule, i, line);
      continue;
    }
    compute(rule, i, rule.rules[i].values.front(), fields_[i]);
    if (rule.rules[i].restricted()) check_allowed(rule, i, i);
  }
}

// ---- Made cards

// Memory grows with the file, not with what a count says.
bool DeckReader::may_make(std::size_t values, int line) {
  made_values_ += values;
  if (made_values_ <= made_limit_) return true;
  fail_and_stop(log_.line(line), "the layout makes more than " + std::to_string(made_limit_) +
                                     " values out of a deck of " + std::to_string(source_.text()->size()) +
                                     " characters: is a count wrong?");
  return false;
}

void DeckReader::make_card(const LayoutEntry& entry, int owner, int line) {
  const CardRule& rule = rule_of(entry.card);
  if (!may_make(rule.rules.size(), line)) return;
  Card card;
  card.spec = entry.card;
  card.owner = owner;
  card.line = line;
  own_rule_ = entry.card;
  flaws_.clear();
  FieldValue value;
  value.line = line;
  const std::vector<FieldValue> outer = std::exchange(
      fields_, std::vector<FieldValue>(rule.rules.size() - (is_list(rule.rules.back()) ? 1 : 0), value));
  const std::size_t index = deck_.cards.size();
  close_card(rule, card, true);
  fields_ = outer;  // of the card that it follows
  if (entry.made_from >= 0) return;
  // The line of what it says; that of the card read last, where it says nothing of the deck.
  Card& made = deck_.cards[index];
  for (std::int32_t i = 0; i < made.value_count; ++i) {
    const ValuePlace& one = deck_.places[made.first_place + i];
    if (one.first_column == 0) continue;
    made.line = one.line;
    return;
  }
}

void DeckReader::make_cards(const LayoutEntry& entry, int owner, int line) {
  if (!entry.when.empty() && (is_faulty(entry.when) || !truth(entry.when))) return;
  int count = 1;
  if (!entry.count.empty() && !count_of(entry.count, card_text(card_name(entry)) + "s", count)) return;
  for (int i = 0; i < count && !stopped_; ++i) make_card(entry, owner, line);
}

// What the layout makes out of a card stands right behind it.
void DeckReader::make_followers(int rule, int card) {
  const int owner = owner_of_followers(card);
  const int line = deck_.cards[card].line;
  for (const LayoutEntry* entry : followers_[rule])
    if (!stopped_) make_cards(*entry, owner, line);
}

// Themselves if they open, otherwise what they belong to; an item of a list belongs to the READ's first card.
int DeckReader::owner_of_followers(int index) const {
  const Card& card = deck_.cards[index];
  if (opens_[card.spec]) return index;
  if (!rule_of(card.spec).is_item || card.owner < 0) return card.owner;
  const Card& read = deck_.cards[card.owner];
  return opens_[read.spec] ? card.owner : read.owner;
}

// sign: -1 takes the card out again.
void DeckReader::count_card(const Card& card, int sign) {
  const auto rule = static_cast<std::size_t>(card.spec);
  counts_[rule] += sign;
  for (const int field : summed_[rule]) {
    const FieldSpec& spec = rule_of(card.spec).spec.fields[field];
    const bool list = static_cast<std::size_t>(field) + 1 == rule_of(card.spec).spec.fields.size();
    double& sum = sums_[{card.spec, field}];
    // What stands behind the values of a card that can be read again is blank.
    const int count = card.first_place < 0 ? std::max(field + 1, card.value_count) : card.value_count;
    for (int i = field; i < (list ? count : std::min(field + 1, count)); ++i) {
      const double number = deck_.number(card, i);
      sum += sign * (!Deck::is_blank(number) ? number : spec.has_fallback ? spec.fallback : 0.0);
    }
  }
}

// A card that only ends its run has no computed values.
bool DeckReader::ends_run(const Card& card) {
  const auto rule = static_cast<std::size_t>(card.spec);
  if (!computes_[rule] && followers_[rule].empty()) return false;
  return run_.entry && run_.entry->drop_last && run_.entry->card == card.spec && truth(run_.entry->until);
}

}  // namespace sage

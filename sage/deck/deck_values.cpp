// What a card that was read is held against: faults of its fields, what stands behind
// them, required values, codes.
#include <algorithm>
#include <tuple>

#include "sage/deck/deck_reader.hpp"
#include "sage/deck/text.hpp"

namespace sage {

namespace {

// The last field that stands on the card.
std::size_t last_read_field(const CardRule& rule) {
  std::size_t field = rule.spec.fields.size() - 1;
  while (field > 0 && rule.spec.fields[field].computed) --field;
  return field;
}

// Old hands let a name run on over a field that nobody needs: no more than a blank stands between.
bool runs_on(std::string_view text, std::string_view behind) {
  const bool to_its_end = text.size() > 1 && text.find_last_not_of(' ') != std::string_view::npos &&
                          text.find_last_not_of(' ') + 2 >= text.size();
  return to_its_end && !behind.empty() && behind.front() != ' ';
}

}  // namespace

void DeckReader::close_card(const CardRule& rule, const Card& card, bool complete) {
  if (!flaws_.empty()) report_flaws(rule);
  if (complete) check_values(rule, card);  // else the deck ended in the card, which has been reported
  const bool ends = ends_run(card);
  const auto at = static_cast<std::size_t>(card.spec);
  if (computes_[at] && complete && !ends) compute_fields(rule, card.line);
  store_card(rule, card, complete);
  own_rule_ = -1;
  if (complete && !ends && !followers_[at].empty()) make_followers(card.spec, latest_[at]);
}

// Without places where the card can be read again, and then without the blanks at its end.
void DeckReader::store_card(const CardRule& rule, const Card& card, bool complete) {
  const auto at = static_cast<std::size_t>(card.spec);
  const bool again = !rule.list_directed && !rule.is_item && !rule.spec.made && !computes_[at];
  std::size_t count = fields_.size();
  if (again && complete && rule.rules.back().count.empty())
    while (count > 0 && fields_[count - 1].blank) --count;
  deck_.add(card, std::span(fields_).first(count), again);
  count_card(deck_.cards.back(), 1);
  previous_[at] = std::exchange(latest_[at], static_cast<int>(deck_.cards.size()) - 1);
  std::swap(previous_fields_[at], latest_fields_[at]);
  latest_fields_[at].card = latest_[at];
  latest_fields_[at].values = fields_;
}

void DeckReader::report_flaws(const CardRule& rule) {
  bool comma_said = false;
  for (FieldFlaw& flaw : flaws_) {
    if (comma_said) flaw.hints = static_cast<std::uint16_t>(flaw.hints & ~hint_comma);
    comma_said = comma_said || (flaw.hints & hint_comma) != 0;
    const auto at = static_cast<std::size_t>(flaw.value);
    const std::size_t field = std::min(at, rule.spec.fields.size() - 1);
    const int errors = log_.errors();
    FieldValue& value = fields_[at];
    // A map may take what isn't a number.
    if (!rule.rules[field].map.empty() && flaw.fault != FieldFault::none) continue;
    if (rule.rules[field].ignored && flaw.fault == FieldFault::bad_character && field > 0 &&
        rule.spec.fields[field - 1].kind == FieldKind::text && runs_on(fields_[at - 1].text, value.text)) {
      log_.add(Severity::note, "S129", log_.where(value),
               quoted(trimmed(value.text)) + " is read as the end of the text before it, not as a number " +
                   field_text(rule, rule.spec.fields[field]));
      value.number = 0.0;
      value.blank = true;
      continue;
    }
    log_.flaw(rule, rule.spec.fields[field], value, flaw);
    if (log_.errors() > errors) {
      mark_faulty(at);
      value.number = 0.0;
    }
  }
}

void DeckReader::check_values(const CardRule& rule, const Card& card) {
  const std::size_t count = std::min(fields_.size(), rule.rules.size());
  for (std::size_t i = 0; i < count; ++i) {
    FieldValue& value = fields_[i];
    const FieldSpec& spec = rule.spec.fields[i];
    if (value.blank && spec.required) {
      log_.add(Severity::error, "S115", value.first_column ? log_.where(value) : log_.line(card.line),
               "a value is missing " + field_text(rule, spec));
      mark_faulty(i);
    }
    if (plain_[card.spec] || spec.computed) continue;
    if (!rule.rules[i].map.empty()) apply_map(rule, i, value);
    if (rule.rules[i].restricted()) check_allowed(rule, i, i);
    const std::string& wanted = rule.rules[i].must_equal;
    if (!wanted.empty() && lower_case(trimmed(value.text)) != lower_case(wanted)) {
      log_.add(Severity::error, "S116", value.first_column ? log_.where(value) : log_.line(card.line),
               "the " + card_text(rule.spec.label) + " must read " + wanted + ", not " +
                   quoted(trimmed(value.text)));
    }
  }
  // A slash may end a list-directed card early.
  for (std::size_t i = count; i < rule.rules.size(); ++i)
    if (rule.spec.fields[i].required && rule.rules[i].count.empty())
      log_.add(Severity::error, "S115", log_.line(card.line),
               "a value is missing " + field_text(rule, rule.spec.fields[i]));
}

void DeckReader::apply_map(const CardRule& rule, std::size_t field, FieldValue& value) {
  if (value.blank && value.kind != FieldKind::text) return;
  const std::string_view text = trimmed(value.text);
  for (const auto& [code, number] : rule.rules[field].map)
    if (code == text) {
      value.number = number;
      value.blank = false;  // of a text that means something left blank
      return;
    }
  std::string known;
  for (const auto& [code, number] : rule.rules[field].map) known += (known.empty() ? "" : ", ") + code;
  log_.add(
      Severity::error, "S117", log_.where(value),
      quoted(text) + " is not a known code " + field_text(rule, rule.spec.fields[field]) + "; known: " + known);
}

// A blank that is wrong has its message already.
void DeckReader::check_allowed(const CardRule& rule, std::size_t field, std::size_t at) {
  const FieldValue& value = fields_[at];
  const FieldRule& one_of = rule.rules[field];
  const auto& [numbers, texts] = std::tie(one_of.allowed, one_of.allowed_texts);
  const std::string_view text = trimmed(value.text);
  if (value.blank || is_faulty(deck_.cards.size(), at)) return;
  const bool within = value.number >= one_of.least && value.number <= one_of.most;
  const bool listed = (numbers.empty() && texts.empty()) ||
                      std::ranges::find(numbers, value.number) != numbers.end() ||
                      std::ranges::find(texts, text) != texts.end();
  if (within && listed) return;
  const std::string& known = one_of.codes;
  std::string all;
  if (!within) all = "what lies between " + number_text(one_of.least) + " and " + number_text(one_of.most);
  for (const double one : numbers) all += (all.empty() ? "" : ", ") + number_text(one);
  for (const std::string& one : texts) all += (all.empty() ? "" : ", ") + one;
  log_.add(Severity::error, "S118", log_.where(value),
           "the " + rule.spec.fields[field].label + " can't be " +
               (texts.empty() ? number_text(value.number) : quoted(text)) + ": " +
               (known.empty() ? "allowed are " + all : known));
  mark_faulty(at);
}

// A list-directed READ passes over what is left of its last record: a count that is too small loses values so.
void DeckReader::note_list_rest() {
  if (!list_read_ || list_read_->ended_by_slash()) return;
  const std::string_view rest = list_read_->rest();
  const std::size_t first = rest.find_first_not_of(" \t,;\r");
  if (first == std::string_view::npos) return;
  const int column = records_.skipped() + static_cast<int>(list_read_->position() + first) + 1;
  const int last = column + static_cast<int>(rest.find_last_not_of(" \t\r") - first);
  const bool number = begins_with_number(rest.substr(first));
  log_.add(number ? unread_number() : Severity::warning, "S119", {deck_.file, records_.line(), column, last},
           "not read: the values before it are all that this READ takes",
           number
               ? "a count before it is too small, a value too many stands before it, or another program reads "
                 "this deck; a slash (/) ends a READ where numbers are left over on purpose"
               : "");
}

// Fields that old hands leave blank on purpose and others by mistake: one note for all cards of a kind.
void DeckReader::note_blanks() {
  struct Blanks {
    int count = 0;
    const Card* first = nullptr;
    bool others = false;  // a card of the kind has something else
  };
  std::vector<std::vector<Blanks>> blanks(deck_.specs.size());
  for (std::size_t s = 0; s < deck_.specs.size(); ++s) {
    const auto& fields = deck_.specs[s].fields;
    const bool any = std::any_of(fields.begin(), fields.end(),
                                 [](const FieldSpec& f) { return f.blank_note != BlankNote::never; });
    if (any) blanks[s].resize(fields.size());
  }
  for (const Card& card : deck_.cards) {
    std::vector<Blanks>& of_card = blanks[card.spec];
    const auto& fields = deck_.specs[card.spec].fields;
    const auto count = static_cast<std::size_t>(card.value_count);
    const std::size_t looked_at = card.first_place < 0 ? of_card.size() : std::min(of_card.size(), count);
    for (std::size_t i = 0; i < looked_at; ++i) {
      if (fields[i].blank_note == BlankNote::never) continue;
      const double number = deck_.number(card, static_cast<int>(i));
      if (!Deck::is_blank(number))
        of_card[i].others = of_card[i].others || number != fields[i].fallback;
      else if (++of_card[i].count == 1)
        of_card[i].first = &card;
    }
  }
  for (std::size_t s = 0; s < blanks.size(); ++s)
    for (std::size_t i = 0; i < blanks[s].size(); ++i) {
      const Blanks& found = blanks[s][i];
      const FieldSpec& field = deck_.specs[s].fields[i];
      if (found.count == 0 || (field.blank_note == BlankNote::compared && !found.others)) continue;
      const CardRule& rule = rule_of(static_cast<int>(s));
      const FieldValue value = deck_.values(*found.first)[i];
      const auto number = static_cast<int>(field.fallback);
      log_.add(
          Severity::note, "S127", value.first_column ? log_.where(value) : log_.line(found.first->line),
          "left blank, which reads as " + std::to_string(number) + " " + field_text(rule, field) +
              (found.count > 1 ? "; and on " + std::to_string(found.count - 1) + " more of these cards" : "") +
              (field.blank_note == BlankNote::compared ? "; other cards of this kind have a value there" : ""));
    }
}

// -----------------------------------------------------

// Warns of the first slip of the card; false if it has none.
bool DeckReader::check_seams(const CardRule& rule) {
  const SequenceColumns sequence{layout_.first_sequence_column, layout_.last_sequence_column};
  const std::optional<SlipFound> slip = find_slip(source_, rule.spec, fields_, seams_, sequence);
  if (!slip) return false;
  const std::size_t field = std::min(static_cast<std::size_t>(slip->value), rule.spec.fields.size() - 1);
  const std::string place = " " + field_text(rule, rule.spec.fields[field]);
  const std::string column = std::to_string(slip->end_column);
  const auto first = static_cast<std::size_t>(slip->first_column) - 1;
  const std::string word =
      quoted(deck_.line_text(slip->line).substr(first, static_cast<std::size_t>(slip->last_column) - first));
  std::string message;
  switch (slip->slip) {
    case Slip::cut:
      message =
          word + " is cut in two: the field ends at column " + column + ", and the rest reads as the next";
      break;
    case Slip::cut_word:
      message = word + " is cut in two: the text ends at column " + column + ", and the rest begins the next";
      break;
    case Slip::cut_text:
      log_.add(Severity::warning, "S133", {deck_.file, slip->line, slip->first_column, slip->last_column},
               word + " runs on beyond column " + column + ", and the field behind it reads the rest" + place,
               "shorten the text, or leave a blank before the field");
      return true;
    case Slip::lost_end:
      message =
          word + " is cut: the field ends at column " + column + ", and what stands behind it is not read";
      break;
    case Slip::lost_head:
      message =
          word + " is cut: the field begins behind column " + column + ", and what stands there is not read";
      break;
    case Slip::moved:
      message =
          word + " stands alone in the field's first column, " + column + ", and the field before it is blank";
      break;
  }
  log_.add(Severity::warning, "S128", {deck_.file, slip->line, slip->first_column, slip->last_column},
           message + place,
           "is the card shifted by a column? Fields may stand side by side where each is full");
  return true;
}

// Words that all are numbers.
bool DeckReader::all_numbers(std::string_view text) const {
  for (;;) {
    const std::size_t first = text.find_first_not_of(" \t,\x1a");
    if (first == std::string_view::npos) return true;
    text.remove_prefix(first);
    if (!begins_with_number(text)) return false;
    text.remove_prefix(std::min(text.find_first_of(" \t,"), text.size()));
  }
}

bool DeckReader::begins_with_number(std::string_view text) const {
  const std::string_view word = text.substr(0, text.find_first_of(" \t,"));
  const FieldResult number = read_free_number(word, false);
  return number.fault == FieldFault::none && !(number.hints & hint_not_finite);
}

void DeckReader::check_rest(const CardRule& rule, std::size_t last_field_end, bool slip_found) {
  const std::string_view beyond = records_.beyond();
  if (!overlong_noted_ && !beyond.empty() && !all_blank(beyond)) {
    overlong_noted_ = true;
    const int first = layout_.records.record_length + 1;
    log_.add(Severity::note, "S129",
             {deck_.file, records_.line(), first, first + static_cast<int>(beyond.size()) - 1},
             "characters beyond column " + std::to_string(first - 1) + " are ignored (reported once)");
  }
  if (layout_.last_sequence_column > 0 &&
      last_field_end >= static_cast<std::size_t>(layout_.first_sequence_column))
    check_sequence_number(rule);
  std::string_view record = records_.record();
  const auto sequence = static_cast<std::size_t>(layout_.first_sequence_column);
  if (sequence > 0 && record.size() >= sequence) record = record.substr(0, sequence - 1);
  if (last_field_end >= record.size() || all_blank(record.substr(last_field_end))) return;
  const std::size_t first = last_field_end + record.substr(last_field_end).find_first_not_of(" \t\x1a");
  if (slip_found) return;
  const int offset = records_.skipped() + 1;
  const SourcePosition where{deck_.file, records_.line(), offset + static_cast<int>(first),
                             offset + static_cast<int>(record.find_last_not_of(" \t\x1a"))};
  const std::size_t field = last_read_field(rule);
  if (fields_.empty()) return;
  const bool list = field + 1 == rule.rules.size() && !rule.rules[field].count.empty();
  const FieldValue& last = list ? fields_.back() : fields_[field];
  if (last.blank && last.kind != FieldKind::text && begins_with_number(record.substr(first)))
    return log_.add(Severity::warning, "S128", where,
                    "a number stands behind the last field of the " + card_text(rule.spec.label) +
                        ", which is blank: it is not read " + field_text(rule, rule.spec.fields[field]),
                    "is the card shifted?");
  if (last.kind != FieldKind::text && all_numbers(record.substr(first)))
    return log_.add(
        Severity::warning, "S134", where,
        "numbers stand behind the last field of the " + card_text(rule.spec.label) + " and are not read",
        "is a value too many on the card, or the card shifted? Words may stand there as a remark");
  log_.add(Severity::note, "S129", where,
           "characters behind the last field of the " + card_text(rule.spec.label) + " are ignored");
}

// Eight digits in 73-80 with blanks before them, where fields reach that far: likely no data.
void DeckReader::check_sequence_number(const CardRule& rule) {
  if (sequence_noted_) return;
  const std::string_view record = records_.record();
  const auto first = static_cast<std::size_t>(layout_.first_sequence_column) - 1;
  const auto size = static_cast<std::size_t>(layout_.last_sequence_column) - first;
  if (record.size() < first + size || first < 2) return;
  const FieldSpec& last = rule.spec.fields[last_read_field(rule)];
  const std::string_view number = record.substr(first, size);
  const bool digits = std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || last.kind == FieldKind::text || !all_blank(record.substr(first - 2, 2))) return;
  sequence_noted_ = true;
  log_.add(Severity::warning, "S130",
           {deck_.file, records_.line(), layout_.first_sequence_column, layout_.last_sequence_column},
           quoted(number) + " looks like a sequence number, but the fields of the " +
               card_text(rule.spec.label) + " reach into columns " +
               std::to_string(layout_.first_sequence_column) + "-" +
               std::to_string(layout_.last_sequence_column) + " (reported once)");
}

}  // namespace sage

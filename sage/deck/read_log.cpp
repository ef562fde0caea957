#include "sage/deck/read_log.hpp"

#include <algorithm>
#include <utility>

#include "sage/deck/text.hpp"

namespace sage {

namespace {

// A guess at how the character that spoils a number came there.
std::string character_hint(std::string_view text, std::size_t at, FieldKind kind, const FieldValue& value) {
  const char c = at < text.size() ? text[at] : '\0';
  const bool digits = std::any_of(text.begin(), text.end(), is_digit);
  if (c == '\t') return "a tab counts as one column: replace tabs by blanks";
  if (static_cast<unsigned char>(c) >= 128) return "a character that is not plain ASCII (a no-break space?)";
  if (static_cast<unsigned char>(c) < 32) return "a control character stands in the field";
  if ((c == 'O' || c == 'o') && (digits || text.size() <= 5))
    return "the letter O stands where the digit 0 may be meant";
  if ((c == 'l' || c == 'I') && (digits || text.size() <= 5))
    return "the letter " + std::string(1, c) + " stands where the digit 1 may be meant";
  if (kind == FieldKind::integer && (c == '.' || c == 'E' || c == 'e') && digits)
    return "an integer is wanted: no point, no exponent (or the card is shifted)";
  if (value.last_column >= 80 && value.first_column >= 65 && value.first_column <= 76)
    return "columns 73-80 may hold a sequence number, which runs into this field";
  return {};
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  return '"' + shown + (text.size() > 40 ? "...\"" : "\"");
}

std::string card_text(const std::string& label) {
  return label.ends_with("card") ? label : label + " card";
}

std::string field_text(const CardRule& card, const FieldSpec& field) {
  std::string text = "(" + card_text(card.spec.label) + ", " + field.label;
  if (!field.unit.empty()) text += ", " + field.unit;
  return text + ")";
}

void ReadLog::add(Severity severity, Code code, const SourcePosition& where, const std::string& message,
                  const std::string& hint) {
  if (options_.strict && severity == Severity::warning) severity = Severity::error;
  int& count = severity == Severity::error ? errors_ : severity == Severity::warning ? warnings_ : notes_;
  last_shown_ = ++count <= options_.shown;
  if (!last_shown_) return;
  Diagnostic diagnostic = card_diagnostic(deck_, severity, code, where, message);
  if (!hint.empty()) diagnostic.detail.push_back("note: " + hint);
  list_.push_back(std::move(diagnostic));
}

void ReadLog::add_hint(const std::string& hint) {
  if (last_shown_ && !list_.empty()) list_.back().detail.push_back("note: " + hint);
}

void ReadLog::flaw(const CardRule& card, const FieldSpec& field, const FieldValue& value,
                   const FieldFlaw& flaw) {
  if (flaw.fault != FieldFault::none) {
    const char* what = fault_text(flaw.fault);
    if (field.kind == FieldKind::integer && (flaw.fault == FieldFault::bad_character))
      what = "is not an integer";
    if (field.kind == FieldKind::logical) what = "is not T or F";
    if (field.kind == FieldKind::text) what = "is not a text in quotes";
    add(Severity::error, "S120", where(value),
        quoted(trimmed(value.text)) + " " + what + " " + field_text(card, field),
        flaw.fault == FieldFault::bad_character ? character_hint(value.text, flaw.at, field.kind, value) : "");
    return;
  }
  hints(card, field, value, flaw.hints);
}

void ReadLog::hints(const CardRule& card, const FieldSpec& field, const FieldValue& value, unsigned hints) {
  const std::string text = quoted(trimmed(value.text));
  const std::string place = " " + field_text(card, field);
  const SourcePosition at = where(value);
  if (hints & hint_not_finite)
    return add(Severity::error, "S121", at, text + " is not a finite number" + place);
  if (hints & hint_overflow)
    return add(Severity::error, "S121", at, text + " is too large for a number" + place);
  if (hints & hint_inner_blank)
    add(Severity::warning, "S122", at, text + " has a blank inside the number" + place,
        "blanks are skipped or count as zeros: is the card shifted by a column?");
  if (hints & hint_comma)
    add(Severity::warning, "S123", at, "a comma ended the field after " + text + place,
        "the fields behind it start right after the comma, not at their columns");
  if (hints & hint_q_exponent)
    add(Severity::warning, "S124", at, text + " has the exponent letter Q and reads as if it were E" + place,
        "gfortran reads it so, the Fortran standard and other compilers know only E and D");
  if (hints & hint_lone_mark) add(Severity::warning, "S124", at, text + " has no digit and reads as 0" + place);
  if (hints & hint_cut)
    add(Severity::warning, "S125", at, "the card ends inside the field of " + text + place,
        "blanks count as zeros in this layout; were blanks at the card's end cut off by an editor?");
  if (hints & hint_trailing_blank)
    add(Severity::note, "S125", at, "blanks behind " + text + " count as zeros" + place);
  if (hints & hint_implied_point)
    add(Severity::note, "S126", at,
        text + " has no point: its last digits are taken as decimals, " + card.spec.format + place);
}

void ReadLog::finish() {
  const auto more = [&](int count, Severity severity, const char* what) {
    if (count <= options_.shown) return;
    list_.push_back({severity,
                     "S109",
                     {deck_.file, 0, 0, 0},
                     "and " + std::to_string(count - options_.shown) + " more " + what,
                     {}});
  };
  more(errors_, Severity::error, "errors");
  more(warnings_, Severity::warning, "warnings");
  more(notes_, Severity::note, "notes");
  for (Diagnostic& diagnostic : list_) deck_.diagnostics.add(std::move(diagnostic));
  list_.clear();
  if (errors_ > 0) throw InputError(std::move(deck_.diagnostics));
}

}  // namespace sage

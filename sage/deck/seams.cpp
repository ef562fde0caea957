#include "sage/deck/seams.hpp"

#include <algorithm>
#include <array>

#include "sage/deck/text.hpp"

namespace sage {

namespace {

bool is_of_number(char c) {
  return is_digit(c) || c == '.';
}

bool is_rest_of_number(std::string_view text) {
  const std::string_view word = text.substr(0, text.find(' '));
  return std::all_of(word.begin(), word.end(), is_of_number);
}

// "E9", "d-05 clay": the exponent of a number that the end of a field cut before it.
bool is_exponent(std::string_view text) {
  constexpr std::string_view letters = "eEdDqQ";
  if (text.empty() || letters.find(text[0]) == std::string_view::npos) return false;
  std::size_t i = text.size() > 1 && (text[1] == '+' || text[1] == '-') ? 2 : 1;
  const std::size_t first = i;
  while (i < text.size() && is_digit(text[i])) ++i;
  return i > first && (i == text.size() || text[i] == ' ' || text[i] == ',');
}

// "1.E", "2.5D-": an exponent that is not complete.
bool ends_in_exponent(std::string_view text) {
  if (text.size() > 1 && (text.back() == '+' || text.back() == '-')) text.remove_suffix(1);
  return text.size() > 1 && std::string_view("eEdD").find(text.back()) != std::string_view::npos &&
         is_of_number(text[text.size() - 2]);
}

// "      0.30" and "33.0E3    ": a number that ends its field beside one that begins its own.  Not where a
// shift to the left by one column would look the same, "      0.30" and "123456.78 ".
bool are_two_numbers(std::string_view left, std::string_view right, std::size_t right_width) {
  const bool points = left.find('.') != std::string_view::npos && right.find('.') != std::string_view::npos;
  return points && right_width - (right.find_last_not_of(' ') + 1) >= 2;
}

class SlipSearch {
 public:
  SlipSearch(const SourceText& source, const CardSpec& spec, std::span<const FieldValue> values,
             std::vector<Seam>& seams, SequenceColumns sequence)
      : source_(source), spec_(spec), values_(values), seams_(seams), sequence_(sequence) {}

  std::optional<SlipFound> find() {
    for (std::size_t i = seams_.size(); i-- > 0;) {
      const bool on = goes_on(seams_[i]);
      seams_[i].whole = is_full(seams_[i]) && (!on || !is_shared(i) || seams_[i + 1].whole);
    }
    for (std::size_t i = 0; i < seams_.size(); ++i)
      if (auto found = look(i)) return found;
    return std::nullopt;
  }

 private:
  const FieldValue& value(const Seam& seam) const { return values_[seam.value]; }
  const FieldSpec& spec(const Seam& seam) const { return spec(seam.value); }
  const FieldSpec& spec(int index) const {
    return spec_.fields[std::min(static_cast<std::size_t>(index), spec_.fields.size() - 1)];
  }

  // Computed fields stand between those that are read, and have no characters.
  int end() const { return static_cast<int>(values_.size()); }
  int next_read(int index) const {
    do ++index;
    while (index < end() && spec(index).computed);
    return index;
  }
  int first_read() const { return next_read(-1); }

  bool is_full(const Seam& seam) const {
    const std::string_view text = value(seam).text;
    return text.size() == seam.width && text.find(' ') == std::string_view::npos;
  }
  // Digits or points on both sides of the field's end.
  bool goes_on(const Seam& seam) const {
    return is_of_number(seam.behind) && is_of_number(value(seam).text.back());
  }
  // The end of the field stands before an exponent, or within it.
  bool cuts_exponent(const Seam& seam) const {
    const FieldValue& v = value(seam);
    if (v.kind != FieldKind::real || v.blank) return false;
    const std::string_view line = source_.line(v.line);
    const std::string_view rest = line.substr(std::min<std::size_t>(v.last_column, line.size()));
    if (is_of_number(v.text.back())) return is_exponent(rest);
    return !rest.empty() && (is_digit(rest[0]) || rest[0] == '+' || rest[0] == '-') && ends_in_exponent(v.text);
  }
  // The field behind begins where this one ends: what goes on is read there.
  bool is_shared(std::size_t i) const {
    if (i + 1 == seams_.size()) return false;
    const Seam &left = seams_[i], &right = seams_[i + 1];
    return right.value == next_read(left.value) && right.start == left.start + left.width &&
           value(left).line == value(right).line;
  }
  // Some field of the card holds this column (tabs may go back).
  bool is_read(int line, std::size_t column) const {
    for (int index = first_read(); index < end(); index = next_read(index)) {
      const FieldValue& v = values_[index];
      if (v.line == line && v.first_column <= column && column <= v.last_column) return true;
    }
    return false;
  }
  // A sequence number fills its columns and touches what stands before it.
  bool is_sequence_number(int line, std::size_t column) const {
    if (sequence_.first == 0 || column != static_cast<std::size_t>(sequence_.first)) return false;
    const std::string_view text = source_.line(line);
    const auto last = static_cast<std::size_t>(sequence_.last);
    return text.size() >= last && text[last - 1] != ' ';
  }
  // Digits that stand right behind the field, and that nothing reads.
  bool is_lost_behind(const Seam& seam) const {
    const FieldValue& v = value(seam);
    const std::size_t behind = v.last_column + std::size_t{1};
    return (is_of_number(seam.behind) || cuts_exponent(seam)) && v.kind != FieldKind::text &&
           !is_read(v.line, behind) && !is_sequence_number(v.line, behind);
  }

  // Every number of the card begins in the first column of its field.
  bool all_begin_fields(FieldKind kind) const {
    for (int index = first_read(); index < end(); index = next_read(index)) {
      const FieldValue& v = values_[index];
      if (!v.blank && v.kind == kind && v.text.front() == ' ') return false;
    }
    return true;
  }
  // Numbers that begin in the first column and leave the last one blank: on the near side of the slip, or of
  // more digits than one (a slip by one column leaves none of these in a right-justified card).
  bool is_left_justified(const Seam& slipped) const {
    const FieldKind kind = value(slipped).kind;
    for (int index = first_read(); index < end(); index = next_read(index)) {
      const FieldValue& v = values_[index];
      if (index == slipped.value || v.blank || v.kind != kind || v.text.front() == ' ' || v.text.back() != ' ')
        continue;
      if (next_read(index) < slipped.value || v.text[1] != ' ') return true;
    }
    return false;
  }

  std::optional<SlipFound> look(std::size_t i) const {
    const Seam& seam = seams_[i];
    const FieldValue& v = value(seam);
    if (v.blank) return is_lost_behind(seam) ? found(Slip::lost_end, seam, v.last_column) : std::nullopt;
    if (auto cut = look_at_end(i)) return cut;
    if (is_of_number(seam.before) && is_of_number(v.text.front()) && v.kind != FieldKind::text &&
        !is_read(v.line, v.first_column - std::size_t{1}))
      return found(Slip::lost_head, seam, v.first_column - 1);
    if (seam.lone && is_digit(v.text.front()) && seam.value > first_read() && !is_free_text(spec(seam)) &&
        is_moved(seam))
      return found(Slip::moved, seam, v.first_column);
    return std::nullopt;
  }

  std::optional<SlipFound> look_at_end(std::size_t i) const {
    const Seam& seam = seams_[i];
    const FieldValue& v = value(seam);
    if (!is_shared(i))
      return (is_of_number(v.text.back()) || cuts_exponent(seam)) && is_lost_behind(seam)
                 ? found(Slip::lost_end, seam, v.last_column)
                 : std::nullopt;
    const Seam& next = seams_[i + 1];
    if (cuts_exponent(seam)) return found(Slip::cut, seam, v.last_column);
    if (is_free_text(spec(seam)))
      return goes_on(seam) && value(next).kind != FieldKind::text ? found(Slip::cut_text, seam, v.last_column)
                                                                  : std::nullopt;
    if (v.kind == FieldKind::text && value(next).kind == FieldKind::text) {
      const bool one_word = seam.behind != ' ' && !is_full(seam) && &spec(seam) != &spec(next);
      return one_word ? found(Slip::cut_word, seam, v.last_column) : std::nullopt;
    }
    if (!goes_on(seam) || next.whole) return std::nullopt;
    // A text that begins with digits: a name ("19962-3 inlet") unless its first word is the rest of a number.
    if (value(next).kind == FieldKind::text && !is_rest_of_number(value(next).text)) return std::nullopt;
    if (is_full(seam) && v.kind != FieldKind::text && all_begin_fields(v.kind)) return std::nullopt;
    if (are_two_numbers(v.text, value(next).text, next.width)) return std::nullopt;
    return found(Slip::cut, seam, v.last_column);
  }

  // A right-justified digit that came one column too far: the field that it left is blank.
  bool is_moved(const Seam& seam) const {
    const FieldValue& v = value(seam);
    int index = seam.value - 1;
    while (spec(index).computed) --index;
    const FieldValue& before = values_[index];
    const bool left_by_it = before.blank && before.kind != FieldKind::text && before.line == v.line &&
                            before.last_column + 1 == v.first_column;
    return left_by_it && !is_left_justified(seam);
  }

  std::optional<SlipFound> found(Slip slip, const Seam& seam, int end_column) const {
    const FieldValue& v = value(seam);
    const std::string_view line = source_.line(v.line);
    const auto at = static_cast<std::size_t>(slip == Slip::lost_end && v.blank ? end_column : end_column - 1);
    std::size_t first = at, last = at;
    while (first > 0 && line[first - 1] != ' ') --first;
    while (last + 1 < line.size() && line[last + 1] != ' ') ++last;
    return SlipFound{slip,      seam.value, v.line, static_cast<int>(first) + 1, static_cast<int>(last) + 1,
                     end_column};
  }

  const SourceText& source_;
  const CardSpec& spec_;
  std::span<const FieldValue> values_;
  std::vector<Seam>& seams_;
  SequenceColumns sequence_;
};

}  // namespace

bool is_free_text(const FieldSpec& spec) {
  constexpr std::array<std::string_view, 4> names{"name", "title", "comment", "text"};
  return spec.kind == FieldKind::text && std::ranges::find(names, spec.name) != names.end();
}

std::optional<SlipFound> find_slip(const SourceText& source, const CardSpec& spec,
                                   std::span<const FieldValue> values, std::vector<Seam>& seams,
                                   SequenceColumns sequence) {
  return SlipSearch(source, spec, values, seams, sequence).find();
}

}  // namespace sage

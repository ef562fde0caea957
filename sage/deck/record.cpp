#include "sage/deck/record.hpp"

#include <algorithm>

namespace sage {

namespace {

// The separator stands right before the record proper.
bool has_separator(std::string_view line, const RecordRules& rules) {
  const auto skip = static_cast<std::size_t>(rules.skip_columns);
  return line.size() >= skip &&
         line.substr(skip - rules.separator.size(), rules.separator.size()) == rules.separator;
}

}  // namespace

int RecordSource::skip_comments(int line) const {
  if (rules_.comment == '\0') return line;
  for (; line <= source_->line_count(); ++line) {
    const std::size_t start = source_->starts()[static_cast<std::size_t>(line) - 1];
    if ((*source_->text())[start] != rules_.comment) break;
  }
  return line;
}

bool RecordSource::next() {
  line_ = skip_comments(line_ + 1);
  if (line_ > source_->line_count()) {
    line_ = source_->line_count() + 1;
    record_ = {};
    return false;
  }
  record_ = line_ == replaced_line_ ? replacement_ : source_->line(line_);
  beyond_ = {};
  const auto length = static_cast<std::size_t>(rules_.record_length);
  if (length > 0 && record_.size() > length) {
    beyond_ = record_.substr(length);
    record_ = record_.substr(0, length);
  }
  skipped_ = 0;
  if (rules_.skip_columns > 0 && has_separator(record_, rules_)) {
    skipped_ = rules_.skip_columns;
    record_.remove_prefix(static_cast<std::size_t>(skipped_));
  }
  return true;
}

bool RecordSource::at_end() const {
  return skip_comments(line_ + 1) > source_->line_count();
}

std::string_view RecordSource::peek_line() const {
  return source_->line(skip_comments(line_ + 1));
}

ReadEnd FormattedRead::new_record() {
  position_ = 0;
  last_field_end_ = 0;
  if (!source_.next()) {
    record_ = {};
    return ReadEnd::end_of_file;
  }
  record_ = source_.record();
  has_comma_ = record_.find(',') != std::string_view::npos;
  return ReadEnd::complete;
}

// Everything of a FORMAT that moves no data.
ReadEnd FormattedRead::control(const FormatStep& step) {
  switch (step.edit) {
    case Edit::tab_to:
      position_ = static_cast<std::size_t>(step.width) - 1;
      break;
    case Edit::tab_by:
      if (step.width < 0 && position_ < static_cast<std::size_t>(-step.width))
        position_ = 0;
      else
        position_ += static_cast<std::size_t>(step.width);
      break;
    case Edit::next_record:
      for (int i = 0; i < step.width; ++i)
        if (const ReadEnd end = new_record(); end != ReadEnd::complete) return end;
      break;
    case Edit::blanks_null:
      blanks_ = BlankMode::null;
      break;
    case Edit::blanks_zero:
      blanks_ = BlankMode::zero;
      break;
    case Edit::scale:
      scale_ = step.width;
      break;
    default:
      break;
  }
  return ReadEnd::complete;
}

// The characters of the next field.  A comma ends a numeric field early and is used up.
std::string_view FormattedRead::cut_field(std::size_t width, bool numeric, bool& comma) {
  const std::size_t start = std::min(position_, record_.size());
  std::string_view field = record_.substr(start, width);
  const std::size_t at = numeric && has_comma_ ? field.find(',') : std::string_view::npos;
  comma = at != std::string_view::npos;
  if (comma) field = field.substr(0, at);
  position_ += comma ? at + 1 : width;
  last_field_end_ = std::max(last_field_end_, position_);
  return field;
}

// The character behind the last column of records that are longer than the layout's.
char FormattedRead::first_beyond(std::size_t end) const {
  return end == record_.size() && !source_.beyond().empty() ? source_.beyond().front() : ' ';
}

// Most fields begin with a blank and have a blank behind them.
inline bool FormattedRead::stands_apart(std::string_view field, std::size_t width) const {
  const char* behind = field.data() + width;
  if (field.front() != ' ') return false;
  return behind < record_.data() + record_.size() ? *behind == ' ' : source_.beyond().empty();
}

void FormattedRead::look_at_ends(const FieldValue& value, std::size_t start, std::size_t width, int index) {
  const std::string_view field = value.text;
  const std::size_t end = start + width;
  const char next = field.size() < width ? ' ' : end < record_.size() ? record_[end] : first_beyond(end);
  const bool begins = field.front() != ' ';
  const char before = begins && start > 0 ? record_[start - 1] : ' ';
  const char behind = value.blank || field.back() != ' ' ? next : ' ';
  const bool lone = begins && width > 1 && (field.size() == 1 || field[1] == ' ');
  if (before == ' ' && behind == ' ' && !lone) return;
  seams_->push_back(
      {index, static_cast<std::uint32_t>(start), static_cast<std::uint32_t>(width), before, behind, lone});
}

void FormattedRead::take_field(const FormatStep& step, FieldKind kind, int text_length, FieldValue& value,
                               FieldResult& result) {
  const std::size_t start = position_;
  const std::size_t left = start < record_.size() ? record_.size() - start : 0;
  std::size_t width = static_cast<std::size_t>(step.width);
  if (width == 0) width = text_length > 0 ? static_cast<std::size_t>(text_length) : left;
  bool comma = false;
  std::string_view field = cut_field(width, kind != FieldKind::text, comma);

  value.text = field;
  value.line = source_.line();
  value.kind = kind;
  if (!field.empty()) {
    const std::size_t offset = static_cast<std::size_t>(source_.skipped()) + start;
    value.first_column = stored_column(offset + 1);
    value.last_column = stored_column(offset + field.size());
  }
  switch (kind) {
    case FieldKind::integer:
      result = read_integer_field(field, blanks_);
      break;
    case FieldKind::real:
      result = read_real_field(field, {step.decimals, scale_, blanks_});
      break;
    case FieldKind::logical:
      result = read_logical_field(field);
      break;
    case FieldKind::text:
      result.blank = field.find_first_not_of(' ') == std::string_view::npos;
      break;
  }
  if (kind == FieldKind::text && text_length > 0 && width > static_cast<std::size_t>(text_length)) {
    const std::size_t drop = std::min(field.size(), width - static_cast<std::size_t>(text_length));
    value.text.remove_prefix(drop);
  }
  value.number = result.value;
  value.blank = result.blank;
  if (comma) result.hints |= hint_comma;
  const bool zeros = blanks_ == BlankMode::zero && kind != FieldKind::text && kind != FieldKind::logical;
  if (!zeros) result.hints = static_cast<std::uint16_t>(result.hints & ~hint_trailing_blank);
  if (zeros && !comma && !result.blank && field.size() < width) result.hints |= hint_cut;
}

ReadEnd FormattedRead::read(FieldKind kind, std::vector<FieldValue>& values, std::vector<FieldFlaw>& flaws,
                            int text_length) {
  for (;;) {
    const FormatStep& step = walker_.next();
    if (is_data(step.edit)) {
      if (!edit_fits(step.edit, kind)) return ReadEnd::wrong_edit;
      const std::size_t left = position_ < record_.size() ? record_.size() - position_ : 0;
      const auto width = static_cast<std::size_t>(step.width);
      if (!source_.rules().pad && left < width &&
          record_.substr(record_.size() - left).find(',') == std::string::npos)
        return ReadEnd::end_of_record;
      FieldResult result;
      const std::size_t start = position_;
      FieldValue& value = values.emplace_back();
      take_field(step, kind, text_length, value, result);
      if (seams_ && !value.text.empty()) {
        const std::size_t columns = width > 0 ? width : value.text.size();
        if (!stands_apart(value.text, columns) && !(result.hints & hint_comma))
          look_at_ends(value, start, columns, static_cast<int>(values.size()) - 1);
      }
      if (result.fault != FieldFault::none || result.hints != hint_none)
        flaws.push_back({static_cast<int>(values.size()) - 1, result.fault, result.hints, result.at});
      return ReadEnd::complete;
    }
    if (step.edit != Edit::end) {
      if (const ReadEnd end = control(step); end != ReadEnd::complete) return end;
      continue;
    }
    if (!format_.reversion_has_data) return ReadEnd::format_exhausted;
    walker_.revert();
    if (const ReadEnd end = new_record(); end != ReadEnd::complete) return end;
  }
}

ReadEnd FormattedRead::finish() {
  for (;;) {
    const FormatStep& step = walker_.next();
    if (is_data(step.edit) || step.edit == Edit::stop || step.edit == Edit::end) return ReadEnd::complete;
    if (const ReadEnd end = control(step); end != ReadEnd::complete) return end;
  }
}

}  // namespace sage

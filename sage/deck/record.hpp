// Reads values from records under a FORMAT or list-directed, as one Fortran READ statement would.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sage/deck/deck.hpp"
#include "sage/deck/field.hpp"
#include "sage/deck/format.hpp"
#include "sage/deck/source.hpp"

namespace sage {

// A column as positions hold it: the largest stands for all beyond.
inline std::uint16_t stored_column(std::size_t c) {
  return static_cast<std::uint16_t>(std::min<std::size_t>(c, std::numeric_limits<std::uint16_t>::max()));
}

// Where records begin and end, and which lines are none.
struct RecordRules {
  char comment = '\0';    // lines that start with it are skipped; '\0' = no comments
  int skip_columns = 0;   // characters before the record proper: a card's name and the separator
  std::string separator;  // ends those characters; lines without it there are records as a whole
  int record_length = 0;  // columns beyond are not read; 0 = no limit
  bool pad = true;        // short records read as if blanks followed
  BlankMode blanks = BlankMode::null;
};

// The lines of a text, one after the other.
class RecordSource {
 public:
  RecordSource(const SourceText& source, RecordRules rules) : source_(&source), rules_(std::move(rules)) {}

  bool next();          // moves to the next record; false at the end of the file
  bool at_end() const;  // no record is left (comments don't count)
  int line() const { return line_; }
  std::string_view record() const { return record_; }
  // Characters of the line before the record, and whether the line goes on beyond it.
  int skipped() const { return skipped_; }
  std::string_view beyond() const { return beyond_; }
  // The record that `next` would give, without moving; empty at the end.
  std::string_view peek_line() const;
  int next_line() const { return skip_comments(line_ + 1); }
  const RecordRules& rules() const { return rules_; }
  const SourceText& source() const { return *source_; }
  // Goes back so that `next` gives this line again.
  void rewind_to(int line) { line_ = line - 1; }
  // This line reads as `text`, which must outlive the source; one line at a time.
  void replace(int line, std::string_view text) {
    replaced_line_ = line;
    replacement_ = text;
  }
  int replaced_line() const { return replaced_line_; }

 private:
  int skip_comments(int line) const;
  const SourceText* source_;
  RecordRules rules_;
  int line_ = 0;
  std::string_view record_, beyond_;
  int skipped_ = 0;
  int replaced_line_ = 0;  // 0 = none
  std::string_view replacement_;
};

inline bool edit_fits(Edit edit, FieldKind kind) {
  switch (kind) {
    case FieldKind::integer:
      return edit == Edit::integer || edit == Edit::general;
    case FieldKind::real:
      return edit == Edit::real || edit == Edit::general;
    case FieldKind::logical:
      return edit == Edit::logical || edit == Edit::general;
    case FieldKind::text:
      return edit == Edit::text || edit == Edit::general;
  }
  return false;
}

// What was wrong or odd about one value.
struct FieldFlaw {
  int value = 0;  // index into the values read by this statement
  FieldFault fault = FieldFault::none;
  std::uint16_t hints = hint_none;
  std::uint16_t at = 0;
};

// A field whose characters touch those beside it, or that begins with a lone character: a number that the end
// of its field cuts looks like this, and so do full fields side by side.
struct Seam {
  int value = 0;            // index into the values read
  std::uint32_t start = 0;  // first column of the field in its record, 0-based
  std::uint32_t width = 0;  // columns that the FORMAT gives it
  char before = ' ';        // the character before the field, where the field's first is no blank
  char behind = ' ';        // the character behind the field, where the field's last is no blank or all are
  bool lone = false;        // one character in the first of several columns, and a blank or nothing behind it
  bool whole = false;       // set by find_slip: what begins in this field ends where a field ends
};

enum class ReadEnd : std::uint8_t {
  complete,
  end_of_file,
  end_of_record,
  wrong_edit,
  format_exhausted,
  ended_by_slash
};

// One READ statement: begin, as many values as wanted, finish.
class FormattedRead {
 public:
  // `seams`: collects the fields that touch others; nullptr = nobody asks.
  FormattedRead(RecordSource& source, const Format& format, std::vector<Seam>* seams = nullptr)
      : source_(source), walker_(format), format_(format), seams_(seams), blanks_(source.rules().blanks) {}

  ReadEnd begin() { return new_record(); }
  // Appends one value.  text_length: characters that the variable holds, for A without a
  // width (0 = rest of record).
  ReadEnd read(FieldKind kind, std::vector<FieldValue>& values, std::vector<FieldFlaw>& flaws,
               int text_length = 0);
  // Format control after the last value: trailing slashes, then the rest of the record is passed over.
  ReadEnd finish();
  std::size_t position() const { return position_; }  // columns of the present record used so far
  // First column after the last field read from the present record, 0-based.
  std::size_t last_field_end() const { return last_field_end_; }

 private:
  ReadEnd new_record();
  ReadEnd control(const FormatStep& step);
  void take_field(const FormatStep& step, FieldKind kind, int text_length, FieldValue& value,
                  FieldResult& result);
  std::string_view cut_field(std::size_t width, bool numeric, bool& comma);
  char first_beyond(std::size_t end) const;
  bool stands_apart(std::string_view field, std::size_t width) const;
  void look_at_ends(const FieldValue& value, std::size_t start, std::size_t width, int index);

  RecordSource& source_;
  FormatWalker walker_;
  const Format& format_;
  std::vector<Seam>* seams_;
  std::string_view record_;
  std::size_t position_ = 0;
  std::size_t last_field_end_ = 0;
  int scale_ = 0;
  BlankMode blanks_;
  bool has_comma_ = false;  // the record holds one
};

// READ(unit, *): values between separators, over as many records as it takes.
class ListRead {
 public:
  // `texts` keeps strings whose quotes had to be undoubled; it must outlive the values.
  ListRead(RecordSource& source, std::deque<std::string>& texts) : source_(source), texts_(texts) {}

  ReadEnd begin();
  ReadEnd read(FieldKind kind, std::vector<FieldValue>& values, std::vector<FieldFlaw>& flaws);
  ReadEnd finish() { return ReadEnd::complete; }
  std::size_t position() const { return position_; }
  bool ended_by_slash() const { return slash_; }
  // What stands behind the last value in its record; the READ passes over it.
  std::string_view rest() const { return record_.substr(std::min(position_, record_.size())); }

 private:
  struct Token {
    std::string_view text;
    std::size_t first = 0;  // column, 0-based
    bool quoted = false;
    bool null = false;
  };
  ReadEnd next_token(FieldKind kind, Token& token, FieldResult& result);
  bool skip_to_value();
  void skip_separator();
  bool take_repeat_count(FieldResult& result);
  ReadEnd take_quoted(Token& token);
  void take_word(Token& token);
  FieldResult convert(const Token& token, FieldKind kind) const;
  char current() const { return position_ < record_.size() ? record_[position_] : '\n'; }

  RecordSource& source_;
  std::deque<std::string>& texts_;
  std::string_view record_;
  std::size_t position_ = 0;
  bool slash_ = false;
  bool comma_ = false;  // a comma closed the value before
  Token token_;         // the present value, for repeats
  FieldKind token_kind_ = FieldKind::real;
  int line_of_token_ = 0;
  int repeats_ = 0;  // further values that the token stands for
};

}  // namespace sage

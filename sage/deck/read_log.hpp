// Collects what reading a deck has to say: shows the first of each kind, counts the rest.
#pragma once

#include <string>

#include "sage/deck/read_deck.hpp"
#include "sage/deck/record.hpp"

namespace sage {

class ReadLog {
 public:
  ReadLog(Deck& deck, const ReadOptions& options) : deck_(deck), options_(options) {}

  void add(Severity severity, Code code, const SourcePosition& where, const std::string& message,
           const std::string& hint = {});
  // Attaches "note: ..." to the last diagnostic shown; nothing if that one was only counted.
  void add_hint(const std::string& hint);

  // A value that can't be read, or reads in a way that its author may not have meant.
  void flaw(const CardRule& card, const FieldSpec& field, const FieldValue& value, const FieldFlaw& flaw);

  int errors() const { return errors_; }
  SourcePosition where(const FieldValue& value) const {
    return {deck_.file, value.line, value.first_column, value.last_column};
  }
  SourcePosition line(int number) const { return {deck_.file, number, 0, 0}; }

  // "and 12 more errors"; throws InputError if there was an error.
  void finish();

 private:
  void hints(const CardRule& card, const FieldSpec& field, const FieldValue& value, unsigned hints);

  Deck& deck_;
  ReadOptions options_;
  int errors_ = 0, warnings_ = 0, notes_ = 0;
  bool last_shown_ = false;
  std::vector<Diagnostic> list_;
};

// "node card"; of a label that says so itself, "master card", no more than that.
std::string card_text(const std::string& label);
// "(material card, friction angle, degrees)".
std::string field_text(const CardRule& card, const FieldSpec& field);
// "\"1.2.3\"": at most 40 characters, control characters shown as "?".
std::string quoted(std::string_view text);

}  // namespace sage

#include "sage/core/error.hpp"

#include <utility>

namespace sage {

namespace {

std::string first_message(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) return to_string(d);
  return "input error";
}

Diagnostics single(SourcePosition where, const std::string& message) {
  Diagnostics diagnostics;
  diagnostics.error(std::move(where), message);
  return diagnostics;
}

const char* severity_text(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "error";
}

}  // namespace

std::string to_string(const SourcePosition& where) {
  std::string text = where.file;
  if (where.line > 0) text += ":" + std::to_string(where.line);
  if (where.line > 0 && where.first_column > 0) {
    text += ":" + std::to_string(where.first_column);
    if (where.last_column > where.first_column) text += "-" + std::to_string(where.last_column);
  }
  return text;
}

std::string to_string(const Diagnostic& diagnostic) {
  std::string text = to_string(diagnostic.where);
  if (!text.empty()) text += ": ";
  text += severity_text(diagnostic.severity);
  text += ": " + diagnostic.message;
  for (const std::string& line : diagnostic.detail) text += "\n" + line;
  return text;
}

void Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  if (diagnostic.severity == Severity::warning) ++warnings_;
  list_.push_back(std::move(diagnostic));
}

void Diagnostics::error(SourcePosition where, std::string message) {
  add({Severity::error, std::move(where), std::move(message), {}});
}

void Diagnostics::warning(SourcePosition where, std::string message) {
  add({Severity::warning, std::move(where), std::move(message), {}});
}

void Diagnostics::note(SourcePosition where, std::string message) {
  add({Severity::note, std::move(where), std::move(message), {}});
}

InputError::InputError(Diagnostics diagnostics)
    : std::runtime_error(first_message(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputError::InputError(SourcePosition where, const std::string& message)
    : InputError(single(std::move(where), message)) {}

}  // namespace sage

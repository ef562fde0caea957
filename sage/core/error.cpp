#include "sage/core/error.hpp"

#include <algorithm>
#include <utility>

namespace sage {

namespace {

std::string first_message(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) return to_string(d);
  return "input error";
}

Diagnostics single(Code code, SourcePosition where, const std::string& message) {
  Diagnostics diagnostics;
  diagnostics.error(code, std::move(where), message);
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

std::string to_string(Code code) {
  return code.given() ? "S" + std::to_string(code.number()) : std::string();
}

std::string with_code(const std::string& message, Code code) {
  if (!code.given()) return message;
  const std::size_t end = std::min(message.find('\n'), message.size());
  return message.substr(0, end) + " [" + to_string(code) + "]" + message.substr(end);
}

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
  text += ": " + with_code(diagnostic.message, diagnostic.code);
  for (const std::string& line : diagnostic.detail) text += "\n" + line;
  return text;
}

void Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  if (diagnostic.severity == Severity::warning) ++warnings_;
  list_.push_back(std::move(diagnostic));
}

void Diagnostics::error(Code code, SourcePosition where, std::string message) {
  add({Severity::error, code, std::move(where), std::move(message), {}});
}

void Diagnostics::warning(Code code, SourcePosition where, std::string message) {
  add({Severity::warning, code, std::move(where), std::move(message), {}});
}

void Diagnostics::note(Code code, SourcePosition where, std::string message) {
  add({Severity::note, code, std::move(where), std::move(message), {}});
}

InputError::InputError(Diagnostics diagnostics)
    : std::runtime_error(first_message(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputError::InputError(Code code, SourcePosition where, const std::string& message)
    : InputError(single(code, std::move(where), message)) {}

std::string message_of(const std::exception& error) {
  const auto* coded = dynamic_cast<const CodedError*>(&error);
  return with_code(error.what(), coded != nullptr ? coded->code() : Code());
}

}  // namespace sage

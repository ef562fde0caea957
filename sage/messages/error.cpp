#include "sage/messages/error.hpp"

#include <algorithm>
#include <new>
#include <string_view>
#include <tuple>
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
  return "S" + std::to_string(code.number());
}

std::string with_code(const std::string& message, Code code) {
  if (code_in(message)) return message;
  const std::size_t end = std::min(message.find('\n'), message.size());
  return message.substr(0, end) + " [" + to_string(code) + "]" + message.substr(end);
}

std::optional<Code> code_in(const std::string& message) {
  const std::string line = message.substr(0, message.find('\n'));
  constexpr std::size_t kSize = std::string_view(" [S104]").size();
  if (line.size() < kSize) return {};
  const std::string_view end = std::string_view(line).substr(line.size() - kSize);
  const std::string_view digits = end.substr(3, 3);
  if (!end.starts_with(" [S") || !end.ends_with(']') || digits[0] == '0') return {};
  if (!std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; })) return {};
  return Code(static_cast<short>(100 * (digits[0] - '0') + 10 * (digits[1] - '0') + (digits[2] - '0')));
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

namespace {

constexpr std::size_t kLast = 16;  // so many are looked through for the same

// One field of a model file stands for many cards, such as a fixity along a line, whose mistake is one: it counts each
// time, and is listed once.
bool is_same(const Diagnostic& one, const Diagnostic& other) {
  const auto place = [](const SourcePosition& at) {
    return std::tie(at.line, at.first_column, at.last_column, at.file);
  };
  return one.where.line > 0 && one.severity == other.severity && place(one.where) == place(other.where) &&
         one.code == other.code && one.message == other.message;
}

}  // namespace

void Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  if (diagnostic.severity == Severity::warning) ++warnings_;
  if (std::any_of(list_.end() - static_cast<std::ptrdiff_t>(std::min(kLast, list_.size())), list_.end(),
                  [&](const Diagnostic& other) { return is_same(diagnostic, other); }))
    return;
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

Code code_of(const std::exception& error) {
  if (const auto* coded = dynamic_cast<const CodedError*>(&error)) return coded->code();
  const bool memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                      dynamic_cast<const std::length_error*>(&error) != nullptr;
  return memory ? Code("S508") : Code("S513");
}

std::string message_of(const std::exception& error) {
  return with_code(error.what(), code_of(error));
}

}  // namespace sage

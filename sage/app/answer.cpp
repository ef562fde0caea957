#include "sage/app/answer.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "sage/app/exit_codes.hpp"
#include "sage/app/screen.hpp"
#include "sage/deck/text.hpp"

namespace sage::app {

namespace {

struct Gathered {
  Json result = Json::object();
  Json messages = Json::array();
};

Gathered& gathered() {
  static Gathered all;
  return all;
}

const char* severity_word(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

Json number_or_null(int value) {
  return value > 0 ? Json(value) : Json(nullptr);
}

Json message_json(const Diagnostic& message) {
  const SourcePosition& where = message.where;
  return {{"severity", severity_word(message.severity)},
          {"code", to_string(message.code)},
          {"message", json_text(message.message)},
          {"where", json_text(where.file)},
          {"line", number_or_null(where.line)},
          {"first_column", number_or_null(where.first_column)},
          {"last_column", number_or_null(where.last_column)},
          {"detail", json_list(message.detail)}};
}

// Pointers (RFC 6901) to the numbers that are none; those become null.
void name_not_finite(Json& value, const std::string& at, Json& names) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    const double number = value.get<double>();
    names.push_back({{"at", at}, {"value", std::isnan(number) ? "nan" : number > 0.0 ? "inf" : "-inf"}});
    value = nullptr;
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      name_not_finite(value[i], at + '/' + std::to_string(i), names);
  } else if (value.is_object()) {
    for (auto& [key, member] : value.items()) {
      std::string escaped;
      for (const char c : key) escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
      name_not_finite(member, at + '/' + escaped, names);
    }
  }
}

}  // namespace

Json* answer() {
  return screen().json ? &gathered().result : nullptr;
}

void keep_message(const Diagnostic& message) {
  if (screen().json) gathered().messages.push_back(message_json(message));
}

std::string json_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0, end = 0; at <= text.size(); at = end + 1) {  // line ends stay
    end = std::min(text.find('\n', at), text.size());
    out += well_formed(text.substr(at, end - at)).text;
    if (end < text.size()) out += '\n';
  }
  return out;
}

Json json_list(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(json_text(text));
  return list;
}

void answer_file(const std::filesystem::path& path) {
  if (Json* json = answer()) (*json)["files"].push_back(json_text(path.string()));
}

std::string answer_text(const std::string& command, int exit_code) {
  Json names = Json::array();
  Json document = {{"sagefe", SAGE_VERSION},        {"version", kAnswerVersion},
                   {"command", json_text(command)}, {"status", exit_word(exit_code)},
                   {"exit_code", exit_code},        {"messages", gathered().messages},
                   {"result", gathered().result},   {"not_finite", Json::array()}};
  name_not_finite(document["result"], "/result", names);
  document["not_finite"] = std::move(names);
  return document.dump(1) + '\n';
}

void begin_answer_part() {
  gathered() = {};
}

// In a binary form: a number that is none stays what it is.
std::string answer_part_text() {
  std::string text;
  Json::to_cbor(Json{{"messages", gathered().messages}, {"result", gathered().result}}, text);
  return text;
}

Json take_answer_part(const std::string& text) {
  const Json part = Json::from_cbor(text, true, false);
  if (part.is_discarded()) return nullptr;  // the worker did not come so far
  for (const Json& message : part["messages"]) gathered().messages.push_back(message);
  return part["result"];
}

const char* exit_word(int exit_code) {
  switch (exit_code) {
    case kOk:
      return "ok";
    case kUsage:
      return "usage";
    case kInput:
      return "input";
    case kNotConverged:
      return "not_converged";
    case kOutput:
      return "output";
    default:
      return "interrupted";
  }
}

}  // namespace sage::app

// What a command answers with --json: gathered while it works, printed as one document at its end
// (docs/manual/json.md, docs/schema/sagefe.schema.json).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sage/messages/error.hpp"

namespace sage::app {

using Json = nlohmann::ordered_json;

// Of the schema; it rises when a member changes its meaning or goes, not when one is added.
inline constexpr int kAnswerVersion = 1;

// The member "result" of the document, for a command to fill; null without --json.
Json* answer();

// Remembers a message for the document; does nothing without --json.
void keep_message(const Diagnostic& message);

// Text for a document: valid UTF-8.
std::string json_text(std::string_view text);
Json json_list(const std::vector<std::string>& texts);
// A file that the command has written, added to "files" of its answer; does nothing without --json.
void answer_file(const std::filesystem::path& path);

// The whole document, as text.  Numbers that are none become null, and "not_finite" says where.
std::string answer_text(const std::string& command, int exit_code);

// What a worker process has gathered, and its way into the document of the process that began it: gives its result.
void begin_answer_part();
std::string answer_part_text();
Json take_answer_part(const std::string& text);

// "ok", "usage", "input", "not_converged", "output" or "interrupted".
const char* exit_word(int exit_code);

}  // namespace sage::app

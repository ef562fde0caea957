#include "sage/deck/source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include "sage/deck/text.hpp"
#include "sage/messages/error.hpp"

namespace sage {

namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// Lines end with LF, CR LF or CR alone; the last may have no end.
std::vector<std::uint32_t> find_lines(std::string_view text) {
  std::vector<std::uint32_t> starts;
  starts.reserve(text.size() / 40 + 1);
  const bool any_cr = text.find('\r') != std::string_view::npos;
  std::size_t at = 0;
  while (at < text.size()) {
    starts.push_back(static_cast<std::uint32_t>(at));
    const std::size_t end = any_cr ? text.find_first_of("\r\n", at) : text.find('\n', at);
    if (end == std::string_view::npos) break;
    at = end + (text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n' ? 2 : 1);
  }
  return starts;
}

// A file of another kind, by its first bytes; nullptr = none that is known.
const char* known_kind(std::string_view text) {
  constexpr std::pair<std::string_view, const char*> kStarts[] = {
      {"%PDF-", "a PDF document"},
      {"%!PS", "a PostScript document"},
      {"{\\rtf", "an RTF document"},
      {"PK\x03\x04", "a ZIP archive (or a document of an office program)"},
      {"\xd0\xcf\x11\xe0", "a document of an office program"},
      {"\x1f\x8b", "compressed by gzip"},
      {"\xfd"
       "7zXZ",
       "compressed by xz"},
      {"\x28\xb5\x2f\xfd", "compressed by zstd"},
      {"\x89PNG", "a PNG picture"},
      {"\xff\xd8\xff", "a JPEG picture"},
  };
  for (const auto& [start, kind] : kStarts)
    if (text.substr(0, start.size()) == start) return kind;
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::string begin = lower_case(text.substr(0, 16));
  for (const char* tag : {"<!doctype html", "<html", "<head", "<body"})
    if (begin.rfind(tag, 0) == 0) return "an HTML page";
  if (begin.rfind("<?xml", 0) == 0 || begin.rfind("<svg", 0) == 0) return "an XML file";
  return nullptr;
}

// A stray control character happens to decks; compressed data has one in ten.
bool mostly_text(std::string_view text) {
  const auto odd = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 32 &&
            std::string_view("\t\n\r\f\x1a").find(c) == std::string_view::npos) ||
           c == '\x7f';
  });
  return odd < 3 || static_cast<double>(odd) < 0.02 * static_cast<double>(text.size());
}

}  // namespace

SourceText::SourceText(std::string text, std::string name)
    : name_(std::move(name)),
      text_(std::make_shared<const std::string>(std::move(text))),
      starts_(std::make_shared<const std::vector<std::uint32_t>>(find_lines(*text_))) {}

std::string_view SourceText::line(int number) const {
  if (number < 1 || number > line_count()) return {};
  const auto index = static_cast<std::size_t>(number);
  const char* begin = text_->data() + (*starts_)[index - 1];
  const char* end = text_->data() + (index < starts_->size() ? (*starts_)[index] : text_->size());
  if (end > begin && end[-1] == '\n') --end;
  if (end > begin && end[-1] == '\r') --end;
  return {begin, static_cast<std::size_t>(end - begin)};
}

namespace {

// What has no stated size (a pipe, a device) may have no end either.
constexpr std::size_t most_of_a_stream = std::size_t{256} << 20;
constexpr auto most_of_a_file = static_cast<std::size_t>(std::numeric_limits<int>::max());

// Bytes that may come; throws for a file that is too large as a whole.
std::size_t readable_bytes(const std::string& path, std::size_t& stated) {
  std::error_code error;
  stated = 0;
  if (!std::filesystem::is_regular_file(path, error)) return most_of_a_stream;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return most_of_a_stream;
  if (size > most_of_a_file) throw InputError("S102", {path, 0, 0, 0}, "the file is larger than 2 GiB");
  stated = static_cast<std::size_t>(size);
  return std::max(stated, most_of_a_stream);
}

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError("S101", {path, 0, 0, 0}, "is a directory, not a file");
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError("S101", {path, 0, 0, 0}, std::string("can't be opened: ") + std::strerror(errno));
  std::string text;
  std::size_t stated = 0;
  const std::size_t most = readable_bytes(path, stated);
  std::size_t room = stated > 0 ? stated + 1 : 65536;
  for (;;) {
    const std::size_t have = text.size();
    text.resize(have + room);
    const std::size_t got = std::fread(text.data() + have, 1, room, file.get());
    text.resize(have + got);
    if (got < room) break;
    if (text.size() > most)
      throw InputError("S102", {path, 0, 0, 0},
                       "gives more than " + std::to_string(most >> 20) +
                           " MiB without an end: a deck or a layout is a file");
    room = text.size();
  }
  if (std::ferror(file.get()))
    throw InputError("S101", {path, 0, 0, 0}, std::string("can't be read: ") + std::strerror(errno));
  return text;
}

void check_is_text(std::string_view text, const std::string& name) {
  if (text.empty()) throw InputError("S103", {name, 0, 0, 0}, "the file is empty");
  if (text.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError("S102", {name, 0, 0, 0}, "the file is larger than 2 GiB");
  if (text.find_first_not_of(" \t\r\n\x1a") == std::string_view::npos)
    throw InputError("S103", {name, 0, 0, 0}, "the file holds nothing but blanks");
  if (const char* kind = known_kind(text))
    throw InputError("S104", {name, 0, 0, 0},
                     "the file is " + std::string(kind) + ", not a deck of cards: a deck is plain text");
  const std::size_t nul = text.find('\0');
  if (nul == std::string_view::npos) {
    if (!mostly_text(text.substr(0, 65536)))
      throw InputError("S104", {name, 0, 0, 0},
                       "the file is binary (full of control characters), not a deck of cards");
    return;
  }
  const bool wide = text.size() > 1 && (text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff");
  throw InputError("S104", {name, 0, 0, 0},
                   wide ? "the file is UTF-16 text: save it as plain ASCII or UTF-8"
                        : "the file is binary (a NUL character at byte " + std::to_string(nul + 1) +
                              "), not a deck of cards");
}

}  // namespace sage

#include "sage/sweep/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>

#include "sage/messages/error.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/platform/checksum.hpp"

namespace sage::sweep {

namespace {

// key, status, warnings, values as bits, reason; then the sum of it all.
std::string line_of(CaseKey key, const CaseOutcome& outcome) {
  std::string text = fmt::format("{:016x}\t{}\t{}\t", key, outcome.status, outcome.warnings);
  for (const double value : outcome.values)
    text += fmt::format("{:016x} ", std::bit_cast<std::uint64_t>(value));
  text += '\t' + outcome.reason;
  return text + fmt::format("\t{:016x}\n", checksum(text));
}

std::uint64_t hex(std::string_view text) {
  std::uint64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return value;
}

}  // namespace

Journal::Journal(std::filesystem::path folder, std::string stem, int part)
    : folder_(std::move(folder)), stem_(std::move(stem)) {
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  file_ = folder_ / fmt::format("{}.cases.{}", stem_, part);
  read_all();
  descriptor_ = open(file_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw OutputError("S601", file_.string() + ": " + std::generic_category().message(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw InputError("S738", {file_.string(), 0, 0, 0}, "another sweep works on this study in the same folder");
  // What a kill cut off must not run into the next line.
  if (lseek(descriptor_, 0, SEEK_END) > 0 && write(descriptor_, "\n", 1) != 1)
    throw OutputError("S601", file_.string() + ": " + std::generic_category().message(errno));
}

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

void Journal::read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    const std::size_t end = line.rfind('\t');
    if (end == std::string::npos) continue;
    const std::string text = line.substr(0, end);
    if (line.substr(end + 1) != fmt::format("{:016x}", checksum(text))) continue;
    const std::vector<std::string_view> parts = split_at('\t', text);
    constexpr std::size_t kParts = 5;
    if (parts.size() != kParts) continue;
    CaseOutcome outcome{std::string(parts[1]), {}, std::string(parts[2]), std::string(parts[4])};
    std::istringstream values{std::string(parts[3])};
    for (std::string value; values >> value;) outcome.values.push_back(std::bit_cast<double>(hex(value)));
    known_.insert_or_assign(hex(parts[0]), std::move(outcome));
  }
}

void Journal::read_all() {
  const std::lock_guard<std::mutex> held(lock_);
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored))
    if (entry.path().filename().string().starts_with(stem_ + ".cases.")) read(entry.path());
}

const CaseOutcome* Journal::find(CaseKey key) const {
  const std::lock_guard<std::mutex> held(lock_);
  const auto found = known_.find(key);
  return found == known_.end() ? nullptr : &found->second;
}

void Journal::add(CaseKey key, const CaseOutcome& outcome) {
  const std::string line = line_of(key, outcome);
  const std::lock_guard<std::mutex> held(lock_);
  const ssize_t written = write(descriptor_, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size()))
    throw OutputError("S601", file_.string() + ": " +
                                  (written < 0 ? std::generic_category().message(errno) : "the disk is full"));
  known_.insert_or_assign(key, outcome);
}

}  // namespace sage::sweep

#include "sage/app/checkpoint.hpp"

#include <fstream>
#include <iterator>

#include "sage/core/archive.hpp"
#include "sage/output/out_file.hpp"

namespace sage::app {

namespace {

constexpr std::string_view kFirstLine = "sagefe restart 1\n";

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path file, double seconds, std::string belongs_to)
    : file_(std::move(file)), seconds_(seconds), belongs_to_(std::move(belongs_to)) {}

bool Checkpoint::due() const {
  if (seconds_ < 0.0) return false;
  return std::chrono::steady_clock::now() - last_ >= std::chrono::duration<double>(seconds_);
}

void Checkpoint::save(const std::string& state) {
  Archive archive;
  std::string belongs_to = belongs_to_, body = state;
  archive(belongs_to);
  archive(body);
  std::uint64_t sum = checksum(archive.bytes());
  archive(sum);
  write_file(file_, std::string(kFirstLine) + archive.bytes());
  last_ = std::chrono::steady_clock::now();
}

std::optional<std::string> Checkpoint::load() const {
  std::ifstream in(file_, std::ios::binary);
  if (!in) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const SourcePosition where{file_.string(), 0, 0, 0};
  if (!text.starts_with(kFirstLine)) throw InputError(where, "is not a checkpoint of this program");
  Archive archive(text.substr(kFirstLine.size()));
  std::string belongs_to, state;
  std::uint64_t sum = 0;
  try {
    archive(belongs_to);
    archive(state);
    archive(sum);
  } catch (const InputError&) {
    throw InputError(where, "is damaged (cut short); run again without --restart");
  }
  if (sum != checksum(std::string_view(archive.bytes()).substr(0, archive.bytes().size() - sizeof sum)))
    throw InputError(where, "is damaged; run again without --restart");
  if (belongs_to != belongs_to_)
    throw InputError(
        where,
        "belongs to another run: the deck, the options or the program have changed since; run again "
        "without --restart");
  return state;
}

void Checkpoint::remove() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace sage::app

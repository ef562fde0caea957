#include "sage/app/checkpoint.hpp"

#include <fstream>
#include <iterator>
#include <vector>

#include "sage/core/archive.hpp"
#include "sage/output/out_file.hpp"

namespace sage::app {

namespace {

constexpr std::string_view kFirstLine = "sagefe restart 2\n";

// A result file that is not complete yet.
struct PartialResult {
  std::string name;  // that it is going to have; with its folder where that is not the checkpoint's
  std::uint64_t bytes = 0;
};

std::vector<PartialResult> partial_results(const std::filesystem::path& checkpoint,
                                           const std::vector<std::filesystem::path>& unfinished) {
  std::vector<PartialResult> results;
  for (const std::filesystem::path& file : unfinished) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file.string() + ".partial", error);
    if (error) continue;  // a pipe
    const bool beside = file.parent_path() == checkpoint.parent_path();
    results.push_back({(beside ? file.filename() : std::filesystem::absolute(file)).string(), bytes});
  }
  return results;
}

void exchange(Archive& archive, std::vector<PartialResult>& results) {
  std::size_t count = results.size();
  archive(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (archive.reading()) results.emplace_back();
    archive(results[i].name);
    archive(results[i].bytes);
  }
}

// What the checkpoint goes on from must be there before anything is opened for writing.  A run that an error
// stopped has ended its files: they bear their final names.
void expect_results(const std::filesystem::path& checkpoint, const std::vector<PartialResult>& results) {
  for (const PartialResult& result : results) {
    const std::filesystem::path file = checkpoint.parent_path() / result.name;
    if (!holds(file.string() + ".partial", result.bytes) && !holds(file, result.bytes))
      throw InputError({checkpoint.string(), 0, 0, 0},
                       "goes on from " + file.string() +
                           ".partial, which is missing or shorter than it was; run again without --restart");
  }
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path file, double seconds, std::string belongs_to)
    : file_(std::move(file)), seconds_(seconds), belongs_to_(std::move(belongs_to)) {}

bool Checkpoint::due() const {
  if (seconds_ < 0.0) return false;
  return std::chrono::steady_clock::now() - last_ >= std::chrono::duration<double>(seconds_);
}

void Checkpoint::save(const std::string& state, const std::vector<std::filesystem::path>& unfinished) {
  Archive archive;
  std::string belongs_to = belongs_to_, body = state;
  std::vector<PartialResult> results = partial_results(file_, unfinished);
  archive(belongs_to);
  exchange(archive, results);
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
  std::vector<PartialResult> results;
  std::uint64_t sum = 0;
  try {
    archive(belongs_to);
    exchange(archive, results);
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
  expect_results(file_, results);
  return state;
}

void Checkpoint::remove() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace sage::app

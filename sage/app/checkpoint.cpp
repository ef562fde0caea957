#include "sage/app/checkpoint.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

#include "sage/core/archive.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

constexpr std::string_view kFirstLine = "sagefe restart 5\n";

// What a checkpoint means depends on every line of the program: its build is identified by its own file.
std::uint64_t build_identity() {
  static const std::optional<Checksum> program = checksum_of("/proc/self/exe");
  if (!program) throw OutputError("S631", "a checkpoint can't name this build: /proc/self/exe can't be read");
  return program->value();
}

void exchange(Archive& archive, std::map<std::string, ResultFile>& files) {
  std::size_t count = files.size();
  archive(count);
  auto at = files.begin();
  for (std::size_t i = 0; i < count; ++i) {
    std::string name = archive.reading() ? "" : at->first;
    ResultFile file = archive.reading() ? ResultFile{} : (at++)->second;
    archive(name);
    archive(file.sum);
    archive(file.complete);
    if (archive.reading()) files[name] = file;
  }
}

// What the checkpoint goes on from must be there before anything is opened for writing.  A run that an error
// stopped has ended its files: they bear their final names.
void expect_results(const std::filesystem::path& checkpoint, const ResultFiles& results,
                    const std::map<std::string, ResultFile>& files) {
  for (const auto& [name, file] : files) {
    const std::filesystem::path path = results.path_of(name), partial = path.string() + ".partial";
    std::error_code error;
    if (file.complete) {
      if (std::filesystem::file_size(path, error) == file.sum.bytes() && begins_with(path, file.sum)) continue;
      throw InputError("S630", {checkpoint.string(), 0, 0, 0},
                       "builds on " + path.string() +
                           ", which is missing or has been changed since; run again without --restart");
    }
    const bool half = begins_with(partial, file.sum);
    if (!half && !begins_with(path, file.sum))
      throw InputError("S630", {checkpoint.string(), 0, 0, 0},
                       "goes on from " + partial.string() +
                           ", which is missing, shorter than it was, or has been changed since; run again "
                           "without --restart");
    if (!half && results.changed_since(name))
      throw InputError("S630", {checkpoint.string(), 0, 0, 0},
                       "goes on from " + path.string() +
                           ", which has been changed since its run ended; run again without --restart");
  }
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path file, double seconds, std::string belongs_to, std::string kernels,
                       ResultFiles& results)
    : file_(std::move(file)),
      seconds_(seconds),
      belongs_to_(std::move(belongs_to)),
      kernels_(std::move(kernels)),
      earlier_kernels_(kernels_),
      results_(&results) {
  expect_no_input(file_);
  std::error_code ignored;
  if (std::filesystem::is_directory(file_, ignored))
    throw OutputError("S601", "cannot write " + file_.string() +
                                  ", the checkpoint: " + std::generic_category().message(EISDIR));
}

bool Checkpoint::due() const {
  if (seconds_ < 0.0) return false;
  return std::chrono::steady_clock::now() - last_ >= std::chrono::duration<double>(seconds_);
}

// The state of a large scene is hundreds of megabytes: it is written in pieces, not put together with the rest.
void Checkpoint::save(const std::string& state) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  results_->sync();
  Archive archive;  // what stands before the state
  std::uint64_t build = build_identity();
  std::string belongs_to = belongs_to_, kernels = kernels_;
  std::map<std::string, ResultFile> files = results_->files();
  std::size_t size = state.size();
  archive(build);
  archive(belongs_to);
  archive(kernels);
  exchange(archive, files);
  archive(size);  // and the state's bytes: as an archive keeps a text
  Checksum sum;
  sum.add(archive.bytes());
  sum.add(state);
  Archive end;
  std::uint64_t value = sum.value();
  end(value);
  OutFile file(file_);
  file.sync_when_finished();
  file.text() = std::string(kFirstLine) + archive.bytes();
  for (std::size_t at = 0; at < size; at += kPiece) {
    file.text().append(state, at, kPiece);
    file.flush();
  }
  file.text() += end.bytes();
  file.finish();
  used_ = true;
  last_ = std::chrono::steady_clock::now();
}

std::optional<std::string> Checkpoint::load() {
  std::ifstream in(file_, std::ios::binary);
  if (!in) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const SourcePosition where{file_.string(), 0, 0, 0};
  if (!text.starts_with("sagefe restart "))
    throw InputError("S631", where, "is not a checkpoint of this program");
  const char* const other_build =
      "was written by another build of the program; go on with that one, or run again without --restart";
  if (!text.starts_with(kFirstLine)) throw InputError("S630", where, other_build);
  Archive archive(text.substr(kFirstLine.size()));
  std::uint64_t build = 0, sum = 0;
  std::string belongs_to, state;
  std::map<std::string, ResultFile> files;
  try {
    archive(build);
    archive(belongs_to);
    archive(earlier_kernels_);
    exchange(archive, files);
    archive(state);
    archive(sum);
  } catch (const InputError&) {
    throw InputError("S631", where, "is damaged (cut short); run again without --restart");
  }
  if (!archive.at_end() ||
      sum != checksum(std::string_view(archive.bytes()).substr(0, archive.bytes().size() - sizeof sum)))
    throw InputError("S631", where, "is damaged; run again without --restart");
  if (build != build_identity()) throw InputError("S630", where, other_build);
  if (belongs_to != belongs_to_)
    throw InputError("S630", where,
                     "belongs to another run: the deck, the options or a plug-in have changed since; run again "
                     "without --restart");
  expect_results(file_, *results_, files);
  for (const auto& [name, file] : files) {
    const std::filesystem::path partial = results_->path_of(name).string() + ".partial";
    std::error_code ignored;
    if (file.complete || !begins_with(partial, file.sum)) continue;
    if (const std::uintmax_t size = std::filesystem::file_size(partial, ignored); size > file.sum.bytes())
      cut_.push_back({partial, size - file.sum.bytes()});
  }
  results_->restore(files);
  used_ = true;
  return state;
}

void Checkpoint::remove() {
  if (used_) results_->sync();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  const std::filesystem::path half = file_.string() + ".partial";
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(half, ignored)))
    std::filesystem::remove(half, ignored);
}

}  // namespace sage::app

#include "sage/output/out_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "sage/core/error.hpp"

namespace sage {

namespace {

constexpr std::size_t kMuch = 1 << 16;

}  // namespace

OutFile::OutFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (std::filesystem::is_symlink(path_, ignored)) path_ = std::filesystem::weakly_canonical(path_);
  const std::filesystem::file_status status = std::filesystem::status(path_, ignored);
  const bool ordinary = !std::filesystem::exists(status) || std::filesystem::is_regular_file(status) ||
                        std::filesystem::is_directory(status);
  partial_ = path_;
  if (ordinary) partial_ += ".partial";
  file_.reset(std::fopen(partial_.c_str(), "ab"));
  if (!file_ && errno == ENOENT) {
    std::error_code error;
    std::filesystem::create_directories(path_.parent_path(), error);
    if (error) fail(path_.parent_path(), error.value());
    file_.reset(std::fopen(partial_.c_str(), "ab"));
  }
  if (!file_) fail(partial_, errno);
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // text_ is the buffer
  last_write_ = std::chrono::steady_clock::now();
}

OutFile::~OutFile() {
  if (!file_ || text_.empty()) return;
  if (!begun_ && ftruncate(fileno(file_.get()), 0) != 0) return;
  std::fwrite(text_.data(), 1, text_.size(), file_.get());
}

void OutFile::cut_to(std::uint64_t size) {
  const bool cut = ftruncate(fileno(file_.get()), static_cast<off_t>(size)) == 0;
  if (!cut && errno != EINVAL) fail(partial_, errno);  // EINVAL: a pipe or a device
  written_ = size;
  begun_ = true;
}

void OutFile::fail(const std::filesystem::path& path, int error) {
  file_.reset();
  text_.clear();
  throw OutputError("cannot write " + path.string() + ": " + std::generic_category().message(error));
}

void OutFile::write() {
  if (!file_) return;
  if (!begun_) cut_to(0);
  if (text_.empty()) return;
  errno = 0;
  const bool complete = std::fwrite(text_.data(), 1, text_.size(), file_.get()) == text_.size();
  if (!complete) fail(partial_, errno != 0 ? errno : EIO);
  written_ += text_.size();
  text_.clear();
  last_write_ = std::chrono::steady_clock::now();
}

void OutFile::exchange(Archive& archive) {
  bool in_use = open();
  archive(in_use);
  if (in_use != open()) throw InputError({}, "the checkpoint was made with other outputs");
  if (!in_use) return;
  if (!archive.reading()) {
    write();
    archive(written_);
    return;
  }
  std::uint64_t size = 0;
  archive(size);
  std::error_code error;
  if (!holds(partial_, size) && holds(path_, size))  // a run stopped by an error has ended its files
    std::filesystem::copy_file(path_, partial_, std::filesystem::copy_options::overwrite_existing, error);
  if (!holds(partial_, size))
    throw InputError({}, partial_.string() + " is shorter than at the time of the checkpoint");
  text_.clear();
  cut_to(size);
}

void OutFile::checkpoint() {
  constexpr std::chrono::milliseconds kWait(500);
  if (text_.size() > kMuch || std::chrono::steady_clock::now() - last_write_ > kWait) write();
}

void OutFile::finish() {
  if (!file_) return;
  write();
  errno = 0;
  if (std::fclose(file_.release()) != 0) fail(partial_, errno);
  std::error_code error;
  if (partial_ != path_) std::filesystem::rename(partial_, path_, error);
  if (error) fail(path_, error.value());
}

bool holds(const std::filesystem::path& file, std::uint64_t bytes) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  return !error && size >= bytes;
}

std::vector<std::filesystem::path> paths_of_open(std::initializer_list<const OutFile*> files) {
  std::vector<std::filesystem::path> paths;
  for (const OutFile* file : files)
    if (file->open()) paths.push_back(file->path());
  return paths;
}

void write_file(const std::filesystem::path& path, std::string text) {
  OutFile file(path);
  file.text() = std::move(text);
  file.finish();
}

}  // namespace sage

#include "sage/output/out_file.hpp"

#include <cerrno>
#include <system_error>

#include "sage/core/error.hpp"

namespace sage {

namespace {

constexpr std::size_t kMuch = 1 << 18;

}  // namespace

OutFile::OutFile(std::filesystem::path path) : path_(std::move(path)), partial_(path_) {
  partial_ += ".partial";
  file_.reset(std::fopen(partial_.c_str(), "wb"));
  if (!file_ && errno == ENOENT) {
    std::error_code error;
    std::filesystem::create_directories(path_.parent_path(), error);
    if (error) fail(path_.parent_path(), error.value());
    file_.reset(std::fopen(partial_.c_str(), "wb"));
  }
  if (!file_) fail(partial_, errno);
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // text_ is the buffer
  last_write_ = std::chrono::steady_clock::now();
}

OutFile::~OutFile() {
  if (file_ && !text_.empty()) std::fwrite(text_.data(), 1, text_.size(), file_.get());
}

void OutFile::fail(const std::filesystem::path& path, int error) {
  file_.reset();
  text_.clear();
  throw OutputError("cannot write " + path.string() + ": " + std::generic_category().message(error));
}

void OutFile::write() {
  if (!file_ || text_.empty()) return;
  errno = 0;
  const bool complete = std::fwrite(text_.data(), 1, text_.size(), file_.get()) == text_.size();
  if (!complete) fail(partial_, errno != 0 ? errno : EIO);
  text_.clear();
  last_write_ = std::chrono::steady_clock::now();
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
  std::filesystem::rename(partial_, path_, error);
  if (error) fail(path_, error.value());
}

void write_file(const std::filesystem::path& path, std::string text) {
  OutFile file(path);
  file.text() = std::move(text);
  file.finish();
}

}  // namespace sage

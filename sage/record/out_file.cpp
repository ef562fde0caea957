#include "sage/record/out_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

namespace sage {

namespace {

constexpr std::size_t kMuch = 1 << 16;

std::vector<std::filesystem::path>& inputs() {
  static std::vector<std::filesystem::path> list;
  return list;
}

ResultLog*& result_log() {
  static ResultLog* log = nullptr;
  return log;
}

std::string reason_of(int error) {
  return std::generic_category().message(error);
}

int open_waiting_for_signals(const std::filesystem::path& path, int flags) {
  int descriptor = -1;
  do descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  while (descriptor < 0 && errno == EINTR);
  return descriptor;
}

}  // namespace

void keep_input(const std::filesystem::path& file) {
  std::error_code ignored;
  // A pipe or a device can't be lost.
  if (!std::filesystem::is_regular_file(file, ignored)) return;
  const std::filesystem::path path = std::filesystem::absolute(file, ignored);
  if (std::find(inputs().begin(), inputs().end(), path) == inputs().end()) inputs().push_back(path);
}

void expect_no_input(const std::filesystem::path& file) {
  std::error_code absent;
  const auto same = [&](const std::filesystem::path& input) {
    return std::filesystem::equivalent(input, file, absent);
  };
  if (std::none_of(inputs().begin(), inputs().end(), same)) return;
  throw OverInput(
      "S602", "the result " + file.string() +
                  " would take the place of a file that is read: another folder (-o) or another name for the "
                  "input is wanted");
}

ResultLog* exchange_result_log(ResultLog* log) {
  return std::exchange(result_log(), log);
}

OutFile::OutFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (std::filesystem::is_symlink(path_, ignored)) path_ = std::filesystem::weakly_canonical(path_);
  const std::filesystem::file_status status = std::filesystem::status(path_, ignored);
  if (std::filesystem::is_directory(status)) fail(path_, EISDIR);
  const bool ordinary = !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
  partial_ = path_;
  if (ordinary) {
    partial_ += ".partial";
    expect_no_input(path_);
    expect_no_input(partial_);
    open_ordinary();
  } else {
    file_.reset(std::fopen(partial_.c_str(), "ab"));
    if (!file_) fail(partial_, errno);
  }
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // text_ is the buffer
  last_write_ = last_look_ = std::chrono::steady_clock::now();
  if (ordinary && result_log() != nullptr) result_log()->opened(path_);
}

// A link or a pipe that somebody has put in the place of NAME.partial is not written through, nor a file that
// has a second name somewhere else.
void OutFile::open_ordinary() {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK;
  int descriptor = open_waiting_for_signals(partial_, kFlags);
  if (descriptor < 0 && (errno == ENOENT || errno == ENOTDIR || errno == ELOOP) &&
      !path_.parent_path().empty()) {
    std::error_code error;
    std::filesystem::create_directories(path_.parent_path(), error);
    if (error)
      throw OutputError("S601",
                        "the folder " + path_.parent_path().string() + " can't be made: " + error.message());
    descriptor = open_waiting_for_signals(partial_, kFlags);
  }
  const int error = errno;
  std::error_code ignored;
  if (descriptor < 0 && std::filesystem::is_symlink(partial_, ignored))
    fail(partial_, "it is a link, which is not followed");
  if (descriptor < 0) fail(partial_, error);
  file_.reset(fdopen(descriptor, "ab"));
  struct stat found {};
  if (!file_ || fstat(descriptor, &found) != 0) fail(partial_, errno);
  if (!S_ISREG(found.st_mode)) fail(partial_, "it is no ordinary file");
  if (found.st_nlink > 1) fail(partial_, "the file there has another name too (a hard link)");
}

OutFile::~OutFile() {
  if (!file_ || text_.empty()) return;
  if (!begun_ && ftruncate(fileno(file_.get()), 0) != 0) return;
  std::fwrite(text_.data(), 1, text_.size(), file_.get());
}

void OutFile::cut_to(std::uint64_t size) {
  const bool cut = ftruncate(fileno(file_.get()), static_cast<off_t>(size)) == 0;
  if (!cut && errno != EINVAL) fail(partial_, errno);  // EINVAL: a pipe or a device
  begun_ = true;
}

void OutFile::fail(const std::filesystem::path& path, int error) {
  fail(path, reason_of(error));
}

void OutFile::fail(const std::filesystem::path& path, const std::string& reason) {
  file_.reset();
  text_.clear();
  throw OutputError("S601", "cannot write " + path.string() + ": " + reason);
}

void OutFile::write() {
  if (!file_) return;
  if (!begun_) cut_to(0);
  if (text_.empty()) return;
  errno = 0;
  const bool complete = std::fwrite(text_.data(), 1, text_.size(), file_.get()) == text_.size();
  if (!complete) fail(partial_, errno != 0 ? errno : EIO);
  sum_.add(text_);
  text_.clear();
  last_write_ = std::chrono::steady_clock::now();
}

// The name leads to the file that is open: else what is written would be lost.
void OutFile::expect_in_place() {
  last_look_ = std::chrono::steady_clock::now();
  if (partial_ == path_) return;
  struct stat named {
  }, opened{};
  const bool found = lstat(partial_.c_str(), &named) == 0 && fstat(fileno(file_.get()), &opened) == 0;
  if (!found || named.st_dev != opened.st_dev || named.st_ino != opened.st_ino)
    fail(partial_, "it was removed or renamed while the run was writing it");
}

// Where the file system has no locks a second run may write into the same file.
void OutFile::expect_own_bytes() {
  if (partial_ == path_) return;
  struct stat found {};
  const bool own = fstat(fileno(file_.get()), &found) == 0 &&
                   static_cast<std::uint64_t>(found.st_size) == sum_.bytes() &&
                   (result_log() == nullptr || !result_log()->may_be_mixed() || begins_with(partial_, sum_));
  if (!own) fail(partial_, "another program has written into it meanwhile");
}

void OutFile::sync() {
  int result = 0;
  do result = fsync(fileno(file_.get()));
  while (result != 0 && errno == EINTR);
  if (result != 0 && errno != EINVAL && errno != EROFS) fail(partial_, errno);  // EINVAL: a pipe
}

void OutFile::exchange(Archive& archive) {
  bool in_use = open();
  archive(in_use);
  if (in_use != open()) throw InputError("S630", {}, "the checkpoint was made with other outputs");
  if (!in_use) return;
  sync_ = true;
  if (!archive.reading()) {
    write();
    expect_in_place();
    sync();
    archive(sum_);
    if (partial_ != path_ && result_log() != nullptr) result_log()->reached(path_, sum_, false);
    return;
  }
  Checksum sum;
  archive(sum);
  text_.clear();
  take_over(sum);
}

// A run that an error stopped has ended its files: then the file of that name is gone on with.
void OutFile::take_over(const Checksum& sum) {
  if (partial_ != path_ && !begins_with(partial_, sum)) {
    if (!begins_with(path_, sum))
      throw InputError("S630", {}, partial_.string() + " is not what it was at the time of the checkpoint");
    const std::unique_ptr<std::FILE, Close> whole(std::fopen(path_.c_str(), "rb"));
    std::vector<char> piece(kMuch);
    cut_to(0);
    for (std::size_t got = 1; whole && got > 0;) {
      got = std::fread(piece.data(), 1, piece.size(), whole.get());
      if (std::fwrite(piece.data(), 1, got, file_.get()) != got) fail(partial_, errno);
    }
  }
  cut_to(sum.bytes());
  sum_ = sum;
}

void OutFile::checkpoint() {
  constexpr std::chrono::milliseconds kWait(500), kLook(100);
  const auto now = std::chrono::steady_clock::now();
  if (file_ && now - last_look_ > kLook) expect_in_place();
  if (text_.size() > kMuch || now - last_write_ > kWait) write();
}

void OutFile::finish() {
  if (!file_) return;
  write();
  expect_in_place();
  expect_own_bytes();
  if (sync_) sync();
  errno = 0;
  if (std::fclose(file_.release()) != 0) fail(partial_, errno);
  if (partial_ == path_) return;
  if (result_log() != nullptr) result_log()->reached(path_, sum_, true);
  std::error_code error;
  std::filesystem::rename(partial_, path_, error);
  if (error) fail(path_, error.value());
  if (sync_) sync_path(path_.parent_path());
}

void OutFile::written_by(const std::function<void(const std::filesystem::path&)>& write_it) {
  cut_to(0);
  try {
    write_it(partial_);
  } catch (...) {
    discard();
    throw;
  }
  expect_in_place();
  const std::optional<Checksum> sum = checksum_of(partial_);
  if (!sum) fail(partial_, "it can't be read back");
  sum_ = *sum;
}

void OutFile::discard() {
  text_.clear();
  file_.reset();
  if (partial_ != path_) ::unlink(partial_.c_str());
}

std::optional<Checksum> checksum_of(const std::filesystem::path& file, std::uint64_t most) {
  const int descriptor = open_waiting_for_signals(file, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0) return std::nullopt;
  Checksum sum;
  std::array<char, kMuch> piece;
  ssize_t got = 1;
  while (sum.bytes() < most && got != 0) {
    got = ::read(descriptor, piece.data(), std::min<std::uint64_t>(piece.size(), most - sum.bytes()));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) break;
    sum.add({piece.data(), static_cast<std::size_t>(got)});
  }
  ::close(descriptor);
  if (got < 0) return std::nullopt;
  return sum;
}

bool begins_with(const std::filesystem::path& file, const Checksum& sum) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size < sum.bytes()) return false;
  const std::optional<Checksum> found = checksum_of(file, sum.bytes());
  return found && found->bytes() == sum.bytes() && found->value() == sum.value();
}

void sync_path(const std::filesystem::path& path) {
  const int descriptor = open_waiting_for_signals(path.empty() ? "." : path, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0) return;  // may be written, but not read
  int result = 0;
  do result = fsync(descriptor);
  while (result != 0 && errno == EINTR);
  const int error = result == 0 ? 0 : errno;
  ::close(descriptor);
  if (error != 0 && error != EINVAL && error != EROFS)
    throw OutputError("S601", "cannot write " + path.string() + ": " + reason_of(error));
}

void expect_no_folders(const std::filesystem::path& folder, std::string_view begin, std::string_view end) {
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), none; !error && at != none; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (name.starts_with(begin) && name.ends_with(end) && at->is_directory(ignored))
      throw OutputError("S601", "cannot write " + at->path().string() + ": " + reason_of(EISDIR));
  }
}

void write_file(const std::filesystem::path& path, std::string text) {
  OutFile file(path);
  file.text() = std::move(text);
  file.finish();
}

}  // namespace sage

#include "sage/app/result_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "sage/app/screen.hpp"
#include "sage/app/write_all.hpp"
#include "sage/deck/source.hpp"
#include "sage/record/values.hpp"

namespace sage::app {

namespace {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !folder.empty() && !std::filesystem::is_directory(folder, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw OutputError("S601", "the folder " + folder.string() + " can't be made: " + error.message());
}

constexpr std::string_view kLines = "# lines ";  // how many the list has, so that a cut one is known

std::optional<std::uint64_t> number_from(std::string_view text, int base) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_ordinary(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(file, error));
}

}  // namespace

ResultFiles::ResultFiles(const std::filesystem::path& folder, const std::string& stem, const ResultOwner& owner)
    : folder_(folder),
      list_(folder / (stem + ".files")),
      while_running_(folder / (stem + ".files.partial")),
      stem_(stem),
      owner_(owner),
      deck_sum_(fmt::format("{:016x}", owner.deck_sum)) {
  make_folder(folder_);
  expect_no_input(list_);
  expect_no_input(while_running_);
  if (std::error_code ignored; std::filesystem::is_directory(list_, ignored))
    throw OutputError("S601",
                      "cannot write " + list_.string() + ": " + std::generic_category().message(EISDIR));
  while (!lock()) ::close(std::exchange(descriptor_, -1));
  try {
    if (is_ordinary(list_)) damaged_ = !parse(read_file(list_.string()), earlier_);
    if (found_) parse(*found_, earlier_);
    std::string text = head();
    if (found_)
      for (const auto& [name, earlier] : earlier_) text += line(name, earlier);
    rewrite(text);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  log_before_ = exchange_result_log(this);
}

ResultFiles::~ResultFiles() {
  exchange_result_log(log_before_);
  if (!closed_ && files_.empty()) {
    try {
      if (found_)
        rewrite(*found_);
      else
        ::unlink(while_running_.c_str());
    } catch (const OutputError&) {
      // The next run reads what is left of it.
    }
  }
  ::close(descriptor_);
}

// False where another run has removed or renamed the file between opening and locking: to be tried again.
bool ResultFiles::lock() {
  struct stat before {};
  const bool existed = lstat(while_running_.c_str(), &before) == 0;
  descriptor_ = ::open(while_running_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (descriptor_ < 0) fail(errno);
  struct stat opened {
  }, named{};
  if (fstat(descriptor_, &opened) != 0 || !S_ISREG(opened.st_mode) || opened.st_nlink > 1) {
    ::close(descriptor_);
    throw OutputError("S601",
                      "cannot write " + while_running_.string() + ": it is no ordinary file of one name");
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) return false;
    if (errno == EWOULDBLOCK) refuse();
    locked_ = false;  // a file system without locks
  }
  if (lstat(while_running_.c_str(), &named) != 0 || named.st_ino != opened.st_ino ||
      named.st_dev != opened.st_dev)
    return false;
  if (existed) found_ = read_list();
  return true;
}

// The first run names itself as soon as it has the lock.
void ResultFiles::refuse() const {
  std::string first;
  for (int attempt = 0; attempt < 20 && first.empty(); ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::string text = read_list();
    if (text.starts_with("# process ")) first = " (" + text.substr(2, text.find('\n') - 2) + ")";
  }
  ::close(descriptor_);
  throw OutputError("S603", "another run" + first + " is writing " + (folder_ / stem_).string() +
                                ".*: wait for its end, or choose another folder (-o)");
}

void ResultFiles::fail(int error) const {
  throw OutputError("S601",
                    "cannot write " + while_running_.string() + ": " + std::generic_category().message(error));
}

std::string ResultFiles::read_list() const {
  std::string text;
  std::array<char, 4096> piece;
  for (off_t at = 0;;) {
    const ssize_t got = pread(descriptor_, piece.data(), piece.size(), at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(got));
    at += got;
  }
}

void ResultFiles::rewrite(const std::string& text) const {
  const bool done = lseek(descriptor_, 0, SEEK_SET) == 0 && write_all(descriptor_, text) &&
                    ftruncate(descriptor_, static_cast<off_t>(text.size())) == 0;
  if (!done) fail(errno);
}

void ResultFiles::append(const std::string& line) const {
  if (!write_all(descriptor_, line)) fail(errno);
}

std::string ResultFiles::head() const {
  std::error_code ignored;
  return fmt::format("# process {}, deck {}\n# of deck {}\n", ::getpid(),
                     plain_name(std::filesystem::absolute(owner_.deck, ignored).string()), deck_sum_);
}

// "run 89abcdef01234567 1234 case.lst"; of a file that was begun and has no end yet "run - - case.lst".
std::string ResultFiles::line(const std::string& name, const Earlier& file) {
  std::string text;
  if (file.begun) text += fmt::format("{} - - {}\n", file.kind, plain_name(name));
  if (file.sum && file.bytes)
    text += fmt::format("{} {:016x} {} {}\n", file.kind, *file.sum, *file.bytes, plain_name(name));
  return text;
}

// A line that was cut, or names a file outside of the folder, counts for nothing.
bool ResultFiles::parse(const std::string& text, EarlierFiles& files) {
  std::string deck;
  std::uint64_t lines = 0;
  std::optional<std::uint64_t> promised;
  bool whole = text.ends_with('\n');
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string one = text.substr(at, end - at);
    constexpr std::string_view kOfDeck = "# of deck ";
    if (one.starts_with(kOfDeck)) deck = one.substr(kOfDeck.size());
    if (one.starts_with(kLines)) promised = number_from(std::string_view(one).substr(kLines.size()), 10);
    if (one.empty() || one[0] == '#') continue;
    ++lines;
    std::istringstream parts(one);
    std::string kind, sum, bytes, rest;
    parts >> kind >> sum >> bytes;
    const bool has_name = parts.get() == ' ' && std::getline(parts, rest);
    const std::optional<std::string> name = has_name ? name_from_plain(rest) : std::nullopt;
    if (!name || name->empty() || name->find('/') != std::string::npos) {
      whole = false;
      continue;
    }
    Earlier& file = files[*name];
    file.kind = kind;
    file.deck = deck;
    if (sum == "-") {
      file.begun = true;
      continue;
    }
    file.sum = number_from(sum, 16);
    file.bytes = number_from(bytes, 10);
    whole = whole && file.sum && file.bytes;
  }
  return whole && !deck.empty() && promised.value_or(lines) == lines;
}

// Files named as those of a run are, which neither this run wrote nor a list has: of the stem and not of a longer one
// that has a list in the folder.
std::vector<std::filesystem::path> ResultFiles::unlisted() const {
  std::vector<std::string> names, others;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder_, error), none; !error && at != none;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!is_ordinary(at->path())) continue;
    if (name.ends_with(".files") && name.size() > stem_.size() + 6)
      others.push_back(name.substr(0, name.size() - 6));
    if (name.starts_with(stem_ + ".") || name.starts_with(stem_ + "_")) names.push_back(name);
  }
  const auto expected = [&](const std::string& name) {
    const std::filesystem::path path = path_of(name);
    return path == list_ || path == while_running_ || name == stem_ + ".restart" || files_.contains(name) ||
           earlier_.contains(name) ||
           std::ranges::any_of(others, [&](const std::string& stem) { return name.starts_with(stem); });
  };
  std::erase_if(names, expected);
  std::ranges::sort(names);
  std::vector<std::filesystem::path> paths;
  for (const std::string& name : names) paths.push_back(path_of(name));
  return paths;
}

// Nothing for the checkpoint, which comes and goes by itself.
std::optional<std::string> ResultFiles::name_of(const std::filesystem::path& file) const {
  if (file.filename() == stem_ + ".restart") return std::nullopt;
  if (file.parent_path() == folder_) return file.filename().string();
  std::error_code ignored;
  return std::filesystem::absolute(file, ignored).string();
}

void ResultFiles::opened(const std::filesystem::path& file) {
  const std::optional<std::string> name = name_of(file);
  if (!name) return;
  files_[*name] = {};
  if (name->find('/') == std::string::npos)
    append(line(*name, {std::string(owner_.kind), deck_sum_, true, {}, {}}));
}

void ResultFiles::reached(const std::filesystem::path& file, const Checksum& sum, bool complete) {
  const std::optional<std::string> name = name_of(file);
  if (!name) return;
  files_[*name] = {sum, complete, false};
  if (complete && name->find('/') == std::string::npos)
    append(line(*name, {std::string(owner_.kind), deck_sum_, false, sum.bytes(), sum.value()}));
}

void ResultFiles::restore(const std::map<std::string, ResultFile>& files) {
  for (const auto& [name, file] : files) files_[name] = file;
}

void ResultFiles::sync() {
  for (auto& [name, file] : files_) {
    if (!file.complete || file.synced) continue;
    sync_path(path_of(name));
    file.synced = true;
  }
  sync_path(folder_);
}

bool ResultFiles::keep(const std::string& name, const Earlier& earlier) const {
  return earlier.kind != owner_.kind && earlier.deck == deck_sum_ && earlier.sum && is_ordinary(path_of(name));
}

bool ResultFiles::changed_since(const std::string& name) const {
  const auto listed = earlier_.find(name);
  if (listed == earlier_.end() || !listed->second.sum) return false;
  const std::optional<Checksum> now = checksum_of(path_of(name));
  return !now || now->bytes() != *listed->second.bytes || now->value() != *listed->second.sum;
}

// False where the file is no longer what the list says.
bool ResultFiles::remove(const std::string& name, const Earlier& earlier) const {
  const std::filesystem::path file = path_of(name), partial = file.string() + ".partial";
  const auto unlink_result = [](const std::filesystem::path& path) {
    if (!is_ordinary(path)) return;
    try {
      expect_no_input(path);
      ::unlink(path.c_str());
    } catch (const OverInput&) {
      // The user has made it an input since.
    }
  };
  const auto own = files_.find(name);
  if (earlier.begun && own == files_.end()) unlink_result(partial);  // what this run left is for its restart
  if (!earlier.sum || !is_ordinary(file) || (own != files_.end() && own->second.complete)) return true;
  const std::optional<Checksum> now = checksum_of(file);
  if (!now || now->bytes() != *earlier.bytes || now->value() != *earlier.sum) return false;
  unlink_result(file);
  return true;
}

ResultFiles::Left ResultFiles::close() {
  Left left;
  left.damaged = damaged_;
  if (damaged_) left.unlisted = unlisted();
  std::map<std::string, std::string> lines;
  for (const auto& [name, earlier] : earlier_) {
    if (keep(name, earlier))
      lines[name] = line(name, {earlier.kind, earlier.deck, false, earlier.bytes, earlier.sum});
    else if (!remove(name, earlier))
      left.changed.push_back(path_of(name));
  }
  for (const auto& [name, file] : files_)
    if (file.complete && name.find('/') == std::string::npos)
      lines[name] =
          line(name, {std::string(owner_.kind), deck_sum_, false, file.sum.bytes(), file.sum.value()});
  closed_ = true;
  if (lines.empty()) {
    ::unlink(while_running_.c_str());
    ::unlink(list_.c_str());
    return left;
  }
  std::string text =
      "# sagefe: the files of " + plain_name(stem_) +
      ", with checksum and size; the next run of this name removes those that it does not write\n" +
      "# of deck " + deck_sum_ + "\n" + std::string(kLines) + std::to_string(lines.size()) + "\n";
  for (const auto& [name, one] : lines) text += one;
  rewrite(text);
  if (::rename(while_running_.c_str(), list_.c_str()) != 0) fail(errno);
  return left;
}

void say_left(const std::string& who, const ResultFiles::Left& left) {
  for (const std::filesystem::path& file : left.changed)
    say_note(who, file.string() + " is of an earlier run, but has been changed since: it stays", "S632");
  if (!left.damaged) return;
  std::string names;
  for (const std::filesystem::path& file : left.unlisted) names += (names.empty() ? "" : ", ") + file.string();
  say_warning(who,
              "the list of the earlier run's files was damaged: " +
                  (names.empty() ? "nothing of it is left" : "these may be of that run, and stay: " + names),
              "S608");
}

void print_files(const std::vector<std::filesystem::path>& files) {
  for (std::size_t i = 0; i < files.size(); ++i)
    fmt::print("{:<7}{}\n", i == 0 ? "files:" : "", files[i].string());
}

}  // namespace sage::app

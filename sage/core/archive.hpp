// Values to bytes and back, for checkpoints.  One function names the values for both directions,
// so that writing and reading cannot drift apart.  The bytes are those of this machine: a
// checkpoint is for the same program.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "sage/messages/error.hpp"
#include "sage/platform/checksum.hpp"

namespace sage {

class Archive {
 public:
  Archive() = default;                                                               // collects
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reading_(true) {}  // gives back
  // Keeps few bytes: only the sum of all is wanted.
  static Archive for_sum() {
    Archive archive;
    archive.only_sum_ = true;
    return archive;
  }

  // Collects behind what `text` holds, in its room.
  static Archive behind(std::string text) {
    Archive archive(std::move(text));
    archive.reading_ = false;
    return archive;
  }

  bool reading() const { return reading_; }
  std::size_t place() const { return at_; }  // of what is read next
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }  // the end of it
  // for_sum(): of all that was written.
  std::uint64_t sum() const {
    Checksum all = sum_;
    all.add(bytes_);
    return all.value();
  }
  bool at_end() const { return at_ == bytes_.size(); }

  // Writes the value, or replaces it by what was written.  Throws InputError where nothing is left to read.
  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    raw(&value, sizeof value);
  }
  void operator()(std::string& text) { list(text); }
  template <class T>
  void operator()(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    list(values);
  }
  void operator()(Eigen::VectorXd& v) {
    auto size = static_cast<std::size_t>(v.size());
    (*this)(size);
    if (reading_) {
      expect(size * sizeof(double));
      v.resize(size);
    }
    raw(v.data(), size * sizeof(double));
  }

 private:
  template <class List>
  void list(List& values) {
    std::size_t size = values.size();
    (*this)(size);
    if (reading_) {
      expect(size * sizeof(values[0]));
      values.resize(size);
    }
    raw(values.data(), size * sizeof(values[0]));
  }
  void expect(std::size_t count) const {
    if (count > bytes_.size() - at_)
      throw InputError("S630", {}, "the checkpoint is shorter than it should be");
  }
  void raw(void* value, std::size_t count) {
    if (reading_) {
      expect(count);
      if (count > 0) std::memcpy(value, bytes_.data() + at_, count);
      at_ += count;
    } else if (only_sum_ && bytes_.size() + count > kSummedAtOnce) {
      sum_.add(bytes_);
      bytes_.clear();
      sum_.add({static_cast<const char*>(value), count});
    } else {
      bytes_.append(static_cast<const char*>(value), count);
    }
  }

  static constexpr std::size_t kSummedAtOnce = 1 << 16;

  std::string bytes_;
  std::size_t at_ = 0;
  bool reading_ = false, only_sum_ = false;
  Checksum sum_;
};

}  // namespace sage

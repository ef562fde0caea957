// Tells whether bytes are those of before: a sum over words of eight bytes, as they come.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace sage {

// The sum does not depend on the pieces in which the bytes come.  One changed word always changes it; it is no
// protection against intent.  Its members are plain, so that a checkpoint can keep it.
class Checksum {
 public:
  void add(std::string_view bytes) {
    const char* at = bytes.data();
    std::size_t left = bytes.size();
    for (; left > 0 && count_ % 8 != 0; --left) add_byte(*at++);
    for (; left >= 8; left -= 8, at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, 8);
      mix(word);
      count_ += 8;
    }
    for (; left > 0; --left) add_byte(*at++);
  }
  std::uint64_t bytes() const { return count_; }  // so far
  std::uint64_t value() const {
    Checksum end = *this;
    end.mix(tail_);
    end.mix(count_);
    return end.state_ ^ (end.state_ >> 32);
  }

 private:
  void add_byte(char byte) {
    tail_ |= static_cast<std::uint64_t>(static_cast<unsigned char>(byte)) << (8 * (count_ % 8));
    if (++count_ % 8 != 0) return;
    mix(tail_);
    tail_ = 0;
  }
  // Of a given state, every word leads to another state: the factors are odd.
  void mix(std::uint64_t word) {
    state_ = std::rotl(state_ ^ word * 0x9E3779B97F4A7C15ULL, 29) * 0xBF58476D1CE4E5B9ULL;
  }

  std::uint64_t state_ = 0x2545F4914F6CDD1DULL, tail_ = 0, count_ = 0;
};

inline std::uint64_t checksum(std::string_view bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.value();
}

}  // namespace sage

// One call of a UMAT: its arguments in memory of their own, between guard words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sage/core/law.hpp"
#include "sage/umat/routine.hpp"

namespace sage::umat {

// What a material card says of its routine.
struct Setup {
  Routine routine;
  std::string material;       // CMNAME
  int components = 4;         // NTENS: 4 (11 22 33 12) or 6 (and 13 23)
  bool symmetric = false;     // DDSDDE is, in every state
  bool differences = false;   // of the stress stand for DDSDDE
  bool threads_safe = false;  // several threads may call it at once
  int statev = 0;             // NSTATV
  std::vector<double> props;
};

// Bytes of an integer argument.
enum class Width : std::uint8_t { four = 4, eight = 8 };

// Why the routine is called.
enum class Asked : std::uint8_t {
  in_earnest,
  to_find_out,         // with numbers that it may have no answer to
  with_wide_integers,  // likewise; the upper halves of all integers hold ones, which routines with integers of 4
                       // bytes don't see
};

// SIGINI or SDVINI.
enum class First : std::uint8_t { stress, history };

class Call {
 public:
  explicit Call(const Setup& setup);
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // Puts in the state at the start of an increment.  h: STATEV, then SSE, SPD and SCD.
  void load(const PointIn<4>& in, const PointContext& context, Width width);
  CallEnd run(Asked asked = Asked::in_earnest);
  // The routine of first values, which the library has, on what load() has put in.
  CallEnd run(First which);

  // The argument that was written beyond its end or, of an input, changed, in words; empty = there is none.
  std::string damage() const;
  void repair();  // the guard words, after damage

  double pnewdt() const;
  bool finite() const;
  Vector4 stress() const;
  Matrix4 tangent() const;
  void history(std::span<double> h) const;
  // Bit by bit: stress, state variables and DDSDDE.
  std::vector<double> answer() const;

  // For the search of routines that read DFGRD1 alone.
  void strain_by_gradient(const Vector4& deps);

 private:
  struct Place {
    const char* name;
    std::size_t first, size, before;  // before: guard words in front of it
  };
  struct Guards {
    std::size_t first, size;
  };
  // Numbers between pages that nobody may touch: what is written far beyond an array is a crash, which is caught.
  class Memory {
   public:
    explicit Memory(std::size_t numbers);
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    double* data = nullptr;
    char *first = nullptr, *end = nullptr;  // of the pages
  };
  std::string damage_words() const;
  double* at(std::size_t which) { return memory_->data + places_[which].first; }
  const double* at(std::size_t which) const { return memory_->data + places_[which].first; }
  void call();
  void call_first(First which);
  char* text_at(std::size_t which) { return reinterpret_cast<char*>(at(which)); }

  const Setup* setup_;
  std::vector<Place> places_;
  std::vector<Guards> guards_;  // in fours
  std::optional<Memory> memory_;
  std::array<char, 80> name_{};  // CMNAME
};

}  // namespace sage::umat

// The utility routines that a UMAT may call, as gfortran names them, and gfortran's STOP, which they replace.  A
// module of its own, whose names all libraries see that are loaded after it (docs/decisions/0020).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>

#include "sage/platform/module.hpp"
#include "sage/umat/host.h"

namespace {

SageUmatHost host{};

// NDI direct components, then NSHR shears 12, 13, 23; of strain engineering shears.
Eigen::Matrix3d tensor(const double* s, int lstr, int ndi, int nshr) {
  Eigen::Matrix3d t = Eigen::Matrix3d::Zero();
  for (int i = 0; i < ndi; ++i) t(i, i) = s[i];
  constexpr std::array<std::array<int, 2>, 3> kPlaces{{{0, 1}, {0, 2}, {1, 2}}};
  for (int i = 0; i < nshr; ++i) {
    const auto [row, column] = kPlaces[i];
    t(row, column) = t(column, row) = (lstr == 2 ? 0.5 : 1.0) * s[ndi + i];
  }
  return t;
}

[[noreturn]] void leave(int who, const std::string& words) {
  if (host.leave != nullptr) host.leave(who, words.data(), words.size());
  std::exit(who == 0 ? 0 : 1);  // no routine is under way: a program of somebody else's
}

// Blank padded, as Fortran has texts.
void put_text(const char* from, char* to, int* length, std::size_t room) {
  const std::size_t size = std::min(std::strlen(from), room);
  std::memset(to, ' ', room);
  std::copy_n(from, size, to);
  *length = static_cast<int>(size);
}

std::string trimmed(const char* text, std::size_t length) {
  std::string words(text, strnlen(text, length));
  words.erase(words.find_last_not_of(' ') + 1);
  return words;
}

std::array<std::mutex, 101> mutexes;
std::mutex* mutex_of(const int* id) {
  return *id >= 0 && *id <= 100 ? &mutexes[*id] : nullptr;
}

// The smallest number that no other living thread has.
constexpr int kMostThreads = 256;
class ThreadNumber {
 public:
  ThreadNumber() {
    const std::lock_guard lock(guard());
    while (number_ < kMostThreads - 1 && taken()[number_]) ++number_;
    taken().set(number_);
  }
  ~ThreadNumber() {
    const std::lock_guard lock(guard());
    taken().reset(number_);
  }
  ThreadNumber(const ThreadNumber&) = delete;
  ThreadNumber& operator=(const ThreadNumber&) = delete;
  int value() const { return number_; }

 private:
  static std::mutex& guard() {
    static std::mutex mutex;
    return mutex;
  }
  static std::bitset<kMostThreads>& taken() {
    static std::bitset<kMostThreads> numbers;
    return numbers;
  }
  int number_ = 0;
};

}  // namespace

extern "C" {

extern const char sage_umat_module_version[];
[[gnu::section(SAGE_MODULE_SECTION), gnu::used]] const char sage_umat_module_version[] =
    SAGE_UMAT_MODULE_VERSION;

void sage_umat_host(const SageUmatHost* program) {
  host = *program;
}

// Invariants: mean stress and the root of 3/2 S:S.
void sinv_(const double* stress, double* sinv1, double* sinv2, const int* ndi, const int* nshr) {
  const Eigen::Matrix3d t = tensor(stress, 1, *ndi, *nshr);
  *sinv1 = t.trace() / 3.0;
  *sinv2 = std::sqrt(1.5) * (t - *sinv1 * Eigen::Matrix3d::Identity()).norm();
}

// Principal values, the largest first, and in the rows of AN their directions.
void sprind_(const double* s, double* ps, double* an, const int* lstr, const int* ndi, const int* nshr) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor(s, *lstr, *ndi, *nshr));
  Eigen::Map<Eigen::Matrix3d> directions(an);
  for (int i = 0; i < 3; ++i) {
    ps[i] = solver.eigenvalues()[2 - i];
    directions.row(i) = solver.eigenvectors().col(2 - i).transpose();
  }
}

void sprinc_(const double* s, double* ps, const int* lstr, const int* ndi, const int* nshr) {
  std::array<double, 9> directions{};
  sprind_(s, ps, directions.data(), lstr, ndi, nshr);
}

// R S R^T.
void rotsig_(const double* s, const double* r, double* sprime, const int* lstr, const int* ndi,
             const int* nshr) {
  const Eigen::Map<const Eigen::Matrix3d> R(r);
  const Eigen::Matrix3d t = R * tensor(s, *lstr, *ndi, *nshr) * R.transpose();
  const std::array<double, 3> shears{t(0, 1), t(0, 2), t(1, 2)};
  for (int i = 0; i < *ndi; ++i) sprime[i] = t(i, i);
  for (int i = 0; i < *nshr; ++i) sprime[*ndi + i] = (*lstr == 2 ? 2.0 : 1.0) * shears[i];
}

void xit_() {
  leave(0, "");
}

// LOP: 1 a message, -1 a warning, -2 an error, -3 an error that ends the run.  %I, %R, %S take the next number or text.
void stdb_abqerr_(const int* lop, const char* text, const int* integers, const double* reals, const char* texts,
                  std::size_t length, std::size_t text_length) {
  std::string words;
  for (std::size_t i = 0; i < length && text[i] != '\0'; ++i) {
    const char kind = text[i] == '%' && i + 1 < length ? text[i + 1] : '\0';
    if (kind == 'I') words += std::to_string(*integers++);
    if (kind == 'R') {
      std::array<char, 32> number{};
      std::snprintf(number.data(), number.size(), "%g", *reals++);
      words += number.data();
    }
    if (kind == 'S') {
      words += trimmed(texts, text_length);
      texts += text_length;
    }
    if (kind == 'I' || kind == 'R' || kind == 'S')
      ++i;
    else
      words += text[i];
  }
  words.erase(words.find_last_not_of(' ') + 1);
  if (*lop == -3) {
    thread_local std::string last_words;  // the jump out of here destroys nothing
    last_words = std::move(words);
    leave(0, last_words);
  }
  std::printf("%s%s\n", *lop == -1 ? "warning: " : *lop == -2 ? "error: " : "", words.c_str());
}

void getoutdir_(char* folder, int* length, std::size_t room) {
  put_text(host.folder != nullptr ? host.folder() : ".", folder, length, room);
}
void getjobname_(char* name, int* length, std::size_t room) {
  put_text(host.job != nullptr ? host.job() : "job", name, length, room);
}
void getnumcpus_(int* processes) {
  *processes = 1;
}
void getrank_(int* rank) {
  *rank = 0;
}
int getnumthreads_() {
  return kMostThreads;
}
int get_thread_id_() {
  thread_local const ThreadNumber number;
  return number.value();
}

void mutexinit_(const int* /*id*/) {}
void mutexlock_(const int* id) {
  if (std::mutex* mutex = mutex_of(id)) mutex->lock();
}
void mutexunlock_(const int* id) {
  if (std::mutex* mutex = mutex_of(id)) mutex->unlock();
}

// In place of gfortran's own, which would end the program.
void _gfortran_stop_string(const char* text, std::size_t length, bool /*quiet*/) {
  leave(1, text != nullptr ? trimmed(text, length) : "");
}
void _gfortran_stop_numeric(int code, bool /*quiet*/) {
  leave(1, std::to_string(code));
}
void _gfortran_exit_i4(const int* code) {
  leave(2, std::to_string(code != nullptr ? *code : 0));
}
void _gfortran_exit_i8(const long* code) {
  leave(2, std::to_string(code != nullptr ? *code : 0));
}
void _gfortran_error_stop_string(const char* text, std::size_t length, bool quiet) {
  _gfortran_stop_string(text, length, quiet);
}
void _gfortran_error_stop_numeric(int code, bool quiet) {
  _gfortran_stop_numeric(code, quiet);
}

}  // extern "C"

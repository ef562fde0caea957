#include "sage/umat/call.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <new>

namespace sage::umat {

namespace {

// Arrays between guard words, in the order of memory.  Those of the answer come first.
enum Array : std::size_t {
  kStress,
  kStatev,
  kDdsdde,
  kDdsddt,
  kDrplde,
  kStran,
  kDstran,
  kProps,
  kCoords,
  kDrot,
  kDfgrd0,
  kDfgrd1,
  kTime,  // single numbers from here on, but for TIME
  kSse,
  kSpd,
  kScd,
  kRpl,
  kDrpldt,
  kDtime,
  kTemp,
  kDtemp,
  kPredef,
  kDpred,
  kPnewdt,
  kCelent,
  kNdi,  // integers
  kNshr,
  kNtens,
  kNstatv,
  kNprops,
  kNoel,
  kNpt,
  kLayer,
  kKspt,
  kKinc,
  kNcrds,
  kLrebar,
  kJstep,
  kCmname,  // texts
  kNames,
  kArguments
};
constexpr std::size_t kCharacters = sizeof(double);  // in the room of a number
// In front of an array, and behind it: a routine for three dimensions writes 36 terms where there are 16.
constexpr std::size_t kBefore = 4, kBehind = 8, kBehindMatrix = 32, kBesideNumber = 2;
// A number of no computation.
constexpr std::uint64_t kGuardBits = 0x7ff8'dead'5afe'beef;
const double kGuard = std::bit_cast<double>(kGuardBits);
// On either side of the arguments.
constexpr std::size_t kFar = std::size_t{1} << 20;

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// Of the increment.  Routines look for a time of exactly 0, where rounding must leave nothing.
double start_of(const PointContext& context) {
  const double start = context.time - context.dt;
  return std::abs(start - context.stage_start) <= 1e-9 * context.dt ? context.stage_start : start;
}

// Routines take increment 1 for the beginning of the step, as Abaqus has it: what follows when the first increment is
// divided counts as the next.
int increment_of(const PointContext& context, double start) {
  return std::max(context.increment, start > context.stage_start ? 2 : 1);
}

void set_unit(double* matrix) {
  std::fill(matrix, matrix + 9, 0.0);
  for (int i = 0; i < 3; ++i) matrix[4 * i] = 1.0;
}

}  // namespace

Call::Memory::Memory(std::size_t numbers) {
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE)),
                    own = (numbers * sizeof(double) + page - 1) / page * page;
  void* const pages =
      mmap(nullptr, own + 2 * kFar, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  first = static_cast<char*>(pages);
  end = first + own + 2 * kFar;
  if (mprotect(first + kFar, own, PROT_READ | PROT_WRITE) != 0) {
    munmap(first, own + 2 * kFar);
    throw std::bad_alloc();
  }
  data = reinterpret_cast<double*>(end - kFar) - numbers;
}

Call::Memory::~Memory() {
  munmap(first, static_cast<std::size_t>(end - first));
}

Call::Call(const Setup& setup) : setup_(&setup) {
  const auto n = static_cast<std::size_t>(setup.components), state = static_cast<std::size_t>(setup.statev);
  std::array<std::size_t, kArguments> sizes{n, state, n * n, n, n, n, n, setup.props.size(), 3, 9, 9, 9, 2};
  std::fill(sizes.begin() + kSse, sizes.end(), std::size_t{1});
  sizes[kJstep] = 4;
  sizes[kCmname] = name_.size() / kCharacters;
  sizes[kNames] = 2 * sizes[kCmname];
  constexpr std::array<const char*, kArguments> kNames{
      "STRESS", "STATEV", "DDSDDE", "DDSDDT", "DRPLDE", "STRAN", "DSTRAN", "PROPS",  "COORDS", "DROT",
      "DFGRD0", "DFGRD1", "TIME",   "SSE",    "SPD",    "SCD",   "RPL",    "DRPLDT", "DTIME",  "TEMP",
      "DTEMP",  "PREDEF", "DPRED",  "PNEWDT", "CELENT", "NDI",   "NSHR",   "NTENS",  "NSTATV", "NPROPS",
      "NOEL",   "NPT",    "LAYER",  "KSPT",   "KINC",   "NCRDS", "LREBAR", "JSTEP",  "CMNAME", "NAMES"};
  std::size_t end = 0;
  for (std::size_t i = 0; i < kArguments; ++i) {
    const std::size_t before = i > kTime && i <= kJstep ? kBesideNumber : kBefore;
    const bool large = i == kDdsdde || i == kStatev, last = i + 1 == kArguments;
    const bool number = i >= kTime && i < kJstep;
    const std::size_t behind = large ? kBehindMatrix : last ? kBefore : number ? kBesideNumber : kBehind;
    if (i == 0)
      guards_.push_back({0, before});
    else
      guards_.back().size += before;
    places_.push_back({kNames[i], end + before, sizes[i], before});
    guards_.push_back({end + before + sizes[i], behind});
    end += before + sizes[i] + behind;
  }
  memory_.emplace(end);
  repair();
  name_.fill(' ');
  for (std::size_t i = 0; i < std::min(name_.size(), setup.material.size()); ++i)
    name_[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(setup.material[i])));
}

void Call::repair() {
  for (const Guards& guards : guards_) std::fill_n(memory_->data + guards.first, guards.size, kGuard);
  set_unit(at(kDrot));
  set_unit(at(kDfgrd0));
  set_unit(at(kDfgrd1));
  std::copy(setup_->props.begin(), setup_->props.end(), at(kProps));
}

void Call::load(const PointIn<4>& in, const PointContext& context, Width width) {
  const auto n = static_cast<std::size_t>(setup_->components), state = static_cast<std::size_t>(setup_->statev);
  std::fill(at(kDdsdde), at(kDdsdde) + n * n, 0.0);
  for (const Array a : {kStress, kStran, kDstran, kDdsddt, kDrplde}) std::fill(at(a), at(a) + n, 0.0);
  for (int i = 0; i < 4; ++i) {
    at(kStress)[i] = in.sigma0[i];
    at(kStran)[i] = in.eps0[i];
    at(kDstran)[i] = in.deps[i];
  }
  std::copy(in.h0.begin(), in.h0.begin() + static_cast<std::ptrdiff_t>(state), at(kStatev));
  for (const Array a : {kSse, kSpd, kScd}) *at(a) = in.h0[state + (a - kSse)];
  for (const Array a : {kRpl, kDrpldt, kTemp, kDtemp, kPredef, kDpred}) *at(a) = 0.0;
  at(kCoords)[0] = context.place.x();
  at(kCoords)[1] = context.place.y();
  at(kCoords)[2] = 0.0;
  // A state that stands has no length of time, but some routines divide by it.
  *at(kDtime) = context.dt > 0.0 ? context.dt : 1.0;
  const double start = start_of(context);
  at(kTime)[0] = start - context.stage_start;
  at(kTime)[1] = start;
  *at(kCelent) = context.size;
  *at(kPnewdt) = 1.0;
  std::memcpy(at(kCmname), name_.data(), name_.size());
  std::memset(at(kNames), ' ', 2 * name_.size());
  const std::array<std::int64_t, kJstep - kNdi> integers{3,
                                                         setup_->components - 3,
                                                         setup_->components,
                                                         setup_->statev,
                                                         static_cast<std::int64_t>(setup_->props.size()),
                                                         context.element,
                                                         context.point + 1,
                                                         1,
                                                         1,
                                                         increment_of(context, start),
                                                         2,
                                                         0};
  for (std::size_t i = 0; i < integers.size(); ++i) std::memcpy(at(kNdi + i), &integers[i], sizeof integers[i]);
  // Step, procedure (1 static), large deformation (no), perturbation (no).
  const std::array<std::int64_t, 4> wide{context.stage, 1, 0, 0};
  const std::array<std::int32_t, 4> narrow{context.stage, 1, 0, 0};
  std::memset(at(kJstep), 0, sizeof wide);
  if (width == Width::four)
    std::memcpy(at(kJstep), narrow.data(), sizeof narrow);
  else
    std::memcpy(at(kJstep), wide.data(), sizeof wide);
}

CallEnd Call::run(Asked asked) {
  if (asked == Asked::with_wide_integers)
    for (std::size_t i = kNdi; i < kJstep; ++i) std::memset(text_at(i) + 4, 0xff, 4);
  return call_caught([](void* self) { static_cast<Call*>(self)->call(); }, this, asked != Asked::in_earnest,
                     {memory_->first, memory_->end});
}

void Call::call() {
  setup_->routine.function(at(kStress), at(kStatev), at(kDdsdde), at(kSse), at(kSpd), at(kScd), at(kRpl),
                           at(kDdsddt), at(kDrplde), at(kDrpldt), at(kStran), at(kDstran), at(kTime),
                           at(kDtime), at(kTemp), at(kDtemp), at(kPredef), at(kDpred), text_at(kCmname),
                           at(kNdi), at(kNshr), at(kNtens), at(kNstatv), at(kProps), at(kNprops), at(kCoords),
                           at(kDrot), at(kPnewdt), at(kCelent), at(kDfgrd0), at(kDfgrd1), at(kNoel), at(kNpt),
                           at(kLayer), at(kKspt), at(kJstep), at(kKinc), name_.size());
}

CallEnd Call::run(First which) {
  struct Work {
    Call* call;
    First which;
  } work{this, which};
  return call_caught(
      [](void* data) {
        const Work& it = *static_cast<Work*>(data);
        it.call->call_first(it.which);
      },
      &work, false, {memory_->first, memory_->end});
}

void Call::call_first(First which) {
  const Routine& routine = setup_->routine;
  if (which == First::stress)
    routine.first_stress(at(kStress), at(kCoords), at(kNtens), at(kNcrds), at(kNoel), at(kNpt), at(kLayer),
                         at(kKspt), at(kLrebar), text_at(kNames), name_.size());
  else
    routine.first_history(at(kStatev), at(kCoords), at(kNstatv), at(kNcrds), at(kNoel), at(kNpt), at(kLayer),
                          at(kKspt));
}

double Call::pnewdt() const {
  return *at(kPnewdt);
}

// After every call: four words at once.
std::string Call::damage() const {
  using Four [[gnu::vector_size(32)]] = std::uint64_t;
  const Four guard = {kGuardBits, kGuardBits, kGuardBits, kGuardBits};
  Four other = {};
  for (const Guards& guards : guards_) {
    const double* const first = memory_->data + guards.first;
    for (std::size_t i = 0; i < guards.size; i += 4) {
      Four words;
      std::memcpy(&words, first + i, sizeof words);
      other |= words ^ guard;
    }
  }
  const bool same = (other[0] | other[1] | other[2] | other[3]) == 0 &&
                    (setup_->props.empty() ||
                     std::memcmp(at(kProps), setup_->props.data(), setup_->props.size() * sizeof(double)) == 0);
  return same ? std::string() : damage_words();
}

std::string Call::damage_words() const {
  for (const Guards& guards : guards_)
    for (std::size_t i = guards.first; i < guards.first + guards.size; ++i) {
      if (same_bits(memory_->data[i], kGuard)) continue;
      const Place* hit = &places_.front();
      for (const Place& place : places_)
        if (place.first - place.before <= i) hit = &place;
      long index = static_cast<long>(i) - static_cast<long>(hit->first);
      if (hit < &places_[kCmname])
        return std::string("wrote to ") + hit->name + "(" + std::to_string(index + 1) + "), which has " +
               std::to_string(hit->size) + (hit->size == 1 ? " number," : " numbers,");
      index *= static_cast<long>(kCharacters);
      for (auto bits = std::bit_cast<std::uint64_t>(memory_->data[i]) ^ kGuardBits; (bits & 0xff) == 0;
           bits >>= 8)
        ++index;  // to the first byte that is another
      return std::string("wrote to ") + hit->name + "(" + std::to_string(index + 1) + "), which has " +
             std::to_string(hit->size * kCharacters) + " characters,";
    }
  return "changed PROPS, which are an input,";
}

bool Call::finite() const {
  double sum = 0.0;  // nothing but zeros, or no number
  for (const Array a : {kStress, kStatev, kDdsdde, kSse, kSpd, kScd})
    for (std::size_t i = 0; i < places_[a].size; ++i) sum += 0.0 * at(a)[i];
  return sum == 0.0;
}

Vector4 Call::stress() const {
  return Vector4(at(kStress));
}

// Column-major with NTENS rows; of six components the first four.
Matrix4 Call::tangent() const {
  Matrix4 D;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) D(i, j) = at(kDdsdde)[j * setup_->components + i];
  return D;
}

void Call::history(std::span<double> h) const {
  const auto state = static_cast<std::ptrdiff_t>(setup_->statev);
  std::copy(at(kStatev), at(kStatev) + state, h.begin());
  for (const Array a : {kSse, kSpd, kScd}) h[static_cast<std::size_t>(state) + (a - kSse)] = *at(a);
}

std::vector<double> Call::answer() const {
  return {at(kStress), at(kDdsdde) + places_[kDdsdde].size};
}

void Call::strain_by_gradient(const Vector4& deps) {
  double* f = at(kDfgrd1);
  f[0] += deps[0];
  f[4] += deps[1];
  f[8] += deps[2];
  f[1] += 0.5 * deps[3];
  f[3] += 0.5 * deps[3];
}

}  // namespace sage::umat

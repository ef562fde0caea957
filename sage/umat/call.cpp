#include "sage/umat/call.hpp"

#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>

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
  kArrays
};
// In front of an array, and behind it: a routine for three dimensions writes 36 terms where there are 16.
constexpr std::size_t kBefore = 4, kBehind = 8, kBehindMatrix = 32;
// A number of no computation.
const double kGuard = std::bit_cast<double>(std::uint64_t{0x7ff8'dead'5afe'beef});

enum Integer : std::size_t { kNdi, kNshr, kNtens, kNstatv, kNprops, kNoel, kNpt, kLayer, kKspt, kKinc };

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

Call::Call(const Setup& setup) : setup_(&setup) {
  const auto n = static_cast<std::size_t>(setup.components), state = static_cast<std::size_t>(setup.statev);
  const std::array<std::size_t, kArrays> sizes{n, state, n * n, n, n, n, n, setup.props.size(), 3, 9, 9, 9};
  constexpr std::array<const char*, kArrays> kNames{"STRESS", "STATEV", "DDSDDE", "DDSDDT", "DRPLDE", "STRAN",
                                                    "DSTRAN", "PROPS",  "COORDS", "DROT",   "DFGRD0", "DFGRD1"};
  std::size_t end = 0;
  for (std::size_t i = 0; i < kArrays; ++i) {
    places_.push_back({kNames[i], end + kBefore, sizes[i]});
    const std::size_t behind = i == kDdsdde || i == kStatev ? kBehindMatrix : kBehind;
    if (i == 0)
      guards_.push_back({0, kBefore});
    else
      guards_.back().size += kBefore;
    guards_.push_back({end + kBefore + sizes[i], behind});
    end += kBefore + sizes[i] + behind;
  }
  memory_.assign(end, 0.0);
  repair();
  name_.fill(' ');
  for (std::size_t i = 0; i < std::min(name_.size(), setup.material.size()); ++i)
    name_[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(setup.material[i])));
}

void Call::repair() {
  for (const Guards& guards : guards_)
    std::fill_n(memory_.begin() + static_cast<std::ptrdiff_t>(guards.first), guards.size, kGuard);
  set_unit(at(kDrot));
  set_unit(at(kDfgrd0));
  set_unit(at(kDfgrd1));
  std::copy(setup_->props.begin(), setup_->props.end(), at(kProps));
}

void Call::load(const PointIn<4>& in, const PointContext& context, Width width) {
  const auto n = static_cast<std::size_t>(setup_->components), state = static_cast<std::size_t>(setup_->statev);
  std::fill(memory_.data() + places_[kDdsdde].first, at(kDdsdde) + n * n, 0.0);
  for (const Array a : {kStress, kStran, kDstran, kDdsddt, kDrplde}) std::fill(at(a), at(a) + n, 0.0);
  for (int i = 0; i < 4; ++i) {
    at(kStress)[i] = in.sigma0[i];
    at(kStran)[i] = in.eps0[i];
    at(kDstran)[i] = in.deps[i];
  }
  std::copy(in.h0.begin(), in.h0.begin() + static_cast<std::ptrdiff_t>(state), at(kStatev));
  std::copy(in.h0.begin() + static_cast<std::ptrdiff_t>(state), in.h0.end(), energies_.begin());
  at(kCoords)[0] = context.place.x();
  at(kCoords)[1] = context.place.y();
  at(kCoords)[2] = 0.0;
  // A state that stands has no length of time, but some routines divide by it.
  dtime_ = context.dt > 0.0 ? context.dt : 1.0;
  const double start = start_of(context);
  time_ = {start - context.stage_start, start};
  size_ = context.size;
  pnewdt_ = 1.0;
  integers_ = {3,
               setup_->components - 3,
               setup_->components,
               setup_->statev,
               static_cast<std::int64_t>(setup_->props.size()),
               context.element,
               context.point + 1,
               1,
               1,
               increment_of(context, start)};
  // Step, procedure (1 static), large deformation (no), perturbation (no).
  jstep_ = {context.stage, 1, 0, 0};
  if (width == Width::four) {
    const std::array<std::int32_t, 4> narrow{context.stage, 1, 0, 0};
    jstep_ = {};
    std::memcpy(jstep_.data(), narrow.data(), sizeof narrow);
  }
}

CallEnd Call::run(Asked asked) {
  if (asked == Asked::with_wide_integers)
    for (std::int64_t& value : integers_) value |= ~std::int64_t{0} << 32;
  return call_caught([](void* self) { static_cast<Call*>(self)->call(); }, this, asked != Asked::in_earnest);
}

void Call::call() {
  double rpl = 0.0, drpldt = 0.0;
  double none[4] = {0.0, 0.0, 0.0, 0.0};  // TEMP, DTEMP, PREDEF, DPRED
  setup_->routine.function(at(kStress), at(kStatev), at(kDdsdde), &energies_[0], &energies_[1], &energies_[2],
                           &rpl, at(kDdsddt), at(kDrplde), &drpldt, at(kStran), at(kDstran), time_.data(),
                           &dtime_, &none[0], &none[1], &none[2], &none[3], name_.data(), &integers_[kNdi],
                           &integers_[kNshr], &integers_[kNtens], &integers_[kNstatv], at(kProps),
                           &integers_[kNprops], at(kCoords), at(kDrot), &pnewdt_, &size_, at(kDfgrd0),
                           at(kDfgrd1), &integers_[kNoel], &integers_[kNpt], &integers_[kLayer],
                           &integers_[kKspt], jstep_.data(), &integers_[kKinc], name_.size());
}

// After every call: whole regions at once.
std::string Call::damage() const {
  static const std::vector<double> kWhole(kBefore + kBehindMatrix, kGuard);
  bool same = setup_->props.empty() ||
              std::memcmp(at(kProps), setup_->props.data(), setup_->props.size() * sizeof(double)) == 0;
  for (const Guards& guards : guards_)
    same = same && std::memcmp(&memory_[guards.first], kWhole.data(), guards.size * sizeof(double)) == 0;
  return same ? std::string() : damage_words();
}

std::string Call::damage_words() const {
  for (const Guards& guards : guards_)
    for (std::size_t i = guards.first; i < guards.first + guards.size; ++i) {
      if (same_bits(memory_[i], kGuard)) continue;
      const Place* hit = &places_.front();
      for (const Place& place : places_)
        if (place.first - kBefore <= i) hit = &place;
      const long index = static_cast<long>(i) - static_cast<long>(hit->first) + 1;
      return std::string("wrote to ") + hit->name + "(" + std::to_string(index) + "), which has " +
             std::to_string(hit->size) + " numbers,";
    }
  return "changed PROPS, which are an input,";
}

bool Call::finite() const {
  bool all = true;
  for (const Array a : {kStress, kStatev, kDdsdde})
    for (std::size_t i = 0; i < places_[a].size; ++i) all = all && std::isfinite(at(a)[i]);
  return all;
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
  std::copy(energies_.begin(), energies_.end(), h.begin() + state);
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

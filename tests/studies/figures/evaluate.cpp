#include "tests/studies/figures/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sage::figures {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kYields = 0.999;  // stress level, less what Newton's iteration leaves
constexpr double kAtPoint = 0.15;  // of R

struct Box {
  double r0 = 0.0, r1 = 1.0, z0 = 0.0, z1 = 1.0;
};

Box box_of(Place place, double aspect) {
  const double close = kAtPoint / aspect;
  switch (place) {
    case Place::everywhere:
      return {};
    case Place::near_ends:
      return {.z0 = 0.75};
    case Place::near_axis:
      return {.r1 = 0.25};
    case Place::near_rim:
      return {.r0 = 0.75};
    case Place::end:
      return {.z0 = 0.95};  // the last row of elements
    case Place::away_from_end:
      return {.z1 = 0.5};
    case Place::not_near_ends:
      return {.z1 = 0.75};
    case Place::below_ends:
      return {.z1 = 0.70};
    case Place::halfway:
      return {.z0 = 0.25, .z1 = 0.75};
    case Place::mid_axis:
      return {.r1 = 0.25, .z1 = 0.25};
    case Place::end_axis:
      return {.r1 = 0.25, .z0 = 0.75};
    case Place::at_end_axis:
      return {.r1 = kAtPoint, .z0 = 1.0 - close};
    case Place::at_end_rim:
      return {.r0 = 1.0 - kAtPoint, .z0 = 1.0 - close};
    case Place::at_mid_axis:
      return {.r1 = kAtPoint, .z1 = close};
    case Place::at_mid_rim:
      return {.r0 = 1.0 - kAtPoint, .z1 = close};
  }
  return {};
}

// A value of a field with its place, area and what it should be.
struct Sample {
  double r, z, area, x, c;
};

std::vector<Sample> samples(const SpecimenRun& run, const Source& source, Place place, bool away) {
  std::vector<Sample> list;
  const State& state = run.state(source.strain);
  const std::vector<double>& values = state.values(source.quantity);
  const std::vector<Spot>& spots = run.cells;
  const double c = run.scene->correct(source.quantity, source.strain), aspect = run.scene->slenderness;
  for (std::size_t i = 0; i < spots.size(); ++i)
    if (!(away && spots[i].corner) && contains(place, spots[i].r, spots[i].z, aspect))
      list.push_back({spots[i].r, spots[i].z, spots[i].area, values[i], c});
  return list;
}

template <typename Of>
double largest(const std::vector<Sample>& list, Of of) {
  double most = list.empty() ? kNone : of(list[0]);
  for (const Sample& s : list) most = std::max(most, of(s));
  return most;
}

template <typename Of>
double mean(const std::vector<Sample>& list, Of of) {
  double sum = 0.0, area = 0.0;
  for (const Sample& s : list) {
    sum += s.area * of(s);
    area += s.area;
  }
  return sum / area;
}

template <typename Of>
double share(const std::vector<Sample>& list, Of of) {
  return mean(list, [&](const Sample& s) { return of(s) ? 1.0 : 0.0; });
}

double change(const Sample& s) {
  return std::abs(s.x - s.c);
}
double value(const Sample& s) {
  return s.x;
}

// The sample with the largest `of`.
template <typename Of>
const Sample& place_of(const std::vector<Sample>& list, Of of) {
  return *std::ranges::max_element(list, {}, of);
}

// Largest and smallest value of each row of elements, and where along r the largest is.
struct Row {
  double z = 0.0, high = -kAny, low = kAny, r = 0.0;
};
std::vector<Row> rows_of(const std::vector<Sample>& list) {
  std::vector<Row> rows;
  for (const Sample& s : list) {
    if (rows.empty() || std::abs(rows.back().z - s.z) > 1e-9) rows.push_back({.z = s.z});
    Row& row = rows.back();
    if (s.x > row.high) row.r = s.r;
    row.high = std::max(row.high, s.x);
    row.low = std::min(row.low, s.x);
  }
  return rows;
}

double rows_at_axis(const std::vector<Sample>& list) {
  const std::vector<Row> rows = rows_of(list);
  return static_cast<double>(std::ranges::count_if(rows, [](const Row& row) { return row.r <= kAtPoint; })) /
         static_cast<double>(rows.size());
}

double row_range(const std::vector<Sample>& list) {
  double most = 0.0;
  for (const Row& row : rows_of(list)) most = std::max(most, row.high - row.low);
  return most;
}

double correlation(const std::vector<Sample>& x, const std::vector<Sample>& y) {
  if (x.size() != y.size() || x.empty()) return kNone;
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = x[i].x - x[i].c, b = y[i].x - y[i].c;
    xx += x[i].area * a * a;
    yy += x[i].area * b * b;
    xy += x[i].area * a * b;
  }
  return xy / std::sqrt(xx * yy);
}

double largest_difference(const std::vector<Sample>& x, const std::vector<Sample>& y) {
  if (x.size() != y.size()) return kNone;
  double most = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, std::abs(x[i].x - y[i].x));
  return most;
}

std::vector<Sample> above(const std::vector<Sample>& list, double limit) {
  std::vector<Sample> some;
  std::ranges::copy_if(list, std::back_inserter(some), [&](const Sample& s) { return s.x >= limit; });
  return some;
}

std::vector<Sample> yielded(const std::vector<Sample>& list) {
  return above(list, kYields);
}

// z / H below which 95 percent of the yielded area lies.
double reach(const std::vector<Sample>& list) {
  std::vector<Sample> some = yielded(list);
  std::ranges::sort(some, {}, &Sample::z);
  double area = 0.0, below = 0.0;
  for (const Sample& s : some) area += s.area;
  for (const Sample& s : some) {
    below += s.area;
    if (below >= 0.95 * area) return s.z;
  }
  return kNone;
}

// z / H of the highest row of points of which at least half have yielded.
double edge_of_yield(const std::vector<Sample>& list) {
  std::map<long, std::pair<double, double>> rows;  // by z: area yielded, area
  for (const Sample& s : list) {
    auto& [part, all] = rows[std::lround(s.z * 1e6)];
    all += s.area;
    if (s.x >= kYields) part += s.area;
  }
  double edge = kNone;
  for (const auto& [z, area] : rows)
    if (area.first >= 0.5 * area.second) edge = static_cast<double>(z) * 1e-6;
  return edge;
}

double of_yielding(const Check& check, const std::vector<Sample>& x, const std::vector<Sample>& y) {
  const auto yields = [](const Sample& s) { return s.x >= kYields; };
  const auto mean_r = [](const std::vector<Sample>& list) {
    return mean(yielded(list), [](const Sample& s) { return s.r; });
  };
  switch (check.measure) {
    case Measure::yielded:
      return share(x, yields);
    case Measure::unyielded:
      return 1.0 - share(x, yields);
    case Measure::yielded_ratio:
      return share(x, yields) / share(y, yields);
    case Measure::yielded_r:
      return mean_r(x);
    case Measure::yielded_z:
      return mean(yielded(x), [](const Sample& s) { return s.z; });
    case Measure::yielded_r_step:
      return mean_r(x) - mean_r(y);
    case Measure::yielded_z_step:
      return reach(x) - reach(y);
    case Measure::yielded_edge:
      return edge_of_yield(x);
    default:
      return kNone;
  }
}

double of_two_fields(const Check& check, const std::vector<Sample>& x, const std::vector<Sample>& y, double q) {
  switch (check.measure) {
    case Measure::difference:
      return largest_difference(x, y) / q;
    case Measure::correlation:
      return correlation(x, y);
    case Measure::change_ratio:
      return largest(x, change) / largest(y, change);
    case Measure::change_ratio_mean:
      return mean(x, change) / mean(y, change);
    case Measure::mean_step:
      return std::abs(mean(x, value) - mean(y, value));
    default:
      return of_yielding(check, x, y);
  }
}

// Of places: where the largest is, what part lies where.
double of_places(const Check& check, const std::vector<Sample>& x, double aspect, double q) {
  const double p = check.p;
  const bool shear = check.a.quantity == Quantity::tau;
  const auto from = [&](const Sample& s) { return distance(check.target, s.r, s.z, aspect); };
  switch (check.measure) {
    case Measure::distance_most:
      return from(place_of(x, [&](const Sample& s) { return shear ? std::abs(s.x) : s.x; }));
    case Measure::distance_least:
      return from(place_of(x, [](const Sample& s) { return -s.x; }));
    case Measure::rows_at_axis:
      return rows_at_axis(x);
    case Measure::share_close:
      return share(x, [&](const Sample& s) { return change(s) <= p * q; });
    case Measure::share_below:
      return share(x, [&](const Sample& s) { return s.x <= p; });
    case Measure::share_above:
      return share(x, [&](const Sample& s) { return s.x >= p; });
    case Measure::above_r:
      return mean(above(x, p), [](const Sample& s) { return s.r; });
    case Measure::above_in:
      return share(above(x, p), [&](const Sample& s) { return from(s) <= 1e-9; });
    default:
      return kNone;
  }
}

// Of sizes.
double of_values(const Check& check, const std::vector<Sample>& x, const Scene& scene, double q) {
  const auto least = [&](auto of) { return -largest(x, [&](const Sample& s) { return -of(s); }); };
  switch (check.measure) {
    case Measure::change_most:
      return largest(x, change) / q;
    case Measure::percent_most:
      return largest(x, change) / x[0].c;
    case Measure::change_mean:
      return mean(x, [](const Sample& s) { return s.x - s.c; }) / q;
    case Measure::percent_mean:
      return mean(x, [](const Sample& s) { return s.x - s.c; }) / x[0].c;
    case Measure::excess_least:
      return least([](const Sample& s) { return s.x - s.c; }) / q;
    case Measure::nearness:
      return (largest(x, value) - scene.cell()) / (q - scene.cell());
    case Measure::least:
      return least(value) / q;
    case Measure::row_range:
      return row_range(x) / q;
    case Measure::range:
      return largest(x, value) - least(value);
    default:
      return kNone;
  }
}

double mean_gap(const Check& check, const SpecimenRun& run, bool away) {
  std::vector<Sample> there, rest;
  for (const Sample& s : samples(run, check.a, Place::everywhere, away))
    (contains(check.place, s.r, s.z, run.scene->slenderness) ? there : rest).push_back(s);
  return mean(there, value) - mean(rest, value);
}

double of_fields(const Check& check, const SpecimenRun& a, const SpecimenRun* b, bool away) {
  if (check.measure == Measure::mean_gap) return mean_gap(check, a, away);
  const std::vector<Sample> x = samples(a, check.a, check.place, away);
  if (x.empty()) return kNone;
  const double q = a.scene->correct(check.a.strain);
  for (double number : {of_values(check, x, *a.scene, q), of_places(check, x, a.scene->slenderness, q)})
    if (!std::isnan(number)) return number;
  std::vector<Sample> y;
  if (b != nullptr) y = samples(*b, check.b, check.place, away);
  return of_two_fields(check, x, y, q);
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

double excess_spread(const SpecimenRun& run) {
  const std::vector<double> ratios = run.ratios();
  std::vector<double> excess;
  for (std::size_t i = 0; i < ratios.size(); ++i)
    if (run.strain[i] >= 1.0 - 1e-9) excess.push_back(ratios[i] - 1.0);
  const double most = std::abs(*std::ranges::max_element(excess, {}, [](double e) { return std::abs(e); }));
  return spread(excess) / most;
}

double first_above(const SpecimenRun& run, double p) {
  const std::vector<double> ratios = run.ratios();
  double from = kNone;
  for (std::size_t i = ratios.size(); i-- > 0 && ratios[i] > p;) from = run.strain[i];
  return from;
}

double normalised(const SpecimenRun& a, const SpecimenRun& b) {
  double most = 0.0, size = 0.0;
  for (std::size_t i = 0; i < std::min(a.measured.size(), b.measured.size()); ++i) {
    const double one = a.measured[i] / a.scene->E, other = b.measured[i] / b.scene->E;
    most = std::max(most, std::abs(one - other));
    size = std::max(size, std::abs(one));
  }
  return most / size;
}

// nu and the excess at the end of the elastic strain: the first source in the place of its own Poisson's ratio.
std::vector<std::pair<double, double>> by_poisson(const Check& check, const SpecimenRun& a, const GetRun& get) {
  std::vector<std::pair<double, double>> list;
  const std::string name = check.a.scene;
  for (const char* more : {"_nu0", "_nu25", "_nu333", "", "_nu4999"}) {
    const SpecimenRun& run = *more == '\0' ? a : get(name + more);
    list.emplace_back(scene_named(name + more).nu, run.ratio(10.0) - 1.0);
  }
  return list;
}

double nu_rises(const std::vector<std::pair<double, double>>& list) {
  double least = kAny;
  for (std::size_t i = 1; i < list.size(); ++i) least = std::min(least, list[i].second - list[i - 1].second);
  return least / list.back().second;
}

// Up to nu = .495, the last that the chapter computed.
double nu_bow(const std::vector<std::pair<double, double>>& list) {
  const auto& [nu0, e0] = list.front();
  const auto& [nu1, e1] = list[list.size() - 2];
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < list.size(); ++i)
    most = std::max(most, std::abs(list[i].second - e0 - (e1 - e0) * (list[i].first - nu0) / (nu1 - nu0)));
  return most / e1;
}

double of_curves(const Check& check, const SpecimenRun& a, const SpecimenRun* b, const GetRun& get) {
  const auto excess = [](const SpecimenRun& run, const Source& source) {
    return run.ratio(source.strain) - 1.0;
  };
  switch (check.measure) {
    case Measure::ratio:
      return a.ratio(check.a.strain);
    case Measure::excess:
      return excess(a, check.a);
    case Measure::excess_most: {
      double most = 0.0;
      for (double ratio : a.ratios()) most = std::max(most, std::abs(ratio - 1.0));
      return most;
    }
    case Measure::excess_ratio:
      return excess(a, check.a) / excess(*b, check.b);
    case Measure::excess_difference:
      return std::abs(excess(a, check.a) - excess(*b, check.b));
    case Measure::excess_spread:
      return excess_spread(a);
    case Measure::ratio_spread:
      return spread(a.ratios());
    case Measure::ratio_spread_both: {
      std::vector<double> all = a.ratios();
      std::ranges::copy(b->ratios(), std::back_inserter(all));
      return spread(all);
    }
    case Measure::normalised:
      return normalised(a, *b);
    case Measure::first_above:
      return first_above(a, check.p);
    case Measure::yield_strain:
      for (std::size_t i = 0; i < a.strain.size(); ++i)
        if (a.yielded[i] >= 0.5) return a.strain[i];
      return kNone;
    case Measure::measured:
      return a.ratio(check.a.strain) * a.scene->correct(check.a.strain);
    case Measure::nu_rises:
      return nu_rises(by_poisson(check, a, get));
    case Measure::nu_bow:
      return nu_bow(by_poisson(check, a, get));
    default:
      return kNone;
  }
}

// A step that meets every place once, far from the one before.
std::vector<double> shuffle(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::size_t step = n * 5 / 8 + 1;
  while (n > 0 && std::gcd(step, n) != 1) ++step;
  std::vector<double> mixed(n);
  for (std::size_t i = 0; i < n; ++i) mixed[i] = values[i * step % n];
  return mixed;
}

// Rows of `width` values from the last to the first.
std::vector<double> upside_down(const std::vector<double>& values, std::size_t width) {
  std::vector<double> turned(values.size());
  const std::size_t rows = values.size() / width;
  for (std::size_t i = 0; i < values.size(); ++i)
    turned[i] = values[(rows - 1 - i / width) * width + i % width];
  return turned;
}

std::vector<double> altered_values(const std::vector<double>& values, Alteration how, std::size_t width,
                                   double turn, double lift) {
  std::vector<double> changed = values;
  switch (how) {
    case Alteration::mirrored:
      return upside_down(values, width);
    case Alteration::shuffled:
      return shuffle(values);
    case Alteration::sign:
      for (double& x : changed) x = turn - x;
      return changed;
    case Alteration::lifted:
      for (double& x : changed) x += lift;
      return changed;
    default:
      return changed;
  }
}

void alter_state(State& state, const SpecimenRun& run, Alteration how) {
  const auto across = static_cast<std::size_t>(run.columns);
  const double q = run.scene->correct(state.strain);
  for (std::size_t k = 0; k < state.at_elements.size(); ++k) {
    const auto quantity = static_cast<Quantity>(static_cast<std::size_t>(Quantity::sigma_r) + k);
    state.at_elements[k] = altered_values(state.at_elements[k], how, across,
                                          2.0 * run.scene->correct(quantity, state.strain), 0.1 * q);
  }
  state.level = altered_values(state.level, how, across, 1.0, 0.1);
  state.joint_level = altered_values(state.joint_level, how, 1, 1.0, 0.1);
}

}  // namespace

bool contains(Place place, double r, double z, double aspect) {
  return distance(place, r, z, aspect) <= 1e-9;
}

double distance(Place place, double r, double z, double aspect) {
  const Box box = box_of(place, aspect);
  const double along_r = std::max({0.0, box.r0 - r, r - box.r1});
  const double along_z = aspect * std::max({0.0, box.z0 - z, z - box.z1});
  return std::max(along_r, along_z);
}

double number_of(const Check& check, const SpecimenRun& a, const SpecimenRun* b, bool away_from_corner,
                 const GetRun& get) {
  switch (check.measure) {
    case Measure::elements:
      return static_cast<double>(a.cells.size());
    case Measure::diameter:
      return 2.0 * a.largest_radius;
    case Measure::height:
      return 2.0 * a.largest_height;
    case Measure::platen_flat:
      return a.flatness;
    case Measure::joint_most:
      return std::ranges::max(a.state(check.a.strain).joint_level);
    case Measure::joint_most_ever:
      return std::ranges::max(a.joint_most);
    default:
      return check.a.quantity == Quantity::none ? of_curves(check, a, b, get)
                                                : of_fields(check, a, b, away_from_corner);
  }
}

bool passes(const Check& check, double number) {
  return number >= check.low && number <= check.high;
}

namespace {

// What a measure can't pass, whatever the field: shares and correlations.
double largest_possible(Measure measure) {
  switch (measure) {
    case Measure::rows_at_axis:
    case Measure::share_close:
    case Measure::share_below:
    case Measure::share_above:
    case Measure::above_in:
    case Measure::correlation:
    case Measure::yielded:
    case Measure::unyielded:
      return 1.0;
    default:
      return kAny;
  }
}

}  // namespace

bool is_near_limit(const Check& check, double number) {
  constexpr double kNear = 0.05, kOfRoom = 0.25;
  const double room = std::min(check.high, largest_possible(check.measure)) - check.low;
  const auto near = [&](double limit, double inside) {  // inside: how far the number is on the side that passes
    const double margin = kNear * std::abs(limit);
    return inside < 0.0 ? -inside <= margin : inside < std::min(margin, kOfRoom * room);
  };
  return (std::isfinite(check.low) && near(check.low, number - check.low)) ||
         (std::isfinite(check.high) && near(check.high, check.high - number));
}

const char* name_of(Alteration alteration) {
  constexpr const char* kNames[] = {"none", "swapped", "same", "mirrored", "shuffled", "sign", "lifted"};
  return kNames[static_cast<std::size_t>(alteration)];
}

SpecimenRun altered(const SpecimenRun& run, Alteration how) {
  SpecimenRun changed = run;
  for (State& state : changed.states) alter_state(state, run, how);
  const std::vector<double> ratios = altered_values(run.ratios(), how, 1, 2.0, 0.1);
  for (std::size_t i = 0; i < ratios.size(); ++i)
    changed.measured[i] = ratios[i] * run.scene->correct(run.strain[i]);
  changed.joint_most = altered_values(run.joint_most, how, 1, 1.0, 0.1);
  changed.yielded = altered_values(run.yielded, how, 1, 1.0, 0.1);
  if (how == Alteration::lifted) {
    changed.largest_radius *= 1.1;
    changed.largest_height *= 1.1;
    changed.flatness += 0.1;
  }
  return changed;
}

std::span<const char* const> swaps(const std::string& scene) {
  struct Swap {
    const char* scene;
    std::array<const char*, 3> others;
  };
  static constexpr Swap kSwaps[] = {
      {"pinned1", {"pinned2", "conv", "pinned1_nu0"}},
      {"pinned1_nu0", {"pinned1"}},
      {"pinned1_nu25", {"pinned1", "conv"}},
      {"pinned1_nu4999", {"pinned1_nu25"}},
      {"pinned2", {"pinned1", "conv", "pinned2_nu0"}},
      {"pinned2_nu0", {"pinned2"}},
      {"pinned2_nu25", {"pinned2", "conv_nu25"}},
      {"pinned2_nu4999", {"pinned2_nu25"}},
      {"conv", {"lub", "pinned2", "pinned1"}},
      {"conv_nu25", {"lub_nu25", "pinned2_nu25"}},
      {"lub", {"conv", "pinned2"}},
      {"lub_nu25", {"conv_nu25", "pinned2_nu25"}},
      {"free", {"conv"}},
      {"dp_conv", {"dp_lub"}},
      {"dp_lub", {"dp_conv"}},
      {"dp_free", {"dp_conv"}},
  };
  for (const Swap& swap : kSwaps)
    if (scene == swap.scene) {
      const auto count = std::ranges::find(swap.others, nullptr) - swap.others.begin();
      return {swap.others.data(), static_cast<std::size_t>(count)};
    }
  return {};
}

}  // namespace sage::figures

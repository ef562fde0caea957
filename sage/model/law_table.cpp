#include "sage/model/law_table.hpp"

#include <algorithm>

#include "sage/model/spread_loads.hpp"
#include "sage/model/undrained.hpp"

namespace sage {

namespace {

double parameter_by_name(const LawVariant& variant, const Parameter& wanted) {
  const int at = variant.entry->find(wanted.name);
  return at >= 0 && static_cast<std::size_t>(at) < variant.parameters.size() ? variant.parameters[at] : 0.0;
}

// Parameters of the first variant's law that are not the same in all of them.
std::vector<Parameter> parameters_that_differ(const std::vector<LawVariant>& variants) {
  std::vector<Parameter> list;
  for (const Parameter& parameter : variants.front().entry->parameters) {
    const double first = parameter_by_name(variants.front(), parameter);
    if (std::ranges::any_of(variants,
                            [&](const LawVariant& one) { return parameter_by_name(one, parameter) != first; }))
      list.push_back(parameter);
  }
  return list;
}

template <int N>
std::unique_ptr<Law<N>> law_of(const LawVariant& variant, const UnitSystem& units) {
  LawPtr law = variant.entry->law_for(variant.parameters, units, variant.material);
  return std::move(std::get<std::unique_ptr<Law<N>>>(law));
}

}  // namespace

template <int N>
LawTable<N>::LawTable(const std::vector<LawVariant>& variants, const UnitSystem& units) {
  for (const LawVariant& variant : variants) {
    One one{law_of<N>(variant, units), variant.held, {}, true, {}};
    const LawTraits traits = one.law->traits();
    symmetric_ = symmetric_ && traits.symmetric;
    wants_context_ = wants_context_ || traits.wants_context;
    add_quantities(one);
    laws_.push_back(std::move(one));
  }
  if constexpr (N == 1)
    if (const auto* spaced = dynamic_cast<const SpacedMembers*>(laws_.front().law.get()))
      this->spacing_of_first = spaced->spacing();
  show_parameters(variants);
  quantities_.push_back({"law_in_force", Dimension::none});
}

template <int N>
void LawTable<N>::add_quantities(One& one) {
  const std::span<const Quantity> own = one.law->traits().history;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto found = std::ranges::find(quantities_, own[i].name, &Quantity::name);
    one.places.push_back(static_cast<int>(found - quantities_.begin()));
    one.in_order = one.in_order && one.places.back() == static_cast<int>(i);
    if (found == quantities_.end()) quantities_.push_back(own[i]);
  }
  if (!one.in_order && own.size() > kMostScattered)
    throw ParameterError("S611", -1,
                         "a law with more than " + std::to_string(kMostScattered) +
                             " history variables can't follow another law");
}

template <int N>
void LawTable<N>::show_parameters(const std::vector<LawVariant>& variants) {
  first_shown_ = quantities_.size();
  for (const Parameter& parameter : parameters_that_differ(variants)) {
    if (std::ranges::find(quantities_, std::string_view(parameter.name), &Quantity::name) != quantities_.end())
      continue;
    names_.push_back(std::make_unique<std::string>(parameter.name));
    const Quantity quantity{*names_.back(), parameter.dimension};
    for (std::size_t v = 0; v < variants.size(); ++v)
      laws_[v].shown.push_back(inward(quantity, parameter_by_name(variants[v], parameter)));
    quantities_.push_back(quantity);
    quantities_.back().initial = laws_.front().shown.back();
  }
}

template <int N>
const typename LawTable<N>::One& LawTable<N>::in_force(std::span<const double> h) const {
  const double number = h[quantities_.size() - 1];
  const auto at = number > 0.0 ? static_cast<std::size_t>(number) : 0;
  return laws_[std::min(at, laws_.size() - 1)];
}

template <int N>
void LawTable<N>::gather(const One& one, std::span<const double> h, double* own) {
  for (const int place : one.places) *own++ = h[place];
}

template <int N>
void LawTable<N>::scatter(const One& one, const double* own, std::span<double> h) {
  for (const int place : one.places) h[place] = *own++;
}

template <int N>
template <class Call>
auto LawTable<N>::with_own(const One& one, std::span<const double> h, const Call& call) const {
  if (one.in_order) return call(h.first(one.places.size()));
  std::array<double, kMostScattered> own;
  gather(one, h, own.data());
  return call(std::span<const double>(own.data(), one.places.size()));
}

template <int N>
bool LawTable<N>::initialise(const Vector<N>& sigma, std::span<double> h) const {
  const One& one = in_force(h);
  if (one.in_order) return one.law->initialise(sigma, h.first(one.places.size()));
  std::array<double, kMostScattered> own;
  gather(one, h, own.data());
  const bool carried = one.law->initialise(sigma, std::span<double>(own.data(), one.places.size()));
  scatter(one, own.data(), h);
  return carried;
}

template <int N>
bool LawTable<N>::accepts_history(const Vector<N>& sigma, std::span<const double> h) const {
  const One& one = in_force(h);
  return with_own(one, h, [&](std::span<const double> own) { return one.law->accepts_history(sigma, own); });
}

template <int N>
Outcome LawTable<N>::update(const PointIn<N>& in, PointOut<N>& out) const {
  const One& one = in_force(in.h0);
  const std::span<double> all = out.h1;
  std::ranges::copy(in.h0, all.begin());
  if (one.held) {
    out.sigma = in.sigma0;
    out.D.setZero();
    out.status = PointStatus::elastic;
    return Outcome::ok;
  }
  const std::size_t size = one.places.size();
  std::array<double, kMostScattered> room;
  PointIn<N> own = in;
  out.h1 = one.in_order ? all.first(size) : std::span<double>(room.data(), size);
  const Outcome outcome = with_own(one, in.h0, [&](std::span<const double> h0) {
    own.h0 = h0;
    return one.law->update(own, out);
  });
  if (!one.in_order) scatter(one, room.data(), all);
  out.h1 = all;
  return outcome;
}

template <int N>
double LawTable<N>::path_error(const PointIn<N>& in, const Vector<N>& sigma, std::span<const double> h) const {
  const One& one = in_force(in.h0);
  if (one.held) return 0.0;
  PointIn<N> own = in;
  return with_own(one, in.h0, [&](std::span<const double> h0) {
    own.h0 = h0;
    return with_own(one, h,
                    [&](std::span<const double> h1) { return sage::path_error(*one.law, own, sigma, h1); });
  });
}

template <int N>
double LawTable<N>::stress_level(const Vector<N>& sigma, std::span<const double> h) const {
  const One& one = in_force(h);
  return with_own(one, h, [&](std::span<const double> own) { return one.law->stress_level(sigma, own); });
}

template <int N>
bool LawTable<N>::choose(int law, bool anew, const Vector<N>& sigma, std::span<double> h) const {
  const One& one = laws_[law];
  std::ranges::copy(one.shown, h.begin() + static_cast<std::ptrdiff_t>(first_shown_));
  h[quantities_.size() - 1] = law;
  if (!anew || one.held) return true;
  for (const int place : one.places) h[place] = quantities_[place].initial;
  return initialise(sigma, h);
}

template class LawTable<1>;
template class LawTable<2>;
template class LawTable<3>;
template class LawTable<4>;
template class LawTable<5>;

LawPtr make_law(const Material& material, const UnitSystem& units) {
  if (material.variants.empty())
    return with_water(material.entry->law_for(material.parameters, units, material.name), material.undrained);
  LawPtr law;
  switch (material.entry->law_size) {
    case 1:
      law = std::make_unique<LawTable<1>>(material.variants, units);
      break;
    case 2:
      law = std::make_unique<LawTable<2>>(material.variants, units);
      break;
    case 3:
      law = std::make_unique<LawTable<3>>(material.variants, units);
      break;
    case 5:
      law = std::make_unique<LawTable<5>>(material.variants, units);
      break;
    default:
      law = std::make_unique<LawTable<4>>(material.variants, units);
  }
  return with_water(std::move(law), material.undrained);
}

Material twin_of(const Material& from, const UnitSystem& units) {
  Material twin;
  twin.number = from.number;
  twin.name = from.name;
  twin.code = from.code;
  twin.law_name = from.law_name;
  twin.entry = from.entry;
  twin.parameters = from.parameters;
  twin.variants = from.variants;
  twin.unit_weight = from.unit_weight;
  twin.saturated_unit_weight = from.saturated_unit_weight;
  twin.where = from.where;
  twin.undrained = from.undrained;
  twin.twin = from.twin;
  twin.law = make_law(twin, units);
  return twin;
}

}  // namespace sage

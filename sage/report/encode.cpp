#include "sage/report/encode.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "sage/deck/text.hpp"

namespace sage::report {

namespace {

static_assert(std::endian::native == std::endian::little, "pages hold little-endian numbers");

void append_step(std::string& bytes, std::uint32_t step, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>((step >> (8 * i)) & 0xffu);
}

Json quantised(const std::vector<double>& values, std::size_t width, double low, double high) {
  const std::uint32_t none = (std::uint32_t{1} << (8 * width)) - 1, last = none - 1;
  const double per_step = last / (high - low);
  std::string bytes;
  bytes.reserve(values.size() * width);
  for (const double value : values)
    append_step(bytes,
                std::isfinite(value) ? static_cast<std::uint32_t>(std::lround((value - low) * per_step)) : none,
                width);
  return {
      {"t", width == 3 ? "q3" : "q2"}, {"n", values.size()}, {"lo", low}, {"hi", high}, {"b", base64(bytes)}};
}

bool all_alike(const std::vector<double>& values) {
  return std::ranges::all_of(values, [&](double value) {
    return value == values.front() || (std::isnan(value) && std::isnan(values.front()));
  });
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t three = 0;
    for (std::size_t i = 0; i < 3; ++i)
      three = three << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i) text += i <= count ? kDigits[(three >> (18 - 6 * i)) & 63u] : '=';
  }
  return text;
}

Json packed(const std::vector<double>& values, Precision precision) {
  if (values.empty() || all_alike(values)) {
    Json json = {{"t", "c"}, {"n", values.size()}, {"v", nullptr}};
    if (!values.empty() && std::isfinite(values.front())) json["v"] = values.front();
    return json;
  }
  double low = INFINITY, high = -INFINITY;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  // A range beyond that of doubles, or of one value beside blanks, has no steps.
  if (precision != Precision::whole && low < high && std::isfinite(high - low))
    return quantised(values, bytes_of(precision), low, high);
  return {{"t", "f8"},
          {"n", values.size()},
          {"b", base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)})}};
}

Json packed_integers(const std::vector<int>& values, std::size_t stride) {
  std::string bytes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::int64_t step = std::int64_t{values[i]} - (i >= stride ? values[i - stride] : 0);
    std::uint64_t left =
        step < 0 ? 2 * static_cast<std::uint64_t>(-step) - 1 : 2 * static_cast<std::uint64_t>(step);
    for (; left >= 128; left >>= 7) bytes += static_cast<char>(left % 128 + 128);
    bytes += static_cast<char>(left);
  }
  return {{"t", "v"}, {"n", values.size()}, {"s", stride}, {"b", base64(bytes)}};
}

std::string text_for_script(const Json& json) {
  const std::string text =
      json.dump(-1, ' ', true, Json::error_handler_t::replace);  // ASCII: no line separators
  std::string safe;
  safe.reserve(text.size() + 64);
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string clean(std::string_view text) {
  std::string all;
  for (std::size_t at = 0;;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    all += well_formed(text.substr(at, end - at), text.substr(end)).text;
    if (end == text.size()) return all;
    all += '\n';
    at = end + 1;
  }
}

}  // namespace sage::report

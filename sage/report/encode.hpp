// Numbers of a page as compact text: JSON objects with bytes in base64, which web/report/src/decode.js reads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace sage::report {

using Json = nlohmann::ordered_json;

// Of numbers of results: as they are (8 bytes), or in 2^24 - 2 or 2^16 - 2 equal steps between the least and the largest.
enum class Precision { whole, fine, coarse };
inline constexpr std::size_t bytes_of(Precision precision) {
  return precision == Precision::whole ? 8 : precision == Precision::fine ? 3 : 2;
}

std::string base64(std::string_view bytes);

// {"t": "f8", "n": 2, "b": base64 of little-endian doubles}, or
// {"t": "q3" or "q2", "n": 2, "lo": least, "hi": largest, "b": base64 of little-endian steps; all ones = no number}, or
// {"t": "c", "n": 2, "v": the value that all have; null = no number}.
Json packed(const std::vector<double>& values, Precision precision);

// {"t": "v", "n": 8, "s": stride, "b": base64}: the difference of each number from the one `stride` before it (0 before
// the first), zigzag, in groups of seven bits with the lowest first.
Json packed_integers(const std::vector<int>& values, std::size_t stride = 1);

// What a script element of type application/json holds: no "<" and no line separators of JavaScript.
std::string text_for_script(const Json& json);

// Lines of valid UTF-8 without characters that steer a terminal, as all outputs have them.
std::string clean(std::string_view text);

}  // namespace sage::report

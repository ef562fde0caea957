// The few SVG elements that pictures and plots use, appended to a text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sage::svg {

inline constexpr int kFont = 13, kTitleFont = 16;  // sizes of the words, px

std::string open(int width, int height);  // white ground, sans-serif
inline constexpr std::string_view kClose = "</svg>\n";

// anchor: "start", "middle" or "end".  The text's baseline is at y.
void text(std::string& out, double x, double y, std::string_view words, int size, std::string_view anchor,
          std::string_view more = "");
void line(std::string& out, double x1, double y1, double x2, double y2, std::string_view colour, double width,
          std::string_view more = "");
// Lines of words that are no wider than `room`, where a letter is `letter` wide, px.
std::vector<std::string> wrapped(const std::string& words, double letter, double room);
// A coordinate with two decimals, as short as it goes.
void number(std::string& out, double value);

}  // namespace sage::svg

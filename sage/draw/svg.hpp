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
inline constexpr std::string_view kBold = "font-weight=\"bold\"";
void line(std::string& out, double x1, double y1, double x2, double y2, std::string_view colour, double width,
          std::string_view more = "");

// px that words take: those of the widest of the fonts that a viewer may choose, so that labels keep apart.
double text_width(std::string_view words, int size, bool bold = false);
// Lines of words that are no wider than `room`, px; a word that is wider by itself is divided.
std::vector<std::string> wrapped(const std::string& words, int size, double room, bool bold = false);
// The beginning and the end of words that are wider than `room`, px, with dots between.
std::string shortened(const std::string& words, int size, double room);
// As text(), shortened to `room`; a viewer shows the whole where the pointer rests.
void text_within(std::string& out, double x, double y, const std::string& words, int size, double room,
                 std::string_view anchor, std::string_view more = "");

// A coordinate with two decimals, as short as it goes.
void number(std::string& out, double value);

}  // namespace sage::svg

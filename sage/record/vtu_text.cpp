#include "sage/record/vtu_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace sage {

namespace {

static_assert(std::endian::native == std::endian::little, "the VTU writer appends raw little-endian data");

// Nearest to this order of the blocks; nothing where that finds none.
std::optional<std::vector<std::size_t>> order_from(const std::vector<std::string>& blocks,
                                                   std::vector<std::size_t> left) {
  std::vector<std::size_t> order, taken;
  std::size_t raw = 0, base64 = 0;
  while (!left.empty()) {
    taken.push_back(base64);
    const auto next = std::ranges::find_if(left, [&](std::size_t i) {
      return left.size() == 1 || std::ranges::count(taken, raw + blocks[i].size()) == 0;
    });
    if (next == left.end()) return std::nullopt;
    raw += blocks[*next].size();
    base64 += (blocks[*next].size() + 2) / 3 * 4;
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

}  // namespace

VtuText::VtuText(std::string_view head) {
  tag(
      fmt::format("<?xml version=\"1.0\"?>\n{}<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                  "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <UnstructuredGrid>",
                  head));
}

void VtuText::tag(std::string_view text) {
  xml_.back() += text;
  xml_.back() += '\n';
}

void VtuText::add(std::string_view type, std::string_view name, int components, const void* values,
                  std::size_t bytes, std::string_view attributes, std::string_view inside) {
  fmt::format_to(std::back_inserter(xml_.back()),
                 "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" "
                 "offset=\"",
                 type, name, components, attributes);
  xml_.push_back(inside.empty() ? "\"/>\n" : fmt::format("\">{}</DataArray>\n", inside));
  const std::uint64_t size = bytes;
  std::string& block = blocks_.emplace_back();
  block.reserve(sizeof size + bytes);
  block.append(reinterpret_cast<const char*>(&size), sizeof size);
  block.append(static_cast<const char*>(values), bytes);
}

std::string VtuText::text() && {
  tag("    </Piece>\n  </UnstructuredGrid>");
  std::vector<std::size_t> offset(blocks_.size());
  std::string data;
  for (const std::size_t i : order()) {
    offset[i] = data.size();
    data += std::exchange(blocks_[i], {});
  }
  std::string all;
  for (std::size_t i = 0; i < xml_.size(); ++i) {
    all += xml_[i];
    if (i < offset.size()) all += std::to_string(offset[i]);
  }
  all += "  <AppendedData encoding=\"raw\">\n_";
  all += data;
  all += "\n  </AppendedData>\n</VTKFile>\n";
  return all;
}

// Of the blocks in the data.  meshio 5.3 makes base64 of them, gives each tag its new offset as it goes, and finds the
// next tag by the old one: no block may begin where one before it begins in base64.
std::vector<std::size_t> VtuText::order() const {
  std::vector<std::size_t> list(blocks_.size());
  std::iota(list.begin(), list.end(), 0);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (const auto found = order_from(blocks_, list)) return *found;
    std::rotate(list.begin(), list.begin() + 1, list.end());
  }
  return list;
}

}  // namespace sage

// The text of a VTU file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sage {

// XML tags with offsets, and the data that they point to: each block is its size in bytes (UInt64), then its bytes.
class VtuText {
 public:
  // Opens the file and its grid.  head: a comment before them, or nothing.
  explicit VtuText(std::string_view head = "");

  void tag(std::string_view text);
  // inside: what stands between the tags of the array.
  void array(std::string_view name, int components, const std::vector<double>& values,
             std::string_view attributes = "", std::string_view inside = "") {
    add("Float64", name, components, values.data(), values.size() * sizeof(double), attributes, inside);
  }
  void array(std::string_view name, int components, const std::vector<std::int64_t>& values,
             std::string_view attributes = "", std::string_view inside = "") {
    add("Int64", name, components, values.data(), values.size() * sizeof(std::int64_t), attributes, inside);
  }
  void array(std::string_view name, int components, const std::vector<std::int32_t>& values,
             std::string_view attributes = "", std::string_view inside = "") {
    add("Int32", name, components, values.data(), values.size() * sizeof(std::int32_t), attributes, inside);
  }
  void array(std::string_view name, int components, const std::vector<std::uint8_t>& values,
             std::string_view attributes = "", std::string_view inside = "") {
    add("UInt8", name, components, values.data(), values.size(), attributes, inside);
  }
  // Closes the grid and the file.
  std::string text() &&;

 private:
  void add(std::string_view type, std::string_view name, int components, const void* values, std::size_t bytes,
           std::string_view attributes, std::string_view inside);
  std::vector<std::size_t> order() const;

  std::vector<std::string> xml_{1}, blocks_;  // between two pieces of XML stands the offset of a block
};

}  // namespace sage

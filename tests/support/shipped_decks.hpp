// The decks of legacy_inputs, found by themselves, and the layout that each was written for.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "sage/deck/layout.hpp"

namespace sage::test {

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Whatever is no page, table, layout or result beside a deck.
inline std::vector<std::filesystem::path> shipped_decks() {
  const std::set<std::string> others{".csv", ".md", ".toml", ".res", ".txt"};
  std::vector<std::filesystem::path> decks;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SAGE_SOURCE_DIR "/legacy_inputs"))
    if (entry.is_regular_file() && !others.contains(entry.path().extension().string()))
      decks.push_back(entry.path());
  std::sort(decks.begin(), decks.end());
  return decks;
}

// By its marks, or as its folder is called; the textbook's decks bear the number of their program: "p51_2" is of
// sg_p51.
inline std::string layout_of(const std::filesystem::path& deck) {
  if (const std::string marked = recognised_layout(bytes_of(deck)); !marked.empty()) return marked;
  const std::string folder = deck.parent_path().filename().string();
  const std::vector<std::string> layouts = built_in_layouts();
  if (std::find(layouts.begin(), layouts.end(), folder) != layouts.end()) return folder;
  if (folder != "smith_griffiths") return "sage1";
  const std::string stem = deck.stem().string();
  return "sg_" + stem.substr(0, stem.find('_'));
}

// "chapter7/dp_08/deck.dat" as chapter7_dp_08_deck, for the name of a test.
inline std::string name_of(const std::filesystem::path& deck) {
  std::string name = deck.lexically_relative(SAGE_SOURCE_DIR "/legacy_inputs").replace_extension().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

}  // namespace sage::test

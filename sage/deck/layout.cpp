#include "sage/deck/layout.hpp"

#include <algorithm>
#include <filesystem>

#include "sage/deck/embedded.hpp"
#include "sage/deck/layout_bytes.hpp"
#include "sage/deck/layout_names.hpp"
#include "sage/deck/source.hpp"
#include "sage/deck/wide_layout.hpp"

namespace sage {

namespace {

// "* layout: quad4m" in the first line of a deck.
std::string named_layout(std::string_view first_line) {
  const std::size_t at = first_line.find("layout:");
  if (first_line.empty() || first_line[0] != '*' || at == std::string_view::npos) return {};
  const std::string_view rest = first_line.substr(at + 7);
  const std::size_t begin = rest.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return std::string(rest.substr(begin, rest.find(' ', begin) - begin));
}

bool is_path(const std::string& name) {
  return name.find('/') != std::string::npos || name.find('.') != std::string::npos;
}

// A layout file that a deck names is beside the deck, or in the folder of the command.
std::string found_beside(const std::string& deck, const std::string& name) {
  const std::string beside = (std::filesystem::path(deck).parent_path() / name).string();
  std::error_code ignored;
  for (const std::string& file : {beside, name})
    if (std::filesystem::exists(file, ignored)) return file;
  throw InputError("S101", {deck, 1, 0, 0},
                   "the layout " + name +
                       " that this line names can't be opened: it is neither in the deck's "
                       "folder nor in the folder of the command");
}

// What: a layout, or its marks alone.
template <class What>
What unpacked(const EmbeddedLayout& embedded) {
  What what;
  Archive archive{std::string(embedded.bytes)};
  exchange(archive, what);
  return what;
}

bool has_marks(const std::vector<LayoutMark>& marks, const SourceText& deck) {
  return std::all_of(marks.begin(), marks.end(), [&](const LayoutMark& mark) {
    const std::string_view line = deck.line(mark.line);
    const auto column = static_cast<std::size_t>(mark.column) - 1;
    return column < line.size() &&
           std::any_of(mark.texts.begin(), mark.texts.end(),
                       [&](const std::string& text) { return line.substr(column, text.size()) == text; });
  });
}

}  // namespace

std::vector<std::string> built_in_layouts() {
  std::vector<std::string> names;
  for (const EmbeddedLayout& layout : embedded_layouts()) {
    names.emplace_back(layout.name);
    if (layout.name == kStandardLayout) names.emplace_back(kWideLayout);
  }
  return names;
}

Layout load_layout(const std::string& path_or_name, bool checked) {
  for (const EmbeddedLayout& embedded : embedded_layouts())
    if (embedded.name == path_or_name) return unpacked<Layout>(embedded);
  if (path_or_name == kWideLayout) return wide_layout(load_layout(std::string(kStandardLayout)));
  if (is_path(path_or_name))
    return (checked ? load_checked_layout : load_layout_text)(read_file(path_or_name), path_or_name);
  std::string known;
  for (const std::string& name : built_in_layouts()) known += (known.empty() ? "" : ", ") + name;
  throw InputError("S140", {path_or_name, 0, 0, 0},
                   "no layout of this name is built in (known: " + known + "); give the path of a layout file");
}

std::string recognised_layout(std::string_view deck_text, const std::string& file) {
  const SourceText deck(std::string(deck_text.substr(0, 4000)), "");
  if (std::string named = named_layout(deck.line(1)); !named.empty())
    return is_path(named) && !file.empty() ? found_beside(file, named) : named;
  for (const EmbeddedLayout& embedded : embedded_layouts())
    if (embedded.has_marks && has_marks(unpacked<std::vector<LayoutMark>>(embedded), deck))
      return std::string(embedded.name);
  return {};
}

std::string detect_layout(std::string_view deck_text, const std::string& file) {
  std::string name = recognised_layout(deck_text, file);
  return name.empty() ? std::string(kStandardLayout) : name;
}

}  // namespace sage

// Plug-ins that a deck names in the comments before its first card, a line each: "* plugin: NAME".  They must
// have been loaded: a deck never loads code by itself.
#include <algorithm>

#include "sage/builder/builder.hpp"
#include "sage/core/catalogue.hpp"

namespace sage::builder {

namespace {

constexpr std::string_view kMark = "* plugin:";

}  // namespace

std::string plugin_hint(int code) {
  return code < kFirstPluginCode ? ""
                                 : "; codes from " + std::to_string(kFirstPluginCode) +
                                       " are of plug-ins, which --plugin LIBRARY loads";
}

namespace {

void need_plugin(Builder& b, const std::string& name, const SourcePosition& where) {
  const auto& loaded = b.catalogue.plugins;
  if (name.empty())
    b.error("S801", where, "the name of a plug-in is missing behind \"" + std::string(kMark) + "\"");
  else if (std::ranges::none_of(loaded, [&](const Plugin& plugin) { return plugin.name == name; }))
    b.error("S801", where,
            "the deck needs the plug-in " + name + ", which is not loaded: --plugin LIBRARY loads it");
  b.model.plugins.push_back(name);
}

}  // namespace

void build_plugins(Builder& b) {
  for (const CardView& card : b.deck.all("plugin"))  // of a model file
    need_plugin(b, card.text("name"), card.where("name"));
  for (int line = 1; b.deck.line_text(line).starts_with('*'); ++line) {
    const std::string_view text = b.deck.line_text(line);
    if (!text.starts_with(kMark)) continue;
    const std::string_view rest = text.substr(kMark.size());
    const std::size_t begin = std::min(rest.find_first_not_of(' '), rest.size());
    const std::string name(rest.substr(begin, rest.find_first_of(" \t\r", begin) - begin));
    const int first = static_cast<int>(kMark.size() + begin) + 1;
    need_plugin(b, name, {b.deck.file, line, first, first + std::max(0, static_cast<int>(name.size()) - 1)});
  }
}

}  // namespace sage::builder

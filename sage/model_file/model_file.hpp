// Models as TOML files: tables with the names of the cards, keys with the names of their fields, and names in place of codes
// and numbers.  docs/manual/model_file.md.
#pragma once

#include <string>
#include <string_view>

#include "sage/core/catalogue.hpp"
#include "sage/deck/deck.hpp"
#include "sage/model/model.hpp"

namespace sage {

// The cards of a file that was read as one (is_model_file): those of layout sage1_wide, each value at its place in the
// file.  Throws InputError with every mistake found: the syntax of TOML, tables and keys that there are not, values of
// another kind, names that nothing has.
Deck model_file_deck(const Deck& as_read, const Catalogue& catalogue);

// The model as such a file, with the numbers of its nodes and elements.  What no card can hold is left out with a warning,
// as sage1_text() does it.
std::string model_file_text(const Model& model, const Catalogue& catalogue, Diagnostics& diagnostics);

// The JSON schema of the files, for editors; docs/schema/model_file.json.
std::string model_file_schema(const Catalogue& catalogue);
// The tables and keys, as Markdown, for docs/manual/model_file.md.
std::string model_file_tables();

}  // namespace sage

// A deck in memory whose numbers have names: other values make another model, with all checks of a deck.
// docs/manual/names.md lists the names.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sage/builder/build_model.hpp"

namespace sage {

struct NamedValue {
  std::string name;                         // "material.clay.friction_angle"
  std::variant<double, std::string> value;  // a text for names of things: "plane_strain"
};
// "material.clay.friction_angle = 28".
std::string to_string(const NamedValue& value);

// A value: copies are independent of each other.  Signs and units are those of the deck.
class NamedModel {
 public:
  // The catalogue must outlive it.  Throws InputError for foreign decks that can't become a model.
  NamedModel(const Deck& deck, const Catalogue& catalogue, BuildOptions options);

  // Throws InputError at the deck: S730 for a name that it lacks, with names that are near; S731 for a value that can't be
  // meant.  What the model makes of the value shows in build().
  void set(const NamedValue& value);
  // A parameter of a material that differs from place to place, in place of the deck's number.  Throws S730 as set() does.
  void vary(const std::string& name, std::function<double(const Vector2&)> value);
  // Throws as set() does, and changes nothing.
  void check(const NamedValue& value) const;
  // The number that has this name; NaN where the deck leaves it blank, or it is a text.  Throws InputError (S730).
  double get(const std::string& name) const;
  // Throws InputError (S731) where two of the names mean the same number, or one is a part of the other.
  void expect_apart(const std::vector<std::string>& names) const;
  // All names: materials by number and by name.
  std::vector<std::string> names() const;

  // Throws InputError with every mistake found.  Messages end with the values that were set.
  Model build() const;

  const BuildOptions& options() const { return options_; }

 private:
  // Where a number stands.
  struct Place {
    std::vector<int> cards;           // indices; more than one where a factor acts on several
    std::vector<std::string> fields;  // of each of these cards; of a list the first
    int in_list = 0;
    bool integer = false;
    bool factor = false;  // the value multiplies what stands there
  };
  struct Entry {
    std::string name;
    Place place;
  };
  void find_names();
  void add_materials();
  void add_reports();
  void add_numbered(const char* prefix, const char* card, std::initializer_list<const char*> fields);
  void add_stages();
  void add_card(const std::string& prefix, const CardView& card, std::initializer_list<const char*> fields);
  const Place& place(const std::string& name) const;
  bool set_option(const NamedValue& value, BuildOptions& options) const;
  void set_formulation(const NamedValue& value, int& code) const;
  void put(int card, const std::string& field, int in_list, double number);
  double number_at(int card, const std::string& field, int in_list) const;
  [[noreturn]] void fail(Code code, const std::string& message) const;
  double number_of(const NamedValue& value) const;
  std::string text_of(const NamedValue& value, std::string_view wanted) const;

  Deck deck_;
  const Catalogue* catalogue_;
  BuildOptions options_;
  std::shared_ptr<std::vector<Entry>> entries_;  // never changed once they are found
  std::vector<NamedValue> set_;
};

}  // namespace sage

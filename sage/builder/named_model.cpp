#include "sage/builder/named_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "sage/builder/builder.hpp"
#include "sage/core/short_names.hpp"
#include "sage/deck/read_deck.hpp"
#include "sage/deck/wide_layout.hpp"
#include "sage/messages/near_names.hpp"

namespace sage {

namespace {

constexpr const char* kGeometry = "geometry";
constexpr const char* kFormulation = "formulation";
constexpr const char* kElement = "element";
constexpr const char* kRefine = "refine";
constexpr const char* kSolver = "solver";
constexpr const char* kOptions[] = {kGeometry, kFormulation, kElement, kRefine, kSolver};
constexpr int kMostRefinements = 12;

bool is_integer_field(std::string_view field) {
  return field == "increments" || field == "max_iterations" || field == "output_every" || field == "method";
}

// A card with another number has places of its own, which say what its line says.
struct CardValues {
  std::vector<double> numbers;
  std::vector<ValuePlace> places;
};

CardValues values_of(const Deck& deck, const Card& card) {
  CardValues out;
  for (const FieldValue& value : deck.values(card)) {
    out.numbers.push_back(value.blank ? Deck::blank_number() : value.number);
    out.places.push_back({value.text, value.line, value.first_column, value.last_column, value.kind});
  }
  return out;
}

}  // namespace

std::string to_string(const NamedValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.value)) return value.name + " = " + *text;
  return fmt::format("{} = {}", value.name, std::get<double>(value.value));
}

NamedModel::NamedModel(const Deck& deck, const Catalogue& catalogue, BuildOptions options)
    : catalogue_(&catalogue), options_(std::move(options)) {
  deck_ = deck;
  if (!deck.draft)
    if (std::optional<Deck> cards = builder::cards_of(deck, catalogue)) deck_ = *std::move(cards);
  // Cards from here on, whose values change: the file must not be read again.
  if (is_model_file(deck)) deck_.layout = kWideLayout;
  find_names();
}

void NamedModel::fail(Code code, const std::string& message) const {
  throw InputError(code, {deck_.file, 0, 0, 0}, message);
}

void NamedModel::add_card(const std::string& prefix, const CardView& card,
                          std::initializer_list<const char*> fields) {
  for (const char* field : fields)
    entries_->push_back({prefix + "." + field, {{card.index()}, {field}, 0, is_integer_field(field), false}});
}

void NamedModel::add_numbered(const char* prefix, const char* card, std::initializer_list<const char*> fields) {
  int number = 0;
  for (const CardView& one : deck_.all(card))
    if (one.card().owner < 0 || std::string_view(card) != "initial")
      add_card(fmt::format("{}.{}", prefix, ++number), one, fields);
}

// Of triaxial reports: others have no use for these numbers.
void NamedModel::add_reports() {
  int number = 0;
  for (const CardView& card : deck_.all("report")) {
    ++number;
    if (card.integer("kind", 1) == static_cast<int>(ReportKind::triaxial))
      add_card(fmt::format("report.{}", number), card, {"height", "area", "cell_pressure"});
  }
}

void NamedModel::add_materials() {
  for (const CardView& card : deck_.all("material")) {
    const std::vector<CardView> parameters = deck_.all("parameters", card);
    const MaterialEntry* law = catalogue_->materials.find(card.integer("law"));
    std::vector<std::string> prefixes{fmt::format("material.{}.", card.integer("number"))};
    if (const std::string name = card.text("name"); !name.empty()) prefixes.push_back("material." + name + ".");
    for (const std::string& prefix : prefixes) {
      entries_->push_back({prefix + "unit_weight", {{card.index()}, {"unit_weight"}}});
      if (law == nullptr || parameters.empty()) continue;
      for (std::size_t i = 0; i < law->parameters.size(); ++i)
        entries_->push_back({prefix + law->parameters[i].name,
                             {{parameters.front().index()}, {"values"}, static_cast<int>(i), false, false}});
      for (const char* letters : {"E", "nu", "c", "phi", "psi", "gamma"})
        if (const int at = parameter_place(*law, letters); at >= 0 && law->find(letters) < 0)
          entries_->push_back({prefix + letters, {{parameters.front().index()}, {"values"}, at, false, false}});
    }
  }
}

void NamedModel::add_stages() {
  int number = 0;
  for (const CardView& stage : deck_.all("stage")) {
    const std::string prefix = fmt::format("stage.{}", ++number);
    add_card(prefix, stage,
             {"increments", "max_iterations", "tolerance", "duration", "gravity_x", "gravity_y", "method"});
    Place loads{{}, {}, 0, false, true}, moved = loads;
    const auto add_all = [&](const char* card, std::initializer_list<const char*> fields, Place* factor) {
      int count = 0;
      for (const CardView& one : deck_.all(card, stage)) {
        add_card(fmt::format("{}.{}.{}", prefix, card, ++count), one, fields);
        if (factor == nullptr) continue;
        for (const char* field : fields) {
          factor->cards.push_back(one.index());
          factor->fields.emplace_back(field);
        }
      }
    };
    add_all("load", {"x_force", "y_force"}, &loads);
    add_all("pressure", {"normal1", "normal2", "shear1", "shear2"}, &loads);
    add_all("fixity", {"x_value", "y_value"}, &moved);
    add_all("initial", {"v1", "v2", "v3", "v4", "v5", "v6"}, nullptr);
    if (!loads.cards.empty()) entries_->push_back({prefix + ".load_factor", loads});
    if (!moved.cards.empty()) entries_->push_back({prefix + ".displacement_factor", moved});
  }
}

void NamedModel::find_names() {
  entries_ = std::make_shared<std::vector<Entry>>();
  add_materials();
  add_stages();
  add_numbered("initial", "initial", {"v1", "v2", "v3", "v4", "v5", "v6"});
  add_reports();
  add_numbered("water", "water", {"value1", "value2"});
  for (const CardView& units : deck_.all("units"))
    add_card("units", units, {"atmospheric_pressure", "water_unit_weight"});
}

std::vector<std::string> NamedModel::names() const {
  std::vector<std::string> all(std::begin(kOptions), std::end(kOptions));
  for (const Entry& entry : *entries_) all.push_back(entry.name);
  return all;
}

const NamedModel::Place& NamedModel::place(const std::string& name) const {
  for (const Entry& entry : *entries_)
    if (entry.name == name) return entry.place;
  fail("S730", fmt::format("the model has no number of the name {}{}", name, did_you_mean(name, names())));
}

double NamedModel::number_of(const NamedValue& value) const {
  const auto* number = std::get_if<double>(&value.value);
  if (number == nullptr || !std::isfinite(*number)) fail("S731", to_string(value) + ": wanted a finite number");
  return *number;
}

std::string NamedModel::text_of(const NamedValue& value, std::string_view wanted) const {
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  fail("S731", fmt::format("{}: wanted {}", to_string(value), wanted));
}

// By code or by name, which one of the deck's elements must have.
void NamedModel::set_formulation(const NamedValue& value, int& code) const {
  if (std::holds_alternative<double>(value.value)) {
    code = static_cast<int>(number_of(value));
    return;
  }
  const std::string& wanted = std::get<std::string>(value.value);
  std::vector<std::string> known;
  for (const CardView& group : deck_.all("group")) {
    const ElementEntry* element =
        catalogue_->elements.find(options_.element != 0 ? options_.element : group.integer("element"));
    if (element == nullptr || !element->solid()) continue;
    for (const Formulation& one : element->formulations) {
      if (one.name == wanted) {
        code = one.code;
        return;
      }
      if (std::ranges::find(known, one.name) == known.end()) known.push_back(one.name);
    }
  }
  fail("S731", fmt::format("{}: known are {}{}", to_string(value), fmt::join(known, ", "),
                           did_you_mean(wanted, known)));
}

// Whether the name is that of an option.
bool NamedModel::set_option(const NamedValue& value, BuildOptions& options) const {
  if (value.name == kGeometry) {
    const std::string wanted = text_of(value, "\"plane_strain\" or \"axisymmetric\"");
    if (wanted != "plane_strain" && wanted != "axisymmetric")
      fail("S731", to_string(value) + ": wanted plane_strain or axisymmetric");
    options.geometry = wanted == "axisymmetric" ? 2 : 1;
  } else if (value.name == kFormulation) {
    set_formulation(value, options.formulation);
  } else if (value.name == kElement) {
    const std::string wanted = text_of(value, "the name of an element");
    options.element = catalogue_->elements.code_of(wanted);
    const ElementEntry* element = catalogue_->elements.find(options.element);
    if (element == nullptr || !element->solid() || !element->square())
      fail("S731", fmt::format("{}: wanted an element that can take the place of a quadrilateral; known: {}",
                               to_string(value), catalogue_->elements.known()));
  } else if (value.name == kRefine) {
    const double times = number_of(value);
    if (times != std::floor(times) || times < 0.0 || times > kMostRefinements)
      fail("S731", fmt::format("{}: wanted a whole number from 0 to {}", to_string(value), kMostRefinements));
    options.refine = static_cast<int>(times);
  } else if (value.name == kSolver) {
    const std::string wanted = text_of(value, "the name of a solver");
    options.solver = catalogue_->solvers.code_of(wanted);
    if (options.solver == 0 && wanted != "automatic")
      fail("S731", to_string(value) + ": known are automatic, " + catalogue_->solvers.known());
  } else {
    return false;
  }
  return true;
}

double NamedModel::number_at(int card, const std::string& field, int in_list) const {
  const CardView view(deck_, card);
  const std::vector<FieldSpec>& fields = view.spec().fields;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == field) return deck_.number(view.card(), static_cast<int>(i) + in_list);
  return Deck::blank_number();
}

// The card's values move to the end of the deck's, where there is room for one more.
void NamedModel::put(int index, const std::string& field, int in_list, double number) {
  Card& card = deck_.cards[index];
  CardValues values = values_of(deck_, card);
  const std::vector<FieldSpec>& fields = deck_.specs[card.spec].fields;
  auto at = static_cast<std::size_t>(
      std::ranges::find_if(fields, [&](const FieldSpec& one) { return one.name == field; }) - fields.begin());
  if (at == fields.size()) {  // such cards have no such field: this one has, from here on
    CardSpec spec = deck_.specs[card.spec];
    FieldSpec added;
    added.name = added.label = field;
    spec.fields.push_back(added);
    card.spec = static_cast<int>(deck_.specs.size());
    deck_.specs.push_back(std::move(spec));
  }
  at += static_cast<std::size_t>(in_list);
  while (values.numbers.size() <= at) {
    values.numbers.push_back(Deck::blank_number());
    values.places.push_back({{}, card.line, 0, 0, FieldKind::real});
  }
  values.numbers[at] = number;
  values.places[at].text = {};
  card.first_value = static_cast<std::int32_t>(deck_.numbers.size());
  card.value_count = static_cast<std::int32_t>(values.numbers.size());
  card.first_place = static_cast<std::int32_t>(deck_.places.size());
  deck_.numbers.insert(deck_.numbers.end(), values.numbers.begin(), values.numbers.end());
  deck_.places.insert(deck_.places.end(), values.places.begin(), values.places.end());
}

void NamedModel::check(const NamedValue& value) const {
  if (BuildOptions options = options_; set_option(value, options)) return;
  const Place& where = place(value.name);
  const double number = number_of(value);
  if (where.integer && (number != std::floor(number) || number < 0.0 || number > 1e9))
    fail("S731", to_string(value) + ": wanted a whole number that is not negative");
}

void NamedModel::set(const NamedValue& value) {
  check(value);
  set_.push_back(value);
  if (set_option(value, options_)) return;
  const Place& where = place(value.name);
  const double number = number_of(value);
  for (std::size_t i = 0; i < where.cards.size(); ++i) {
    const double old = number_at(where.cards[i], where.fields[i], where.in_list);
    if (!where.factor)
      put(where.cards[i], where.fields[i], where.in_list, number);
    else if (!Deck::is_blank(old))
      put(where.cards[i], where.fields[i], where.in_list, old * number);
  }
}

void NamedModel::vary(const std::string& name, std::function<double(const Vector2&)> value) {
  (void)place(name);
  const std::size_t key = name.find('.') + 1, parameter = name.rfind('.') + 1;
  options_.placed.push_back({name.substr(key, parameter - 1 - key), name.substr(parameter), std::move(value)});
}

void NamedModel::expect_apart(const std::vector<std::string>& names) const {
  using Spot = std::tuple<int, std::string, int>;
  std::map<Spot, std::string> taken;
  for (const std::string& name : names) {
    std::vector<Spot> spots{{-1, name, 0}};
    if (std::ranges::find(kOptions, name) == std::end(kOptions)) {
      const Place& where = place(name);
      spots.clear();
      for (std::size_t i = 0; i < where.cards.size(); ++i)
        spots.emplace_back(where.cards[i], where.fields[i], where.in_list);
    }
    for (const Spot& spot : spots)
      if (const auto [found, is_new] = taken.try_emplace(spot, name); !is_new)
        fail("S731", fmt::format("{} and {} change the same number of the deck", found->second, name));
  }
}

double NamedModel::get(const std::string& name) const {
  if (std::ranges::find(kOptions, name) != std::end(kOptions))
    return name == kRefine ? options_.refine : std::numeric_limits<double>::quiet_NaN();
  const Place& where = place(name);
  if (where.factor) return 1.0;
  const double number = number_at(where.cards.front(), where.fields.front(), where.in_list);
  return Deck::is_blank(number) ? std::numeric_limits<double>::quiet_NaN() : number;
}

Model NamedModel::build() const {
  try {
    return build_model(deck_, *catalogue_, options_);
  } catch (const InputError& error) {
    if (set_.empty()) throw;
    std::string words;
    for (const NamedValue& value : set_) words += (words.empty() ? "with " : ", ") + to_string(value);
    Diagnostics found;
    for (Diagnostic one : error.diagnostics().list()) {
      one.detail.push_back(words);
      found.add(one);
    }
    throw InputError(found);
  }
}

}  // namespace sage

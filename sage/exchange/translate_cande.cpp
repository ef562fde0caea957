// CANDE Level 3 decks: soil elements and the beams of pipes by load step, under the load factors of the steps.
// Interfaces and links: cande_joints.cpp.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sage/core/types.hpp"
#include "sage/exchange/cande_soils.hpp"
#include "sage/exchange/translate_cande.hpp"

namespace sage::translate {

namespace {

constexpr int kMostSteps = 99999;        // what the card has columns for
constexpr double kCubicInches = 1728.0;  // lengths in inches, densities in lbf/ft^3

constexpr double kAtmosphere = 14.696;  // psi
// Of hyperbolic soils: lifts are born without stress, and moduli that see less hardly let Newton settle.
constexpr double kLargestPoisson = 0.49, kStressFloor = 0.05;

void fail(const Deck& deck, const SourcePosition& where, const std::string& message) {
  refuse_field(deck, where, message);
}

void add_listed_nodes(const Deck& deck, const CandeJoints& joints, CardWriter& out) {
  for (const CardView& node : deck.all("node")) {
    for (const char* field : {"reference_code", "generation_x", "generation_y", "increment"})
      if (node.integer(field) != 0)
        fail(deck, node.where(field),
             "node generation (" + node.label(field) +
                 ") is not built: its rule stands in CANDE's user manual alone, which is not at hand; give the "
                 "coordinates of every node");
    if (!joints.moves(node.integer("number")))
      out.add("node", node.where(), {take(node, "number"), take(node, "x"), take(node, "y")});
  }
  joints.add_nodes(out);
}

bool selig(const CardView& model) {
  return model.integer("model") == 1;
}

// Cards D-3 and D-4 are read with blanks as zeros: a number without which there is no soil is asked for.
void check_duncan(const Deck& deck, const CardView& model, const CardView& strength, const CardView& bulk) {
  const auto wanted = [&](const CardView& card, const char* field) {
    const double value = card.real(field);
    if (!(value > 0.0) || !std::isfinite(value))
      fail(deck, card.where(field),
           "the " + card.label(field) + " of this soil must be above zero; blank counts as zero");
  };
  wanted(strength, "modulus_number");
  wanted(strength, "failure_ratio");
  if (selig(model) && bulk.real("bulk_number") > 0.0) wanted(bulk, "bulk_exponent");
  if (strength.real("cohesion") == 0.0) wanted(strength, "friction_angle");
}

// The law of Duncan et al. (1980), or with the bulk modulus of Selig, from the cards D-2 to D-4.
std::vector<NewField> duncan_parameters(const CardView& model, const CardView& strength, const CardView& bulk,
                                        CardWriter& out) {
  if (!(bulk.real("bulk_number") > 0.0)) {
    out.warning("S703", bulk.where("bulk_number"),
                "without a bulk modulus number this soil has a constant Poisson's ratio, which "
                "is not known here");
    return {};
  }
  out.warning("S703", strength.where("modulus_number"),
              std::string("computed as ") + (selig(model) ? "duncan_selig" : "duncan_chang_eb") +
                  "; the deck has no modulus for unloading: the modulus number K serves for both");
  return {take(strength, "modulus_number", "values"),
          take(strength, "modulus_exponent", "values"),
          take(strength, "failure_ratio", "values"),
          take(strength, "modulus_number", "values"),
          take(bulk, "bulk_number", "values"),
          take(bulk, "bulk_exponent", "values"),
          take(strength, "cohesion", "values"),
          take(strength, "friction_angle", "values"),
          take(strength, "friction_drop", "values"),
          {"values", kLargestPoisson},
          {"values", kStressFloor}};
}

// The same of a soil that CANDE has by name.
std::vector<NewField> named_parameters(const CardView& material, const CardView& model, bool used,
                                       CardWriter& out) {
  const std::string name = material.text("name");
  const NamedSoil* soil = named_soil(selig(model), name);
  if (soil == nullptr) {
    if (named_soil(!selig(model), name) != nullptr)
      out.warning("S703", model.where("model"),
                  "the soil " + name + " is known for code " + (selig(model) ? "0 (Duncan)" : "1 (Selig)") +
                      " of this card alone");
    return {};
  }
  const std::string number = material.text("number");
  const std::string source = selig(model) ? "Selig (1988)" : "Duncan et al. (1980)";
  const std::string law = selig(model) ? "duncan_selig" : "duncan_chang_eb";
  const std::string known = "material " + number + " (" + std::string(soil->name) + ")";
  if (used)
    out.left_out(material.where("name"),
                 known + ", computed as " + law + " with numbers not compared with " + source,
                 known + ": the numbers of this soil have not been compared with " + source +
                     ": give them on cards D-3 and D-4 (soil USER), or compute " + law +
                     " with those of legacy_inputs/cande_level3/README.md; K serves for unloading too");
  std::vector<NewField> values;
  for (const double value : {soil->K, soil->n, soil->R_f, soil->K, soil->bulk, soil->bulk_other, soil->cohesion,
                             soil->friction_angle, soil->friction_loss, kLargestPoisson, kStressFloor})
    values.push_back({"values", value, material.where("name")});
  return values;
}

std::vector<NewField> hyperbolic_parameters_of(const Deck& deck, const CardView& material,
                                               const CardView& model, bool used, std::string& law,
                                               CardWriter& out) {
  if (const int code = model.integer("model"); code != 0 && code != 1)
    fail(deck, model.where("model"),
         "the code of the model is 0 (Duncan) or 1 (Selig), not " + std::to_string(code));
  if (model.integer("unloading") != 0)
    out.warning("S703", model.where("unloading"),
                "unloading with lasting strain (code " + model.text("unloading") +
                    ") is not built: this soil unloads with its modulus number K");
  law = selig(model) ? "duncan_selig" : "duncan_chang_eb";
  const auto strength = deck.all("duncan_strength", material), bulk = deck.all("duncan_bulk", material);
  if (!strength.empty() && !bulk.empty()) check_duncan(deck, model, strength.front(), bulk.front());
  if (!strength.empty() && !bulk.empty()) return duncan_parameters(model, strength.front(), bulk.front(), out);
  return named_parameters(material, model, used, out);
}

// The parameters of a material, empty where the deck doesn't give a law that exists here.
std::vector<NewField> parameters(const Deck& deck, const CardView& material, bool used, std::string& law,
                                 CardWriter& out) {
  std::vector<NewField> values;
  const auto add = [&](const CardView& card, std::initializer_list<const char*> fields) {
    for (const char* field : fields) values.push_back(take(card, field, "values"));
  };
  const auto isotropic = deck.all("isotropic", material), mohr = deck.all("mohr_coulomb", material);
  if (!isotropic.empty()) {
    law = "linear_elastic";
    add(isotropic.front(), {"youngs_modulus", "poissons_ratio"});
  } else if (!mohr.empty()) {
    law = "mohr_coulomb";
    add(mohr.front(), {"youngs_modulus", "poissons_ratio", "cohesion", "friction_angle"});
  } else if (const auto model = deck.all("duncan", material); !model.empty()) {
    values = hyperbolic_parameters_of(deck, material, model.front(), used, law, out);
  }
  return values;
}

// The wall of a pipe for each unit of its length, from the B cards of its group; elastic.
struct Wall {
  double axial = 0.0, bending = 0.0;  // E A / (1 - nu^2) and E I / (1 - nu^2)
  double weight = 0.0;                // for each unit of the wall's surface
  std::string name;
  SourcePosition where;
  int material = 0;  // number of its own
};

double above_zero(const Deck& deck, const CardView& card, const char* field) {
  const double value = card.real(field);
  if (!(value > 0.0) || !std::isfinite(value))
    fail(deck, card.where(field), "the pipe's " + card.label(field) + " must be above zero");
  return value;
}

// `density`: its field on the card of the moduli, if it has one.
Wall wall_of(const Deck& deck, double modulus, const CardView& moduli, double area, double inertia,
             const CardView& pipe, const char* density = nullptr) {
  const double nu = moduli.real("poissons_ratio");
  if (!(nu >= 0.0 && nu < 0.5))
    fail(deck, moduli.where("poissons_ratio"), "the pipe's Poisson's ratio must lie from 0 to below 0.5");
  const double plane = modulus / (1.0 - nu * nu), weight = density == nullptr ? 0.0 : moduli.real(density);
  if (!(weight >= 0.0) || !std::isfinite(weight))
    fail(deck, moduli.where(density), "the pipe's density can't be negative");
  return {plane * area, plane * inertia, weight * area, "pipe " + pipe.text("type"), moduli.where(), 0};
}

// What the pipe's material does in CANDE and the elastic wall here doesn't.
void say_elastic(const CardView& card, CardWriter& out) {
  const bool large = card.integer("deformation") != 0;
  out.warning("S703", card.where(),
              std::string("the pipe is computed elastic: no yield, no local buckling, no limit by its seams") +
                  (large ? "; deformations are small, other than its code of large deformation asks" : ""));
}

// Net load factors of the load steps (cards E-1); 1 where there is none.
class LoadFactors {
 public:
  LoadFactors(const Deck& deck, int steps) : of_step_(static_cast<std::size_t>(steps) + 1, 0.0) {
    for (const CardView& card : deck.all("load_factor")) {
      const int first = card.integer("first"), given = card.integer("last"), last = given == 0 ? first : given;
      const double factor = card.real("factor", 1.0);
      if (first < 1 || last < first)
        fail(deck, card.where(first < 1 ? "first" : "last"),
             "load factors count from load step 1, first to last; here from " + std::to_string(first) + " to " +
                 std::to_string(last));
      if (!(factor > 0.0) || !std::isfinite(factor))
        fail(deck, card.where("factor"), "a load factor above zero is wanted (blank: 1)");
      for (int step = first; step <= std::min(last, steps); ++step) {
        double& place = of_step_[step];
        if (place != 0.0)
          fail(deck, card.where("first"), "load step " + std::to_string(step) + " has a load factor already");
        place = factor;
      }
    }
  }
  double at(int step) const {
    const double factor = of_step_[step];
    return factor == 0.0 ? 1.0 : factor;
  }
  // The first step whose loads are multiplied; 0 = none.
  int first_in_use() const {
    for (std::size_t step = 1; step < of_step_.size(); ++step)
      if (of_step_[step] != 0.0 && of_step_[step] != 1.0) return static_cast<int>(step);
    return 0;
  }

 private:
  std::vector<double> of_step_;  // 0: no card
};

// The pipe groups (cards A-2) and the elements that each has: a beam's material is the number of its group.
class Pipes {
 public:
  Pipes(const Deck& deck, const LoadFactors& factors, int highest_material, CardWriter& out) {
    std::map<int, int> beams;
    for (const CardView& element : deck.all("element"))
      if (is_beam(element)) ++beams[element.integer("material")];
    int number = 0;
    for (const CardView& card : deck.all("pipe")) {
      const auto has = beams.find(++number);
      if (has == beams.end()) continue;
      if (const int said = card.integer("elements"); said != 0 && said != has->second)
        fail(deck, card.where("elements"),
             "pipe group " + std::to_string(number) + " has " + std::to_string(said) +
                 " beam elements by this card, " + std::to_string(has->second) + " by cards C-4");
      add(deck, card, number, out);
    }
    for (const CardView& element : deck.all("element"))
      if (is_beam(element)) place(deck, element, factors.at(birth_of(element)));
    for (Wall& wall : walls_) wall.material = ++highest_material;
  }
  const std::vector<Wall>& walls() const { return walls_; }
  // The place in walls() of a beam's wall; -1 where it has none.
  int wall(const CardView& beam) const {
    const auto found = of_beam_.find(beam.integer("number"));
    return found == of_beam_.end() ? -1 : found->second;
  }

 private:
  struct Range {
    int first, last, wall;  // elements of the group, counted from 1
  };

  void add(const Deck& deck, const CardView& pipe, int number, CardWriter& out) {
    const std::string type = pipe.text("type");
    std::vector<Range>& ranges = ranges_[number];
    const auto whole = [&](const Wall& wall) {
      walls_.push_back(wall);
      ranges.push_back({1, kMostSteps, static_cast<int>(walls_.size()) - 1});
    };
    const auto metal = [&](const char* first, const char* second) {
      const auto moduli = deck.all(first, pipe), section = deck.all(second, pipe);
      if (moduli.empty() || section.empty())
        return refuse(pipe, "cards B-1 and B-2 of an analysis are wanted", out);
      const CardView& b1 = moduli.front();
      if (type == "STEEL" && b1.integer("joint_slip") != 0)
        return refuse(pipe, "joints that slip are not built", out);
      const CardView& b2 = section.front();
      whole(wall_of(deck, above_zero(deck, b1, "youngs_modulus"), b1, above_zero(deck, b2, "area"),
                    above_zero(deck, b2, "inertia"), pipe, "density"));
      say_elastic(b1, out);
    };
    if (type == "STEEL") return metal("pipe_steel", "pipe_section");
    if (type == "ALUMINUM") return metal("pipe_alum", "pipe_alum_section");
    if (type == "PLASTIC") {
      const auto kind = deck.all("pipe_plastic", pipe), moduli = deck.all("pipe_plastic_moduli", pipe),
                 section = deck.all("pipe_plastic_section", pipe);
      if (kind.empty() || moduli.empty() || section.empty() || kind.front().text("wall") == "PROFILE")
        return refuse(pipe, "cards B-1 to B-3 of a smooth or general wall are wanted", out);
      const CardView &b1 = kind.front(), &b2 = moduli.front(), &b3 = section.front();
      const char* modulus = b1.integer("duration") == 2 ? "long_modulus" : "short_modulus";
      const bool smooth = b3.real("area") == 0.0;  // a wall without ribs: its height says all
      const double h = smooth ? above_zero(deck, b3, "height") : 0.0;
      whole(wall_of(deck, above_zero(deck, b2, modulus), b2, smooth ? h : above_zero(deck, b3, "area"),
                    smooth ? h * h * h / 12.0 : above_zero(deck, b3, "inertia"), pipe, "density"));
      return say_elastic(b1, out);
    }
    if (type != "BASIC")
      return refuse(pipe, "only STEEL, ALUMINUM, PLASTIC and BASIC pipes are known here", out);
    for (const CardView& card : deck.all("pipe_basic", pipe)) {
      if (card.real("load") != 0.0)
        fail(deck, card.where("load"), "the load along a basic pipe is not built: leave it blank");
      whole(wall_of(deck, above_zero(deck, card, "youngs_modulus"), card, above_zero(deck, card, "area"),
                    above_zero(deck, card, "inertia"), pipe));
      const int first = std::max(1, card.integer("first"));
      ranges.back() = {first, card.integer("last") == 0 ? kMostSteps : card.integer("last"),
                       ranges.back().wall};
    }
    if (ranges.empty()) refuse(pipe, "cards B-1.Basic are wanted", out);
  }
  void refuse(const CardView& pipe, const std::string& why, CardWriter& out) {
    const std::string what = "pipe " + pipe.text("type");
    out.left_out(pipe.where("type"), what, what + " is not taken: " + why);
  }
  void place(const Deck& deck, const CardView& element, double factor) {
    const auto ranges = ranges_.find(element.integer("material"));
    if (ranges == ranges_.end() || ranges->second.empty()) return;
    const int count = ++counted_[ranges->first];
    for (const Range& range : ranges->second)
      if (count >= range.first && count <= range.last) {
        of_beam_[element.integer("number")] = factored(range.wall, factor);
        return;
      }
    fail(deck, element.where(),
         "no card B-1.Basic covers beam " + std::to_string(count) + " of pipe group " +
             std::to_string(ranges->first));
  }
  // The same wall with its weight times the load factor of its step.
  int factored(int wall, double factor) {
    if (factor == 1.0 || walls_[wall].weight == 0.0) return wall;
    const auto [place, is_new] = factored_.try_emplace({wall, factor}, static_cast<int>(walls_.size()));
    if (is_new) {
      Wall other = walls_[wall];
      other.weight *= factor;
      other.name += " x " + number_text(factor);
      walls_.push_back(other);
    }
    return place->second;
  }

  std::vector<Wall> walls_;
  std::map<int, std::vector<Range>> ranges_;  // by pipe group
  std::map<int, int> counted_, of_beam_;
  std::map<std::pair<int, double>, int> factored_;
};

void add_walls(const Pipes& pipes, const Catalogue& catalogue, CardWriter& out) {
  for (const Wall& wall : pipes.walls()) {
    const int card = out.add("material", wall.where,
                             {{"number", static_cast<double>(wall.material)},
                              {"law", static_cast<double>(law_code(catalogue, "section_elastic"))},
                              {"unit_weight", wall.weight},
                              {"name", 0.0, wall.where, wall.name}});
    out.add("parameters", wall.where, {{"values", wall.axial}, {"values", wall.bending}}, card);
  }
}

// A soil of the deck under one load factor: the weight that an element brings is that of its load step, so one
// material of the deck becomes several that differ in unit weight alone.
struct Soils {
  std::map<std::pair<int, double>, int> number;  // of material and factor
  int highest = 0;                               // of all numbers

  Soils(const Deck& deck, const LoadFactors& factors) {
    std::set<int> defined;
    for (const CardView& material : deck.all("material")) {
      defined.insert(material.integer("number"));
      highest = std::max(highest, material.integer("number"));
    }
    for (const CardView& element : deck.all("element")) {
      if (!is_soil(element)) continue;
      const int material = element.integer("material");
      const double factor = factors.at(birth_of(element));
      number.try_emplace({material, factor}, factor == 1.0 || defined.count(material) == 0 ? material : -1);
    }
    for (auto& [key, own] : number)
      if (own < 0) own = ++highest;
  }
};

// A soil of which the deck has no law that exists here: the elastic material that stands for it.
struct StandIn {
  std::vector<NewField> values;
  std::string name;
};

StandIn stand_in(const Deck& deck, CardWriter& out) {
  std::string ignored;
  for (const CardView& material : deck.all("material"))
    if (!deck.all("isotropic", material).empty())
      return {parameters(deck, material, false, ignored, out),
              material.text("number") + " (" + material.text("name") + ")"};
  return {};
}

// The material's law and numbers; those of the stand-in, reported as left out, where
// the deck does not hold them.
std::vector<NewField> law_of(const Deck& deck, const CardView& material, const StandIn& stand_in, bool used,
                             std::string& law, CardWriter& out) {
  std::vector<NewField> values = parameters(deck, material, used, law, out);
  if (!values.empty()) return values;
  const std::string name = "material " + material.text("number") + " (" + material.text("name") + ")";
  if (stand_in.values.empty())
    fail(deck, material.where("law"),
         name + ": its law is not known here, and the deck has no isotropic material to stand for it");
  if (used)
    out.left_out(material.where("law"), name + ", computed as the elastic material " + stand_in.name,
                 name +
                     ": its law's numbers are not in the deck or its law is not known here; computed as the "
                     "elastic material " +
                     stand_in.name);
  law = "linear_elastic";
  return stand_in.values;
}

void add_materials(const Deck& deck, const Catalogue& catalogue, const Soils& soils, CardWriter& out) {
  const StandIn other = stand_in(deck, out);
  for (const CardView& material : deck.all("material")) {
    if (material.integer("law") == 6 || material.integer("law") == 7) continue;  // interfaces and links
    if (!(material.real("unit_weight") >= 0.0))
      fail(deck, material.where("unit_weight"),
           "the " + material.label("unit_weight") + " of a soil can't be negative: it would pull upwards");
    const int number = material.integer("number");
    std::map<double, int> numbers;  // by load factor
    for (const auto& [key, own] : soils.number)
      if (key.first == number) numbers.emplace(key.second, own);
    std::string law;
    const std::vector<NewField> values = law_of(deck, material, other, !numbers.empty(), law, out);
    if (numbers.empty()) numbers.emplace(1.0, number);
    for (const auto& [factor, own] : numbers) {
      std::string name = material.text("name", "-");
      if (factor != 1.0) name += " x " + number_text(factor);
      const int card = out.add("material", material.where(),
                               {{"number", static_cast<double>(own), material.where("number")},
                                {"law", static_cast<double>(law_code(catalogue, law)), material.where("law")},
                                take(material, "unit_weight", {}, factor / kCubicInches),
                                {"name", 0.0, material.where("name"), name}});
      out.add("parameters", material.where(), values, card);
    }
  }
}

struct GroupKey {
  int birth, death, material;  // of a beam: its wall
  bool triangle, beam;
  auto operator<=>(const GroupKey&) const = default;
};
using Groups = std::map<GroupKey, double>;  // ordered by load step

GroupKey key_of(const CardView& element, const Pipes& pipes) {
  if (is_beam(element)) return {birth_of(element), element.integer("death"), pipes.wall(element), false, true};
  const int n3 = element.integer("n3"), n4 = element.integer("n4");
  return {birth_of(element), element.integer("death"), element.integer("material"), n4 == 0 || n4 == n3, false};
}

// A node of an element; of nodes that a link joins for good the one that stays.
NewField joined(const CardView& element, const char* field, const CandeJoints& joints) {
  NewField node = take(element, field);
  node.number = static_cast<double>(joints.node(static_cast<int>(node.number)));
  return node;
}

// Those decks turn elements either way; this program wants them counter-clockwise.
class Turner {
 public:
  explicit Turner(const Deck& deck) {
    for (const CardView& node : deck.all("node"))
      place_.insert_or_assign(node.integer("number"), Vector2(node.real("x"), node.real("y")));
  }
  // The fields n1 ... in counter-clockwise order.
  std::vector<NewField> nodes(const CardView& element, bool triangle, const CandeJoints& joints) {
    std::vector<NewField> list;
    for (const char* node : {"n1", "n2", "n3", "n4"})
      if (!triangle || node[1] != '4') list.push_back(joined(element, node, joints));
    double twice_area = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto a = place_.find(static_cast<int>(list[i].number));
      const auto b = place_.find(static_cast<int>(list[(i + 1) % list.size()].number));
      if (a == place_.end() || b == place_.end()) return list;
      twice_area += a->second.x() * b->second.y() - b->second.x() * a->second.y();
    }
    if (twice_area >= 0.0) return list;
    ++turned_;
    std::reverse(list.begin(), list.end());
    for (std::size_t i = 0; i < list.size(); ++i) list[i].name = "n" + std::to_string(i + 1);
    return list;
  }
  int turned() const { return turned_; }

 private:
  std::map<int, Vector2> place_;
  int turned_ = 0;
};

// Without its beams the pipe would be a hole with loose soil above; its nodes are
// held: a rigid pipe that stays.
void leave_out(const Deck& deck, const Pipes& pipes, const CandeJoints& joints, CardWriter& out) {
  int beams = 0, interfaces = 0, links = 0;
  SourcePosition where;
  for (const CardView& element : deck.all("element")) {
    if (is_soil(element) || pipes.wall(element) >= 0 || joints.takes(element)) continue;
    const int kind = element.integer("class");
    if (where.line == 0) where = kind == 0 ? element.where() : element.where("class");
    ++(kind == 1 ? interfaces : kind > 1 ? links : beams);
    if (kind != 0) continue;
    for (const char* node : {"n1", "n2"})
      out.add("fixity", element.where(node), {take(element, node, "first"), {"x_code", 1.0}, {"y_code", 1.0}});
  }
  std::string list, message;
  const auto add = [&](int count, const std::string& what) {
    if (count == 0) return;
    const std::string comma = list.empty() ? "" : ", ";
    list += comma + std::to_string(count) + " " + what + (count == 1 ? "" : "s");
    message += comma + std::to_string(count) + " " + what + "(s)";
  };
  add(beams, "beam element");
  add(interfaces, "interface");
  add(links, "link");
  if (list.empty()) return;
  if (beams > 0) list += " (the pipe; its nodes are held)";
  message = "left out: " + message + "; this program does not translate them";
  if (links > 0)
    message += " (of links class 8 and 9 are: the equations of composite ones are in no source at hand)";
  if (beams > 0)
    message += ". The beams' nodes are held in x and y: the soil rests on a pipe that does not move";
  out.left_out(where, list, message);
}

// CANDE generates elements by rules that are not known here.
void refuse_generation(const Deck& deck) {
  int before = 0;
  for (const CardView& element : deck.all("element")) {
    for (const char* field : {"node_increment", "rows", "row_increment"})
      if (element.integer(field) > 1)
        fail(deck, element.where(field),
             "element generation (" + element.label(field) +
                 ") is not built: its rule stands in CANDE's user manual alone, which is not at hand; give "
                 "every element on a card of its own");
    if (const int number = element.integer("number"); before > 0 && number > before + 1)
      fail(deck, element.where("number"),
           "elements " + std::to_string(before + 1) + " to " + std::to_string(number - 1) +
               " are not given: CANDE fills such a gap by generation, which is not built; give every element "
               "on a card of its own");
    before = element.integer("number");
  }
}

Groups add_groups(const Deck& deck, const Catalogue& catalogue, const LoadFactors& factors, const Soils& soils,
                  const Pipes& pipes, const CandeJoints& joints, CardWriter& out) {
  Groups groups;
  for (const CardView& element : deck.all("element"))
    if (is_soil(element) || pipes.wall(element) >= 0) groups.try_emplace(key_of(element, pipes), 0.0);
  double number = 0.0;
  for (auto& [key, group] : groups) {
    group = ++number;
    if (key.beam) {
      const Wall& wall = pipes.walls()[static_cast<std::size_t>(key.material)];
      out.add("group", wall.where,
              {{"number", group},
               {"element", static_cast<double>(catalogue.elements.code_of("beam2"))},
               {"material", static_cast<double>(wall.material)},
               {"name", 0.0, {}, "pipe, step " + std::to_string(key.birth)}});
      continue;
    }
    out.add("group", deck.one("control").where(),
            {{"number", group},
             {"element", static_cast<double>(corner_element(catalogue, key.triangle))},
             {"material", static_cast<double>(soils.number.at({key.material, factors.at(key.birth)}))},
             {"name", 0.0, {}, "step " + std::to_string(key.birth)}});
  }
  Turner turner(deck);
  for (const CardView& element : deck.all("element")) {
    if (!is_soil(element) && pipes.wall(element) < 0) continue;
    const GroupKey key = key_of(element, pipes);
    std::vector<NewField> fields{take(element, "number"), {"group", groups.at(key)}};
    if (key.beam) {
      for (const char* node : {"n1", "n2"}) fields.push_back(joined(element, node, joints));
      out.add("element", element.where(), fields);
      continue;
    }
    for (NewField& node : turner.nodes(element, key.triangle, joints)) fields.push_back(std::move(node));
    out.add("element", element.where(), fields);
  }
  if (turner.turned() > 0)
    out.note("S704", {deck.file, 0, 0, 0},
             std::to_string(turner.turned()) + " element(s) listed clockwise were turned round");
  return groups;
}

// Supports that hold from the start; displacements and forces belong to their load step.
void add_boundary(const Deck& deck, const LoadFactors& factors, CardWriter& out, int step, int stage) {
  for (const CardView& card : deck.all("fixity")) {
    const bool x = card.integer("x_code") == 1, y = card.integer("y_code") == 1;
    const double vx = card.real("x_value"), vy = card.real("y_value");
    if (card.real("angle") != 0.0) fail(deck, card.where("angle"), "supports along turned axes are not built");
    if (card.real("pressure1") != 0.0 || card.real("pressure2") != 0.0)
      fail(deck, card.where("pressure1"), "pressures between nodes of a boundary card are not built");
    const int of_step = std::max(1, card.integer("load_step"));
    const bool plain = of_step == 1 && vx == 0.0 && vy == 0.0;
    if (plain ? stage >= 0 : stage < 0 || of_step != step) continue;
    const NewField last = take(card, "last"), by = take(card, "step");
    if (x || y)
      out.add("fixity", card.where(),
              {take(card, "first"),
               last,
               by,
               {"x_code", x ? 1.0 : 0.0},
               {"y_code", y ? 1.0 : 0.0},
               {"x_value", x ? vx : 0.0},
               {"y_value", y ? vy : 0.0}},
              stage);
    const double factor = stage < 0 ? 1.0 : factors.at(step);
    if (factor != 1.0 && ((x && vx != 0.0) || (y && vy != 0.0)))
      out.warning("S705", card.where(x && vx != 0.0 ? "x_value" : "y_value"),
                  "a prescribed displacement is no load: it is not multiplied by the load factor of its step");
    if ((!x && vx != 0.0) || (!y && vy != 0.0))
      out.add("load", card.where(),
              {take(card, "first"),
               last,
               by,
               {"x_force", x ? 0.0 : factor * vx},
               {"y_force", y ? 0.0 : factor * vy}},
              stage);
  }
}

// Elements live within the deck's load steps, at least from one to the next.
void check_life(const Deck& deck, const CardView& element, int given) {
  const std::string name = "element " + element.text("number");
  const int birth = element.integer("birth"), death = element.integer("death");
  if (birth < 0) fail(deck, element.where("birth"), name + ": its load step of birth is negative");
  if (death < 0) fail(deck, element.where("death"), name + ": its load step of death is negative");
  if (given > 0 && birth > given)
    fail(deck, element.where("birth"),
         name + " is born in load step " + std::to_string(birth) + ", after the last of the " +
             std::to_string(given) + " that card C-2 has: it would never be there");
  if (element.integer("class") <= 1 && death > 0 && death <= birth_of(element))
    fail(deck, element.where("death"),
         name + " is taken away in load step " + std::to_string(death) + ", and is born in " +
             std::to_string(birth_of(element)) + ": it would never be there");
}

// Ends of a pipe that a card C-5 keeps on a line across it, free along that line, are where a half mesh has been cut: by
// symmetry they don't turn.  Card C-5 has no rotation; without this the pipe would have a hinge there.
void hold_ends_on_symmetry(const Deck& deck, const Pipes& pipes, const CandeJoints& joints, CardWriter& out) {
  std::map<int, Vector2> place;
  for (const CardView& node : deck.all("node"))
    place.insert_or_assign(node.integer("number"), Vector2(node.real("x"), node.real("y")));
  std::map<int, std::vector<int>> others;  // of a beam's node: the other ends of its beams
  for (const CardView& element : deck.all("element")) {
    if (!is_beam(element) || pipes.wall(element) < 0) continue;
    others[joints.node(element.integer("n1"))].push_back(element.integer("n2"));
    others[joints.node(element.integer("n2"))].push_back(element.integer("n1"));
  }
  std::vector<int> held;
  SourcePosition first;
  for (const CardView& card : deck.all("fixity")) {
    const bool x = card.integer("x_code") == 1, y = card.integer("y_code") == 1;
    if (x == y || card.integer("load_step") > 1 || card.real(x ? "x_value" : "y_value") != 0.0) continue;
    const int from = card.integer("first"), to = std::max(from, card.integer("last")),
              step = std::max(1, card.integer("step"));
    for (int node = from; node <= to; node += step) {
      const auto found = others.find(joints.node(node));
      if (found == others.end() || found->second.size() != 1) continue;
      const auto here = place.find(node), there = place.find(found->second.front());
      if (here == place.end() || there == place.end()) continue;
      const Vector2 along = there->second - here->second;
      if (std::abs(x ? along.x() : along.y()) <= std::abs(x ? along.y() : along.x())) continue;
      if (held.empty()) first = card.where("first");
      held.push_back(found->first);
      out.add(
          "fixity", card.where("first"),
          {{"first", static_cast<double>(found->first)}, {"x_code", 1.0}, {"unknown", 0.0, {}, "rotation"}});
    }
  }
  if (!held.empty())
    out.warning(
        "S704", first,
        std::to_string(held.size()) + " end(s) of the pipe, the first at node " + std::to_string(held.front()) +
            ", are kept on a line across the pipe: taken for a line of symmetry, where it does not turn");
}

// The control card's number; without one the last step in which an element is born or taken away.
int load_steps(const Deck& deck, const CandeJoints& joints) {
  const int given = deck.one("control").integer("load_steps");
  int steps = std::max({1, given, given > 0 ? 0 : joints.last_step()});
  for (const CardView& element : deck.all("element")) {
    check_life(deck, element, given);
    if (given <= 0 && (is_soil(element) || is_beam(element)))
      steps = std::max({steps, birth_of(element), element.integer("death")});
  }
  if (steps > kMostSteps)
    fail(deck, deck.one("control").where("load_steps"),
         std::to_string(steps) + " load steps; at most " + std::to_string(kMostSteps) + " are taken");
  return steps;
}

void add_stages(const Deck& deck, const LoadFactors& factors, CardWriter& out, const Groups& groups,
                const CandeJoints& joints) {
  const CardView control = deck.one("control");
  const int steps = load_steps(deck, joints);
  for (int step = 1; step <= steps; ++step) {
    out.add("stage_title", control.where(), {{"title", 0.0, {}, "load step " + std::to_string(step)}});
    const int stage =
        out.add("stage", control.where(), {{"increments", 1.0}, {"gravity_y", step == 1 ? -1.0 : 0.0}});
    std::vector<NewField> births, deaths;
    for (const auto& [key, number] : groups) {
      if (step > 1 && key.birth == step) births.push_back({"groups", number});
      if (key.death == step) deaths.push_back({"groups", number});
    }
    for (const CandeJoints::Group& group : joints.groups()) {
      const auto number = static_cast<double>(group.number);
      if (step > 1 && group.birth == step) births.push_back({"groups", number});
      if (group.death == step) deaths.push_back({"groups", number});
    }
    if (step > 1) joints.add_gaps(step, stage, out);
    add_boundary(deck, factors, out, step, stage);
    if (!births.empty()) out.add("birth", control.where(), births, stage);
    if (!deaths.empty()) out.add("death", control.where(), deaths, stage);
  }
}

// Numbers of nodes may have gaps: card C-2 has the highest.
void check_highest_node(const Deck& deck, const CardView& control, const CandeJoints& joints, CardWriter& out) {
  const int stated = control.integer("total_nodes"), highest = joints.highest_node();
  if (stated == 0 || highest == 0 || stated == highest) return;
  const std::string words = "the highest node is " + std::to_string(stated) + " by this card, " +
                            std::to_string(highest) + " by cards C-3";
  if (stated > highest) return out.warning("S701", control.where("total_nodes"), words);
  Diagnostics problems;
  problems.add(card_diagnostic(deck, Severity::error, "S701", control.where("total_nodes"), words));
  throw InputError(problems);
}

// Live loads that CANDE spreads along the pipe as they go down into the ground.
void refuse_load_scaling(const Deck& deck, CardWriter& out) {
  const std::vector<CardView> cards = deck.all("load_scaling");
  if (!cards.empty())
    out.left_out(
        cards.front().where("text"), "continuous load scaling",
        "continuous load scaling (cards C-2b and C-2c) is not built: its equations are in no source at "
        "hand; forces on nodes count as they are");
}

// The largest modulus of an elastic soil, and that of a hyperbolic one at atmospheric pressure; 0: there is none.
SoilStiffness stiffest_soil(const Deck& deck) {
  double elastic = 0.0, hyperbolic = 0.0;
  const auto see = [](double& most, double modulus) {
    if (std::isfinite(modulus)) most = std::max(most, modulus);
  };
  for (const char* card : {"isotropic", "mohr_coulomb"})
    for (const CardView& soil : deck.all(card)) see(elastic, soil.real("youngs_modulus"));
  for (const CardView& soil : deck.all("duncan_strength"))
    see(hyperbolic, kAtmosphere * soil.real("modulus_number"));
  for (const CardView& material : deck.all("material"))
    for (const CardView& model : deck.all("duncan", material))
      if (const NamedSoil* soil = named_soil(selig(model), material.text("name")))
        see(hyperbolic, kAtmosphere * soil->K);
  return {elastic, hyperbolic};
}

double stiffest_wall(const Pipes& pipes) {
  double most = 0.0;
  for (const Wall& wall : pipes.walls()) most = std::max(most, wall.axial);
  return most;
}

// What the load factors do, and where the deck contradicts itself.
void explain_factors(const Deck& deck, const LoadFactors& factors, CardWriter& out) {
  const int step = factors.first_in_use();
  if (step == 0) return;
  const CardView first = deck.all("load_factor").front();
  out.note("S705", first.where("factor"),
           "the load factors multiply what is added in their load steps: the weight of the elements born there "
           "and the forces on nodes");
  for (const CardView& title : deck.all("title"))
    if (title.integer("method") == 0)
      out.warning("S705", title.where("method"),
                  "this card asks for working stress (method 0), yet load step " + std::to_string(step) +
                      " has a load factor other than 1; the factors are applied");
}

}  // namespace

Deck cande_deck(const Deck& deck, const Catalogue& catalogue) {
  CardWriter out(deck);
  out.copy("title");
  const CardView control = deck.one("control");
  out.add("units", control.where(),
          {{"length", 0.0, {}, "in"},
           {"force", 0.0, {}, "lbf"},
           {"stress", 0.0, {}, "psi"},
           {"atmospheric_pressure", kAtmosphere},
           {"water_unit_weight", kCandeWaterWeight}});
  out.add("control", control.where(), {{"geometry", 1.0}});
  CandeJoints joints(deck, out);
  check_highest_node(deck, control, joints, out);
  const LoadFactors factors(deck, load_steps(deck, joints));
  const Soils soils(deck, factors);
  add_listed_nodes(deck, joints, out);
  add_materials(deck, catalogue, soils, out);
  refuse_generation(deck);
  const Pipes pipes(deck, factors, soils.highest, out);
  add_walls(pipes, catalogue, out);
  leave_out(deck, pipes, joints, out);
  refuse_load_scaling(deck, out);
  const Groups groups = add_groups(deck, catalogue, factors, soils, pipes, joints, out);
  joints.add(catalogue, stiffest_soil(deck), stiffest_wall(pipes),
             soils.highest + static_cast<int>(pipes.walls().size()), static_cast<int>(groups.size()), out);
  joints.add_gaps(1, -1, out);
  add_boundary(deck, factors, out, 0, -1);
  hold_ends_on_symmetry(deck, pipes, joints, out);
  explain_factors(deck, factors, out);
  add_stages(deck, factors, out, groups, joints);
  return out.take();
}

}  // namespace sage::translate

#include <array>
#include <cmath>

#include "sage/exchange/translate_cande.hpp"

namespace sage::translate {

namespace {

constexpr double kStiffer = 1e4;  // contact, than elastic soil
constexpr double kStifferThanSoft =
    30.0;                            // and than soil at atmospheric pressure, whose lifts begin far softer
constexpr double kShearShare = 0.1;  // of the normal stiffness, before slip, in such soil
// Of the shear stiffness, in the tangent of what slips: without it a pipe that slips all around can spin.  In elastic
// soil, where shear is as stiff as contact, it comes to 1e-4 of the soil.
constexpr double kSlipTangent = 1e-4, kSlipTangentInElastic = 1e-8;
// Of the shear stiffness, without friction: an elastic trace that never slips.  Coordinates and angles with the decimals of
// their cards leave a round pipe a moment that nothing else could balance.
constexpr double kSmooth = 1e-10;
constexpr double kAtOnePlace = 1e-6;  // of the mesh's reach
// Of the way to its soil that a normal shows at least, or it lies along the surface.
constexpr double kSlant = 0.2;

}  // namespace

void refuse_field(const Deck& deck, const SourcePosition& where, const std::string& message) {
  Diagnostics problems;
  problems.add(card_diagnostic(deck, Severity::error, "S702", where, message));
  throw InputError(problems);
}

CandeJoints::CandeJoints(const Deck& deck, CardWriter& out) {
  for (const CardView& node : deck.all("node")) {
    const int number = node.integer("number");
    nodes_.insert_or_assign(number, Vector2(node.real("x"), node.real("y")));
    highest_node_ = std::max(highest_node_, number);
  }
  bool any = false;
  for (const CardView& element : deck.all("element")) any = any || element.integer("class") != 0;
  if (!any) return;
  look_around(deck);
  read_materials(deck);
  for (const CardView& element : deck.all("element")) {
    const int kind = element.integer("class");
    if (kind == 1) add_interface(deck, element);
    if (kind == 8 || kind == 9) add_link(deck, element, out);
  }
  if (turned_ > 0)
    out.warning("S704", first_turned_,
                "the normal of " + std::to_string(turned_) +
                    " interface(s) points from node 2 to node 1 by the soil around them, and is turned: an "
                    "interface opens where its second node moves along the normal");
  if (along_ > 0)
    out.warning("S704", first_along_,
                "the normal of " + std::to_string(along_) +
                    " interface(s) lies nearly along the surface of the soil there (angle from x, to the side "
                    "of the second node): they hold along it and slip across");
}

void CandeJoints::look_around(const Deck& deck) {
  for (const CardView& element : deck.all("element")) {
    std::vector<int> corners;
    for (const char* field : {"n1", "n2", "n3", "n4"}) {
      const int node = element.integer(field);
      if (node != 0 && std::ranges::find(corners, node) == corners.end()) corners.push_back(node);
    }
    Vector2 middle = Vector2::Zero();
    for (const int node : corners)
      if (const auto found = nodes_.find(node); found != nodes_.end())
        middle += found->second / static_cast<double>(corners.size());
    for (const int node : corners) {
      Around& here = around_[node];
      ++here.uses;
      here.beam = here.beam || is_beam(element);
      if (element.integer("class") == 0)
        here.birth = here.birth == 0 ? birth_of(element) : std::min(here.birth, birth_of(element));
      if (!is_soil(element)) continue;
      here.soil += middle;
      ++here.soils;
    }
  }
  for (const CardView& card : deck.all("fixity")) {
    const int first = card.integer("first"), last = std::max(first, card.integer("last")),
              step = std::max(1, card.integer("step"));
    for (auto at = around_.lower_bound(first); at != around_.end() && at->first <= last; ++at)
      if ((at->first - first) % step == 0) at->second.held = true;
  }
}

void CandeJoints::read_materials(const Deck& deck) {
  for (const CardView& material : deck.all("material")) {
    if (material.integer("law") != 6) continue;
    const std::vector<CardView> cards = deck.all("interface", material);
    if (cards.empty())
      refuse_field(deck, material.where("law"),
                   "interface material " + material.text("number") + " has no card D-2.Interface");
    const CardView& card = cards.front();
    const auto checked = [&](const char* field, double least, double most) {
      const double value = card.real(field);
      if (!(value >= least && value <= most))
        refuse_field(deck, card.where(field),
                     "the " + card.label(field) + " of an interface must lie from " + number_text(least) +
                         " to " + number_text(most) + "; here it is " + number_text(value));
      return value;
    };
    const Material one{
        card.where("angle"),
        checked("angle", -360.0, 360.0),
        {checked("friction", 0.0, 100.0), checked("tension", 0.0, 1e9), checked("gap", 0.0, 1e6), false}};
    if (!materials_.emplace(material.integer("number"), one).second)
      refuse_field(deck, material.where("number"),
                   "interface material " + material.text("number") + " is defined twice");
  }
}

CandeJoints::Joint CandeJoints::start(const Deck& deck, const CardView& element, const char* what) {
  Joint joint{element, {}, node(element.integer("n1")), node(element.integer("n2")), element.integer("n3"),
              0,       {}};
  const std::string name = std::string(what) + " " + element.text("number");
  std::array<Vector2, 2> place;
  for (std::size_t i = 0; i < 2; ++i) {
    const char* field = i == 0 ? "n1" : "n2";
    const auto found = nodes_.find(element.integer(field));
    if (found == nodes_.end())
      refuse_field(
          deck, element.where(field),
          name + ": node " + element.text(field, "0") +
              " has no card C-3; CANDE places such nodes by its Laplace generation, whose rule is in no "
              "source at hand");
    place[i] = found->second;
  }
  double reach = 0.0;
  for (const auto& [number, at] : nodes_) reach = std::max(reach, at.cwiseAbs().maxCoeff());
  if ((place[0] - place[1]).norm() > kAtOnePlace * reach)
    refuse_field(deck, element.where("n2"),
                 name + " joins nodes " + number_text((place[0] - place[1]).norm()) +
                     " in apart; only nodes at one place can be joined here");
  if (joint.first == joint.second) refuse_field(deck, element.where("n2"), name + " joins a node with itself");
  if (joint.third == 0 || joint.third == element.integer("n1") || joint.third == element.integer("n2") ||
      around_[joint.third].uses > 1)
    refuse_field(deck, element.where("n3"),
                 name + ": its third node must be its own, which no other element has");
  joint.far = place[0];
  last_step_ = std::max({last_step_, birth_of(element), element.integer("death")});
  known_.insert(element.integer("number"));
  return joint;
}

// How far the way to the soil at the second node, or from that at the first, goes along the normal: 1 all of it, negative
// where the normal is turned round; 1 too where there is no soil to tell.
double CandeJoints::towards_soil(const Joint& joint, const Vector2& normal) const {
  double shown = 0.0;
  int sides = 0;
  for (const auto& [node, sense] : {std::pair{joint.first, -1.0}, std::pair{joint.second, 1.0}}) {
    const Around& here = around_.at(node);
    if (here.soils == 0) continue;
    const Vector2 way = here.soil / here.soils - nodes_.at(node);
    if (way.norm() == 0.0) continue;
    shown += sense * normal.dot(way.normalized());
    ++sides;
  }
  return sides == 0 ? 1.0 : shown / sides;
}

void CandeJoints::add_interface(const Deck& deck, const CardView& element) {
  const auto material = materials_.find(element.integer("material"));
  if (material == materials_.end())
    refuse_field(deck, element.where("material"),
                 "interface " + element.text("number") + ": no card D-1 has the interface material " +
                     element.text("material", "0"));
  Joint joint = start(deck, element, "interface");
  joint.law = material->second.law;
  const double angle = material->second.angle * kRadiansPerDegree;
  Vector2 normal(std::cos(angle), std::sin(angle));
  const double towards = towards_soil(joint, normal);
  if (std::abs(towards) < kSlant && ++along_ == 1) first_along_ = material->second.where;
  if (towards < -kSlant) {
    if (++turned_ == 1) first_turned_ = element.where();
    normal = -normal;
  }
  joint.far += 2.0 * Vector2(normal.y(), -normal.x());  // the normal is to the left of the way there
  moved_.insert(joint.third);
  joints_.push_back(joint);
}

// Pinned, or with no rotation to tie: a joint that never parts.  Two beams, for good: one node.
void CandeJoints::add_link(const Deck& deck, const CardView& element, CardWriter& out) {
  Joint joint = start(deck, element, "link");
  const Around &first = around_[joint.first], &second = around_[element.integer("n2")];
  if (element.integer("class") == 9 || !first.beam || !second.beam) {
    joint.law.bonded = true;
    joint.far += Vector2(2.0, 0.0);
    moved_.insert(joint.third);
    joints_.push_back(joint);
    return;
  }
  const bool for_good =
      element.integer("death") == 0 && birth_of(element) <= std::max(first.birth, second.birth);
  if (!for_good || second.held) {
    const std::string name = "link " + element.text("number");
    out.left_out(
        element.where(for_good                        ? "n2"
                      : element.integer("death") != 0 ? "death"
                                                      : "birth"),
        name,
        name + (for_good ? ": its second node has supports or loads of its own (card C-5)"
                         : " welds two beams (class 8) for some load steps: a rotation is tied here for "
                           "good or not at all"));
    return;
  }
  joined_[element.integer("n2")] = joint.first;
}

int CandeJoints::node(int number) const {
  for (auto other = joined_.find(number); other != joined_.end(); other = joined_.find(number))
    number = other->second;
  return number;
}

void CandeJoints::add_nodes(CardWriter& out) const {
  int number = highest_node_;
  for (const Joint& joint : joints_)
    for (const int node : {joint.third, ++number})
      out.add("node", joint.card.where("n3"),
              {{"number", static_cast<double>(node)}, {"x", joint.far.x()}, {"y", joint.far.y()}});
}

void CandeJoints::add(const Catalogue& catalogue, const SoilStiffness& soils, double stiffest_wall,
                      int material, int group, CardWriter& out) {
  const bool soft = soils.hyperbolic > 0.0;
  const double stiffest = std::max({soils.elastic, soils.hyperbolic, 1.0}),
               contact = soft ? kStifferThanSoft * soils.hyperbolic : kStiffer * stiffest,
               shear = soft ? kShearShare * contact : contact,
               bond = kStiffer * std::max(stiffest, stiffest_wall);
  const auto as_number = [](int value) { return static_cast<double>(value); };
  std::map<Law, int> numbers;
  for (const Joint& joint : joints_) {
    const auto [law, is_new] = numbers.try_emplace(joint.law, material + 1);
    if (!is_new) continue;
    ++material;
    const Law& l = joint.law;
    const int card = out.add("material", joint.card.where(),
                             {{"number", as_number(material)},
                              {"law", as_number(law_code(catalogue, l.bonded ? "goodman" : "clough_duncan"))},
                              {"name", 0.0, {}, l.bonded ? "link" : "interface"}});
    std::vector<double> values{bond, bond, 1.0};
    const double along = l.friction > 0.0 ? shear : kSmooth * shear;
    if (!l.bonded)
      values = {0.0,
                std::atan(l.friction) / kRadiansPerDegree,
                l.tension,
                0.0,
                along / kCandeWaterWeight,
                0.0,
                contact,
                l.tension > 0.0 ? contact : 0.0,
                l.friction > 0.0 ? 0.0 : along};
    const double in_slip =
        l.friction > 0.0 ? (soft ? kSlipTangent : kSlipTangentInElastic) : kSlipTangentInElastic;
    if (!l.bonded) values.insert(values.end(), {0.0, 1e-6, 0.0, in_slip});
    std::vector<NewField> fields;
    for (const double value : values) fields.push_back({"values", value});
    out.add("parameters", joint.card.where(), fields, card);
  }
  const double interface = as_number(catalogue.elements.code_of("interface4"));
  std::map<std::tuple<int, int, Law>, int> group_of;
  int fourth = highest_node_;
  for (const Joint& joint : joints_) {
    const int birth = birth_of(joint.card), death = joint.card.integer("death");
    const auto [of, is_new] = group_of.try_emplace({birth, death, joint.law}, group + 1);
    if (is_new) {
      groups_.push_back({joint.law, birth, death, ++group, joint.card.where()});
      out.add("group", joint.card.where(),
              {{"number", as_number(group)},
               {"element", interface},
               {"material", as_number(numbers.at(joint.law))},
               {"name",
                0.0,
                {},
                (joint.law.bonded ? "links, step " : "interfaces, step ") + std::to_string(birth)}});
    }
    ++fourth;
    out.add("element", joint.card.where(),
            {take(joint.card, "number"),
             {"group", as_number(of->second)},
             {"n1", as_number(node(joint.first)), joint.card.where("n1")},
             {"n2", as_number(joint.third), joint.card.where("n3")},
             {"n3", as_number(fourth), joint.card.where("n3")},
             {"n4", as_number(node(joint.second)), joint.card.where("n2")}});
    for (const int held : {joint.third, fourth})
      out.add("fixity", joint.card.where("n3"), {{"first", as_number(held)}, {"x_code", 1.0}, {"y_code", 1.0}});
  }
}

void CandeJoints::add_gaps(int step, int stage, CardWriter& out) const {
  for (const Group& group : groups_)
    if (group.birth == step && group.law.gap > 0.0)
      out.add("initial", group.where,
              {{"group", static_cast<double>(group.number)},
               {"kind", 4.0},
               {"v1", 1.0},
               {"v2", group.law.gap},
               {"v3", 1.0}},
              stage);
}

}  // namespace sage::translate

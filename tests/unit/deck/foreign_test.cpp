// Decks that no one here wrote, under layouts of other programs.
// Expected values of CANDE and QUAD4M: every card as a Fortran runtime read it (data/parse_golden).
// Expected values of the list-directed decks: counted and copied by hand from the decks.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "sage/deck/read_deck.hpp"
#include "sage/deck/text.hpp"
#include "tests/support/text.hpp"

namespace sage {
namespace {

const std::string kInputs = SAGE_SOURCE_DIR "/legacy_inputs/";

// One row of the table: line, card, texts joined by "|", integers, reals.
struct GoldenCard {
  std::string name;
  std::vector<std::string> texts;
  std::vector<double> numbers;
  bool parsed = true;
};

std::map<int, GoldenCard> golden(const std::string& name) {
  std::ifstream file(SAGE_SOURCE_DIR "/tests/unit/deck/data/parse_golden/" + name);
  std::map<int, GoldenCard> cards;
  for (std::string line; std::getline(file, line);) {
    GoldenCard card;
    const std::size_t comma = line.find(',');
    const std::size_t after = std::min(line.find(',', comma + 1), line.size());
    card.name = line.substr(comma + 1, after - comma - 1);
    const int number = std::stoi(line);
    std::string rest = line.substr(after + 1);
    card.parsed = rest != "not parsed";
    if (card.parsed) {
      const std::size_t quote = rest.find('"', 1);
      card.texts = test::split(rest.substr(1, quote - 1), '|');
      if (quote + 2 < rest.size())
        for (const std::string& part : test::split(rest.substr(quote + 2), ','))
          card.numbers.push_back(std::stod(part));
    }
    cards[number] = card;
  }
  return cards;
}

// Texts, then integers, then reals of a card as the table has them.
void compare(const Deck& deck, const Card& card, const GoldenCard& expected) {
  const CardSpec& spec = deck.specs[card.spec];
  SCOPED_TRACE(spec.label + ", line " + std::to_string(card.line));
  std::vector<std::string> texts;
  std::vector<double> integers, reals;
  for (const FieldValue& value : deck.values(card)) {
    if (value.kind == FieldKind::text) texts.emplace_back(trimmed(value.text));
    if (value.kind == FieldKind::integer) integers.push_back(value.number);
    if (value.kind == FieldKind::real) reals.push_back(value.number);
  }
  integers.insert(integers.end(), reals.begin(), reals.end());
  EXPECT_EQ(integers, expected.numbers);
  if (texts.empty()) texts.emplace_back();
  ASSERT_EQ(texts.size(), expected.texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(texts[i], trimmed(expected.texts[i]));
}

// Every row of the table has its card, and every value is the same to the last bit.
void compare_deck(const std::string& path, const std::string& table, int cards) {
  const Deck deck = read_deck(kInputs + path);
  const std::map<int, GoldenCard> rows = golden(table);
  int compared = 0;
  for (const Card& card : deck.cards) {
    const auto row = rows.find(card.line);
    if (row == rows.end() || !row->second.parsed) continue;
    compare(deck, card, row->second);
    ++compared;
  }
  int expected = 0;
  for (const auto& [line, row] : rows) expected += row.parsed ? 1 : 0;
  EXPECT_EQ(compared, expected);
  EXPECT_EQ(compared, cards);
  EXPECT_EQ(deck.diagnostics.warnings(), 0);
}

TEST(Cande, EveryCardOfTheMesh) {
  compare_deck("cande_level3/candejar_input_test.cid", "candejar_input_test.csv", 3574);
}

TEST(Cande, EveryCardOfTheMock) {
  compare_deck("cande_level3/candejar_cidmock_standard_lines.cid", "candejar_cidmock_standard_lines.csv", 12);
}

TEST(Cande, TrimmedBlanksReadTheSame) {
  const Layout layout = load_layout("cande_level3");
  const Deck padded = read_deck(kInputs + "cande_level3/candejar_input_test.cid", layout);
  const Deck cut = read_deck(kInputs + "cande_level3/candejar_input_test1.cid", layout);
  ASSERT_EQ(padded.cards.size(), cut.cards.size());
  int different = 0;
  for (std::size_t c = 0; c < padded.cards.size(); ++c) {
    const std::vector<FieldValue> a = padded.values(padded.cards[c]), b = cut.values(cut.cards[c]);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      different += a[i].number != b[i].number || a[i].blank != b[i].blank ? 1 : 0;
  }
  EXPECT_EQ(different, 1);  // C-2: 28 and 3 soil materials
  EXPECT_EQ(padded.one("control").integer("materials"), 28);
  EXPECT_EQ(cut.one("control").integer("materials"), 3);
}

TEST(Cande, NodesAndElementsGoByTheirOwnNames) {
  const Layout layout = load_layout("cande_level3");
  const Deck deck = read_deck(kInputs + "cande_level3/candejar_input_test.cid", layout);
  EXPECT_EQ(deck.all("node").size(), 1471u);
  EXPECT_EQ(deck.all("element").size(), 2047u);
  EXPECT_EQ(deck.all("fixity").size(), 46u);
  const std::vector<CardView> materials = deck.all("material");
  ASSERT_EQ(materials.size(), 3u);
  EXPECT_EQ(materials[1].text("name"), "CL90");
  EXPECT_EQ(materials[1].integer("law"), 3);
  EXPECT_EQ(deck.all("duncan", materials[1])[0].real("average"), 0.5);
  EXPECT_TRUE(deck.all("isotropic", materials[1]).empty());
  EXPECT_EQ(to_string(deck.all("node")[0].where("x")).substr(deck.file.size()), ":8:38-47");
}

TEST(Cande, MisplacedCardsAreNamed) {
  const Layout layout = load_layout("cande_level3");
  const std::string node = std::string(19, ' ') + "C-3.L3!!    1  00      0.00      0.00\n";
  try {
    read_deck_text(node, "x.cid", layout);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "x.cid:1: error: card A-1 is missing: \"C-3.L3!!    1  00      0.00   \" stands here [S110]\n"
                 "      | ....+....1....+....2....+....3....+....4....+....5....+.\n"
                 "    1 |                    C-3.L3!!    1  00      0.00      0.00");
  }
}

TEST(Quad4m, EveryNodeAndElement) {
  compare_deck("quad4m/MDL.Q4I", "MDL.Q4I.csv", 5222);
}

TEST(Quad4m, Control) {
  const Deck deck = read_deck(kInputs + "quad4m/MDL.Q4I", load_layout("quad4m"));
  EXPECT_EQ(deck.one("units").text("system"), "S");
  EXPECT_EQ(deck.one("damping").real("rock_vs"), 1350.0);
  EXPECT_EQ(deck.all("motion_file")[1].text("file"), "WFY.ACC");
  EXPECT_EQ(deck.one("seismic_output").text("suffix"), "Q4K");
  EXPECT_EQ(deck.one("state_output").text("file"), "SG.Q4R");
}

// ---- List-directed ------------------------------------------------------------------------------------------

Deck textbook(const std::string& name, const std::string& layout) {
  return read_deck(kInputs + "smith_griffiths/" + name + ".dat", load_layout(layout));
}

std::vector<double> numbers(const ValueList& values) {
  std::vector<double> list;
  for (const FieldValue& value : values) list.push_back(value.number);
  return list;
}

TEST(SmithGriffiths, TextsAndCodesBecomeOurs) {
  const Deck deck = textbook("p51_5", "sg_p51");
  const CardView mesh = deck.one("rectangle");
  EXPECT_EQ(mesh.integer("geometry"), 2);
  EXPECT_EQ(mesh.text("geometry"), "axisymmetric");
  EXPECT_EQ(mesh.integer("shape"), 2);
  EXPECT_EQ(mesh.integer("nodes_per_element"), 4);
  EXPECT_EQ(mesh.integer("direction"), 2);
  EXPECT_EQ(mesh.integer("columns"), 3);
  EXPECT_EQ(mesh.integer("rows"), 2);
  EXPECT_EQ(mesh.card().line, 1);
  EXPECT_EQ(mesh.where("rows").line, 3);
  const std::vector<CardView> rows = deck.all("material_values");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].real("youngs_modulus"), 1000.0);
  EXPECT_EQ(rows[1].real("poissons_ratio"), 0.45);
  EXPECT_EQ(numbers(deck.one("element_materials").list("materials")), (std::vector<double>{1, 2, 1, 2, 1, 2}));
  EXPECT_EQ(numbers(deck.one("rectangle_x").list("x")), (std::vector<double>{0, 4, 10, 30}));
  EXPECT_EQ(numbers(deck.one("rectangle_y").list("y")), (std::vector<double>{0, -4, -10}));
  const std::vector<CardView> fixities = deck.all("fixity");
  ASSERT_EQ(fixities.size(), 8u);
  EXPECT_EQ(fixities[2].integer("first"), 3);
  EXPECT_EQ(fixities[0].integer("x_code"), 1);  // "1 0 1": x fixed, y free
  EXPECT_EQ(fixities[0].integer("y_code"), 0);
  EXPECT_EQ(deck.all("load")[1].real("y_force"), -23.3333);
  EXPECT_TRUE(deck.all("displacement").empty());
}

TEST(SmithGriffiths, TrianglesHaveTwoMaterialsARectangle) {
  const Deck deck = textbook("p51_2", "sg_p51");
  EXPECT_EQ(deck.one("rectangle").integer("shape"), 1);
  EXPECT_EQ(deck.all("fixity").size(), 17u);
  EXPECT_EQ(deck.all("fixity")[16].card().line, 11);
  EXPECT_EQ(deck.all("load").size(), 5u);
  EXPECT_EQ(textbook("p51_1", "sg_p51").all("load").size(), 3u);
}

TEST(SmithGriffiths, EveryDeckReadsToItsEnd) {
  EXPECT_EQ(textbook("p52", "sg_p52").one("load").real("x_force"), 0.3183);
  EXPECT_EQ(textbook("p52", "sg_p52").all("fixity").size(), 13u);
  const Deck footing = textbook("p61", "sg_p61");
  EXPECT_EQ(footing.all("fixity").size(), 33u);
  EXPECT_EQ(numbers(footing.one("increments").list("factors")),
            (std::vector<double>{200, 100, 50, 50, 50, 30, 20, 10, 5, 4}));
  EXPECT_EQ(footing.one("material_values").real("undrained_strength"), 100.0);
  const Deck rigid = textbook("p63", "sg_p63");
  EXPECT_EQ(rigid.one("rectangle_x").list("x").size(), 41u);
  EXPECT_EQ(rigid.one("rectangle_y").list("y").size(), 21u);
  EXPECT_EQ(rigid.one("rectangle_y").list("y")[20].number, 0.0);
  EXPECT_EQ(rigid.one("increments").real("displacement"), -0.001);
  EXPECT_EQ(textbook("p66", "sg_p66").one("iteration").real("yield_tolerance"), 5e-5);
  EXPECT_EQ(textbook("p68", "sg_p68").one("iteration").integer("limit"), 25);
  const Deck lifts = textbook("p69", "sg_p69");
  EXPECT_EQ(lifts.one("embankment").integer("lifts"), 5);
  EXPECT_EQ(numbers(lifts.one("embankment_y").list("y")), (std::vector<double>{10, 11, 12, 13, 14}));
  EXPECT_EQ(lifts.all("fixity").size(), 49u);
  const Deck triaxial = textbook("p611_1", "sg_p611");
  EXPECT_EQ(triaxial.one("material_values").real("consolidation"), -100.0);
  EXPECT_EQ(triaxial.all("displacement")[2].integer("first"), 6);
  EXPECT_EQ(triaxial.one("iteration").real("displacement"), -2e-3);
}

}  // namespace
}  // namespace sage

// The reader against the Fortran runtime of this machine, on random fields, FORMATs and records.
// The cases go through a batch file: one Fortran program reads them all (oracle.f90).
#include <gtest/gtest.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>

#include "fortran_case.hpp"

namespace sage::test {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  bool chance(int percent) { return below(100) < percent; }
  char of(std::string_view letters) { return letters[below(static_cast<int>(letters.size()))]; }

 private:
  std::mt19937 engine_;
};

// Another seed looks for what the fixed ones don't meet: SAGE_ORACLE_SEED=5 test_deck_oracle.
unsigned seed(unsigned fixed) {
  const char* other = std::getenv("SAGE_ORACLE_SEED");
  return fixed + (other ? 1000u * static_cast<unsigned>(std::atoi(other)) : 0u);
}

std::string digits(Random& random, int most) {
  std::string text;
  for (int n = 1 + random.below(most); n > 0; --n) text += random.of("0123456789");
  return text;
}

// Something that mostly is a number.
std::string number(Random& random, bool real) {
  std::string text;
  if (random.chance(30)) text += random.of("+-");
  if (!random.chance(10)) text += digits(random, real ? 6 : 5);
  if (real && random.chance(70)) text += '.';
  if (real && random.chance(60)) text += digits(random, random.chance(5) ? 20 : 6);
  if (real && random.chance(25)) {
    if (random.chance(80)) text += random.of("EeDdQq");
    if (random.chance(10)) text += ' ';
    if (random.chance(50)) text += random.of("+-");
    if (random.chance(95)) text += digits(random, random.chance(5) ? 4 : 2);
  }
  return text;
}

// A field of some width: a number somewhere in it, sometimes spoilt.
std::string field(Random& random, char kind, int width) {
  std::string text;
  if (kind == 'L')
    text = std::string(random.chance(30) ? "." : "") + random.of("TFtfx") + (random.chance(30) ? "rue" : "");
  if (kind == 'A')
    for (int n = random.below(width + 1); n > 0; --n) text += random.of("ABC abc 123,.'");
  if (kind == 'I' || kind == 'D')
    text = random.chance(8) ? "" : number(random, kind == 'D' || random.chance(3));
  if (static_cast<int>(text.size()) < width)
    text.insert(
        0,
        static_cast<std::size_t>(random.chance(60) ? width - static_cast<int>(text.size())
                                                   : random.below(width - static_cast<int>(text.size()) + 1)),
        ' ');
  if (random.chance(6) && !text.empty())
    text[random.below(static_cast<int>(text.size()))] = random.of(" ,.+-0Ox\tE:/*");
  text.resize(width, ' ');
  return text;
}

struct Item {
  char kind;
  int width;
};

// A data edit with its repeat count; its fields are added to `items`.
std::string data_edit(Random& random, std::vector<Item>& items) {
  const char kind = random.of("IIIDDDDDAL");
  const int repeat = random.chance(40) ? 1 + random.below(3) : 1;
  const int width = 1 + random.below(random.chance(10) ? 25 : 12);
  std::string edit = repeat > 1 || random.chance(5) ? std::to_string(repeat) : "";
  if (kind == 'I')
    edit += "I" + std::to_string(width) + (random.chance(5) ? "." + std::to_string(random.below(width)) : "");
  if (kind == 'A') edit += "A" + std::to_string(width);
  if (kind == 'L') edit += "L" + std::to_string(width);
  if (kind == 'D') {
    static constexpr const char* letters[] = {"F", "F", "F", "E", "D", "G", "ES", "EN"};
    edit += std::string(letters[random.below(8)]) + std::to_string(width) + "." +
            std::to_string(random.below(std::min(width, 8) + 1));
  }
  for (int i = 0; i < repeat; ++i) items.push_back({kind, width});
  return edit;
}

std::string control_edit(Random& random) {
  switch (random.below(9)) {
    case 0:
      return std::to_string(1 + random.below(6)) + "X";
    case 1:
      return "T" + std::to_string(1 + random.below(20));
    case 2:
      return "TR" + std::to_string(1 + random.below(5));
    case 3:
      return "TL" + std::to_string(1 + random.below(5));
    case 4:
      return "BN";
    case 5:
      return "BZ";
    case 6:
      return std::to_string(random.below(7) - 3) + "P";
    case 7:
      return ":";
    default:
      return "/";
  }
}

// A FORMAT of some items, groups among them; the fields of one pass are listed in `items`.
// `revert_to`: the first field of the last group, where a second pass begins.
std::string format_items(Random& random, std::vector<Item>& items, int depth, bool plain,
                         std::size_t& revert_to) {
  std::string text;
  const int count = 1 + random.below(3);
  for (int i = 0; i < count; ++i) {
    const std::size_t comma = text.size();
    if (i > 0) text += ",";
    if (!plain && random.chance(25)) text += control_edit(random) + ",";
    if (depth < 3 && random.chance(15)) {
      std::vector<Item> inner;
      std::size_t ignored = 0;
      revert_to = items.size();
      const int repeat = 1 + random.below(2);
      text += (repeat > 1 ? std::to_string(repeat) : "") + "(" +
              format_items(random, inner, depth + 1, plain, ignored) + ")";
      for (int r = 0; r < repeat; ++r) items.insert(items.end(), inner.begin(), inner.end());
    } else {
      text += data_edit(random, items);
    }
    // gfortran does without the comma before a letter.
    const bool letter = i > 0 && std::isalpha(static_cast<unsigned char>(text[comma + 1])) != 0;
    if (letter && random.chance(15)) text.erase(comma, 1);
  }
  return text;
}

// Records whose columns suit the fields of a FORMAT without tabs.
std::string record_for(Random& random, const std::vector<Item>& items) {
  std::string record;
  for (const Item& item : items) record += field(random, item.kind, item.width);
  if (random.chance(25)) record.resize(random.below(static_cast<int>(record.size()) + 1));
  if (random.chance(25)) record.erase(record.find_last_not_of(' ') + 1);
  return record;
}

constexpr int max_values = 12;

// T and TL move within a record.  Behind a short record or a comma gfortran counts their columns from
// what it has consumed, not from the padded record as the standard has it, and may lose its place:
// such cases are no reference.
bool has_tabs(const FortranCase& made) {
  return made.format.find('T') != std::string::npos;
}

std::string full_record(std::string record) {
  for (char& c : record)
    if (c == ',') c = ' ';
  record.resize(300, ' ');
  return record;
}

FortranCase formatted_case(Random& random, bool plain) {
  FortranCase made;
  std::vector<Item> items;
  std::size_t revert_to = 0;
  made.format = "(" + format_items(random, items, 1, plain, revert_to) + ")";
  const std::vector<Item> again(items.begin() + static_cast<std::ptrdiff_t>(revert_to), items.end());
  made.blanks = random.chance(30) ? BlankMode::zero : BlankMode::null;
  const int wanted = 1 + random.below(std::min(max_values, 2 * static_cast<int>(items.size())));
  for (std::size_t i = 0; i < static_cast<std::size_t>(wanted); ++i)
    made.kinds += i < items.size() ? items[i].kind : again[(i - items.size()) % again.size()].kind;
  const auto record = [&](const std::vector<Item>& fields) {
    return has_tabs(made) ? full_record(record_for(random, fields)) : record_for(random, fields);
  };
  made.text = record(items) + (random.chance(10) ? "\r\n" : "\n");
  if (static_cast<std::size_t>(wanted) > items.size()) made.text += record(again) + "\n";
  return made;
}

FortranCase list_case(Random& random) {
  FortranCase made;
  made.format = "*";
  const int wanted = 1 + random.below(6);
  for (int i = 0; i < wanted; ++i) made.kinds += random.of("IIDDDA");
  for (char kind : made.kinds) {
    if (random.chance(8)) made.text += random.of("23") + std::string("*");
    if (kind == 'A' && random.chance(60)) {
      const char quote = random.of("'\"");
      made.text += quote + std::string("it") + (random.chance(30) ? std::string(2, quote) : "") +
                   (random.chance(20) ? ", /" : "s") + quote;
    } else if (kind == 'A') {
      made.text += "word";
    } else if (!random.chance(4)) {
      std::string text = number(random, kind == 'D');
      if (random.chance(4) && !text.empty())
        text[random.below(static_cast<int>(text.size()))] = random.of("x.*+,/");
      made.text += text;
    }
    static constexpr const char* separators[] = {" ",  " ",   "  ",   ",",   ", ", " , ", "\n",
                                                 "\t", ",\n", " \n ", "\n,", "/",  ";"};
    made.text += separators[random.below(random.chance(10) ? 13 : 8)];
  }
  made.text += "\n";
  return made;
}

// Spare records follow each case: the next READ shows which of them were used.
constexpr int spare_records = 14;
std::string with_spares(const FortranCase& made) {
  std::string all = made.text;
  for (int i = 1; i <= spare_records; ++i) {
    all += std::to_string(i);
    if (has_tabs(made)) all += std::string(300, ' ');
    all += '\n';
  }
  return all;
}

std::string bits_text(double value) {
  if (std::isnan(value)) return "NaN";
  char text[20];
  std::snprintf(text, sizeof text, "%016llX",
                static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
  return text;
}

// The line that the Fortran program should print for a case.
std::string answer(const FortranCase& made) {
  FortranCase given = made;
  given.text = with_spares(made);
  const FortranOutcome out = run_case(given);
  if (!out.ok) return "failed";
  std::string line = "0";
  for (std::size_t i = 0; i < made.kinds.size(); ++i) {
    const bool unset = out.items[i] == "unset" || i >= out.values.size();
    switch (made.kinds[i]) {
      case 'I':
        line += " I" + (unset ? "-77777" : out.items[i]);
        break;
      case 'D':
        line += " D" + bits_text(unset ? -77777.5 : out.values[i].number);
        break;
      case 'A':
        line += " A<" + (unset ? "~" : out.items[i]) + ">";
        break;
      default:
        line += " L" + (unset ? "F" : out.items[i]);
    }
  }
  return line + " N<" + out.next + ">";
}

void write_cases(const std::vector<FortranCase>& cases, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  for (const FortranCase& c : cases)
    file << "#CASE " << (c.blanks == BlankMode::zero ? "ZERO" : "NULL") << ' ' << c.kinds << '\n'
         << c.format << '\n'
         << with_spares(c);
}

// "0 I1 ..." as it stands; anything that failed is "failed"; NaN in one spelling.
std::string normalised(std::string line) {
  if (line.rfind("0 ", 0) != 0) return "failed";
  for (std::size_t at = line.find(" D"); at != std::string::npos; at = line.find(" D", at + 2)) {
    const std::string bits = line.substr(at + 2, 16);
    if (bits.size() < 16 || bits.find_first_not_of("0123456789ABCDEF") != std::string::npos) continue;
    if (std::isnan(std::bit_cast<double>(static_cast<std::uint64_t>(std::stoull(bits, nullptr, 16)))))
      line.replace(at + 2, 16, "NaN");
  }
  return line;
}

void compare(const std::vector<FortranCase>& cases, const std::string& name) {
  const auto folder = std::filesystem::temp_directory_path();
  const std::string stem = (folder / ("sage_oracle_" + name)).string();
  write_cases(cases, stem + ".in");
  ASSERT_EQ(std::system((std::string(SAGE_FORTRAN_ORACLE) + " " + stem + ".in " + stem + ".out").c_str()), 0);
  std::ifstream answers(stem + ".out");
  std::string line;
  std::size_t wrong = 0, failed = 0;
  for (const FortranCase& c : cases) {
    ASSERT_TRUE(std::getline(answers, line)) << "the Fortran program stopped early";
    const std::string expected = normalised(line), ours = answer(c);
    if (expected == "failed") ++failed;
    if (expected == ours || ++wrong > 20) continue;
    ADD_FAILURE() << c.format << (c.blanks == BlankMode::zero ? " ZERO " : " NULL ") << c.kinds << "\n"
                  << c.text << "Fortran: " << expected << "   (" << line << ")\nours:    " << ours;
  }
  EXPECT_EQ(wrong, 0u) << "of " << cases.size();
  // The generator must keep making cases of both kinds.
  EXPECT_GT(failed, cases.size() / 100);
  EXPECT_LT(failed, cases.size() / 2 * (name == "list" ? 2 : 1));
  std::filesystem::remove(stem + ".in");
  std::filesystem::remove(stem + ".out");
}

TEST(FortranOracle, FieldsUnderPlainFormats) {
  Random random(seed(20240711));
  std::vector<FortranCase> cases;
  for (int i = 0; i < 60000; ++i) cases.push_back(formatted_case(random, true));
  compare(cases, "plain");
}

TEST(FortranOracle, FormatsWithControlEdits) {
  Random random(seed(7));
  std::vector<FortranCase> cases;
  for (int i = 0; i < 30000; ++i) cases.push_back(formatted_case(random, false));
  compare(cases, "control");
}

TEST(FortranOracle, ListDirected) {
  Random random(seed(1982));
  std::vector<FortranCase> cases;
  while (cases.size() < 30000) {
    FortranCase made = list_case(random);
    // gfortran reads on behind a slash that opens a record, against the standard: no reference.
    // Nor is ".*5", which it takes for "5".
    static const std::regex no_reference("\\n[ \\t]*/|\\.\\*");
    if (!std::regex_search(made.text, no_reference)) cases.push_back(std::move(made));
  }
  compare(cases, "list");
}

}  // namespace
}  // namespace sage::test

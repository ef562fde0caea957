// The reader against a table of fields as a Fortran runtime (gfortran 12.2) read them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "fortran_case.hpp"
#include "tests/support/text.hpp"

namespace sage::test {
namespace {

using Row = std::vector<std::string>;

// Commas outside quotes; "" inside quotes is one quote.
Row split_csv(const std::string& line) {
  Row row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      row.back() += '"';
      ++i;
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      row.emplace_back();
    } else {
      row.back() += line[i];
    }
  }
  return row;
}

// Quoted, with \n \r \t \xNN and \\ as escapes.
std::string unescape(const std::string& quoted) {
  std::string text;
  for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
    if (quoted[i] != '\\') {
      text += quoted[i];
      continue;
    }
    switch (quoted[++i]) {
      case 'n':
        text += '\n';
        break;
      case 'r':
        text += '\r';
        break;
      case 't':
        text += '\t';
        break;
      case 'x':
        text += static_cast<char>(std::stoi(quoted.substr(i + 1, 2), nullptr, 16));
        i += 2;
        break;
      default:
        text += quoted[i];
    }
  }
  return text;
}

std::string strip_quotes(const std::string& text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? unescape(text) : text;
}

void check_row(const Row& row) {
  FortranCase given;
  given.format = row[2];
  given.blanks = row[3] == "ZERO" ? BlankMode::zero : BlankMode::null;
  given.pad = row[4] == "YES";
  given.kinds = row[6];
  given.text = unescape(row[8]);
  if (row[7] == "LF") given.text += "\n";
  if (row[7] == "CRLF") given.text += "\r\n";
  const FortranOutcome out = run_case(given);

  const bool failed = row[9] == "ERROR" || row[9] == "EOF" || row[9] == "EOR";
  const std::string wanted_status = row[9] == "ERROR" ? "error"
                                    : row[9] == "EOF" ? "eof"
                                    : row[9] == "EOR" ? "eor"
                                                      : "ok";
  EXPECT_EQ(out.status, wanted_status);
  const std::vector<std::string> wanted = split(failed ? row[13] : row[9], '|');
  ASSERT_EQ(out.items.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_EQ(out.items[i], strip_quotes(wanted[i])) << "item " << i;
  if (!failed) {
    EXPECT_EQ(out.next, strip_quotes(row[12]));
  }
}

TEST(FortranGolden, EveryRowAgrees) {
  std::ifstream file(SAGE_SOURCE_DIR "/tests/unit/deck/data/fortran_read_golden.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  int rows = 0;
  while (std::getline(file, line)) {
    SCOPED_TRACE(line);
    check_row(split_csv(line));
    ++rows;
  }
  EXPECT_EQ(rows, 100);
}

}  // namespace
}  // namespace sage::test

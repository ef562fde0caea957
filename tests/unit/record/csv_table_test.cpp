// CSV files of a run read back.
#include "sage/record/csv_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "sage/messages/error.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

std::filesystem::path write(const std::string& text) {
  const std::filesystem::path file = test::fresh_folder("csv_table") / "t.csv";
  std::ofstream(file) << text;
  return file;
}

TEST(CsvTable, HasNamesUnitsAndNumbers) {
  const CsvTable table =
      read_csv_table(write("# a title\n# what it holds\nstage,force[lbf],ratio[-],note\n1,-2.5e3,,\"a, b\"\n# "
                           "between\r\n2,4,1.5,\r\n"));
  EXPECT_EQ(table.title(), "a title");
  EXPECT_EQ(table.comments.at(1), "what it holds");
  EXPECT_EQ(table.names(), "stage, force, ratio, note");
  ASSERT_NE(table.find("force"), nullptr);
  EXPECT_EQ(table.find("force")->unit, "lbf");
  EXPECT_EQ(table.find("force")->values, (std::vector<double>{-2500.0, 4.0}));
  EXPECT_EQ(table.find("ratio")->unit, "-");
  EXPECT_TRUE(std::isnan(table.find("ratio")->values.at(0)));
  EXPECT_EQ(table.find("ratio")->values.at(1), 1.5);
  EXPECT_TRUE(std::isnan(table.find("note")->values.at(0)));
  EXPECT_EQ(table.find("pressure"), nullptr);
}

void expect_refused(const std::filesystem::path& file, const std::string& words) {
  try {
    read_csv_table(file);
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(CsvTable, WhatIsNoneIsRefused) {
  expect_refused(write("# only words\n"), "no line with the names");
  expect_refused(write("a,b\n1,2\n1,2,3\n"), "t.csv:3: error: 3 cells, where the line of names has 2");
  expect_refused("absent.csv", "can't be opened");
}

}  // namespace
}  // namespace sage

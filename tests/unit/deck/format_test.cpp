#include "sage/deck/format.hpp"

#include <gtest/gtest.h>

#include "fortran_case.hpp"

namespace sage {
namespace {

// Widths of the first n fields, with reversion, as "5 5 10"; "/" where a record begins.
std::string widths(const std::string& text, int n) {
  const Format format = compile_format(text);
  FormatWalker walker(format);
  std::string shown;
  while (n > 0) {
    const FormatStep& step = walker.next();
    if (step.edit == Edit::end || step.edit == Edit::next_record) shown += "/ ";
    if (step.edit == Edit::end) walker.revert();
    if (!is_data(step.edit)) continue;
    shown += std::to_string(step.width) + " ";
    --n;
  }
  shown.pop_back();
  return shown;
}

TEST(Format, UnrollsRepeatsAndGroups) {
  EXPECT_EQ(widths("(3I5,2F10.0)", 5), "5 5 5 10 10");
  EXPECT_EQ(widths("(2(I1,2(I2,I3)),I4)", 11), "1 2 3 2 3 1 2 3 2 3 4");
  EXPECT_EQ(widths("( 2 i 5 , f1 0.0 )", 3), "5 5 10");
  EXPECT_EQ(widths("(I1/I2)", 2), "1 / 2");
  EXPECT_EQ(widths("(I1,*(I2,I3))", 6), "1 2 3 2 3 2");
}

// What gfortran 12 makes of a missing comma: F and D have no exponent part, E and G have.
TEST(Format, AnExponentBelongsToEAndG) {
  EXPECT_EQ(widths("(3F24.7E12.6)", 4), "24 24 24 12");
  EXPECT_EQ(widths("(F5.1E5.2)", 2), "5 5");
  EXPECT_EQ(widths("(D8.2E5.2)", 2), "8 5");
  EXPECT_EQ(widths("(F5.1D5.2)", 2), "5 5");
  EXPECT_EQ(widths("(E8.2E2,F5.1)", 2), "8 5");
  EXPECT_EQ(widths("(G8.2E2,ES9.3E3,F5.1)", 3), "8 9 5");
  for (const char* refused : {"(E8.2E5.2)", "(G8.2E5.2)", "(F5.1E2)", "(D8.2E2,F5.1)", "(F5E5.2)"})
    EXPECT_THROW(compile_format(refused), FormatError) << refused;
}

TEST(Format, RevertsToTheLastTopLevelGroup) {
  EXPECT_EQ(widths("(I1,2I2)", 5), "1 2 2 / 1 2");
  EXPECT_EQ(widths("(I1,(I2,I3))", 5), "1 2 3 / 2 3");
  EXPECT_EQ(widths("(I1,2(I2,(I3)),I4)", 9), "1 2 3 2 3 4 / 2 3 2");
}

int error_column(const std::string& text) {
  try {
    compile_format(text);
  } catch (const FormatError& error) {
    return error.column();
  }
  return 0;
}

TEST(Format, MistakesAreFoundAtTheirColumn) {
  EXPECT_EQ(error_column("(I5,F10)"), 8);
  EXPECT_EQ(error_column("(I5,Q3)"), 5);
  EXPECT_EQ(error_column("I5)"), 1);
  EXPECT_EQ(error_column("(I5"), 3);
  EXPECT_EQ(error_column("(I5))"), 5);
  EXPECT_EQ(error_column("(,I5)"), 2);
  EXPECT_EQ(error_column("(I0)"), 4);
  EXPECT_EQ(error_column("(3HABC,I5)"), 3);
  EXPECT_EQ(error_column("(I5,2)"), 6);
  EXPECT_NE(error_column("(99999(99999(99999(I5))))"), 0);
  EXPECT_NE(error_column("(*(X),I5)"), 0);
  EXPECT_NE(error_column(std::string(100, '(') + "I5" + std::string(100, ')')), 0);
  EXPECT_EQ(error_column("(1X,I5 F10.0,1PE12.4E2,T3,TL2,TR1,BN,BZ,SP,SS,S,:,L1,A,A3,G10.3,ES9.2,EN9.2,D9.2)"),
            0);
}

TEST(FormattedRead, MovesWithinARecord) {
  // T goes back, X and TR skip, TL returns: columns by hand.
  const auto read = [](const std::string& format, const std::string& kinds, const std::string& text) {
    return test::run_case({format, BlankMode::null, true, kinds, text}).items;
  };
  using Items = std::vector<std::string>;
  EXPECT_EQ(read("(T6,I5,T1,I5)", "II", "   12   34"), (Items{"34", "12"}));
  EXPECT_EQ(read("(I2,3X,I2)", "II", "12xxx34"), (Items{"12", "34"}));
  EXPECT_EQ(read("(I4,TL2,I2)", "II", "1234"), (Items{"1234", "34"}));
  // Behind a short record the standard counts columns of the padded record (gfortran counts what it consumed).
  EXPECT_EQ(read("(I5,TL2,I2)", "II", "  12"), (Items{"12", "2"}));
}

}  // namespace
}  // namespace sage

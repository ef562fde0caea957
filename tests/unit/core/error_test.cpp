#include "sage/core/error.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

TEST(SourcePosition, PrintsAsCompilersDo) {
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 41, 11, 20}), "a.dat:41:11-20");
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 41, 11, 11}), "a.dat:41:11");
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 41, 0, 0}), "a.dat:41");
  EXPECT_EQ(to_string(SourcePosition{"a.dat", 0, 0, 0}), "a.dat");
}

TEST(Diagnostics, CountsBySeverity) {
  Diagnostics d;
  d.error({"a.dat", 1, 0, 0}, "one");
  d.warning({"a.dat", 2, 0, 0}, "two");
  d.note({"a.dat", 3, 0, 0}, "three");
  EXPECT_EQ(d.errors(), 1);
  EXPECT_EQ(d.warnings(), 1);
  EXPECT_EQ(d.list().size(), 3u);
}

TEST(InputError, ShowsTheFirstError) {
  Diagnostics d;
  d.warning({"a.dat", 2, 0, 0}, "two");
  d.error({"a.dat", 3, 1, 5}, "three");
  EXPECT_STREQ(InputError(d).what(), "a.dat:3:1-5: error: three");
}

}  // namespace
}  // namespace sage

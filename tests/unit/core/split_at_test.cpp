// Lists in one text.
#include "sage/messages/split_at.hpp"

#include <gtest/gtest.h>

namespace sage {
namespace {

using Parts = std::vector<std::string_view>;

TEST(SplitAt, KeepsEveryPart) {
  EXPECT_EQ(split_at(',', "soil"), Parts({"soil"}));
  EXPECT_EQ(split_at(',', "soil,joints"), Parts({"soil", "joints"}));
  EXPECT_EQ(split_at('\t', "a,b\tc"), Parts({"a,b", "c"}));
}

// A comma too many is a part that its user rejects by name, wherever it is.
TEST(SplitAt, HasEmptyParts) {
  EXPECT_EQ(split_at(',', ""), Parts({""}));
  EXPECT_EQ(split_at(',', ",a"), Parts({"", "a"}));
  EXPECT_EQ(split_at(',', "a,,b"), Parts({"a", "", "b"}));
  EXPECT_EQ(split_at(',', "a,"), Parts({"a", ""}));
}

}  // namespace
}  // namespace sage

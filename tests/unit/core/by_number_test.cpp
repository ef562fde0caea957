// Numbers of nodes and elements: found whatever they are, listed in order.
#include "sage/core/by_number.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace sage {
namespace {

constexpr int kFarthest = std::numeric_limits<int>::max();

std::vector<std::pair<int, int>> listed(ByNumber<int>& numbers) {
  std::vector<std::pair<int, int>> list;
  numbers.for_each([&](int number, int value) { list.emplace_back(number, value); });
  return list;
}

TEST(ByNumber, FindsWhatWasPutThere) {
  ByNumber<int> numbers;
  EXPECT_TRUE(numbers.empty());
  for (const int number : {7, kFarthest, -3, 1, 90'000'000})
    EXPECT_TRUE(numbers.try_emplace(number, 2 * 7).second);
  EXPECT_EQ(numbers.size(), 5u);
  const auto [value, added] = numbers.try_emplace(kFarthest, 5);
  EXPECT_FALSE(added);
  EXPECT_EQ(*value, 14);  // what is there stays
  EXPECT_FALSE(numbers.contains(2));
  EXPECT_FALSE(numbers.contains(-1));
  EXPECT_FALSE(numbers.contains(std::numeric_limits<int>::min()));
  EXPECT_EQ(listed(numbers),
            (std::vector<std::pair<int, int>>{{-3, 14}, {1, 14}, {7, 14}, {90'000'000, 14}, {kFarthest, 14}}));
  numbers.at(7) = 3;
  numbers.at(90'000'000) = 3;
  numbers.erase_if([](int v) { return v == 3; });
  EXPECT_EQ(numbers.size(), 3u);
  EXPECT_FALSE(numbers.contains(7));
  EXPECT_FALSE(numbers.contains(90'000'000));
  EXPECT_TRUE(numbers.try_emplace(7, 8).second);
  EXPECT_EQ(*numbers.find(7), 8);
}

// The list grows over numbers that were too far away when they came: they stay what they are.
TEST(ByNumber, IsAMapForAnyOrder) {
  std::mt19937 random(5);
  for (const int range : {100, 1'000'000, 100'000'000}) {
    ByNumber<int> numbers;
    std::map<int, int> reference;
    for (int i = 0; i < 30'000; ++i) {
      const int number =
          i % 3 == 0 ? 300'000 + i : 1 + static_cast<int>(random() % static_cast<unsigned>(range));
      EXPECT_EQ(numbers.try_emplace(number, i).second, reference.try_emplace(number, i).second);
    }
    EXPECT_EQ(numbers.size(), reference.size());
    EXPECT_EQ(listed(numbers), (std::vector<std::pair<int, int>>(reference.begin(), reference.end())));
    for (const auto& [number, value] : reference) ASSERT_EQ(*numbers.find(number), value);
  }
}

}  // namespace
}  // namespace sage

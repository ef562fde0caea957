// The profile as table and JSON.
#include "sage/record/profile_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace sage {
namespace {

Profile small_profile() {
  Profile profile;
  {
    const Profile::Scope analysis(profile, "analysis");
    Profile::Scope factors(profile, "factorisation");
    factors.add_operations(3e9);
  }
  const Profile::Scope files(profile, "files");
  profile.stop();
  return profile;
}

TEST(ProfileText, TableShowsTheTree) {
  const std::string table = profile_table(small_profile());
  EXPECT_NE(table.find("\n  whole run "), std::string::npos) << table;
  EXPECT_NE(table.find("\n    analysis "), std::string::npos) << table;
  EXPECT_NE(table.find("\n      factorisation "), std::string::npos) << table;
  EXPECT_NE(table.find("\n    files "), std::string::npos) << table;
  const std::size_t row = table.find("factorisation");
  EXPECT_NE(table.substr(row, table.find('\n', row) - row).find(" 3 "), std::string::npos) << "GF\n" << table;
  EXPECT_EQ(table.find("MB\n"), std::string::npos) << "was not measured";
  for (std::size_t at = 0, end = 0; (end = table.find('\n', at)) != std::string::npos; at = end + 1)
    EXPECT_LE(end - at, 110u);
}

TEST(ProfileText, JsonQuotesAndNests) {
  const auto json = nlohmann::json::parse(profile_json(small_profile(), "a \"b\"\\\n", 2, "avx2"));
  EXPECT_EQ(json["case"], "a \"b\"\\\n");
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["kernels"], "avx2");
  const auto& run = json["run"];
  EXPECT_EQ(run["phase"], "whole run");
  ASSERT_EQ(run["phases"].size(), 2u);
  const auto& factors = run["phases"][0]["phases"][0];
  EXPECT_EQ(factors["phase"], "factorisation");
  EXPECT_EQ(factors["operations"].get<std::int64_t>(), 3000000000);
  EXPECT_FALSE(factors.contains("phases"));
  EXPECT_FALSE(factors.contains("memory_bytes")) << "was not measured";
}

}  // namespace
}  // namespace sage

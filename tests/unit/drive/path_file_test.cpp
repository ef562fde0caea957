// Stress and strain paths from tables.
#include "sage/drive/path_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sage/messages/error.hpp"

namespace sage::drive {
namespace {

// A file of this process, gone with the object.
class PathFile {
 public:
  explicit PathFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("sage_path_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".csv")) {
    std::ofstream(path_) << text;
  }
  PathFile(const PathFile&) = delete;
  PathFile& operator=(const PathFile&) = delete;
  ~PathFile() { std::filesystem::remove(path_); }
  std::vector<Leg> read(int law_size, bool undrained = false) const {
    return read_path(path_, law_size, undrained, 7);
  }
  std::string refusal(int law_size, bool undrained = false) const {
    try {
      read(law_size, undrained);
    } catch (const InputError& error) {
      return to_string(error.diagnostics().list().front());
    }
    return "";
  }

 private:
  std::filesystem::path path_;
};

TEST(PathFile, ARowIsALegAndBlanksStay) {
  const PathFile file(
      "# a path\n"
      "stress_xx[kPa], stress_yy, strain_yy, strain_zz, steps, duration\n"
      "100, 200, , 0, 3,\n"
      "100, , 0.02, , , 2.5\n");
  const std::vector<Leg> legs = file.read(4);
  ASSERT_EQ(legs.size(), 2u);
  EXPECT_EQ(legs[0].steps, 3);
  EXPECT_EQ(legs[1].steps, 7);
  EXPECT_EQ(legs[1].duration, 2.5);
  EXPECT_EQ(legs[0].goals[1].control, Control::stress);
  EXPECT_EQ(legs[0].goals[1].value, 200.0);
  EXPECT_EQ(legs[1].goals[1].control, Control::strain);
  EXPECT_EQ(legs[1].goals[1].value, 0.02);
  EXPECT_TRUE(std::isnan(legs[1].goals[2].value));
  EXPECT_TRUE(std::isnan(legs[0].goals[3].value));
}

TEST(PathFile, TheThirdNormalStrainKeepsTheVolume) {
  const std::vector<Leg> legs = PathFile("strain_xx,strain_yy\n0.01,0.02\n,0.03\n").read(4, true);
  EXPECT_DOUBLE_EQ(legs[0].goals[2].value, -0.03);
  EXPECT_DOUBLE_EQ(legs[1].goals[2].value, -0.04);
}

TEST(PathFile, RefusalsNameTheLineAndTheColumn) {
  const auto says = [](const std::string& text, const std::string& words, int law_size = 4,
                       bool undrained = false) {
    const std::string refusal = PathFile(text).refusal(law_size, undrained);
    EXPECT_NE(refusal.find(words), std::string::npos) << text << ": " << refusal;
  };
  says("strain_yy,stress_yy\n0.1,100\n", ".csv:2: error: stress_yy and strain_yy are both given");
  says("strain_yy\n0.1\nfast\n", ".csv:3: error: column strain_yy: fast is no number");
  says("strain_y\n0.1\n", "column strain_y is none of stress_xx, strain_xx,");
  says("strain_yy\n", "has no row");
  says("strain_yy,steps\n0.1,2.5\n", "steps: wanted a whole number");
  says("strain_yy,duration\n0.1,0\n", "duration: must be above 0");
  says("strain_yy\ninf\n", "column strain_yy: inf is no number");
  says("strain_yy\n0.1\n", "two of strain_xx, strain_yy and strain_zz", 4, true);
  says("strain_xx,stress_yy\n0.1,1\n", "an undrained path is one of strains", 4, true);
  says("strain_yy\n0.1\n", "none of shear, relative_shear, normal, relative_normal", 2);
}

}  // namespace
}  // namespace sage::drive

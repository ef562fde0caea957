// A folder for the files of a test: of its process alone, so that tests may run side by side, and gone with it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace sage::test {

inline std::filesystem::path scratch_folder(const std::string& name) {
  struct Root {
    std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("sagefe_tests_" + std::to_string(::getpid()));
    ~Root() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Root root;
  std::filesystem::create_directories(root.path / name);
  return root.path / name;
}

}  // namespace sage::test

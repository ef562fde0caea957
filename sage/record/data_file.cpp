#include "sage/record/data_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "sage/messages/error.hpp"

namespace sage {

namespace {

using MakeDataFile = DataFile* (*)(const char* path, bool reading);

Module data_module() {
  return {"the module of result files (HDF5)",
          "SAGE_DATA_MODULE",
          SAGE_DATA_MODULE_RELATIVE,
          SAGE_DATA_MODULE_NAME,
          SAGE_DATA_MODULE_VERSION,
          "sage_make_data_file"};
}

MakeDataFile loaded() {
  static const MakeDataFile make = [] {
    try {
      return reinterpret_cast<MakeDataFile>(load_module(data_module(), data_module_places()));
    } catch (const AnalysisError& error) {
      throw OutputError("S505", error.what());
    }
  }();
  return make;
}

}  // namespace

std::vector<std::string> data_module_places() {
  return module_places(data_module());
}

void expect_data_module() {
  loaded();
}

std::unique_ptr<DataFile> make_data_file(const std::string& path) {
  const MakeDataFile make = loaded();
  errno = 0;
  std::unique_ptr<DataFile> file(make(path.c_str(), false));
  if (!file)
    throw OutputError("S601",
                      "cannot write " + path + ": " + (errno != 0 ? std::strerror(errno) : "HDF5 refuses it"));
  return file;
}

std::unique_ptr<DataFile> open_data_file(const std::string& path) {
  const MakeDataFile make = loaded();
  errno = 0;
  // A pipe would be waited for without end, a device has none.
  std::error_code unknown;
  if (const auto status = std::filesystem::status(path, unknown);
      std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError("S101", {path, 0, 0, 0},
                     std::filesystem::is_directory(status) ? "is a folder, not a file" : "is no ordinary file");
  if (!std::ifstream(path))
    throw InputError("S101", {path, 0, 0, 0}, std::string("can't be opened: ") + std::strerror(errno));
  std::unique_ptr<DataFile> file(make(path.c_str(), true));
  if (!file) throw InputError("S640", {path, 0, 0, 0}, "is no whole file of HDF5");
  return file;
}

}  // namespace sage

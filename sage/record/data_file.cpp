#include "sage/record/data_file.hpp"

#include <cerrno>
#include <cstring>

#include "sage/core/error.hpp"

namespace sage {

namespace {

using MakeDataFile = DataFile* (*)(const char* path);

Module data_module() {
  return {"the module that writes result files (HDF5)",
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
      throw OutputError(error.what());
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
  std::unique_ptr<DataFile> file(make(path.c_str()));
  if (!file)
    throw OutputError("cannot write " + path + ": " + (errno != 0 ? std::strerror(errno) : "HDF5 refuses it"));
  return file;
}

}  // namespace sage

// The seam between the result file and the library that writes and reads it, which is a module loaded on use.  Nothing of
// the library is seen here.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sage/platform/module.hpp"

namespace sage {

// Changes with DataFile.
#define SAGE_DATA_MODULE_VERSION "sage-data-4"

enum class DataType : std::uint8_t { float64, int64, int32, uint8 };

// A file of named tables in folders, "/a/b/table"; folders are made as they are named.  Functions that give a
// bool: false where the file could not be written or read, and error() says why.
class DataFile {
 public:
  virtual ~DataFile() = default;
  // A table of rows of this shape (empty: of one number), to which append() adds.  chunk: rows that are stored
  // together; such of zeros alone take no room.  piece: of a row that is long, so many of its lines (its first
  // dimension) are stored together; 0 = all.  Then chunk is 1.
  virtual bool table(const char* path, DataType type, const std::vector<std::uint64_t>& row,
                     std::uint64_t chunk, std::uint64_t piece = 0) = 0;
  virtual bool append(const char* path, const void* rows, std::uint64_t count) = 0;
  // The last row's lines from `first` on, where a piece begins: a whole piece, or what is left.  first = 0 begins
  // another row.
  virtual bool append_piece(const char* path, const void* lines, std::uint64_t first, std::uint64_t count) = 0;
  // Of a folder or table.
  virtual bool text(const char* path, const char* name, const char* value) = 0;
  virtual bool numbers(const char* path, const char* name, const std::int64_t* values, std::uint64_t count) = 0;
  // Of a file that was opened: a whole table of bytes, and the text of a folder or table.
  virtual bool read(const char* path, std::string& bytes) = 0;
  // One row, from 0, of a table whose rows have that many bytes.
  virtual bool read_row(const char* path, std::uint64_t row, void* to, std::uint64_t bytes) = 0;
  virtual bool read_text(const char* path, const char* name, std::string& value) = 0;
  virtual bool close() = 0;
  virtual const char* error() const = 0;
};

// Takes the place of what the file holds.  Throws OutputError where the module can't be loaded or the file not be
// opened.
std::unique_ptr<DataFile> make_data_file(const std::string& path);
// To be read.  Throws OutputError where the module can't be loaded, InputError where the file can't be opened.
std::unique_ptr<DataFile> open_data_file(const std::string& path);
// Throws OutputError that lists the places, as make_data_file would.
void expect_data_module();
std::vector<std::string> data_module_places();

}  // namespace sage

// Result files by HDF5.  What the program looks for in this module: its version, which it reads in the file before
// it loads it, and one function.
#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "sage/record/data_file.hpp"

namespace sage {

namespace {

hid_t hdf5_type(DataType type) {
  switch (type) {
    case DataType::float64:
      return H5T_IEEE_F64LE;
    case DataType::int64:
      return H5T_STD_I64LE;
    case DataType::int32:
      return H5T_STD_I32LE;
    case DataType::uint8:
      return H5T_STD_U8LE;
  }
  return H5I_INVALID_HID;
}

std::size_t size_of(DataType type) {
  switch (type) {
    case DataType::float64:
    case DataType::int64:
      return 8;
    case DataType::int32:
      return 4;
    case DataType::uint8:
      break;
  }
  return 1;
}

// Closes what it holds.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool ok() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// The innermost of HDF5's own messages.
herr_t first_message(unsigned, const H5E_error2_t* error, void* text) {
  if (error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

struct Table {
  hid_t id = H5I_INVALID_HID;
  std::size_t packed_row =
      0;  // bytes of a row, or of a piece of one, that is compressed by itself; 0: there are none
  std::size_t width = 0;       // of a number
  std::size_t row = 0;         // bytes of one
  hsize_t chunk = 0;           // rows
  std::vector<hsize_t> piece;  // what is stored together, in every dimension
};

// What was never written reads as zeros.
bool only_zeros(const void* values, std::size_t bytes) {
  const char* const at = static_cast<const char*>(values);
  return bytes > 0 && at[0] == 0 && std::memcmp(at, at + 1, bytes - 1) == 0;
}

// Bytes of one place in the numbers behind one another, as HDF5's filter of that name has them.
std::vector<unsigned char> shuffled(const unsigned char* numbers, std::size_t bytes, std::size_t width) {
  std::vector<unsigned char> turned(bytes);
  const std::size_t count = bytes / width;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t b = 0; b < width; ++b) turned[b * count + i] = numbers[i * width + b];
  return turned;
}

// A long row, or a piece of one, whose middle hardly becomes smaller.  Compressing stress and strain of 200 000 elements took as long
// as computing them, for half of their size; tables of zeros, directions and states pay a hundred times more.
bool left_as_it_is(const Table& table, const void* row) {
  constexpr std::size_t kLong = std::size_t{1} << 20, kSample = std::size_t{1} << 14;
  constexpr uLongf kWorth = 4;  // times smaller
  if (table.packed_row == 0 || table.row < kLong) return false;
  const std::size_t middle = table.packed_row / table.width / 2 * table.width;
  const auto sample = shuffled(static_cast<const unsigned char*>(row) + middle, kSample, table.width);
  uLongf size = compressBound(kSample);
  std::vector<unsigned char> packed(size);
  if (compress2(packed.data(), &size, sample.data(), kSample, 1) != Z_OK) return false;
  return size * kWorth > kSample;
}

// A bit for each filter that a stored row has not passed: shuffle and deflate.
constexpr std::uint32_t kNoFilters = 3;

// Around the library's calls: every thread has its own list of what failed, which is printed unless that thread says no,
// and is lost memory when the thread ends.
class Calls {
 public:
  Calls() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }
  ~Calls() { H5Eclear2(H5E_DEFAULT); }
  Calls(const Calls&) = delete;
  Calls& operator=(const Calls&) = delete;
};

class Hdf5File final : public DataFile {
 public:
  Hdf5File(const char* path, bool reading) {
    const Calls calls;
    errno = 0;
    if (reading) {
      file_ = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
      return;
    }
    const Id properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties.get(), false);
    errno = 0;
    file_ = H5Fcreate(path, H5F_ACC_TRUNC, properties.get(), H5P_DEFAULT);
  }
  ~Hdf5File() override { close(); }
  bool is_open() const { return file_ >= 0; }

  bool table(const char* path, DataType type, const std::vector<std::uint64_t>& row, std::uint64_t chunk,
             std::uint64_t part) override {
    const Calls calls;
    const int rank = static_cast<int>(row.size()) + 1;
    std::vector<hsize_t> size{0}, most{H5S_UNLIMITED}, piece{chunk};
    for (std::uint64_t n : row) {
      size.push_back(n);
      most.push_back(n == 0 ? H5S_UNLIMITED : n);  // a group without elements: its rows are empty,
      piece.push_back(n == 0 ? 1 : n);             // and neither a chunk nor what is fixed may be
    }
    if (part > 0 && piece.size() > 1) piece[1] = std::min<hsize_t>(piece[1], part);
    std::uint64_t numbers = 1, together = 1;
    for (std::uint64_t n : row) numbers *= n;
    for (std::size_t i = 1; i < piece.size(); ++i) together *= piece[i];
    const Id space(H5Screate_simple(rank, size.data(), most.data()), H5Sclose);
    const Id how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_obj_track_times(how.get(), false);  // equal runs, equal bytes
    H5Pset_create_intermediate_group(links.get(), 1);
    bool done = space.ok() && make_folders(path) && H5Pset_chunk(how.get(), rank, piece.data()) >= 0;
    if (done && numbers > 16) done = H5Pset_shuffle(how.get()) >= 0 && H5Pset_deflate(how.get(), 1) >= 0;
    if (!done) return failed(path);
    const hid_t set =
        H5Dcreate2(file_, path, hdf5_type(type), space.get(), links.get(), how.get(), H5P_DEFAULT);
    if (set < 0) return failed(path);
    const std::size_t width = size_of(type);
    const std::size_t packed = numbers > 16 && chunk == 1 ? together * width : 0;
    sets_[path] = {set, packed, width, numbers * width, chunk, piece};
    return true;
  }

  bool append(const char* path, const void* rows, std::uint64_t count) override {
    const Calls calls;
    const Table* const table = find(path);
    if (table == nullptr) return false;
    if (count == 0) return true;
    std::vector<hsize_t> size = extent_of(*table), start(size.size(), 0), more = size;
    start[0] = size[0];
    more[0] = count;
    size[0] += count;
    errno = 0;
    if (H5Dset_extent(table->id, size.data()) < 0) return failed();
    const bool whole_chunks = start[0] % table->chunk == 0 && count % table->chunk == 0;
    const bool by_itself = count == 1 && table->packed_row == table->row;
    return write(*table, start, more, rows, whole_chunks, by_itself ? rows : nullptr);
  }

  bool append_piece(const char* path, const void* lines, std::uint64_t first, std::uint64_t count) override {
    const Calls calls;
    const Table* const table = find(path);
    if (table == nullptr) return false;
    std::vector<hsize_t> size = extent_of(*table), start(size.size(), 0), more = size;
    if (first == 0) ++size[0];
    start[0] = size[0] - 1;
    start[1] = first;
    more[0] = 1;
    more[1] = count;
    errno = 0;
    if (first == 0 && H5Dset_extent(table->id, size.data()) < 0) return failed();
    if (count == 0) return true;
    // What is left of a row is stored as a whole piece, too.
    const std::size_t bytes = count * (table->row / size[1]);
    std::vector<char> padded;
    if (bytes < table->packed_row) {
      padded.assign(table->packed_row, 0);
      std::memcpy(padded.data(), lines, bytes);
    }
    return write(*table, start, more, lines, true, padded.empty() ? lines : padded.data());
  }

  // Of a fixed length: VTK reads no other.
  bool text(const char* path, const char* name, const char* value) override {
    const Calls calls;
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    const std::size_t length = std::strlen(value);
    H5Tset_size(type.get(), length > 0 ? length : 1);
    H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
    bool ascii = true;
    for (const char* c = value; *c != '\0'; ++c) ascii = ascii && static_cast<unsigned char>(*c) < 0x80;
    if (!ascii) H5Tset_cset(type.get(), H5T_CSET_UTF8);
    return attribute(path, name, type.get(), type.get(), space.get(), length > 0 ? value : "\0");
  }

  bool numbers(const char* path, const char* name, const std::int64_t* values, std::uint64_t count) override {
    const Calls calls;
    const hsize_t size = count;
    const Id space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose);
    return attribute(path, name, H5T_STD_I64LE, H5T_NATIVE_INT64, space.get(), values);
  }

  bool read(const char* path, std::string& bytes) override {
    const Calls calls;
    forget_failure();
    const Id set(H5Dopen2(file_, path, H5P_DEFAULT), H5Dclose);
    if (!set.ok()) return failed();
    const Id space(H5Dget_space(set.get()), H5Sclose), type(H5Dget_type(set.get()), H5Tclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    if (count < 0) return failed();
    bytes.resize(static_cast<std::size_t>(count) * H5Tget_size(type.get()));
    return H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0 || failed();
  }

  bool read_row(const char* path, std::uint64_t row, void* to, std::uint64_t bytes) override {
    const Calls calls;
    forget_failure();
    const Id set(H5Dopen2(file_, path, H5P_DEFAULT), H5Dclose);
    if (!set.ok()) return failed();
    const Id space(H5Dget_space(set.get()), H5Sclose), type(H5Dget_type(set.get()), H5Tclose);
    std::vector<hsize_t> size(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space.get()), 0)));
    H5Sget_simple_extent_dims(space.get(), size.data(), nullptr);
    std::vector<hsize_t> start(size.size(), 0), one = size;
    std::uint64_t found = H5Tget_size(type.get());
    for (std::size_t i = 1; i < size.size(); ++i) found *= size[i];
    if (size.empty() || row >= size[0] || found != bytes) {
      error_ = std::string(path) + " has other rows";
      return false;
    }
    if (bytes == 0) return true;
    start[0] = row;
    one[0] = 1;
    const Id memory(H5Screate_simple(static_cast<int>(one.size()), one.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, one.data(), nullptr);
    return H5Dread(set.get(), type.get(), memory.get(), space.get(), H5P_DEFAULT, to) >= 0 || failed();
  }

  bool read_text(const char* path, const char* name, std::string& value) override {
    const Calls calls;
    forget_failure();
    const Id attribute(H5Aopen_by_name(file_, path, name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute.ok()) return failed();
    const Id type(H5Aget_type(attribute.get()), H5Tclose);
    if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0) {
      error_ = std::string(path) + " has no text " + name;
      return false;
    }
    value.assign(H5Tget_size(type.get()), '\0');
    if (H5Aread(attribute.get(), type.get(), value.data()) < 0) return failed();
    value.resize(std::strlen(value.c_str()));
    return true;
  }

  bool close() override {
    const Calls calls;
    bool done = true;
    errno = 0;
    for (const auto& [path, set] : sets_) done = H5Dclose(set.id) >= 0 && done;
    sets_.clear();
    if (file_ >= 0) done = H5Fclose(file_) >= 0 && done;
    file_ = H5I_INVALID_HID;
    return done || failed();
  }

  const char* error() const override { return error_.c_str(); }

 private:
  const Table* find(const char* path) {
    const auto set = sets_.find(path);
    if (set != sets_.end()) return &set->second;
    error_ = std::string("no table ") + path;
    return nullptr;
  }

  static std::vector<hsize_t> extent_of(const Table& table) {
    const Id space(H5Dget_space(table.id), H5Sclose);
    std::vector<hsize_t> size(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
    H5Sget_simple_extent_dims(space.get(), size.data(), nullptr);
    return size;
  }

  // From the numbers `start` on so many in every dimension.  whole: nothing else is or will be stored with them.
  // by_itself: the bytes that are compressed by themselves, or not at all; null: they are not all that is stored there.
  bool write(const Table& table, const std::vector<hsize_t>& start, const std::vector<hsize_t>& more,
             const void* values, bool whole, const void* by_itself) {
    std::size_t bytes = table.width;
    for (hsize_t n : more) bytes *= n;
    if (bytes == 0) return true;
    if (whole && only_zeros(values, bytes)) return true;
    if (by_itself != nullptr && left_as_it_is(table, by_itself))
      return H5Dwrite_chunk(table.id, H5P_DEFAULT, kNoFilters, start.data(), table.packed_row, by_itself) >=
                 0 ||
             failed();
    const Id space(H5Dget_space(table.id), H5Sclose), type(H5Dget_type(table.id), H5Tclose);
    const Id memory(H5Screate_simple(static_cast<int>(more.size()), more.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, more.data(), nullptr);
    return H5Dwrite(table.id, type.get(), memory.get(), space.get(), H5P_DEFAULT, values) >= 0 || failed();
  }

  // What a read found missing may be no fault: older files lack some tables.
  void forget_failure() {
    errno = 0;
    error_.clear();
  }

  // Groups without times, which intermediate groups of HDF5's own making have not.
  bool make_folders(const std::string& path) {
    for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1)) {
      const std::string folder = path.substr(0, at);
      if (H5Lexists(file_, folder.c_str(), H5P_DEFAULT) > 0) continue;
      const Id how(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
      H5Pset_obj_track_times(how.get(), false);
      const Id group(H5Gcreate2(file_, folder.c_str(), H5P_DEFAULT, how.get(), H5P_DEFAULT), H5Gclose);
      if (!group.ok()) return false;
    }
    return true;
  }

  bool attribute(const std::string& path, const char* name, hid_t type, hid_t memory, hid_t space,
                 const void* value) {
    errno = 0;
    if (!make_folders(path + "/")) return failed();
    const Id object(H5Oopen(file_, path.c_str(), H5P_DEFAULT), H5Oclose);
    if (!object.ok()) return failed();
    const Id made(H5Acreate2(object.get(), name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    return (made.ok() && H5Awrite(made.get(), memory, value) >= 0) || failed();
  }

  // What the system says comes first: a full disk.
  // `table`: that could not be made.
  bool failed(const char* table = nullptr) {
    if (!error_.empty()) return false;
    if (errno != 0)
      error_ = std::strerror(errno);
    else
      H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, first_message, &error_);
    if (error_.empty()) error_ = "HDF5 gives no reason";
    if (table != nullptr) error_ += std::string(", ") + table;
    return false;
  }

  hid_t file_ = H5I_INVALID_HID;
  std::map<std::string, Table> sets_;
  std::string error_;
};

}  // namespace

}  // namespace sage

extern "C" {

extern const char sage_data_module_version[];
[[gnu::section(SAGE_MODULE_SECTION), gnu::used]] const char sage_data_module_version[] =
    SAGE_DATA_MODULE_VERSION;

// The caller owns the file.  nullptr: it can't be opened; errno says why, where the system knows.
sage::DataFile* sage_make_data_file(const char* path, bool reading) {
  // At the end of the program HDF5 would close a file once more that a full disk kept it from closing, and crash.
  H5dont_atexit();
  auto file = std::make_unique<sage::Hdf5File>(path, reading);
  return file->is_open() ? file.release() : nullptr;
}

}  // extern "C"

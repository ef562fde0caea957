// The result file, read back by HDF5's own library: fields of a specimen whose state is known in closed form.
#include "sage/record/result_file.hpp"
#include "sage/record/in_order.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "sage/platform/checksum.hpp"
#include "sage/record/data_file.hpp"
#include "sage/record/stored_result.hpp"
#include "tests/unit/record/specimen.hpp"

namespace sage {
namespace {

using test::contents;
using test::fresh_folder;
using test::Specimen;

// A file of HDF5 and what it holds.
class Hdf5 {
 public:
  explicit Hdf5(const std::filesystem::path& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  Hdf5(const Hdf5&) = delete;
  Hdf5& operator=(const Hdf5&) = delete;
  ~Hdf5() { H5Fclose(file_); }

  bool has(const std::string& path) const {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t object = H5Oopen(file_, path.c_str(), H5P_DEFAULT);
    if (object >= 0) H5Oclose(object);
    return object >= 0;
  }
  std::vector<hsize_t> shape(const std::string& path) const {
    const hid_t set = H5Dopen2(file_, path.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
    std::vector<hsize_t> size(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return size;
  }
  std::vector<double> numbers(const std::string& path) const {
    std::size_t count = 1;
    for (hsize_t n : shape(path)) count *= n;
    std::vector<double> values(count);
    const hid_t set = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << path;
    H5Dclose(set);
    return values;
  }
  std::string text(const std::string& path, const char* name) const {
    const hid_t attribute = H5Aopen_by_name(file_, path.c_str(), name, H5P_DEFAULT, H5P_DEFAULT),
                type = H5Aget_type(attribute);
    std::string value(H5Tget_size(type), '\0');
    H5Aread(attribute, type, value.data());
    H5Tclose(type);
    H5Aclose(attribute);
    return value.c_str();
  }

 private:
  hid_t file_;
};

using Shape = std::vector<hsize_t>;

// sigma_1 = E e along the axis in a cylinder, all else zero; two increments of half the strain each.
TEST(ResultFile, HoldsTheFieldsOfTheCompressedSpecimen) {
  Specimen specimen;
  const auto folder = fresh_folder("result");
  {
    ResultOutput result(folder, "t");
    specimen.run(result, 0.01, 2);
    ASSERT_EQ(result.files(), std::vector<std::filesystem::path>{folder / "t.h5"});
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "t.h5.states.partial"));
  EXPECT_FALSE(std::filesystem::exists(folder / "t.h5.partial"));
  const Hdf5 file(folder / "t.h5");
  EXPECT_EQ(file.numbers("/sage/increments/load_factor"), (std::vector<double>{0.5, 1.0}));
  EXPECT_EQ(file.shape("/sage/groups/1/stress"), (Shape{2, 8, 4}));
  const std::vector<double> stress = file.numbers("/sage/groups/1/stress"),
                            principal = file.numbers("/sage/groups/1/principal_stress"),
                            p = file.numbers("/sage/groups/1/mean_stress"),
                            q = file.numbers("/sage/groups/1/deviator"),
                            strain = file.numbers("/sage/groups/1/strain");
  for (std::size_t step = 0; step < 2; ++step)
    for (std::size_t point = 0; point < 8; ++point) {
      const double axial = step == 0 ? 5.0 : 10.0;
      const std::size_t i = step * 8 + point;
      EXPECT_NEAR(stress[4 * i + 1], axial, 1e-9);
      EXPECT_NEAR(stress[4 * i], 0.0, 1e-9);
      EXPECT_NEAR(principal[3 * i], axial, 1e-9);
      EXPECT_NEAR(principal[3 * i + 2], 0.0, 1e-9);
      EXPECT_NEAR(p[i], axial / 3.0, 1e-9);
      EXPECT_NEAR(q[i], axial, 1e-9);
      EXPECT_NEAR(strain[4 * i + 1], axial / Specimen::kE, 1e-12);
      EXPECT_NEAR(strain[4 * i], -Specimen::kNu * axial / Specimen::kE, 1e-12);
    }
  const std::vector<double> traction = file.numbers("/sage/groups/2/traction");
  EXPECT_NEAR(traction.back(), 10.0, 1e-9);
  EXPECT_EQ(file.text("/sage/groups/1/stress", "unit"), "psi");
  EXPECT_EQ(file.text("/sage/groups/1/stress", "components"), "xx yy zz xy");
  EXPECT_EQ(file.text("/sage/groups/1/stress", "sign"), "compression positive");
  EXPECT_EQ(file.text("/sage", "title"), specimen.model.title);
  EXPECT_FALSE(file.has("/sage/groups/1/traction"));
  EXPECT_FALSE(file.has("/sage/groups/2/stress"));
}

// Rows above 1 MB are stored as they are where compressing them gains little; readers see no difference.
TEST(ResultFile, LongRowsComeBackCompressedOrNot) {
  const auto path = fresh_folder("result_long") / "t.h5";
  constexpr std::size_t kNumbers = 200000;
  std::vector<double> alike(kNumbers, 0.25), mixed(kNumbers);
  for (std::size_t i = 0; i < kNumbers; ++i) mixed[i] = std::sin(1e4 * static_cast<double>(i));
  const auto file = make_data_file(path.string());
  for (const char* name : {"/alike", "/mixed"})
    ASSERT_TRUE(file->table(name, DataType::float64, {kNumbers}, 1));
  for (int step = 0; step < 2; ++step) {
    ASSERT_TRUE(file->append("/alike", alike.data(), 1)) << file->error();
    ASSERT_TRUE(file->append("/mixed", mixed.data(), 1)) << file->error();
  }
  ASSERT_TRUE(file->close());
  const auto back = open_data_file(path.string());
  for (const auto& [name, numbers] : {std::pair{"/alike", &alike}, std::pair{"/mixed", &mixed}}) {
    std::string bytes;
    ASSERT_TRUE(back->read(name, bytes)) << back->error();
    const std::size_t row = kNumbers * sizeof(double);
    ASSERT_EQ(bytes.size(), 2 * row);
    EXPECT_EQ(std::memcmp(bytes.data(), numbers->data(), row), 0) << name;
    EXPECT_EQ(std::memcmp(bytes.data() + row, numbers->data(), row), 0) << name;
  }
  const auto size = std::filesystem::file_size(path);
  EXPECT_LT(size, 2 * kNumbers * sizeof(double) + 100000u);  // the row of one number takes next to nothing
  EXPECT_GT(size, 2 * kNumbers * sizeof(double));            // the other is not compressed
}

// Rows that come piece by piece, the last one shorter than the others; the same where a reader asks for rows.
TEST(ResultFile, PiecesOfRowsComeBack) {
  const auto path = fresh_folder("result_pieces") / "t.h5";
  constexpr std::size_t kLines = 100000, kPiece = 30000, kRow = 2 * kLines;
  std::vector<double> mixed(2 * kRow), zeros(2 * kRow, 0.0);
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = std::sin(1e4 * static_cast<double>(i));
  std::vector<std::int32_t> words(2 * kLines, 7);
  const auto file = make_data_file(path.string());
  const auto add = [&](const char* name, DataType type, const std::vector<std::uint64_t>& row,
                       const auto& values) {
    ASSERT_TRUE(file->table(name, type, row, 1, kPiece)) << file->error();
    const std::size_t line = values.size() / 2 / kLines;
    for (std::size_t step = 0; step < 2; ++step)
      for (std::size_t first = 0; first < kLines; first += kPiece)
        ASSERT_TRUE(file->append_piece(name, values.data() + (step * kLines + first) * line, first,
                                       std::min(kPiece, kLines - first)))
            << file->error();
  };
  add("/mixed", DataType::float64, {kLines, 2}, mixed);
  add("/zeros", DataType::float64, {kLines, 2}, zeros);
  add("/words", DataType::int32, {kLines}, words);
  ASSERT_TRUE(file->close());
  const auto back = open_data_file(path.string());
  const auto expect = [&](const char* name, const auto& values) {
    const std::size_t row = values.size() / 2 * sizeof values[0];
    std::string all, second(row, ' ');
    ASSERT_TRUE(back->read(name, all)) << back->error();
    ASSERT_EQ(all.size(), 2 * row);
    EXPECT_EQ(std::memcmp(all.data(), values.data(), all.size()), 0) << name;
    ASSERT_TRUE(back->read_row(name, 1, second.data(), row)) << back->error();
    EXPECT_EQ(std::memcmp(second.data(), values.data() + values.size() / 2, row), 0) << name;
  };
  expect("/mixed", mixed);
  expect("/zeros", zeros);
  expect("/words", words);
  // Four pieces of 480 000 bytes a row of the first alone.
  EXPECT_LT(std::filesystem::file_size(path), 2u * 4u * kPiece * 2u * sizeof(double) + 100000u);
}

// As the triangles among the quadrilaterals of a card.
TEST(ResultFile, TwoGroupsMayHaveOneNumber) {
  Specimen specimen;
  specimen.model.groups[1].number = specimen.model.groups[0].number;
  const auto folder = fresh_folder("result_number");
  {
    ResultOutput result(folder, "t");
    specimen.run(result, 0.01, 2);
  }
  const Hdf5 file(folder / "t.h5");
  EXPECT_NEAR(file.numbers("/sage/groups/1/stress")[1], 5.0, 1e-9);
  EXPECT_NEAR(file.numbers("/sage/groups/1_interface4/traction").back(), 10.0, 1e-9);
}

// What a group without elements has at its points.
TEST(ResultFile, RowsMayBeEmpty) {
  const auto path = fresh_folder("result_empty") / "t.h5";
  const auto file = make_data_file(path.string());
  ASSERT_TRUE(file->table("/none", DataType::float64, {0, 2}, 1)) << file->error();
  ASSERT_TRUE(file->append("/none", nullptr, 1)) << file->error();
  ASSERT_TRUE(file->table("/no_piece", DataType::float64, {0, 2}, 1, 0)) << file->error();
  ASSERT_TRUE(file->append_piece("/no_piece", nullptr, 0, 0)) << file->error();
  ASSERT_TRUE(file->close());
  const auto back = open_data_file(path.string());
  for (const char* name : {"/none", "/no_piece"}) {
    std::string bytes = "x";
    ASSERT_TRUE(back->read(name, bytes)) << back->error();
    EXPECT_EQ(bytes, "");
  }
}

// What ParaView's reader asks for: parts, steps and where each array of a step begins.
TEST(ResultFile, HasTheLayoutOfVtkHdf) {
  Specimen specimen;
  const auto folder = fresh_folder("result_vtk");
  ResultOutput result(folder, "t");
  specimen.run(result, 0.01, 3);
  const Hdf5 file(folder / "t.h5");
  EXPECT_EQ(file.text("/VTKHDF", "Type"), "UnstructuredGrid");
  EXPECT_EQ(file.numbers("/VTKHDF/Steps/Values").size(), 3u);
  EXPECT_EQ(file.numbers("/VTKHDF/NumberOfPoints"), std::vector<double>{10});  // one grid for all steps
  EXPECT_EQ(file.numbers("/VTKHDF/NumberOfCells"), std::vector<double>{3});
  EXPECT_EQ(file.numbers("/VTKHDF/Offsets"), (std::vector<double>{0, 4, 8, 10}));
  EXPECT_EQ(file.numbers("/VTKHDF/Types"), (std::vector<double>{9, 9, 3}));
  EXPECT_EQ(file.numbers("/VTKHDF/Steps/PartOffsets"), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(file.shape("/VTKHDF/Steps/CellOffsets"), (Shape{3, 1}));
  EXPECT_EQ(file.numbers("/VTKHDF/Steps/PointDataOffsets/stress"), (std::vector<double>{0, 10, 20}));
  EXPECT_EQ(file.numbers("/VTKHDF/Steps/CellDataOffsets/q"), (std::vector<double>{0, 3, 6}));
  EXPECT_EQ(file.shape("/VTKHDF/PointData/stress"), (Shape{30, 6}));
  EXPECT_EQ(file.shape("/VTKHDF/PointData/displacement"), (Shape{30, 3}));
  const std::vector<double> q = file.numbers("/VTKHDF/CellData/q"),
                            u = file.numbers("/VTKHDF/PointData/displacement"),
                            nodes = file.numbers("/VTKHDF/PointData/node");
  for (std::size_t step = 0; step < 3; ++step)
    EXPECT_NEAR(q[3 * step], 10.0 * static_cast<double>(step + 1) / 3.0, 1e-9);
  for (std::size_t i = 20; i < 30; ++i) {
    const auto index = static_cast<Eigen::Index>(nodes[i] / 10.0) - 1;
    EXPECT_NEAR(u[3 * i], specimen.u[2 * index], 1e-15);
    EXPECT_NEAR(u[3 * i + 1], specimen.u[2 * index + 1], 1e-15);
  }
}

TEST(ResultFile, EqualRunsGiveEqualBytes) {
  const auto folder = fresh_folder("result_equal");
  std::string bytes[2];
  for (std::string& one : bytes) {
    Specimen specimen;
    ResultOutput result(folder, "t");
    specimen.run(result, 0.01, 2);
    one = contents(folder / "t.h5");
  }
  EXPECT_GT(bytes[0].size(), 1000u);
  EXPECT_TRUE(bytes[0] == bytes[1]);
}

TEST(ResultFile, AThreadOfItsOwnGivesTheSameBytes) {
  const auto folder = fresh_folder("result_threads");
  std::string bytes[2];
  for (int threads : {1, 2}) {
    Specimen specimen;
    ResultOutput result(folder, "t", {"a deck", "", "", ""}, threads);
    specimen.run(result, 0.01, 3);
    bytes[threads - 1] = contents(folder / "t.h5");
  }
  EXPECT_GT(bytes[0].size(), 1000u);
  EXPECT_TRUE(bytes[0] == bytes[1]);
}

// Whoever does them, in the order in which they were added, though more waits than may.
TEST(InOrder, DoesAllTasksInTheirOrder) {
  for (bool own_thread : {false, true}) {
    std::vector<int> done;
    InOrder tasks(own_thread, 10);
    for (int i = 0; i < 100; ++i) tasks.add(static_cast<std::size_t>(i), [&done, i] { done.push_back(i); });
    tasks.finish();
    ASSERT_EQ(done.size(), 100u);
    EXPECT_TRUE(std::ranges::is_sorted(done));
  }
}

TEST(InOrder, NothingIsDoneBehindAnError) {
  int done = 0;
  InOrder tasks(true, 10);
  tasks.add(1, [&] { ++done; });
  tasks.add(1, [] { throw OutputError("S601", "disk full"); });
  try {
    for (int i = 0; i < 100; ++i) tasks.add(9, [&] { ++done; });
    tasks.finish();
    FAIL() << "the error is lost";
  } catch (const OutputError& error) {
    EXPECT_STREQ(error.what(), "disk full");
  }
  EXPECT_THROW(tasks.finish(), OutputError);
  EXPECT_EQ(done, 1);
}

// Every number of a state, by the bytes that a checkpoint would have.
std::string bytes_of(Frame frame) {
  Archive archive;
  frame.exchange_state(archive);
  return archive.bytes();
}

// Stress and strain of solids stand in their fields alone, and come back from there.
TEST(ResultFile, GivesBackTheStatesThatItWasMadeOf) {
  Specimen specimen;
  const auto folder = fresh_folder("result_states");
  ResultOutput result(folder, "t", {"a deck", "", "", ""});
  specimen.run(result, 0.01, 2);
  const Frame last(specimen.model, specimen.step(2, 2), specimen.solution());
  const StoredResult stored(folder / "t.h5");
  ASSERT_EQ(stored.states().size(), 2u);
  EXPECT_TRUE(bytes_of(stored.frame(specimen.model, 1)) == bytes_of(last));
  EXPECT_FALSE(bytes_of(stored.frame(specimen.model, 0)) == bytes_of(last));
}

// What a reader makes of the stress by itself stands in small files, and where it was asked for.
TEST(ResultFile, LargeModelsLackWhatFollowsFromTheStress) {
  Specimen specimen;
  const auto folder = fresh_folder("result_large");
  ResultOutput result(folder, "t", {"a deck", "", "", ""}, 1, {{"deviator"}, 9});
  specimen.run(result, 0.01, 2);
  const Hdf5 file(folder / "t.h5");
  const std::string left_out = file.text("/sage", "left_out");
  EXPECT_EQ(left_out,
            "mean_stress principal_stress stress_difference principal_angle principal_direction_1 "
            "principal_direction_3");
  EXPECT_FALSE(file.has("/sage/groups/1/principal_stress"));
  EXPECT_FALSE(file.has("/VTKHDF/CellData/principal_stress"));
  EXPECT_EQ(file.shape("/sage/groups/1/deviator"), (Shape{2, 8}));
  EXPECT_EQ(file.shape("/sage/groups/1/stress"), (Shape{2, 8, 4}));
  const Frame last(specimen.model, specimen.step(2, 2), specimen.solution());
  EXPECT_TRUE(bytes_of(StoredResult(folder / "t.h5").frame(specimen.model, 1)) == bytes_of(last));
}

// A damaged number of a field is one of the state.
TEST(ResultFile, StatesOfDamagedFieldsAreRefused) {
  Specimen specimen;
  const auto folder = fresh_folder("result_damage");
  ResultOutput result(folder, "t", {"a deck", "", "", ""});
  specimen.run(result, 0.01, 1);
  {
    const hid_t file = H5Fopen((folder / "t.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
                set = H5Dopen2(file, "/sage/groups/1/strain", H5P_DEFAULT);
    std::vector<double> strain(32, 0.0);
    ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, strain.data()), 0);
    H5Dclose(set);
    H5Fclose(file);
  }
  const StoredResult stored(folder / "t.h5");
  EXPECT_THROW(stored.frame(specimen.model, 0), InputError);
}

// The reason is that of the table that can't be read, not of one that files need not have.
TEST(ResultFile, StatesWithoutTheirFieldsSayWhatIsMissing) {
  Specimen specimen;
  const auto folder = fresh_folder("result_lacking");
  ResultOutput result(folder, "t", {"a deck", "", "", ""});
  specimen.run(result, 0.01, 1);
  {
    const hid_t file = H5Fopen((folder / "t.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(H5Ldelete(file, "/sage/groups/1/strain", H5P_DEFAULT), 0);
    H5Fclose(file);
  }
  const StoredResult stored(folder / "t.h5");
  try {
    stored.frame(specimen.model, 0);
    FAIL() << "no strain";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("strain"), std::string::npos) << error.what();
  }
}

// Files of the format before: whole states, rows of four numbers.
TEST(ResultFile, FilesOfTheFormatBeforeAreRead) {
  Specimen specimen;
  const auto path = fresh_folder("result_before") / "t.h5";
  specimen.compress(0.01);
  Frame frame(specimen.model, specimen.step(3, 3), specimen.solution());
  const std::string state = bytes_of(frame);
  const auto file = make_data_file(path.string());
  const auto bytes = [&](const char* name, const std::string& value) {
    const std::string table = stored_path(name);
    ASSERT_TRUE(file->table(table.c_str(), DataType::uint8, {}, value.size()));
    ASSERT_TRUE(file->append(table.c_str(), value.data(), value.size()));
  };
  bytes("deck", "a deck");
  bytes("layout", "a layout");
  for (const char* name : {"name", "layout", "options", "model", "failure"})
    ASSERT_TRUE(file->text(kStoredFolder, name, ""));
  ASSERT_TRUE(file->text(kStoredFolder, "format", "frames-1"));
  const std::int64_t row[]{0, 3, 3, std::bit_cast<std::int64_t>(checksum(state))};
  ASSERT_TRUE(file->table(stored_path("states").c_str(), DataType::int64, {4}, 1));
  ASSERT_TRUE(file->append(stored_path("states").c_str(), row, 1));
  bytes("state1", state);
  ASSERT_TRUE(file->close());
  const StoredResult stored(path);
  ASSERT_EQ(stored.states().size(), 1u);
  EXPECT_EQ(stored.states()[0].increments, 3);
  EXPECT_TRUE(bytes_of(stored.frame(specimen.model, 0)) == state);
}

TEST(ResultFile, FailedRunHoldsTheLastStateAndSaysSo) {
  Specimen specimen;
  const auto folder = fresh_folder("result_fail");
  ResultOutput result(folder, "t");
  specimen.run_and_fail(result, 0.01, 2);
  const Hdf5 file(folder / "t.h5");
  EXPECT_TRUE(file.text("/sage", "status").starts_with("NOT CONVERGED")) << file.text("/sage", "status");
  EXPECT_EQ(file.numbers("/sage/increments/load_factor").back(), 0.75);
  EXPECT_EQ(file.numbers("/sage/increments/converged").back(), 0.0);
}

// A run that an error stops leaves no result file, whole or half.
TEST(ResultFile, IsWholeOrAbsent) {
  Specimen specimen;
  const auto folder = fresh_folder("result_stop");
  {
    ResultOutput result(folder, "t");
    specimen.compress(0.01);
    result.on_increment(specimen.model, specimen.step(1, 2), specimen.solution());
    result.stop("disk full");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "t.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "t.h5.partial"));
}

// Goes on from a checkpoint to the same bytes.
TEST(ResultFile, RestartGivesTheSameBytes) {
  const auto folder = fresh_folder("result_restart");
  Specimen whole;
  ResultOutput straight(folder, "a");
  whole.run(straight, 0.01, 3);
  Archive kept;
  {
    Specimen killed;
    ResultOutput result(folder, "b");
    killed.compress(0.01 * 1 / 3);
    result.on_increment(killed.model, killed.step(1, 3), killed.solution());
    result.exchange(kept);
    killed.compress(0.77);  // behind the checkpoint: cut off
    result.on_increment(killed.model, killed.step(2, 3), killed.solution());
  }
  Specimen specimen;
  specimen.compress(0.01 * 1 / 3);
  ResultOutput result(folder, "b");
  Archive back(kept.bytes());
  result.exchange(back);
  for (int i : {2, 3}) {
    specimen.compress(0.01 * i / 3);
    result.on_increment(specimen.model, specimen.step(i, 3), specimen.solution());
  }
  const RunResult finished;
  result.on_finish(specimen.model, finished);
  EXPECT_TRUE(contents(folder / "a.h5") == contents(folder / "b.h5"));
}

TEST(ResultFile, RefusesAFolderOfItsNameAtOnce) {
  const auto folder = fresh_folder("result_folder");
  std::filesystem::create_directories(folder / "t.h5");
  EXPECT_THROW(ResultOutput(folder, "t"), OutputError);
  EXPECT_THROW(ResultOutput("/dev/null/results", "t"), OutputError);
}

}  // namespace
}  // namespace sage

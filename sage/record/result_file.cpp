#include "sage/record/result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <optional>

#include "sage/model/fingerprint.hpp"
#include "sage/platform/checksum.hpp"
#include "sage/record/apart.hpp"
#include "sage/record/data_file.hpp"
#include "sage/record/in_order.hpp"
#include "sage/record/point_fields.hpp"
#include "sage/record/state_time.hpp"
#include "sage/record/stored_result.hpp"
#include "sage/record/values.hpp"
#include "sage/record/vtk_data.hpp"

namespace sage {

namespace {

using Shape = std::vector<std::uint64_t>;

// A DataFile whose failures are OutputErrors.  What is written to it waits for a thread of its own, where there is
// one: compressing and writing take as long as computing.
class TableFile {
 public:
  TableFile(const std::filesystem::path& partial, std::filesystem::path path, bool own_thread)
      : path_(std::move(path)), file_(make_data_file(partial.string())), writer_(own_thread, kMostWaiting) {}

  void table(const std::string& name, DataType type, const Shape& row = {}, std::uint64_t chunk = 1,
             std::uint64_t piece = 0) {
    later(0, [=, this] {
      return file_->table(name.c_str(), type, row, std::max<std::uint64_t>(chunk, 1), piece);
    });
  }
  template <class T>
  void append(const std::string& name, std::vector<T> values, std::uint64_t rows) {
    const std::size_t bytes = values.size() * sizeof(T);
    later(bytes, [=, this, values = std::move(values)]() mutable {
      const bool done = file_->append(name.c_str(), values.data(), rows);
      if constexpr (std::is_same_v<T, double>) numbers_.give(std::move(values));
      return done;
    });
  }
  // A piece of a row, as DataFile::append_piece takes it.
  template <class T>
  void append_piece(const std::string& name, std::vector<T> values, std::uint64_t first, std::uint64_t count) {
    const std::size_t bytes = values.size() * sizeof(T);
    later(bytes, [=, this, values = std::move(values)]() mutable {
      const bool done = file_->append_piece(name.c_str(), values.data(), first, count);
      if constexpr (std::is_same_v<T, double>) numbers_.give(std::move(values));
      return done;
    });
  }
  // A table that is complete at once.
  template <class T>
  void whole(const std::string& name, std::vector<T> values, const Shape& row = {}) {
    std::uint64_t numbers = 1;
    for (std::uint64_t n : row) numbers *= n;
    const std::uint64_t rows = numbers == 0 ? 0 : values.size() / numbers;
    table(name, type_of<T>(), row, rows);
    append(name, std::move(values), rows);
  }
  void bytes(const std::string& name, std::string text) {
    const std::size_t size = text.size();
    table(name, DataType::uint8, {}, size);
    later(size, [=, this, text = std::move(text)]() mutable {
      const bool done = file_->append(name.c_str(), text.data(), size);
      texts_.give(std::move(text));
      return done;
    });
  }
  void text(const std::string& path, const char* name, const std::string& value) {
    later(0, [=, this] { return file_->text(path.c_str(), name, value.c_str()); });
  }
  void numbers(const std::string& path, const char* name, const std::vector<std::int64_t>& values) {
    later(0, [=, this] { return file_->numbers(path.c_str(), name, values.data(), values.size()); });
  }
  void close() {
    later(0, [this] { return file_->close(); });
    writer_.finish();
  }

  // Room for what is going to be written.
  std::vector<double> room(std::size_t numbers) { return numbers_.take(numbers); }
  std::string room_for_text(std::size_t size) { return texts_.take(size); }

  template <class T>
  static constexpr DataType type_of() {
    if constexpr (std::is_same_v<T, double>) return DataType::float64;
    if constexpr (std::is_same_v<T, std::int64_t>) return DataType::int64;
    if constexpr (std::is_same_v<T, std::int32_t>) return DataType::int32;
    return DataType::uint8;
  }

 private:
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 26;

  template <class Write>
  void later(std::size_t bytes, Write write) {
    writer_.add(bytes, [this, write = std::move(write)]() mutable {
      if (!write()) throw OutputError("S601", "cannot write " + path_.string() + ": " + file_->error());
    });
  }

  std::filesystem::path path_;
  std::unique_ptr<DataFile> file_;
  ListPool<std::vector<double>> numbers_;
  ListPool<std::string> texts_;
  InOrder writer_;  // the last member: its thread uses the others
};

template <class T>
std::string joined(const std::vector<T>& parts) {
  return fmt::format("{}", fmt::join(parts, " "));
}

// What a reader must know of a field's numbers.
void describe_table(TableFile& out, const std::string& path, const FieldEntry& field, const Model& model) {
  constexpr const char* kSigns[] = {"", "compression positive", "along the axes"};
  out.text(path, "meaning", field.meaning);
  out.text(path, "unit", unit_text(field.dimension, model.units));
  out.text(path, "sign", kSigns[static_cast<std::size_t>(field.sign)]);
  std::vector<std::string> names;
  for (const FieldComponent& component : field.components) names.push_back(component.name);
  if (!names.empty()) out.text(path, "components", joined(names));
  if (!field.words.empty()) out.text(path, "words", joined(field.words));
}

// VTK's own part: grids of active groups as parts, each step with the part that it has, and arrays of steps one
// behind the other.
class VtkPart {
 public:
  VtkPart(TableFile& out, const Model& model, const FieldTable& fields, ThreadPool* pool)
      : out_(out), model_(model), fields_(fields), pool_(pool), time_(model) {
    out_.numbers(kRoot, "Version", {2, 0});
    out_.text(kRoot, "Type", "UnstructuredGrid");
    out_.table(root("Points"), DataType::float64, {3}, kChunk);
    out_.table(root("Types"), DataType::uint8, {}, kChunk);
    for (const char* name : {"Connectivity", "Offsets"}) out_.table(root(name), DataType::int64, {}, kChunk);
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
      out_.table(root(name), DataType::int64);
    out_.table(steps("Values"), DataType::float64);
    out_.text(steps("Values"), "meaning", time_.meaning());
    for (const char* name : {"PartOffsets", "NumberOfParts", "PointOffsets"})
      out_.table(steps(name), DataType::int64);
    for (const char* name : {"CellOffsets", "ConnectivityIdOffsets"})
      out_.table(steps(name), DataType::int64, {1});
  }

  void add(const Frame& frame) {
    const Solution now = frame.view();
    if (count_ == 0 || now.activity->group != active_) add_grid(now);
    const auto one = [&](const char* name, std::int64_t value) {
      out_.append(steps(name), std::vector{value}, 1);
    };
    out_.append(steps("Values"), std::vector{time_.at(frame.report())}, 1);
    one("PartOffsets", parts_ - 1);
    one("NumberOfParts", 1);
    one("PointOffsets", here_.points);
    one("CellOffsets", here_.cells);
    one("ConnectivityIdOffsets", here_.ids);
    add_arrays("PointData", vtk_point_data(model_, now, layout_, fields_, pool_), layout_.node.size(),
               point_rows_);
    add_arrays("CellData", vtk_cell_data(model_, now, fields_, pool_), cells_, cell_rows_);
    ++count_;
  }

  void finish() { out_.numbers(steps(""), "NSteps", {count_}); }

 private:
  static constexpr const char* kRoot = "/VTKHDF";
  static constexpr std::uint64_t kChunk = 4096;
  static std::string root(const std::string& name) { return std::string(kRoot) + "/" + name; }
  static std::string steps(const std::string& name) {
    return std::string(kRoot) + "/Steps" + (name.empty() ? "" : "/" + name);
  }
  struct Place {
    std::int64_t points = 0, cells = 0, ids = 0;
  };

  void add_grid(const Solution& now) {
    active_ = now.activity->group;
    layout_ = nodal_layout(model_, *now.activity);
    VtkGrid grid = vtk_grid(model_, layout_);
    cells_ = grid.types.size();
    std::vector<std::int64_t> ends{0};
    ends.reserve(cells_ + 1);
    ends.insert(ends.end(), grid.offsets.begin(), grid.offsets.end());
    here_ = next_;
    const auto points = static_cast<std::int64_t>(layout_.node.size()),
               cells = static_cast<std::int64_t>(cells_),
               ids = static_cast<std::int64_t>(grid.connectivity.size());
    out_.append(root("Points"), std::move(grid.points), layout_.node.size());
    out_.append(root("Types"), std::move(grid.types), cells_);
    out_.append(root("Connectivity"), std::move(grid.connectivity), static_cast<std::uint64_t>(ids));
    out_.append(root("Offsets"), std::move(ends), cells_ + 1);
    out_.append(root("NumberOfPoints"), std::vector{points}, 1);
    out_.append(root("NumberOfCells"), std::vector{cells}, 1);
    out_.append(root("NumberOfConnectivityIds"), std::vector{ids}, 1);
    next_ = {next_.points + points, next_.cells + cells, next_.ids + ids};
    ++parts_;
  }

  void add_arrays(const std::string& where, std::vector<VtkArray> arrays, std::size_t rows,
                  std::int64_t& before) {
    for (VtkArray& array : arrays) {
      const std::string path = root(where) + "/" + array.name,
                        offsets = steps(where + "Offsets") + "/" + array.name;
      std::visit(
          [&](auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            if (count_ == 0) {
              out_.table(path, TableFile::type_of<T>(), array.width > 1 ? Shape{array.width} : Shape{}, rows);
              out_.text(path, "unit", unit_text(array.field->dimension, model_.units));
              out_.table(offsets, DataType::int64);
            }
            out_.append(path, std::move(values), rows);
          },
          array.values);
      out_.append(offsets, std::vector{before}, 1);
    }
    before += static_cast<std::int64_t>(rows);
  }

  TableFile& out_;
  const Model& model_;
  const FieldTable& fields_;
  ThreadPool* const pool_;
  const StateTime time_;
  std::int64_t count_ = 0, parts_ = 0, point_rows_ = 0, cell_rows_ = 0;
  std::vector<char> active_;
  NodalLayout layout_;
  std::size_t cells_ = 0;
  Place here_, next_;
};

// Everything by its own place: increments, nodes, integration points of every group.
class OwnPart {
 public:
  OwnPart(TableFile& out, const Model& model, const FieldTable& fields, ThreadPool* pool)
      : out_(out), model_(model), fields_(fields), pool_(pool) {
    start_increments();
    start_nodes();
    for (const Group& group : model.groups) start_group(group);
  }

  // Gives the checksum of what Frame::follows_from_fields.
  std::uint64_t add(const Frame& frame) {
    const Solution now = frame.view();
    sum_ = {};
    add_increment(frame.report());
    add_nodes(now);
    for (std::size_t g = 0; g < model_.groups.size(); ++g) add_group(now.groups()[g]);
    return sum_.value();
  }

 private:
  static std::string increments(const std::string& name) { return "/sage/increments/" + name; }
  static std::string nodes(const std::string& name) { return "/sage/nodes/" + name; }
  std::string in(const Group& group, const std::string& name = "") const {
    return group_path(model_, group) + (name.empty() ? "" : "/" + name);
  }
  static bool whole_numbers(const FieldEntry& field) {
    return field.form != FieldForm::number && !field.optional;
  }
  static Shape with_size(Shape shape, const FieldEntry& field) {
    if (field.size() > 1) shape.push_back(field.size());
    return shape;
  }

  // Words are stored by their places in `words`.
  void start(const std::string& path, const FieldEntry& field, const Shape& rows, std::uint64_t piece = 0) {
    out_.table(path, whole_numbers(field) ? DataType::int32 : DataType::float64, with_size(rows, field), 1,
               piece);
    describe_table(out_, path, field, model_);
  }
  static std::vector<std::int32_t> whole(const std::vector<double>& values) {
    std::vector<std::int32_t> numbers;
    numbers.reserve(values.size());
    for (double value : values) numbers.push_back(std::isnan(value) ? -1 : static_cast<std::int32_t>(value));
    return numbers;
  }
  void append(const std::string& path, const FieldEntry& field, std::vector<double> values) {
    if (whole_numbers(field))
      out_.append(path, whole(values), 1);
    else
      out_.append(path, std::move(values), 1);
  }
  void append_piece(const std::string& path, const FieldEntry& field, std::vector<double> values,
                    std::size_t first, std::size_t count) {
    if (whole_numbers(field))
      out_.append_piece(path, whole(values), first, count);
    else
      out_.append_piece(path, std::move(values), first, count);
  }

  void start_increments() {
    out_.table(increments("stage"), DataType::int32);
    out_.table(increments("increment"), DataType::int32);
    for (const FieldEntry& field : fields_.rows())
      if (field.place() == FieldPlace::increment) start(increments(field.name), field, {});
  }
  void add_increment(const StepReport& report) {
    const IncrementView view = increment_view(model_, report);
    out_.append(increments("stage"), std::vector<std::int32_t>{view.stage}, 1);
    out_.append(increments("increment"), std::vector<std::int32_t>{view.increment}, 1);
    for (const FieldEntry& field : fields_.rows()) {
      if (field.place() != FieldPlace::increment) continue;
      std::vector<double> values(field.size());
      read_field(field, view, values.data());
      append(increments(field.name), field, std::move(values));
    }
  }

  bool own_node_field(const FieldEntry& field) const {
    return field.place() == FieldPlace::node && field.name != "node";
  }
  void start_nodes() {
    const std::vector<std::int32_t>& numbers = model_.mesh.number;
    out_.whole(nodes("node"), numbers);
    out_.whole(nodes("place"),
               std::vector<double>(model_.mesh.x.data(), model_.mesh.x.data() + model_.mesh.x.size()), {2});
    for (const FieldEntry& field : fields_.rows())
      if (own_node_field(field)) start(nodes(field.name), field, {numbers.size()});
  }
  // NaN where no active element has the node.
  void add_nodes(const Solution& now) {
    const std::vector<char> active = active_nodes(model_, *now.activity);
    const NodeViews views(model_, now);
    FieldList fields;
    std::vector<std::vector<double>> values;
    for (const FieldEntry& field : fields_.rows()) {
      if (!own_node_field(field)) continue;
      fields.push_back(&field);
      values.push_back(out_.room(active.size() * field.size()));
    }
    in_pieces(pool_, active.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        const NodeView view = views.at(static_cast<int>(n));
        for (std::size_t f = 0; f < fields.size(); ++f) {
          double* const to = values[f].data() + n * fields[f]->size();
          if (active[n])
            read_field(*fields[f], view, to);
          else
            std::fill_n(to, fields[f]->size(), std::nan(""));
        }
      }
    });
    for (std::size_t f = 0; f < fields.size(); ++f)
      append(nodes(fields[f]->name), *fields[f], std::move(values[f]));
  }

  FieldList point_fields(const Group& group) const {
    FieldList list;
    for (const FieldEntry& field : fields_.rows())
      if (applies(field, group, model_.material_of(group).law_ref())) list.push_back(&field);
    return list;
  }
  static std::size_t points_of(const Group& group) {
    return static_cast<std::size_t>(group.elements() * group.element->traits().points);
  }
  void start_group(const Group& group) {
    std::vector<double> places(2 * points_of(group));
    in_pieces(pool_, static_cast<std::size_t>(group.elements()), [&](std::size_t first, std::size_t last) {
      const int points = group.element->traits().points;
      double* to = places.data() + first * static_cast<std::size_t>(2 * points);
      Eigen::Matrix2Xd x;
      for (std::size_t e = first; e < last; ++e) {
        element_coordinates(model_.mesh, group, static_cast<int>(e), x);
        for (int p = 0; p < points; ++p, to += 2) Vector2::Map(to) = group.element->position(x, p);
      }
    });
    std::vector<std::int32_t> nodes_of;
    nodes_of.reserve(group.nodes.size());
    for (int node : group.nodes) nodes_of.push_back(model_.mesh.number[node]);
    out_.whole(in(group, "place"), std::move(places), {2});
    out_.whole(in(group, "nodes"), std::move(nodes_of), {group.node_count()});
    out_.whole(in(group, "active"), std::vector<std::uint8_t>{});
    out_.text(in(group), "name", group.name);
    out_.text(in(group), "element", group.element_name);
    out_.text(in(group), "law", model_.material_of(group).law_name);
    out_.numbers(in(group), "points", {group.element->traits().points});
    for (const FieldEntry& field : fields_.rows())
      if (field.place() == FieldPlace::element) add_element_field(group, field);
    for (const FieldEntry* field : point_fields(group))
      start(in(group, field->name), *field, {points_of(group)}, piece_of(points_of(group)));
  }
  void add_element_field(const Group& group, const FieldEntry& field) {
    std::vector<double> values(static_cast<std::size_t>(group.elements()) * field.size());
    in_pieces(pool_, static_cast<std::size_t>(group.elements()), [&](std::size_t first, std::size_t last) {
      Eigen::Matrix2Xd x;
      for (std::size_t e = first; e < last; ++e) {
        element_coordinates(model_.mesh, group, static_cast<int>(e), x);
        read_field(field, element_view(model_, group, static_cast<int>(e), x),
                   values.data() + e * field.size());
      }
    });
    const std::string path = in(group, field.name);
    if (whole_numbers(field)) {
      out_.whole(path, std::vector<std::int32_t>(values.begin(), values.end()), with_size({}, field));
    } else {
      out_.whole(path, std::move(values), with_size({}, field));
    }
    describe_table(out_, path, field, model_);
  }
  // NaN (words: -1) while the group is not active.
  void add_group(const GroupData& data) {
    const Group& group = *data.group;
    out_.append(in(group, "active"), std::vector<std::uint8_t>{static_cast<std::uint8_t>(data.active)}, 1);
    FieldList others;
    for (const FieldEntry* field : point_fields(group)) {
      const bool stress = field->name == "stress";
      if (Frame::follows_from_fields(data) && (stress || field->name == "strain"))
        add_tensor(data, *field, stress ? data.state.committed.sigma : data.state.committed.eps);
      else
        others.push_back(field);
    }
    add_fields(data, others);
  }
  // What the state's stress or strain follows from, and its checksum is of.
  void add_tensor(const GroupData& data, const FieldEntry& field, const std::vector<double>& internal) {
    const std::size_t size = field.size();
    each_piece(points_of(*data.group), [&](std::size_t first, std::size_t count) {
      std::vector<double> values = out_.room(count * size);
      in_pieces(pool_, values.size(), [&](std::size_t from, std::size_t to) {
        const double* const at = internal.data() + first * size;
        for (std::size_t i = from; i < to; ++i) values[i] = outward(at[i]);
      });
      sum_.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
      append_piece(in(*data.group, field.name), field, std::move(values), first, count);
    });
  }
  // Together: what a point has is looked up once for all of them.
  void add_fields(const GroupData& data, const FieldList& fields) {
    const PointFields reader(fields, data);
    each_piece(points_of(*data.group), [&](std::size_t first, std::size_t count) {
      std::vector<std::vector<double>> values;
      for (const FieldEntry* field : fields) values.push_back(out_.room(count * field->size()));
      if (!data.active)
        for (std::vector<double>& one : values) std::ranges::fill(one, std::nan(""));
      else
        in_pieces(pool_, count, [&](std::size_t from, std::size_t to) {
          for (std::size_t p = from; p < to; ++p) {
            const PointState point(model_.mesh, data, first + p);
            for (std::size_t f = 0; f < fields.size(); ++f)
              reader.read(f, point, values[f].data() + p * fields[f]->size());
          }
        });
      for (std::size_t f = 0; f < fields.size(); ++f)
        append_piece(in(*data.group, fields[f]->name), *fields[f], std::move(values[f]), first, count);
    });
  }

  // Points whose numbers are stored together: what a piece needs stays near the processor.
  static std::size_t piece_of(std::size_t points) {
    constexpr std::size_t kMost = std::size_t{1} << 16;
    const std::size_t pieces = std::max<std::size_t>((points + kMost - 1) / kMost, 1);
    return (points + pieces - 1) / pieces;
  }
  // Of no points one piece, which is empty.
  template <class Work>
  static void each_piece(std::size_t points, const Work& work) {
    const std::size_t piece = piece_of(points);
    std::size_t first = 0;
    do {
      work(first, std::min(piece, points - first));
      first += piece;
    } while (first < points);
  }

  TableFile& out_;
  const Model& model_;
  const FieldTable& fields_;
  ThreadPool* const pool_;
  Checksum sum_;
};

// In a large model what follows from a point's stress or strain by itself is left to those who read the file, but for
// what was asked for: it would be half of the file, and cost more than a linear run.
bool is_left_out(const FieldEntry& field, const std::vector<std::string>& asked) {
  const bool follows =
      std::holds_alternative<StressField>(field.value) || std::holds_alternative<StrainField>(field.value);
  return follows && field.shape != FieldShape::tensor && std::ranges::find(asked, field.name) == asked.end();
}

constexpr int kWorthThreads = 20000;  // points
// Points of all states.  Below that a thread that writes costs more by handing over than it saves.
constexpr std::size_t kWorthOwnThread = 40000;

int points_of(const Model& model) {
  int points = 0;
  for (const Group& group : model.groups) points += group.elements() * group.element->traits().points;
  return points;
}

// What StoredResult reads: the model's sources, and of every state what no field has.
class SourcePart {
 public:
  SourcePart(TableFile& out, const RunSource& source, const Model& model, const std::string& failure)
      : out_(out), kept_(!source.deck.empty()) {
    if (!kept_) return;
    bytes("deck", source.deck);
    bytes("layout", source.layout_text);
    if (!source.heads.empty()) {
      bytes(kStoredHeads, source.heads);
      out_.text(kStoredFolder, kStoredHeads, "doubles");
    }
    out_.text(kStoredFolder, "name", model.file);
    out_.text(kStoredFolder, "layout", source.layout);
    out_.text(kStoredFolder, "options", source.options);
    out_.text(kStoredFolder, "format", kStoredFormat);
    out_.text(kStoredFolder, "model", fmt::format("{:016x}", fingerprint(model)));
    out_.text(kStoredFolder, "failure", failure);
    out_.table(stored_path("states"), DataType::int64, {kStoredColumns});
  }

  // fields: checksum of those that say the rest of the state.
  void add(Frame& frame, std::uint64_t fields) {
    if (!kept_) return;
    Archive archive = Archive::behind(out_.room_for_text(0));
    frame.exchange_state(archive, false);
    std::string stored = archive.take();
    const StepReport& report = frame.report();
    const std::vector<std::int64_t> row{report.stage, report.increment, report.increments,
                                        std::bit_cast<std::int64_t>(checksum(stored)),
                                        std::bit_cast<std::int64_t>(fields)};
    out_.append(stored_path("states"), row, 1);
    out_.bytes(stored_path(fmt::format("state{}", ++count_)), std::move(stored));
  }

 private:
  void bytes(const std::string& name, const std::string& text) { out_.bytes(stored_path(name), text); }

  TableFile& out_;
  bool kept_;
  int count_ = 0;
};

}  // namespace

ResultOutput::ResultOutput(const std::filesystem::path& folder, const std::string& stem, RunSource source,
                           int threads, ResultFields fields)
    : path_(folder / (stem + ".h5")),
      source_(std::move(source)),
      threads_(threads),
      fields_(std::move(fields)) {
  expect_data_module();
  expect_no_input(path_);
  std::error_code ignored;
  if (std::filesystem::is_directory(path_, ignored))
    throw OutputError("S601",
                      "cannot write " + path_.string() + ": " + std::generic_category().message(EISDIR));
  states_ = OutFile(path_.string() + ".states");
}

ResultOutput::~ResultOutput() {
  const bool of_no_checkpoint = (!written_.empty() || !waiting_.empty()) && !in_checkpoint_;
  if (!files_.empty() || of_no_checkpoint) states_.discard();
}

void ResultOutput::add(const Model& model, const StepReport& report, const Solution& solution) {
  waiting_.emplace_back(model, report, solution);
  waiting_bytes_ += waiting_.back().size_of_state();
  if (waiting_bytes_ > kMostWaiting) write_states();
}

void ResultOutput::write_states() {
  for (Frame& frame : waiting_) {
    std::string& text = states_.text();
    const std::size_t before = text.size();
    text.reserve(before + frame.size_of_state());
    Archive archive = Archive::behind(std::move(text));
    frame.exchange_report(archive);
    frame.exchange_state(archive);
    text = archive.take();
    written_.push_back(text.size() - before);
    states_.checkpoint();
  }
  waiting_.clear();
  waiting_bytes_ = 0;
}

// One after the other: of those that were written one alone is in memory.
void ResultOutput::each_state(const Model& model, const std::function<void(Frame&)>& use) {
  std::ifstream in;
  if (!written_.empty()) in.open(states_.partial(), std::ios::binary);
  Frame frame(model);
  std::string bytes;
  for (std::uint64_t size : written_) {
    bytes.resize(size);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
      throw OutputError("S601", "the states of the run can't be read back for its result file");
    Archive archive(std::move(bytes));
    frame.exchange_report(archive);
    frame.exchange_state(archive);
    bytes = archive.take();
    use(frame);
  }
  for (Frame& one : waiting_) use(one);
}

void ResultOutput::on_increment(const Model& model, const StepReport& report, const Solution& solution) {
  if (is_output_increment(stage_of(model, report.stage), report)) add(model, report, solution);
}

void ResultOutput::on_failure(const Model& model, const StepReport& report, const std::string& reason,
                              const Solution& solution) {
  failure_ = one_line(reason);
  add(model, report, solution);
}

void ResultOutput::exchange(Archive& archive) {
  in_checkpoint_ = true;
  if (!archive.reading()) write_states();
  states_.exchange(archive);
  archive(written_);
}

// HDF5 follows null pointers where an allocation fails.
void ResultOutput::on_finish(const Model& model, const RunResult& result) {
  OutFile file(path_);
  if (!written_.empty()) states_.flush();
  file.written_by([&](const std::filesystem::path& partial) {
    const auto write = [&] { write_result(model, result, partial); };
    if (memory_may_fail())
      run_apart("cannot write " + path_.string(), write);
    else
      write();
  });
  file.finish();
  files_.push_back(path_);
}

void ResultOutput::write_result(const Model& model, const RunResult& result,
                                const std::filesystem::path& partial) {
  FieldTable fields = fields_of(model);
  std::vector<std::string> left_out;
  if (points_of(model) > fields_.most_points)
    fields = fields.without([&](const FieldEntry& field) {
      if (is_left_out(field, fields_.asked)) left_out.push_back(field.name);
      return is_left_out(field, fields_.asked);
    });
  const std::size_t numbers = static_cast<std::size_t>(points_of(model)) * (written_.size() + waiting_.size());
  TableFile out(partial, path_, threads_ > 1 && numbers > kWorthOwnThread);
  out.text("/sage", "title", model.title);
  out.text("/sage", "deck", model.file);
  out.text("/sage", "program", "sagefe " SAGE_VERSION);
  out.text("/sage", "status",
           failure_.empty() ? completed_words(model, result.motion) : "NOT CONVERGED: " + failure_);
  out.text("/sage", "signs", sign_convention(model, ""));
  out.text("/sage", "geometry", model.geometry == Geometry::axisymmetric ? "axisymmetric" : "plane strain");
  if (!left_out.empty()) out.text("/sage", "left_out", joined(left_out));
  std::optional<ThreadPool> pool;
  if (threads_ > 1 && points_of(model) > kWorthThreads) pool.emplace(threads_);
  VtkPart vtk(out, model, fields, pool ? &*pool : nullptr);
  OwnPart own(out, model, fields, pool ? &*pool : nullptr);
  SourcePart source(out, source_, model, failure_);
  each_state(model, [&](Frame& frame) {
    vtk.add(frame);
    source.add(frame, own.add(frame));
  });
  vtk.finish();
  out.close();
}

}  // namespace sage

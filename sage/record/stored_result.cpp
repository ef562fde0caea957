#include "sage/record/stored_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "sage/messages/error.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/platform/checksum.hpp"

namespace sage {

StoredResult::StoredResult(const std::filesystem::path& file)
    : path_(file), file_(open_data_file(file.string())) {
  std::string format;
  if (!file_->read_text(kStoredFolder, "format", format))
    fail("holds no run of this program that could be shown again (sagefe run --result writes one)");
  whole_ = format == kWholeFormat;
  if (!whole_ && format != kStoredFormat)
    fail("its states are written as " + format + ", this program reads " + kStoredFormat +
         ": run the deck again");
  source_ = {bytes("deck"), text("layout"), bytes("layout"), text("options")};
  if (std::string form; file_->read_text(kStoredFolder, kStoredHeads, form))
    source_.heads = bytes(kStoredHeads);
  deck_name_ = text("name");
  failure_ = text("failure");
  model_ = text("model");
  const std::string rows = bytes("states");
  std::vector<std::int64_t> row(whole_ ? kWholeColumns : kStoredColumns);
  const std::size_t size = row.size() * sizeof row[0];
  for (std::size_t at = 0; at + size <= rows.size(); at += size) {
    std::memcpy(row.data(), rows.data() + at, size);
    states_.push_back({static_cast<int>(row[0]), static_cast<int>(row[1]), static_cast<int>(row[2]),
                       std::bit_cast<std::uint64_t>(row[3]),
                       whole_ ? 0 : std::bit_cast<std::uint64_t>(row[4])});
  }
}

void StoredResult::fail(const std::string& what) const {
  throw InputError("S640", {path_.string(), 0, 0, 0}, what);
}

std::string StoredResult::bytes(const std::string& name) const {
  std::string value;
  if (!file_->read(stored_path(name).c_str(), value)) fail("is damaged: " + std::string(file_->error()));
  return value;
}

std::string StoredResult::text(const char* name) const {
  std::string value;
  if (!file_->read_text(kStoredFolder, name, value)) fail("is damaged: " + std::string(file_->error()));
  return value;
}

void StoredResult::expect_model(const Model& model) const {
  if (fmt::format("{:016x}", fingerprint(model)) != model_)
    fail("its deck means another model in this program (other elements, laws or version): run the deck again");
}

Frame StoredResult::frame(const Model& model, std::size_t state) const {
  std::string stored = bytes(fmt::format("state{}", state + 1));
  if (checksum(stored) != states_.at(state).checksum) fail(fmt::format("state {} is damaged", state + 1));
  Frame frame(model);
  Archive archive(std::move(stored));
  frame.exchange_state(archive, whole_);
  if (!whole_) read_fields(model, state, frame);
  return frame;
}

void StoredResult::read_fields(const Model& model, std::size_t state, Frame& frame) const {
  Checksum sum;
  const auto row = [&](const std::string& table, std::size_t points) {
    std::vector<double> values(4 * points);
    const std::size_t bytes = values.size() * sizeof(double);
    if (!file_->read_row(table.c_str(), state, values.data(), bytes))
      fail("is damaged: " + std::string(file_->error()));
    sum.add({reinterpret_cast<const char*>(values.data()), bytes});
    return values;
  };
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const GroupData& data = frame.view().groups()[g];
    if (!Frame::follows_from_fields(data)) continue;
    const std::string folder = group_path(model, model.groups[g]);
    const std::size_t points = data.state.committed.status.size();
    std::vector<double> stress = row(folder + "/stress", points), strain = row(folder + "/strain", points);
    frame.set_fields(g, std::move(stress), std::move(strain));
  }
  if (sum.value() != states_.at(state).fields_checksum)
    fail(fmt::format("stress or strain of state {} is damaged", state + 1));
}

std::string group_path(const Model& model, const Group& group) {
  const bool second = std::any_of(model.groups.data(), &group,
                                  [&](const Group& other) { return other.number == group.number; });
  return fmt::format("/sage/groups/{}{}", group.number, second ? "_" + group.entry->name : "");
}

}  // namespace sage

#include "sage/record/stored_result.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>

#include "sage/core/checksum.hpp"
#include "sage/core/error.hpp"
#include "sage/model/fingerprint.hpp"

namespace sage {

StoredResult::StoredResult(const std::filesystem::path& file)
    : path_(file), file_(open_data_file(file.string())) {
  std::string format;
  if (!file_->read_text(kStoredFolder, "format", format))
    fail("holds no run of this program that could be shown again (sagefe run --result writes one)");
  if (format != kStoredFormat)
    fail("its states are written as " + format + ", this program reads " + kStoredFormat +
         ": run the deck again");
  source_ = {bytes("deck"), text("layout"), bytes("layout"), text("options")};
  if (std::string form; file_->read_text(kStoredFolder, kStoredHeads, form))
    source_.heads = bytes(kStoredHeads);
  deck_name_ = text("name");
  failure_ = text("failure");
  model_ = text("model");
  const std::string rows = bytes("states");
  std::array<std::int64_t, kStoredColumns> row;
  for (std::size_t at = 0; at + sizeof row <= rows.size(); at += sizeof row) {
    std::memcpy(row.data(), rows.data() + at, sizeof row);
    states_.push_back({static_cast<int>(row[0]), static_cast<int>(row[1]), static_cast<int>(row[2]),
                       std::bit_cast<std::uint64_t>(row[3])});
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
  frame.exchange_state(archive);
  return frame;
}

}  // namespace sage

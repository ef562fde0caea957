// Fields of the points of one group, for loops over many points: which of them apply is asked once.
#pragma once

#include <algorithm>
#include <limits>

#include "sage/record/field_reader.hpp"

namespace sage {

class PointFields {
 public:
  // The fields must outlive it.
  PointFields(const FieldList& fields, const GroupData& data) {
    for (const FieldEntry* field : fields) {
      const bool tensor = std::holds_alternative<StressField>(field->value) ||
                          std::holds_alternative<StrainField>(field->value);
      rows_.push_back({field, applies(*field, data), tensor, carried_size(*field)});
    }
  }

  // As read_field() and carry() of the field at this place of the list.
  void read(std::size_t field, const PointState& point, double* value) const {
    const Row& row = rows_[field];
    if (row.applies)
      read_applying(*row.entry, point, value);
    else
      std::fill_n(value, row.entry->size(), std::numeric_limits<double>::quiet_NaN());
  }
  void carry(std::size_t field, const PointState& point, double* parts) const {
    if (rows_[field].of_tensor)
      sage::carry(*rows_[field].entry, point, parts);
    else
      read(field, point, parts);
  }
  // Of all fields, one behind the other.
  void carry_all(const PointState& point, double* parts) const {
    for (std::size_t f = 0; f < rows_.size(); ++f) {
      carry(f, point, parts);
      parts += rows_[f].carried;
    }
  }

 private:
  struct Row {
    const FieldEntry* entry;
    bool applies, of_tensor;  // of stress or strain
    std::size_t carried;      // numbers
  };
  std::vector<Row> rows_;
};

}  // namespace sage

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
    for (const FieldEntry* field : fields)
      rows_.push_back({field, applies(*field, data), std::get_if<StressField>(&field->value),
                       std::get_if<StrainField>(&field->value), std::get_if<PointField>(&field->value)});
  }

  // As read_field() of the field at this place of the list.
  void read(std::size_t field, const PointState& point, double* value) const {
    const Row& row = rows_[field];
    if (!row.applies)
      std::fill_n(value, row.entry->size(), std::numeric_limits<double>::quiet_NaN());
    else if (row.stress != nullptr)
      row.stress->of(point.stress, value);
    else if (row.strain != nullptr)
      row.strain->of(point.strain, value);
    else
      row.point->of(point.view, value);
  }
  // As carry().
  void carry(std::size_t field, const PointState& point, double* parts) const {
    const Row& row = rows_[field];
    if (row.stress == nullptr && row.strain == nullptr) return read(field, point, parts);
    if (point.solid)
      Vector4::Map(parts) = row.stress != nullptr ? point.stress : point.strain;
    else
      std::fill_n(parts, 4, std::numeric_limits<double>::quiet_NaN());
  }

 private:
  struct Row {
    const FieldEntry* entry;
    bool applies;
    const StressField* stress;
    const StrainField* strain;
    const PointField* point;
  };
  std::vector<Row> rows_;
};

}  // namespace sage

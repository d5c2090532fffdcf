// The units of a file of points: of its columns, of a row below their names, or of --unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "node/csv/contact_file.h"
#include "node/csv/point_columns.h"

namespace palpate::csv {

/// What a number of that column is in SI units.
double unit_of(const PointColumns& columns, Column column, const ContactFileOptions& options,
               bool is_probe_log);

/// The columns with the units of a row below their names, "mm;mm"; nullopt if the row is none.
std::optional<PointColumns> with_row_of_units(const PointColumns& columns,
                                              const std::vector<std::string_view>& fields);

/// What is wrong if two coordinates have different units (one of them is a mistake, and which one
/// nobody knows), or if a length is in mil; or nothing.
std::string clash_of_units(const PointColumns& columns);

/// What is assumed or overruled, or nothing.
std::string note_of_unit(const PointColumns& columns, const ContactFileOptions& options,
                         bool is_probe_log);

}  // namespace palpate::csv

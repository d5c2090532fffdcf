// What is to be said of a file of points: what was ignored, assumed or taken for something else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "node/csv/point_columns.h"
#include "node/csv/point_reader.h"

namespace palpate::csv {

/// What reading came across beside the rows and their columns.
struct SeenInPoints {
  std::string_view preface;       ///< the first line before the names that names nothing
  std::size_t preface_lines = 0;  ///< lines like it
  std::size_t names_again = 0;    ///< times that the line of names comes again
  std::uint32_t blocks = 1;       ///< of rows between empty lines
  bool unnamed_used = false;      ///< a column without a name has a value
  bool has_comma = false;         ///< as a decimal point
};

/// The notes on the rows of `table`, which has been read to its end.
std::vector<std::string> notes_of_points(const PointTable& table, const PointColumns& columns,
                                         const ContactFileOptions& options,
                                         const SeenInPoints& seen);

}  // namespace palpate::csv

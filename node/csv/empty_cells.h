// Cells that are empty in a column: what they stand for is said, or they are refused.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "node/csv/contact_file.h"
#include "node/csv/point_columns.h"
#include "node/csv/text_lines.h"

namespace palpate::csv {

/// Counts them while the rows are read. Where "not measured" is a value of its own (noise, time,
/// normals, covariances), or a group is that of its probe, a cell may be empty. Every other column
/// is filled in all rows or in none: a spreadsheet writes merged cells as one that is filled above
/// empty ones, and 0 would be taken for what the first row says of all.
class EmptyCells {
 public:
  /// The cell of that column in the present line.
  void see(Column column, std::string_view cell, const TextLines& lines);

  /// Whether a row has something there.
  bool is_used(Column column) const { return of(column).filled > 0; }

  /// "FILE:LINE:COLUMN: what is wrong" of the first cell that must not be empty, or nothing.
  std::string error(const ContactFileOptions& options) const;

  std::vector<std::string> notes() const;

 private:
  struct Cells {
    std::size_t filled = 0;
    std::size_t empty = 0;
    std::string first_empty;  ///< "FILE:LINE:COLUMN: "
  };

  const Cells& of(Column column) const { return cells_[static_cast<std::size_t>(column)]; }

  std::array<Cells, kPointColumnCount> cells_;
};

}  // namespace palpate::csv

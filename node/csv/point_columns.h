// Columns as people call them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "node/csv/csv_columns.h"

namespace palpate::csv {

/// Every Column: those of a contact CSV file, and Z.
inline constexpr std::size_t kPointColumnCount = kColumnCount + 1;
inline constexpr std::array<Column, 3> kCoordinates = {Column::X, Column::Y, Column::Z};

bool is_length(Column column);
bool is_area(Column column);

struct NamedColumn {
  Column column = Column::X;
  /// SI units in one of the file's; nullopt where the name tells none.
  std::optional<double> unit;
  bool is_in_mil = false;  ///< a thousandth of an inch, and to some a millimetre: no unit is told
};

/// The column of that name: case, quotes, blanks and hyphens do not matter, a unit may follow after
/// an underscore or in brackets ("x", "X [mm]", "pos_y_um", "time_s"). nullopt for others.
std::optional<NamedColumn> column_of(std::string_view name);

/// The unit that stands alone, "mm" or "[mm]", in SI units; nullopt for others.
std::optional<double> unit_in_brackets(Column column, std::string_view text);

/// For messages: the names in their plainest form.
std::string known_columns();

/// Which column stands where in a line.
struct PointColumns {
  std::array<std::optional<std::size_t>, kPointColumnCount> places;
  std::array<std::optional<double>, kPointColumnCount> units;
  std::vector<std::string> ignored;  ///< columns that are none of these
  std::vector<std::size_t> unnamed;  ///< places of columns whose name is empty
  bool tips_by_diameter = false;     ///< what stands in the place of the tip radius
  std::string twice;                 ///< name of a column that comes a second time; else empty
  std::string in_mil;                ///< name of a column of such lengths; else empty
  /// Why columns of normals or covariances are not used, a sentence each.
  std::vector<std::string> unused_details;

  std::optional<std::size_t> place(Column column) const {
    return places[static_cast<std::size_t>(column)];
  }
  /// Two coordinates at least.
  bool is_enough() const;
};

/// LinuxCNC writes the position of nine axes: X Y Z A B C U V W.
inline constexpr std::size_t kLinuxCncAxes = 9;

/// So many columns without names, and what is assumed of them; nullopt if nothing can be, and why.
std::optional<PointColumns> columns_by_number(std::size_t count, std::string& note);

PointColumns columns_of(const std::vector<std::string_view>& names);

}  // namespace palpate::csv

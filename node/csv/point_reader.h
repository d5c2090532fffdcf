// Files of points that do not hold to the columns of contact_csv.h, and probe logs.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "node/csv/contact_file.h"
#include "node/csv/empty_cells.h"
#include "node/wire/ingest_limits.h"

namespace palpate::csv {

/// What the node would refuse is not used offline either. [m]
inline constexpr double kMaxCoordinateM = IngestLimits{}.max_coordinate_m;

/// Rows whose positions are still in space.
struct PointTable {
  ContactTable table;                   ///< positions: x and y of `points` where there are just two
  std::vector<Eigen::Vector3d> points;  ///< where three coordinates were read; else empty [m]
  std::vector<std::size_t> lines;       ///< of the rows in the file, from 1; empty = not known
  bool is_probe_log = false;            ///< every row is a touch
  bool has_patches = false;             ///< the file says where patches end
  bool has_three_without_names = false;  ///< columns
  EmptyCells empty_cells;
  std::vector<std::string> notes;
};

/// Columns with names or without, by any usual separator.
Result<PointTable> read_points(std::string_view text, std::string_view name,
                               const ContactFileOptions& options);

/// grbl's answers to G38: lines "[PRB:x,y,z:1]" among others.
bool is_grbl_log(std::string_view text);
Result<PointTable> read_grbl_log(std::string_view text, std::string_view name,
                                 const ContactFileOptions& options);

}  // namespace palpate::csv

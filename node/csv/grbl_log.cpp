#include <cmath>

#include "node/csv/point_reader.h"
#include "node/csv/text_lines.h"
#include "node/files/counted.h"

namespace palpate::csv {
namespace {

constexpr std::string_view kGrblProbe = "[PRB:";

}  // namespace

bool is_grbl_log(std::string_view text) { return text.find(kGrblProbe) != std::string_view::npos; }

Result<PointTable> read_grbl_log(std::string_view text, std::string_view name,
                                 const ContactFileOptions& options) {
  using Read = Result<PointTable>;
  PointTable result;
  result.is_probe_log = true;
  result.table.names = {"probe"};
  constexpr double kMillimetre = 1e-3;
  const double unit = options.unit_m.value_or(kMillimetre);
  std::size_t other_lines = 0;
  std::size_t missed = 0;
  TextLines lines(text, name);
  while (lines.next()) {
    const std::size_t found = lines.line().find(kGrblProbe);
    if (found == std::string_view::npos) {
      other_lines += trimmed(lines.line()).empty() ? 0 : 1;
      continue;
    }
    std::string_view rest = lines.line().substr(found + kGrblProbe.size());
    Eigen::Vector3d point;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::size_t end = rest.find_first_of(",:]");
      const auto value = number_of(rest.substr(0, end), false);
      if (end == std::string_view::npos || !value || !std::isfinite(*value) ||
          std::abs(*value) * unit > kMaxCoordinateM) {
        return Read::fail(lines.error(
            rest.data(), "[PRB:x,y,z:1] expected, found " + shown(lines.line().substr(found))));
      }
      point[axis] = *value * unit;
      if (axis < 2 && rest[end] != ',') {
        return Read::fail(lines.error(rest.data() + end, "three coordinates expected"));
      }
      rest.remove_prefix(end + 1);
    }
    if (!lines.line().ends_with(":1]") &&
        lines.line().find(":1]", found) == std::string_view::npos) {
      ++missed;
      continue;
    }
    ContactRow row;
    row.context.tip_radius_m = options.tip_radius_m;
    row.sample.position_m = point.head<2>();
    result.table.rows.push_back(row);
    result.points.push_back(point);
  }
  if (result.table.rows.empty()) {
    return Read::fail(lines.error(nullptr, "no probing cycle of this grbl log touched anything"));
  }
  result.notes.push_back(
      "a grbl log: its [PRB:x,y,z:1] lines are the touches" +
      (other_lines > 0
           ? ", " + counted(other_lines, "other line is", "other lines are") + " ignored"
           : std::string()));
  if (missed > 0) {
    result.notes.push_back("left out: " + counted(missed, "probing cycle") +
                           " that touched nothing ([PRB:...:0])");
  }
  if (!options.unit_m) {
    result.notes.emplace_back(
        "grbl reports millimetres unless $13=1: taken as millimetres (else --unit in)");
  }
  return Read::ok(std::move(result));
}

}  // namespace palpate::csv

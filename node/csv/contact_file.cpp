#include "node/csv/contact_file.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "node/csv/contact_csv.h"
#include "node/csv/csv_columns.h"
#include "node/csv/point_plane.h"
#include "node/csv/point_reader.h"
#include "node/csv/text_encoding.h"
#include "node/csv/text_lines.h"
#include "node/files/bounded_file.h"
#include "node/files/counted.h"

namespace palpate {
namespace {

using Read = Result<ContactFile>;

/// Whether the first line that holds anything is a header as contact_csv.h has it.
bool is_own_format(std::string_view text) {
  csv::TextLines lines(text, "");
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line().substr(0, lines.line().find('#')));
    if (line.empty()) continue;
    std::size_t required = 0;
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t end = std::min(line.find(',', from), line.size());
      const auto* const found = std::find(csv::kColumnNames.begin(), csv::kColumnNames.end(),
                                          trimmed(line.substr(from, end - from)));
      if (found == csv::kColumnNames.end()) return false;
      required +=
          found - csv::kColumnNames.begin() < static_cast<std::ptrdiff_t>(csv::kRequiredColumns)
              ? 1
              : 0;
      from = end + 1;
    }
    return required >= csv::kRequiredColumns;
  }
  return false;
}

Result<csv::PointTable> read_own(std::string_view text, std::string_view name,
                                 const ContactFileOptions& options) {
  csv::PointTable result;
  Result<ContactTable> table = parse_contact_csv(text, name, &result.empty_cells);
  if (!table) return Result<csv::PointTable>::fail(table.error);
  result.table = std::move(*table.value);
  result.has_patches = true;
  for (ContactRow& row : result.table.rows) {
    if (options.unit_m) {
      row.sample.position_m *= *options.unit_m;
      row.sample.sigma_m *= *options.unit_m;
      row.detail.covariance_m2 *= *options.unit_m * *options.unit_m;
      row.context.tip_radius_m *= *options.unit_m;
    }
    if (row.context.tip_radius_m == 0.0) row.context.tip_radius_m = options.tip_radius_m;
  }
  if (options.unit_m && *options.unit_m != 1.0) {
    result.notes.emplace_back("the unit is taken from --unit, not from the columns' names");
  }
  return Result<csv::PointTable>::ok(std::move(result));
}

/// One patch is one touch of one tip; what is wrong, ":LINE: " before it where that is known, or
/// nothing.
std::string disagreement_in_patches(const ContactTable& table,
                                    const std::vector<std::size_t>& lines) {
  std::map<std::tuple<std::size_t, std::uint64_t, std::size_t, std::uint32_t>, PatchContext> seen;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const ContactRow& row = table.rows[i];
    const PatchContext& first =
        seen.try_emplace({row.group, row.object, row.probe, row.context.patch}, row.context)
            .first->second;
    const char* what = row.context.tip_radius_m != first.tip_radius_m     ? "tip_radius"
                       : row.context.material_side != first.material_side ? "material_side"
                                                                          : nullptr;
    if (what != nullptr) {
      const std::string line = i < lines.size() ? ":" + std::to_string(lines[i]) : "";
      return line + ": " + what + " changes within patch " + std::to_string(row.context.patch) +
             " of probe " + table.names[row.probe];
    }
  }
  return {};
}

/// Three columns without names of which the first counts 1, 2, 3, ... while both others vary: point
/// numbers, that would be taken for x. What is wrong, or nothing.
std::string counts_instead(const csv::PointTable& points, const ContactFileOptions& options) {
  constexpr std::size_t kFewest = 4;  // two or three numbers count by chance
  if (!points.has_three_without_names || options.plane != PointPlane::Varying ||
      points.points.size() < kFewest) {
    return {};
  }
  constexpr double kRounding = 1e-9;  // of the change to metres and back, for numbers of a million
  const double unit = options.unit_m.value_or(1.0);
  Eigen::Vector3d low = points.points.front();
  Eigen::Vector3d high = low;
  double next = std::round(low.x() / unit);
  for (const Eigen::Vector3d& point : points.points) {
    if (std::abs(point.x() / unit - next) > kRounding) return {};
    next += 1.0;
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  // A scan by even steps along x holds y or z still (point_plane.cpp has the bound).
  constexpr double kHeldStill = 0.01;
  const Eigen::Vector2d others = (high - low).tail<2>();
  if (others.minCoeff() <= kHeldStill * others.maxCoeff()) return {};
  return "three columns without names, of which the first counts: are these point numbers? Name "
         "the "
         "columns in a first line (number,x_mm,y_mm), or choose the plane (--plane xy, xz, yz, "
         "fit)";
}

/// Where the file has another tip radius than was said: that it counts, or nothing.
std::string note_of_unused_tip(const ContactTable& table, double tip_radius_m) {
  const auto others = std::count_if(
      table.rows.begin(), table.rows.end(),
      [&](const ContactRow& row) { return row.context.tip_radius_m != tip_radius_m; });
  if (tip_radius_m == 0.0 || others == 0) return {};
  return "--tip-radius is not used for " + counted(static_cast<std::uint64_t>(others), "sample") +
         ": the tip radius that the file states counts";
}

/// Numbers the rows of each probe and object as patches of their own.
void part_into_touches(ContactTable& table) {
  std::map<std::tuple<std::size_t, std::uint64_t, std::size_t>, std::uint32_t> counts;
  for (ContactRow& row : table.rows) {
    row.context.patch = counts[{row.group, row.object, row.probe}]++;
  }
}

}  // namespace

std::optional<PointPlane> point_plane_from_name(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PointPlane>, 5> kPlanes = {
      {{"auto", PointPlane::Varying},
       {"xy", PointPlane::Xy},
       {"xz", PointPlane::Xz},
       {"yz", PointPlane::Yz},
       {"fit", PointPlane::Fitted}}};
  for (const auto& [known, plane] : kPlanes) {
    if (known == name) return plane;
  }
  return std::nullopt;
}

Read parse_contact_file(std::string_view text, std::string_view name,
                        const ContactFileOptions& options) {
  if (const auto utf8 = csv::utf8_of_utf16(text)) return parse_contact_file(*utf8, name, options);
  Result<csv::PointTable> read = is_own_format(text)      ? read_own(text, name, options)
                                 : csv::is_grbl_log(text) ? csv::read_grbl_log(text, name, options)
                                                          : csv::read_points(text, name, options);
  if (!read) return Read::fail(read.error);
  csv::PointTable& points = *read.value;
  if (const std::string why = points.empty_cells.error(options); !why.empty()) {
    return Read::fail(why);
  }
  ContactFile file{std::move(points.table), std::move(points.notes), points.has_patches};
  for (std::string& note : points.empty_cells.notes()) file.notes.push_back(std::move(note));
  if (!points.points.empty()) {
    if (const std::string why = counts_instead(points, options); !why.empty()) {
      return Read::fail(std::string(name) + ": " + why);
    }
    const csv::PlanePoints plane = csv::in_plane(points.points, options.plane);
    if (!plane.error.empty()) return Read::fail(std::string(name) + ": " + plane.error);
    for (std::size_t i = 0; i < file.table.rows.size(); ++i) {
      file.table.rows[i].sample.position_m = plane.points[i];
    }
    file.notes.push_back(plane.note);
  } else if (options.plane != PointPlane::Varying) {
    return Read::fail(std::string(name) + ": has two coordinates: --plane chooses among three");
  }
  if (std::string note = note_of_unused_tip(file.table, options.tip_radius_m); !note.empty()) {
    file.notes.push_back(std::move(note));
  }
  if (options.touches.value_or(points.is_probe_log)) {
    if (!options.touches) {
      file.notes.emplace_back("every row is a touch of its own (else --strokes)");
    } else if (points.has_patches) {
      file.notes.emplace_back("the file's patches are not used: every row is a touch of its own");
    }
    part_into_touches(file.table);
  }
  if (const std::string why = disagreement_in_patches(file.table, points.lines); !why.empty()) {
    return Read::fail(std::string(name) + why);
  }
  return Read::ok(std::move(file));
}

Read read_contact_file(const std::string& path, const ContactFileOptions& options) {
  const bool is_standard_input = path == "-";
  const std::string name = is_standard_input ? "standard input" : path;
  const Result<std::string> text = is_standard_input
                                       ? read_bounded(STDIN_FILENO, name, kMostContactFileBytes)
                                       : read_bounded(path, kMostContactFileBytes);
  if (text) {
    if (const auto why = csv::no_text_because(*text.value)) return Read::fail(name + ": " + *why);
  }
  return text ? parse_contact_file(*text.value, name, options) : Read::fail(text.error);
}

}  // namespace palpate

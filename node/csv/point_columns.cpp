#include "node/csv/point_columns.h"

#include <algorithm>
#include <utility>

#include "node/csv/contact_file.h"
#include "node/files/counted.h"
#include "node/files/printable.h"

namespace palpate {

std::optional<double> length_unit_m(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, double>, 13> kUnits = {
      {{"m", 1.0},
       {"mm", 1e-3},
       {"cm", 1e-2},
       {"um", 1e-6},
       {"\xC2\xB5m", 1e-6},
       {"\xCE\xBCm", 1e-6},
       {"\xB5m", 1e-6},  // Latin-1
       {"micron", 1e-6},
       {"microns", 1e-6},
       {"nm", 1e-9},
       {"in", 0.0254},
       {"inch", 0.0254},
       {"inches", 0.0254}}};
  for (const auto& [unit, metres] : kUnits) {
    if (unit == name) return metres;
  }
  return std::nullopt;
}

namespace csv {
namespace {

struct Alias {
  std::string_view name;
  Column column;
};

constexpr std::array kAliases = {
    Alias{"x", Column::X},
    Alias{"pos_x", Column::X},
    Alias{"position_x", Column::X},
    Alias{"x_pos", Column::X},
    Alias{"x_position", Column::X},
    Alias{"x_coord", Column::X},
    Alias{"x_coordinate", Column::X},
    Alias{"point_x", Column::X},
    Alias{"contact_x", Column::X},
    Alias{"tip_x", Column::X},
    Alias{"x_value", Column::X},
    Alias{"x_actual", Column::X},
    Alias{"x_measured", Column::X},
    Alias{"x_wert", Column::X},
    Alias{"x_ist", Column::X},
    Alias{"x_koordinate", Column::X},
    Alias{"px", Column::X},
    Alias{"sigma", Column::Sigma},
    Alias{"std", Column::Sigma},
    Alias{"stddev", Column::Sigma},
    Alias{"noise", Column::Sigma},
    Alias{"tip_radius", Column::TipRadius},
    Alias{"ball_radius", Column::TipRadius},
    Alias{"stylus_radius", Column::TipRadius},
    Alias{"tip_diameter", Column::TipRadius},
    Alias{"ball_diameter", Column::TipRadius},
    Alias{"stylus_diameter", Column::TipRadius},
    Alias{"stamp", Column::Stamp},
    Alias{"timestamp", Column::Stamp},
    Alias{"time", Column::Stamp},
    Alias{"t", Column::Stamp},
    Alias{"probe", Column::Probe},
    Alias{"finger", Column::Probe},
    Alias{"sensor", Column::Probe},
    Alias{"patch", Column::Patch},
    Alias{"stroke", Column::Patch},
    Alias{"touch", Column::Patch},
    Alias{"scan", Column::Patch},
    Alias{"segment", Column::Patch},
    Alias{"object", Column::Object},
    Alias{"part", Column::Object},
    Alias{"group", Column::Group},
    Alias{"material_side", Column::MaterialSide},
    Alias{"side", Column::MaterialSide},
};

/// Names that have one form only; their x and y are none of a coordinate.
constexpr std::array kDetails = {
    Alias{"normal_x", Column::NormalX},         Alias{"normal_y", Column::NormalY},
    Alias{"normal_sigma", Column::NormalSigma}, Alias{"cov_xx", Column::CovarianceXx},
    Alias{"cov_xy", Column::CovarianceXy},      Alias{"cov_yy", Column::CovarianceYy},
};

std::optional<Column> alias(std::string name) {
  for (const Alias& detail : kDetails) {
    if (detail.name == name) return detail.column;
  }
  // y and z go by x's names.
  Column coordinate = Column::X;
  for (char& c : name) {
    const bool alone = (&c == name.data() || *(&c - 1) == '_' || *(&c - 1) == 'p') &&
                       (&c == name.data() + name.size() - 1 || *(&c + 1) == '_');
    if (alone && (c == 'y' || c == 'z')) {
      coordinate = c == 'y' ? Column::Y : Column::Z;
      c = 'x';
      break;
    }
  }
  for (const Alias& known : kAliases) {
    if (known.name == name) {
      return known.column == Column::X ? coordinate
             : coordinate == Column::X ? std::optional(known.column)
                                       : std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<double> time_unit_ns(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kUnits = {
      {{"ns", 1.0}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}}};
  for (const auto& [unit, nanoseconds] : kUnits) {
    if (unit == name) return nanoseconds;
  }
  return std::nullopt;
}

/// "mm2" or "mm^2". [m^2]
std::optional<double> area_unit_m2(std::string_view name) {
  if (!name.ends_with('2')) return std::nullopt;
  name.remove_suffix(name.ends_with("^2") ? 2 : 1);
  const auto length = length_unit_m(name);
  return length ? std::optional(*length * *length) : std::nullopt;
}

std::optional<double> angle_unit_rad(std::string_view name) {
  if (name == "rad") return 1.0;
  return name == "deg" ? std::optional(kPi / 180.0) : std::nullopt;
}

/// Lower case, words joined by single underscores, brackets and quotes gone.
std::string plain(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool parts = c == ' ' || c == '-' || c == '_' || c == '[' || c == ']' || c == '(' ||
                       c == ')' || c == '/' || c == '"' || c == '\'' || c == '.' || c == ':' ||
                       c == ',';
    if (!parts) {
      result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!result.empty() && result.back() != '_') {
      result += '_';
    }
  }
  while (!result.empty() && result.back() == '_') result.pop_back();
  return result;
}

bool is_mil(std::string_view unit) { return unit == "mil" || unit == "mils"; }

std::optional<double> unit_for(Column column, std::string_view name) {
  if (column == Column::Stamp) return time_unit_ns(name);
  if (column == Column::NormalSigma) return angle_unit_rad(name);
  if (is_area(column)) return area_unit_m2(name);
  return is_length(column) ? length_unit_m(name) : std::nullopt;
}

}  // namespace

bool is_length(Column column) {
  return column == Column::X || column == Column::Y || column == Column::Z ||
         column == Column::Sigma || column == Column::TipRadius;
}

bool is_area(Column column) {
  return column == Column::CovarianceXx || column == Column::CovarianceXy ||
         column == Column::CovarianceYy;
}

std::optional<NamedColumn> column_of(std::string_view name) {
  std::string words = plain(name);
  // A message's fields, as ROS prints them: field.pose.position.x.
  constexpr std::string_view kField = "field_";
  if (const std::size_t place = words.rfind("pose_position_");
      place != std::string::npos && words.starts_with(kField)) {
    words.erase(0, place + std::string_view("pose_").size());
  } else if (words.starts_with("field_point_")) {
    words.erase(0, kField.size());
  }
  if (const auto column = alias(words)) {
    // A time or an angle without unit may be anything.
    if (*column == Column::Stamp || *column == Column::NormalSigma) return std::nullopt;
    return NamedColumn{*column, std::nullopt};
  }
  const std::size_t last = words.rfind('_');
  if (last == std::string::npos) return std::nullopt;
  std::string before_unit = words.substr(0, last);
  if (before_unit.ends_with("_in")) before_unit.resize(before_unit.size() - 3);  // "x in mm"
  const auto column = alias(std::move(before_unit));
  const auto unit =
      column ? unit_for(*column, std::string_view(words).substr(last + 1)) : std::nullopt;
  if (column && is_length(*column) && is_mil(std::string_view(words).substr(last + 1))) {
    return NamedColumn{*column, std::nullopt, true};
  }
  return unit ? std::optional(NamedColumn{*column, unit}) : std::nullopt;
}

std::optional<double> unit_in_brackets(Column column, std::string_view text) {
  return unit_for(column, plain(text));
}

std::string known_columns() {
  return "x, y, z, sigma, tip_radius (each with or without a unit: x_mm), stamp_ns (or time_s), "
         "probe, patch, object, group, material_side, normal_x, normal_y, normal_sigma_rad, "
         "cov_xx_mm2, cov_xy_mm2, cov_yy_mm2";
}

bool PointColumns::is_enough() const {
  return (place(Column::X) ? 1 : 0) + (place(Column::Y) ? 1 : 0) + (place(Column::Z) ? 1 : 0) >= 2;
}

std::optional<PointColumns> columns_by_number(std::size_t count, std::string& note) {
  if (count != 2 && count != 3 && count != kLinuxCncAxes) {
    note = counted(count, "column") +
           " without a line of names: 2 are x and y, 3 are x, y and z, 9 are a LinuxCNC probe log; "
           "name the others in a first line (" +
           known_columns() + ")";
    return std::nullopt;
  }
  note = count == 2   ? "no line of names: the two columns are x and y"
         : count == 3 ? "no line of names: the three columns are x, y and z"
                      : "nine columns without names: a LinuxCNC probe log, x, y and z first; its "
                        "other axes are ignored";
  PointColumns columns;
  for (std::size_t axis = 0; axis < std::min<std::size_t>(count, 3); ++axis) {
    columns.places[static_cast<std::size_t>(kCoordinates[axis])] = axis;
  }
  return columns;
}

namespace {

/// Leaves out normals and covariances that say too little, and says why.
void keep_whole_details(PointColumns& columns) {
  using Kind = std::vector<Column>;
  const auto has = [&](Column column) { return columns.place(column).has_value(); };
  const bool in_plane = has(Column::X) && has(Column::Y) && !has(Column::Z);
  const auto keep = [&](const char* what, const Kind& all, const Kind& needed, const char* names) {
    if (std::none_of(all.begin(), all.end(), has)) return;
    const bool is_whole = std::all_of(needed.begin(), needed.end(), has);
    if (in_plane && is_whole) return;
    columns.unused_details.push_back(
        std::string(what) +
        (is_whole ? " are not used: they are read beside the two coordinates x and y alone"
                  : " are not used: they need the columns ") +
        (is_whole ? "" : names));
    for (const Column column : all) {
      columns.places[static_cast<std::size_t>(column)] = std::nullopt;
    }
  };
  const Kind normal = {Column::NormalX, Column::NormalY, Column::NormalSigma};
  keep("normals", normal, normal, "normal_x, normal_y and normal_sigma_rad (or _deg)");
  keep("covariances", {Column::CovarianceXx, Column::CovarianceXy, Column::CovarianceYy},
       {Column::CovarianceXx, Column::CovarianceYy},
       "cov_xx and cov_yy, each with its unit (cov_xx_mm2)");
}

}  // namespace

PointColumns columns_of(const std::vector<std::string_view>& names) {
  PointColumns columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto named = column_of(names[i]);
    if (!named) {
      if (names[i].empty()) {
        columns.unnamed.push_back(i);
      } else {
        columns.ignored.push_back(printable(names[i], 40));
      }
      continue;
    }
    auto& place = columns.places[static_cast<std::size_t>(named->column)];
    if (place && columns.twice.empty()) columns.twice = printable(names[i], 40);
    if (named->is_in_mil && columns.in_mil.empty()) columns.in_mil = printable(names[i], 40);
    place = i;
    columns.units[static_cast<std::size_t>(named->column)] = named->unit;
    if (named->column == Column::TipRadius) {
      columns.tips_by_diameter = plain(names[i]).find("diameter") != std::string::npos;
    }
  }
  keep_whole_details(columns);
  return columns;
}

}  // namespace csv
}  // namespace palpate

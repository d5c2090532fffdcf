#include "node/csv/point_units.h"

#include <algorithm>
#include <array>
#include <utility>

namespace palpate::csv {
namespace {

std::optional<double> named_unit(const PointColumns& columns, Column column) {
  return columns.units[static_cast<std::size_t>(column)];
}

/// Its plainest name.
std::string_view name_of_unit(double metres) {
  constexpr std::array<std::string_view, 6> kPlain = {"m", "mm", "cm", "um", "nm", "in"};
  const auto* const found = std::find_if(kPlain.begin(), kPlain.end(), [&](std::string_view name) {
    return length_unit_m(name) == metres;
  });
  return found == kPlain.end() ? "?" : *found;
}

constexpr std::array<std::pair<Column, const char*>, 5> kLengths = {
    {{Column::X, "x"},
     {Column::Y, "y"},
     {Column::Z, "z"},
     {Column::Sigma, "sigma"},
     {Column::TipRadius, "tip_radius"}}};

/// Whether --unit contradicts what a coordinate's name says: then no name of a length is believed.
bool overrules_names(const PointColumns& columns, double unit_m) {
  return std::any_of(kCoordinates.begin(), kCoordinates.end(), [&](Column column) {
    const auto named = named_unit(columns, column);
    return named && *named != unit_m;
  });
}

/// Lengths that keep the unit of their names beside another of --unit; or nothing.
std::string note_of_kept_units(const PointColumns& columns, double unit_m) {
  std::string note;
  for (const auto& [column, name] : kLengths) {
    const auto named = named_unit(columns, column);
    if (columns.place(column) && named && *named != unit_m) {
      note += (note.empty() ? "" : "; ") + std::string("column ") + name + " is taken in " +
              std::string(name_of_unit(*named)) + ", as its name says, not in the unit of --unit";
    }
  }
  return note;
}

/// Columns of lengths without a unit, beside a coordinate that names one; or nothing.
std::string note_of_lent_unit(const PointColumns& columns) {
  std::string without;
  std::size_t count = 0;
  std::string lender;
  for (const auto& [column, name] : kLengths) {
    if (!columns.place(column)) continue;
    const auto unit = named_unit(columns, column);
    if (!unit) {
      without += (count++ > 0 ? ", " : "") + std::string(name);
    } else if (lender.empty()) {
      // The coordinates come first, and one of them names a unit.
      lender = std::string(name_of_unit(*unit)) + ", as " + name + " is";
    }
  }
  if (count == 0) return "";
  return (count == 1 ? "column " + without + " names no unit"
                     : "columns " + without + " name no unit") +
         ": taken as " + lender + " (else --unit mm, um or in)";
}

}  // namespace

double unit_of(const PointColumns& columns, Column column, const ContactFileOptions& options,
               bool is_probe_log) {
  const auto named = named_unit(columns, column);
  if (!is_length(column) && !is_area(column)) return named.value_or(1.0);
  const auto of_kind = [&](double length_m) {
    return is_area(column) ? length_m * length_m : length_m;
  };
  const bool overruled = options.unit_m && overrules_names(columns, *options.unit_m);
  if (named && !overruled) return *named;
  if (options.unit_m) return of_kind(*options.unit_m);
  // One coordinate's unit stands for what names none.
  for (const Column other : kCoordinates) {
    if (const auto unit = named_unit(columns, other)) return of_kind(*unit);
  }
  constexpr double kMillimetre = 1e-3;
  return is_probe_log ? of_kind(kMillimetre) : 1.0;
}

std::optional<PointColumns> with_row_of_units(const PointColumns& columns,
                                              const std::vector<std::string_view>& fields) {
  PointColumns with_units = columns;
  for (std::size_t i = 0; i < kPointColumnCount; ++i) {
    const auto column = static_cast<Column>(i);
    const auto place = columns.place(column);
    if (!place || column == Column::Stamp) continue;
    const auto unit = unit_in_brackets(column, fields[*place]);
    if (unit && !columns.units[i]) with_units.units[i] = unit;
    const bool is_coordinate =
        std::find(kCoordinates.begin(), kCoordinates.end(), column) != kCoordinates.end();
    if (!unit && is_coordinate) return std::nullopt;
  }
  return with_units;
}

std::string clash_of_units(const PointColumns& columns) {
  if (!columns.in_mil.empty()) {
    return "column " + columns.in_mil +
           ": a mil is a thousandth of an inch, but to some a millimetre; convert to mm or in, or "
           "say --unit mm if it is one";
  }
  std::optional<double> first;
  for (const Column column : kCoordinates) {
    const auto unit = named_unit(columns, column);
    if (unit && first && *unit != *first) {
      return "the coordinates have different units; give them the same one, or say --unit, which "
             "then holds for every length";
    }
    if (unit) first = unit;
  }
  return "";
}

std::string note_of_unit(const PointColumns& columns, const ContactFileOptions& options,
                         bool is_probe_log) {
  if (options.unit_m) {
    return overrules_names(columns, *options.unit_m)
               ? "the unit is taken from --unit, not from the columns' names"
               : note_of_kept_units(columns, *options.unit_m);
  }
  const bool names_unit = std::any_of(kCoordinates.begin(), kCoordinates.end(), [&](Column axis) {
    return named_unit(columns, axis).has_value();
  });
  if (names_unit) return note_of_lent_unit(columns);
  return is_probe_log ? "the log names no unit: taken as millimetres (else --unit in)"
                      : "no unit is named: taken as metres (else --unit mm, um or in)";
}

}  // namespace palpate::csv

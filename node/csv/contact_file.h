// The offline door for files that were made for others: what people have, read as contacts.
//
// Beside the columns of node/csv/contact_csv.h: columns by common names and units (x_mm, "X [um]",
// pos_y), in any order; two or three columns without names; comma, semicolon, tab, bar or blanks
// between them; '#' and '%' comments; decimal commas where the separator is none or between quotes;
// exponents with D; what spreadsheets write (UTF-16, "sep=;", titles above the names, a row of
// units below them, empty rows); files joined end to end, with the line of names again; the probe
// logs of LinuxCNC and grbl. Nothing is guessed in silence: every assumption, and whatever is left
// out, is a note.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "node/csv/contact_table.h"
#include "node/files/result.h"

namespace palpate {

/// The plane of points that have three coordinates.
enum class PointPlane {
  Varying,  ///< the two axes along which the points vary; an error where they vary along all three
  Xy,
  Xz,
  Yz,
  Fitted,  ///< the plane of least squares
};

/// "auto", "xy", "xz", "yz" or "fit".
std::optional<PointPlane> point_plane_from_name(std::string_view name);

/// "m", "mm", "cm", "um", "nm", "in", "inch"; nullopt for others. [m]
std::optional<double> length_unit_m(std::string_view name);

struct ContactFileOptions {
  /// Unit of the lengths whose columns name none; of every length in the file if a coordinate names
  /// another. nullopt = as the columns say, metres where they do not. [m]
  std::optional<double> unit_m;
  PointPlane plane = PointPlane::Varying;
  /// Every row is a touch of its own, a patch of one sample; nullopt = only in a probe log.
  std::optional<bool> touches;
  /// Of rows that bring none. [m]
  double tip_radius_m = 0.0;
};

struct ContactFile {
  ContactTable table;
  std::vector<std::string> notes;  ///< what was assumed, left out or changed, a sentence each
  bool has_patches = false;        ///< the file says where one ends
};

/// Reads a file, or standard input for "-". Strict: used as a whole or not at all; an error reads
/// "FILE:LINE:COLUMN: what is wrong", COLUMN counting bytes from 1; of a row that contradicts its
/// patch "FILE:LINE: what is wrong", and of all points or the file itself "FILE: what is wrong". An
/// empty cell is an error or a note, see empty_cells.h.
Result<ContactFile> read_contact_file(const std::string& path, const ContactFileOptions& options);

/// The same from memory; `name` stands for the file in errors.
Result<ContactFile> parse_contact_file(std::string_view text, std::string_view name,
                                       const ContactFileOptions& options);

}  // namespace palpate

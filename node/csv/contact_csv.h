// The offline door: contact samples in CSV files.
//
// A header line names the columns, in any order: probe, patch, x_m, y_m, and optionally sigma_m,
// stamp_ns, object, group, tip_radius_m, material_side (left, right or unspecified), normal_x,
// normal_y, normal_sigma_rad, cov_xx_m2, cov_xy_m2, cov_yy_m2. '#' starts a comment; empty lines
// are skipped; lines end in LF or CRLF. An empty field of an optional column means "not given".
// Nothing is quoted: no field may hold a comma.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "node/csv/contact_table.h"
#include "node/files/result.h"

namespace palpate::csv {
class EmptyCells;
}

namespace palpate {

/// Seven million samples with all their digits; what is longer is no file of contacts. [bytes]
inline constexpr std::size_t kMostContactFileBytes = std::size_t{512} << 20;

/// Strict: a file is used as a whole or not at all, and an error reads "FILE:LINE:COLUMN: what is
/// wrong", with `name` for the file and COLUMN counting bytes from 1. Numbers must be finite, and
/// within the bounds that the recognizer node sets to messages (node/intake/ingest.h). Where
/// `empty_cells` is given, the cells are counted there.
Result<ContactTable> parse_contact_csv(std::string_view text, std::string_view name,
                                       csv::EmptyCells* empty_cells = nullptr);

/// Writes a table so that reading it gives the same values to the last bit: numbers in their
/// shortest exact form. Optional columns that no row uses are left out.
class ContactCsvWriter {
 public:
  /// Columns for `table`; the header line is put into `text` at once.
  ContactCsvWriter(const ContactTable& table, std::string& text);

  void write(const ContactRow& row);

 private:
  const ContactTable& table_;
  std::string& text_;
  bool with_sigma_ = false;
  bool with_stamp_ = false;
  bool with_object_ = false;
  bool with_group_ = false;
  bool with_tip_radius_ = false;
  bool with_side_ = false;
  bool with_normal_ = false;
  bool with_covariance_ = false;
};

/// The whole table.
std::string to_csv(const ContactTable& table);

}  // namespace palpate

#include "node/csv/point_notes.h"

#include <algorithm>
#include <utility>

#include "node/csv/point_units.h"
#include "node/csv/text_fields.h"
#include "node/files/counted.h"

namespace palpate::csv {
namespace {

/// What of a column of noise is not one.
void add_notes_of_noise(const std::vector<ContactRow>& rows, const PointColumns& columns,
                        std::vector<std::string>& notes) {
  const auto unknown = static_cast<std::size_t>(
      std::ranges::count_if(rows, [](const ContactRow& r) { return r.sample.sigma_m == 0.0; }));
  if (columns.place(Column::Sigma) && unknown == rows.size()) {
    notes.emplace_back(
        "sigma is 0 or empty in every row: without --sigma, the noise counts as not stated");
  } else if (columns.place(Column::Sigma) && unknown > 0) {
    notes.push_back(
        "sigma is 0 or empty in " + std::to_string(unknown) + " of " + counted(rows.size(), "row") +
        ": without --sigma, the noise of all of an object with such a row is estimated");
  }
  if (columns.place(Column::CovarianceXx) && !columns.place(Column::CovarianceXy)) {
    notes.emplace_back("no column cov_xy: it counts as 0");
  }
}

}  // namespace

std::vector<std::string> notes_of_points(const PointTable& table, const PointColumns& columns,
                                         const ContactFileOptions& options,
                                         const SeenInPoints& seen) {
  std::vector<std::string> notes;
  if (seen.preface_lines > 0) {
    notes.push_back("lines ignored before the names of the columns: " +
                    std::to_string(seen.preface_lines) + ", the first " + shown(seen.preface));
  }
  if (!columns.ignored.empty()) {
    std::string names;
    for (const std::string& name : columns.ignored) {
      names += (names.empty() ? "" : ", ") + name;
    }
    notes.push_back("columns ignored: " + names);
  }
  if (seen.unnamed_used) notes.emplace_back("columns without a name are ignored");
  notes.insert(notes.end(), columns.unused_details.begin(), columns.unused_details.end());
  add_notes_of_noise(table.table.rows, columns, notes);
  if (seen.has_comma) notes.emplace_back("commas are read as decimal points");
  if (seen.blocks > 1) {
    notes.push_back(
        std::string(seen.names_again > 0 ? "empty lines and lines of names" : "empty lines") +
        " part the rows into " + std::to_string(seen.blocks) + " patches");
  }
  if (std::string note = note_of_unit(columns, options, table.is_probe_log); !note.empty()) {
    notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace palpate::csv

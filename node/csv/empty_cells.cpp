#include "node/csv/empty_cells.h"

#include "node/files/counted.h"

namespace palpate::csv {
namespace {

/// What an empty cell of a column is.
struct Meaning {
  Column column;
  const char* name;
  const char* where_all_must_have_one;  ///< what to write instead; nullptr = it may be empty
  const char* where_some_are_empty;     ///< what these rows then say
};

constexpr std::array kMeanings = {
    Meaning{Column::Probe, "probe", "the name of the probe", nullptr},
    Meaning{Column::Patch, "patch", "the number of the stroke", nullptr},
    Meaning{Column::Object, "object", "the number of the part", nullptr},
    Meaning{Column::TipRadius, "tip_radius", "0 where the points are on the surface",
            "--tip-radius holds for them"},
    Meaning{Column::MaterialSide, "material_side", "unspecified where it is not known", nullptr},
    Meaning{Column::Group, "group", nullptr, "their group is that of their probe alone"},
    Meaning{Column::Stamp, "stamp", nullptr, "it is not known of them"},
    Meaning{Column::NormalX, "normal_x", nullptr, "no normal was measured there"},
    Meaning{Column::CovarianceXx, "cov_xx", nullptr, "they have no covariance"},
};

/// Whether the options say what these cells stand for, or nobody asks.
bool is_answered(Column column, const ContactFileOptions& options) {
  if (column == Column::TipRadius) return options.tip_radius_m > 0.0;
  // A touch is a patch of its own, and has no direction of travel.
  return options.touches.value_or(false) &&
         (column == Column::Patch || column == Column::MaterialSide);
}

}  // namespace

void EmptyCells::see(Column column, std::string_view cell, const TextLines& lines) {
  Cells& cells = cells_[static_cast<std::size_t>(column)];
  if (!cell.empty()) {
    ++cells.filled;
  } else if (cells.empty++ == 0) {
    cells.first_empty = lines.error(cell.data(), "");
  }
}

std::string EmptyCells::error(const ContactFileOptions& options) const {
  for (const Meaning& meaning : kMeanings) {
    const Cells& cells = of(meaning.column);
    const bool is_refused = meaning.where_all_must_have_one != nullptr && cells.filled > 0 &&
                            cells.empty > 0 && !is_answered(meaning.column, options);
    if (!is_refused) continue;
    return cells.first_empty + meaning.name + " is empty here and in " +
           std::to_string(cells.empty - 1) + " more of " +
           counted(cells.filled + cells.empty, "row") +
           ", and filled in the others: fill it in every row (" + meaning.where_all_must_have_one +
           ") or in none";
  }
  return {};
}

std::vector<std::string> EmptyCells::notes() const {
  std::vector<std::string> notes;
  for (const Meaning& meaning : kMeanings) {
    const Cells& cells = of(meaning.column);
    if (cells.empty == 0) continue;
    const std::string name = meaning.name;
    if (cells.filled == 0) {
      notes.push_back(name + " is empty in every row: read as if there were no such column");
    } else if (meaning.where_some_are_empty != nullptr) {
      notes.push_back(name + " is empty in " + std::to_string(cells.empty) + " of " +
                      counted(cells.filled + cells.empty, "row") + ": " +
                      meaning.where_some_are_empty);
    }
  }
  return notes;
}

}  // namespace palpate::csv

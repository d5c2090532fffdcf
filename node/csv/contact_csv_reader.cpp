#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/recognition/samples/side_words.h"
#include "node/csv/contact_csv.h"
#include "node/csv/csv_columns.h"
#include "node/csv/decimal_marks.h"
#include "node/csv/empty_cells.h"
#include "node/csv/row_detail.h"
#include "node/csv/text_lines.h"
#include "node/files/counted.h"
#include "node/wire/ingest_limits.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

using csv::Column;
using csv::kColumnCount;
using csv::kColumnNames;
using csv::kRequiredColumns;
using csv::shown;

// What the node would refuse is not used offline either.
constexpr double kMaxCoordinateM = IngestLimits{}.max_coordinate_m;
constexpr double kMinSigmaM = kMinSigma;
constexpr double kMaxSigmaM = IngestLimits{}.max_sigma_m;
constexpr double kMaxTipRadiusM = IngestLimits{}.max_tip_radius_m;
constexpr double kMostVarianceM2 = kMaxSigmaM * kMaxSigmaM;

class Reader {
 public:
  Reader(std::string_view text, std::string_view name, csv::EmptyCells* empty_cells)
      : lines_(text, name), empty_cells_(empty_cells) {}

  Result<ContactTable> read() {
    bool has_header = false;
    while (error_.empty() && next_line()) {
      if (trimmed(line_).empty()) continue;
      if (!has_header) {
        header_ = trimmed(line_);
        has_header = read_header();
      } else if (trimmed(line_) == header_) {
        fail(lines_.line().data(), csv::kNamesAgain);
      } else {
        read_row();
      }
    }
    if (error_.empty() && !has_header) {
      fail(lines_.line().data(), "no header line; it names the columns: probe,patch,x_m,y_m");
    }
    if (error_.empty() && table_.rows.empty()) {
      fail(lines_.line().data(), "no samples after the header line");
    }
    if (!error_.empty()) {
      return Result<ContactTable>::fail(std::move(error_));
    }
    return Result<ContactTable>::ok(std::move(table_));
  }

 private:
  /// Puts the next line into line_, without comment.
  bool next_line() {
    if (!lines_.next()) return false;
    line_ = lines_.line();
    if (const std::size_t comment = line_.find('#'); comment != std::string_view::npos) {
      line_ = line_.substr(0, comment);
    }
    return true;
  }

  /// Splits line_ at its commas; at most one field more than there are columns.
  std::size_t split() {
    std::size_t count = 0;
    for (std::size_t from = 0; count < fields_.size();) {
      const std::size_t comma = line_.find(',', from);
      fields_[count++] = trimmed(line_.substr(from, comma - from));
      if (comma == std::string_view::npos) break;
      from = comma + 1;
    }
    return count;
  }

  bool read_header() {
    columns_.fill(std::nullopt);
    width_ = split();
    for (std::size_t i = 0; i < width_; ++i) {
      const auto* const found = std::find(kColumnNames.begin(), kColumnNames.end(), fields_[i]);
      if (found == kColumnNames.end()) {
        return fail(fields_[i].data(), unknown_column(fields_[i]));
      }
      auto& column = columns_[static_cast<std::size_t>(found - kColumnNames.begin())];
      if (column) return fail(fields_[i].data(), "column " + std::string(*found) + " comes twice");
      column = i;
    }
    for (std::size_t i = 0; i < kRequiredColumns; ++i) {
      if (!columns_[i]) {
        return fail(lines_.line().data(), "column " + std::string(kColumnNames[i]) + " is missing");
      }
    }
    return true;
  }

  static std::string unknown_column(std::string_view name) {
    std::string why = "no such column: " + shown(name) + "; there are";
    for (const std::string_view column : kColumnNames) {
      (why += ' ') += column;
    }
    if (name.find(';') != std::string_view::npos || name.find('\t') != std::string_view::npos) {
      why += "; columns are separated by commas";
    }
    return why;
  }

  void read_row() {
    const std::size_t count = split();
    if (count != width_) {
      fail(count > width_ ? fields_[width_].data() : line_.data() + line_.size(),
           count > width_ ? "more than " + counted(width_, "field") +
                                std::string(csv::hint_of_commas(line_, ','))
                          : counted(count, "field") + " instead of " + std::to_string(width_));
      return;
    }
    for (std::size_t i = 0; empty_cells_ != nullptr && i < columns_.size(); ++i) {
      if (columns_[i]) empty_cells_->see(static_cast<Column>(i), fields_[*columns_[i]], lines_);
    }
    ContactRow row;
    const std::string_view probe = field(Column::Probe);
    if (probe.empty() || probe != last_probe_) {
      if (!is_valid_name(probe)) {
        fail(probe.data(), "probe " + shown(probe) + ": a name is 1 to 64 of A-Z a-z 0-9 _ . -");
        return;
      }
      last_probe_ = probe;
      last_probe_index_ = intern(probe);
    }
    row.probe = row.group = last_probe_index_;
    if (const std::string_view group = optional_field(Column::Group); !group.empty()) {
      if (!is_valid_name(group)) {
        fail(group.data(), "group " + shown(group) + ": a name is 1 to 64 of A-Z a-z 0-9 _ . -");
        return;
      }
      row.group = group == table_.names[row.probe] ? row.probe : intern(group);
    }
    const bool all_read =
        whole(Column::Patch, row.context.patch) &&
        number(Column::X, -kMaxCoordinateM, kMaxCoordinateM, row.sample.position_m.x()) &&
        number(Column::Y, -kMaxCoordinateM, kMaxCoordinateM, row.sample.position_m.y()) &&
        number(Column::Sigma, 0.0, kMaxSigmaM, row.sample.sigma_m) && is_noise(row.sample) &&
        whole(Column::Stamp, row.sample.stamp_ns) && whole(Column::Object, row.object) &&
        number(Column::TipRadius, 0.0, kMaxTipRadiusM, row.context.tip_radius_m) &&
        side(row.context.material_side) && detail(row);
    if (all_read && agrees_with_patch(row)) {
      table_.rows.push_back(row);
    }
  }

  std::size_t intern(std::string_view name) {
    const auto found = name_indices_.find(name);
    if (found != name_indices_.end()) return found->second;
    table_.names.emplace_back(name);
    return name_indices_.emplace(name, table_.names.size() - 1).first->second;
  }

  bool is_noise(const ContactSample& sample) {
    const std::string_view text = optional_field(Column::Sigma);
    return sample.sigma_m == 0.0 || sample.sigma_m >= kMinSigmaM ||
           fail(text.data(), in_column(Column::Sigma, text) + "must be 0 (not known) or >= 1e-15");
  }

  bool detail(ContactRow& row) {
    csv::DetailNumbers read;
    if (!number(Column::NormalX, -2.0, 2.0, read.normal.x()) ||
        !number(Column::NormalY, -2.0, 2.0, read.normal.y()) ||
        !number(Column::NormalSigma, 0.0, kPi, read.normal_sigma_rad) ||
        !number(Column::CovarianceXx, 0.0, kMostVarianceM2, read.covariance_m2.x()) ||
        !number(Column::CovarianceXy, -kMostVarianceM2, kMostVarianceM2, read.covariance_m2.y()) ||
        !number(Column::CovarianceYy, 0.0, kMostVarianceM2, read.covariance_m2.z())) {
      return false;
    }
    const csv::DetailFault fault = csv::take_detail(read, row);
    if (fault == csv::DetailFault::None) return true;
    const Column column = fault == csv::DetailFault::Covariance     ? Column::CovarianceXx
                          : fault == csv::DetailFault::NormalLength ? Column::NormalX
                                                                    : Column::NormalSigma;
    const std::string_view text = optional_field(column);
    return fail(text.empty() ? lines_.line().data() : text.data(),
                in_column(column, text) + std::string(csv::words_of(fault)));
  }

  std::string_view field(Column column) const {
    return fields_[*columns_[static_cast<std::size_t>(column)]];
  }

  /// Empty where the file has no such column.
  std::string_view optional_field(Column column) const {
    return columns_[static_cast<std::size_t>(column)] ? field(column) : std::string_view();
  }

  static bool is_required(Column column) {
    return static_cast<std::size_t>(column) < kRequiredColumns;
  }

  std::string in_column(Column column, std::string_view text) const {
    return std::string(kColumnNames[static_cast<std::size_t>(column)]) + " " + shown(text) + ": ";
  }

  /// A finite number within the bounds; untouched where the field is optional and empty.
  bool number(Column column, double lowest, double highest, double& value) {
    const std::string_view text = optional_field(column);
    if (text.empty() && !is_required(column)) return true;
    double parsed = 0.0;
    const char* begin = csv::without_plus(text).data();
    const auto [end, status] = std::from_chars(begin, text.data() + text.size(), parsed);
    if (end != text.data() + text.size() || status == std::errc::invalid_argument) {
      return fail(text.data(), in_column(column, text) + "not a number");
    }
    if (status == std::errc::result_out_of_range) {
      return fail(text.data(), in_column(column, text) + "beyond what a double can hold");
    }
    if (!std::isfinite(parsed)) {
      return fail(text.data(),
                  in_column(column, text) + "not a finite number; leave out rows without a touch");
    }
    if (parsed < lowest || parsed > highest) {
      char bounds[64];
      std::snprintf(bounds, sizeof bounds, "must lie in %g to %g", lowest, highest);
      return fail(text.data(), in_column(column, text) + bounds);
    }
    value = parsed;
    return true;
  }

  /// A whole number that its type can hold.
  template <typename Integer>
  bool whole(Column column, Integer& value) {
    const std::string_view text = optional_field(column);
    if (text.empty() && !is_required(column)) return true;
    if (const auto whole = csv::whole_of<Integer>(text)) {
      value = *whole;
      return true;
    }
    return fail(text.data(),
                in_column(column, text) + std::string(csv::why_no_whole<Integer>(text)));
  }

  bool side(MaterialSide& value) {
    const std::string_view text = optional_field(Column::MaterialSide);
    const auto read = text.empty() ? MaterialSide::Unspecified : material_side_from_name(text);
    if (!read) {
      return fail(text.data(),
                  in_column(Column::MaterialSide, text) + "must be left, right or unspecified");
    }
    value = *read;
    return true;
  }

  /// One patch is one touch of one tip.
  bool agrees_with_patch(const ContactRow& row) {
    const auto key = std::tuple(row.group, row.object, row.probe, row.context.patch);
    if (last_patch_ == nullptr || key != last_patch_key_) {
      last_patch_ = &patches_.try_emplace(key, row.context).first->second;
      last_patch_key_ = key;
    }
    if (row.context.tip_radius_m != last_patch_->tip_radius_m) {
      return fail(field(Column::Patch).data(), "tip_radius_m changes within a patch");
    }
    if (row.context.material_side != last_patch_->material_side) {
      return fail(field(Column::Patch).data(), "material_side changes within a patch");
    }
    return true;
  }

  bool fail(const char* at, std::string_view why) {
    if (error_.empty()) error_ = lines_.error(at, std::string(why));
    return false;
  }

  using PatchKey = std::tuple<std::size_t, std::uint64_t, std::size_t, std::uint32_t>;

  csv::TextLines lines_;
  csv::EmptyCells* empty_cells_;
  std::string_view line_;
  std::string_view header_;
  std::array<std::string_view, kColumnCount + 1> fields_;
  std::array<std::optional<std::size_t>, kColumnCount> columns_;  ///< place of each in a line
  std::size_t width_ = 0;
  std::string_view last_probe_;
  std::size_t last_probe_index_ = 0;
  std::map<PatchKey, PatchContext> patches_;
  PatchContext* last_patch_ = nullptr;
  PatchKey last_patch_key_;
  std::map<std::string, std::size_t, std::less<>> name_indices_;
  ContactTable table_;
  std::string error_;
};

}  // namespace

Result<ContactTable> parse_contact_csv(std::string_view text, std::string_view name,
                                       csv::EmptyCells* empty_cells) {
  return Reader(text, name, empty_cells).read();
}

}  // namespace palpate

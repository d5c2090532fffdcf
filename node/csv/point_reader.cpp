#include "node/csv/point_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/recognition/samples/side_words.h"
#include "node/csv/decimal_marks.h"
#include "node/csv/point_columns.h"
#include "node/csv/point_notes.h"
#include "node/csv/point_units.h"
#include "node/csv/row_detail.h"
#include "node/csv/text_fields.h"
#include "node/csv/text_lines.h"
#include "node/files/counted.h"
#include "node/wire/topics.h"

namespace palpate::csv {
namespace {

// The first number of nanoseconds that a stamp (int64, contact.proto) does not hold: 2^63, about
// 292 years.
constexpr double kBeyondStampNs = 0x1p63;

class PointReader {
 public:
  PointReader(std::string_view text, std::string_view name, const ContactFileOptions& options)
      : lines_(text, name), options_(options) {}

  Result<PointTable> read() {
    while (error_.empty() && lines_.next()) {
      std::string_view line = lines_.line();
      const std::size_t mark = comment_mark(line);
      const std::string_view comment =
          mark == std::string_view::npos ? std::string_view() : line.substr(mark + 1);
      line = line.substr(0, mark);
      if (trimmed(line).empty()) {
        if (!comment.empty() && !is_known_) {
          comment_ = comment;
          comment_place_ = lines_.place();
        }
        if (mark == std::string_view::npos) gap_ = true;
        if (is_known_ && is_names(comment)) begin_again();
        continue;
      }
      if (is_known_) {
        is_names(line) ? begin_again() : read_row(line);
        continue;
      }
      if (const char told = told_separator(line); told != '\0' && seen_.preface.empty()) {
        told_separator_ = told;
        continue;
      }
      const First first = know_columns(line);
      if (first == First::Neither) {
        // A title, a date: the names of the columns may follow.
        if (seen_.preface.empty()) {
          seen_.preface = trimmed(line);
          without_names_ =
              lines_.error(line.data(), "no columns of two coordinates: " + shown(seen_.preface) +
                                            "; known are " + known_columns());
        }
        ++seen_.preface_lines;
        continue;
      }
      gap_ = false;
      is_known_ = true;
      units_may_follow_ = first == First::Names;
      if (first == First::Names) names_ = trimmed(line);
      if (first == First::Numbers) read_row(line);
    }
    if (error_.empty() && !is_known_) error_ = without_names_;
    if (error_.empty() && result_.table.rows.empty()) {
      fail(lines_.line().data(),
           is_known_ ? "no samples after the header line" : "no samples: the file is empty");
    }
    if (!error_.empty()) return Result<PointTable>::fail(error_);
    result_.has_patches = result_.empty_cells.is_used(Column::Patch) || seen_.blocks > 1;
    seen_.has_comma = marks_.comma();
    for (std::string& note : notes_of_points(result_, columns_, options_, seen_)) {
      result_.notes.push_back(std::move(note));
    }
    return Result<PointTable>::ok(std::move(result_));
  }

 private:
  bool fail(const char* at, const std::string& why) {
    if (error_.empty()) error_ = lines_.error(at, why);
    return false;
  }

  void split(std::string_view line) { split_fields(line, separator_, fields_); }

  enum class First { Names, Numbers, Neither };

  /// Of a line before the data: the columns' names, the first of the data, or neither.
  First know_columns(std::string_view line) {
    separator_ = told_separator_ != '\0' ? told_separator_ : separator_of(line);
    split(line);
    const bool is_data = std::all_of(fields_.begin(), fields_.end(), [&](std::string_view field) {
      return field.empty() || number_of(field, true);
    });
    if (!is_data) {
      columns_ = columns_of(fields_);
      if (!columns_.is_enough()) return First::Neither;
      width_ = fields_.size();
      if (!columns_.twice.empty()) fail(line.data(), "column " + columns_.twice + " comes twice");
      agree_on_unit(lines_.place(), line);
      return First::Names;
    }
    width_ = fields_.size();
    if (!seen_.preface.empty()) {
      error_ = without_names_;
    } else if (!know_by_comment()) {
      know_by_width(line);
    }
    return First::Numbers;
  }

  void agree_on_unit(const TextLines::Place& place, std::string_view names) {
    const std::string clash = options_.unit_m ? "" : clash_of_units(columns_);
    if (!clash.empty() && error_.empty()) error_ = lines_.error(place, names.data(), clash);
  }

  bool is_names(std::string_view line) const { return !names_.empty() && trimmed(line) == names_; }

  /// The line of names again, as when files are joined: another stroke begins.
  void begin_again() {
    if (result_.empty_cells.is_used(Column::Patch))
      fail(lines_.line().data(), std::string(kNamesAgain));
    gap_ = units_may_follow_ = true;
    ++seen_.names_again;
  }

  /// numpy.savetxt writes its header as a comment.
  bool know_by_comment() {
    const char data_separator = separator_;
    for (const char tried : {data_separator, ',', ' '}) {
      separator_ = tried;
      split(comment_);
      const PointColumns named = columns_of(fields_);
      if (fields_.size() == width_ && named.is_enough() && named.twice.empty()) {
        columns_ = named;
        names_ = trimmed(comment_);
        result_.notes.push_back("the last comment before the data names the columns: " +
                                shown(trimmed(comment_)));
        separator_ = data_separator;
        agree_on_unit(comment_place_, comment_);
        return true;
      }
    }
    separator_ = data_separator;
    return false;
  }

  void know_by_width(std::string_view line) {
    std::string note;
    const auto columns = columns_by_number(width_, note);
    if (!columns) {
      fail(line.data(), note + std::string(hint_of_commas(line, separator_)));
      return;
    }
    columns_ = *columns;
    result_.has_three_without_names = width_ == 3;
    result_.is_probe_log = width_ == kLinuxCncAxes;
    result_.notes.push_back(note);
  }

  std::string_view field(Column column) const {
    const auto place = columns_.place(column);
    return place ? fields_[*place] : std::string_view();
  }

  double unit_of(Column column) const {
    return csv::unit_of(columns_, column, options_, result_.is_probe_log);
  }

  bool length(Column column, const char* what, double lowest, double highest, double& value) {
    const std::string_view text = field(column);
    // Between quotes a comma is no separator.
    const auto parsed = number_of(text, true);
    if (!parsed || !std::isfinite(*parsed)) {
      return fail(text.data(),
                  std::string(what) + " " + shown(text) +
                      (parsed         ? ": not a finite number"
                       : text.empty() ? ": nothing is there"
                                      : ": not a number") +
                      (parsed || text.empty() ? "; leave out rows without a touch" : ""));
    }
    if (const std::string clash = marks_.take(text); !clash.empty()) {
      return fail(text.data(), std::string(what) + " " + shown(text) + ": " + clash);
    }
    value = *parsed * unit_of(column);
    if (value < lowest || value > highest) {
      char bounds[80];
      std::snprintf(bounds, sizeof bounds, ": must lie in %g to %g m", lowest, highest);
      return fail(text.data(), std::string(what) + " " + shown(text) + bounds);
    }
    return true;
  }

  template <typename Integer>
  bool whole(Column column, const char* what, Integer& value) {
    const std::string_view text = field(column);
    if (text.empty()) return true;
    const auto parsed = whole_of<Integer>(text);
    value = parsed.value_or(value);
    return parsed.has_value() || fail(text.data(), std::string(what) + " " + shown(text) + ": " +
                                                       std::string(why_no_whole<Integer>(text)));
  }

  bool name(Column column, const char* what, std::size_t& index) {
    const std::string_view text = field(column);
    if (text.empty()) return true;
    if (!is_valid_name(text)) {
      return fail(text.data(), std::string(what) + " " + shown(text) +
                                   ": a name is 1 to 64 of A-Z a-z 0-9 _ . -");
    }
    index = intern(text);
    return true;
  }

  std::size_t intern(std::string_view name) {
    const auto [found, is_new] =
        indices_.try_emplace(std::string(name), result_.table.names.size());
    if (is_new) result_.table.names.emplace_back(name);
    return found->second;
  }

  bool stamp(ContactRow& row) {
    const std::string_view text = field(Column::Stamp);
    if (text.empty()) return true;
    const double unit = columns_.units[static_cast<std::size_t>(Column::Stamp)].value_or(1.0);
    if (unit == 1.0) return whole(Column::Stamp, "stamp_ns", row.sample.stamp_ns);
    const auto parsed = number_of(text, true);
    const bool is_finite = parsed && std::isfinite(*parsed);
    if (!is_finite || !(std::abs(*parsed * unit) < kBeyondStampNs)) {
      return fail(text.data(), "time " + shown(text) +
                                   (!parsed      ? ": not a number"
                                    : !is_finite ? ": not a finite number"
                                                 : ": out of range: a stamp lies within 292 years "
                                                   "of 1970"));
    }
    row.sample.stamp_ns = std::llround(*parsed * unit);
    // At the start itself a sample has a time: not the 0 that says that none is known.
    if (row.sample.stamp_ns == 0) row.sample.stamp_ns = 1;
    return true;
  }

  bool side(ContactRow& row) {
    const std::string_view text = field(Column::MaterialSide);
    const auto read = text.empty() ? MaterialSide::Unspecified : material_side_from_name(text);
    if (!read) {
      return fail(text.data(),
                  "material_side " + shown(text) + ": must be left, right or unspecified");
    }
    row.context.material_side = *read;
    return true;
  }

  bool detail(ContactRow& row) {
    DetailNumbers read;
    const std::array<std::pair<Column, double*>, 6> numbers = {
        {{Column::NormalX, &read.normal.x()},
         {Column::NormalY, &read.normal.y()},
         {Column::NormalSigma, &read.normal_sigma_rad},
         {Column::CovarianceXx, &read.covariance_m2.x()},
         {Column::CovarianceXy, &read.covariance_m2.y()},
         {Column::CovarianceYy, &read.covariance_m2.z()}}};
    for (const auto& [column, value] : numbers) {
      const std::string_view text = field(column);
      if (text.empty()) continue;
      const auto parsed = number_of(text, true);
      const std::string clash = parsed ? marks_.take(text) : "not a number";
      if (!clash.empty()) return fail(text.data(), shown(text) + ": " + clash);
      if (!std::isfinite(*parsed)) return fail(text.data(), shown(text) + ": not a finite number");
      *value = *parsed * unit_of(column);
    }
    const DetailFault fault = take_detail(read, row);
    const std::string_view at = field(fault == DetailFault::Covariance     ? Column::CovarianceXx
                                      : fault == DetailFault::NormalLength ? Column::NormalX
                                                                           : Column::NormalSigma);
    return fault == DetailFault::None || fail(at.data(), std::string(words_of(fault)));
  }

  void read_row(std::string_view line) {
    if (!error_.empty()) return;
    split(line);
    // Spreadsheets end lines in a separator.
    if (fields_.size() == width_ + 1 && fields_.back().empty()) fields_.pop_back();
    if (fields_.size() != width_) {
      const bool is_more = fields_.size() > width_;
      fail(is_more ? fields_[width_].data() : line.data() + line.size(),
           counted(fields_.size(), "field") + " instead of " + std::to_string(width_) +
               std::string(is_more ? hint_of_commas(line, separator_) : ""));
      return;
    }
    // Spreadsheets write empty rows as separators alone.
    if (std::all_of(fields_.begin(), fields_.end(), [](auto field) { return field.empty(); })) {
      gap_ = true;
      return;
    }
    if (std::exchange(units_may_follow_, false)) {
      if (const auto with_units = with_row_of_units(columns_, fields_)) {
        columns_ = *with_units;
        agree_on_unit(lines_.place(), line);
        return;
      }
    }
    seen_.unnamed_used =
        seen_.unnamed_used || std::ranges::any_of(columns_.unnamed, [&](std::size_t place) {
          return !fields_[place].empty();
        });
    for (std::size_t i = 0; i < columns_.places.size(); ++i) {
      const auto column = static_cast<Column>(i);
      if (columns_.place(column)) result_.empty_cells.see(column, field(column), lines_);
    }
    ContactRow row;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    int axes = 0;
    constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < kNames.size(); ++axis) {
      const Column column = kCoordinates[axis];
      if (!columns_.place(column)) continue;
      if (!length(column, kNames[axis], -kMaxCoordinateM, kMaxCoordinateM,
                  point[static_cast<Eigen::Index>(axis)])) {
        return;
      }
      if (axes < 2) row.sample.position_m[axes] = point[static_cast<Eigen::Index>(axis)];
      ++axes;
    }
    if (!field(Column::Sigma).empty() &&
        (!length(Column::Sigma, "sigma", 0.0, IngestLimits{}.max_sigma_m, row.sample.sigma_m) ||
         (row.sample.sigma_m > 0.0 && row.sample.sigma_m < kMinSigma &&
          !fail(field(Column::Sigma).data(), "sigma " + shown(field(Column::Sigma)) +
                                                 ": must be 0 (not known) or >= 1e-15 m")))) {
      return;
    }
    row.context.tip_radius_m = options_.tip_radius_m;
    if (!field(Column::TipRadius).empty()) {
      const bool by_diameter = columns_.tips_by_diameter;
      if (!length(Column::TipRadius, by_diameter ? "tip_diameter" : "tip_radius", 0.0,
                  IngestLimits{}.max_tip_radius_m, row.context.tip_radius_m)) {
        return;
      }
      row.context.tip_radius_m *= by_diameter ? 0.5 : 1.0;
    }
    const bool has_patches = result_.empty_cells.is_used(Column::Patch);
    // As gnuplot has it, an empty line begins another stroke.
    if (gap_ && !has_patches && !result_.table.rows.empty()) ++seen_.blocks;
    gap_ = false;
    row.context.patch = has_patches ? 0 : seen_.blocks - 1;
    if (field(Column::Probe).empty()) row.probe = intern("probe");
    if (!name(Column::Probe, "probe", row.probe)) return;
    row.group = row.probe;
    if (!name(Column::Group, "group", row.group) ||
        !whole(Column::Patch, "patch", row.context.patch) ||
        !whole(Column::Object, "object", row.object) || !stamp(row) || !side(row) || !detail(row)) {
      return;
    }
    result_.table.rows.push_back(row);
    result_.lines.push_back(lines_.number());
    if (axes == 3) result_.points.push_back(point);
  }

  TextLines lines_;
  ContactFileOptions options_;
  PointTable result_;
  std::string error_;
  std::string_view comment_;  ///< the last one before the data
  TextLines::Place comment_place_;
  std::string without_names_;      ///< the error where no names follow the preface
  std::string_view names_;         ///< the line or comment that names the columns
  char told_separator_ = '\0';     ///< by the file itself
  bool units_may_follow_ = false;  ///< the names were the line before
  bool is_known_ = false;          ///< the columns
  bool gap_ = false;               ///< an empty line came before
  char separator_ = ',';           ///< ' ' = any blanks
  DecimalMarks marks_;
  std::size_t width_ = 0;
  PointColumns columns_;
  std::vector<std::string_view> fields_;
  SeenInPoints seen_;
  std::map<std::string, std::size_t> indices_;
};

}  // namespace

Result<PointTable> read_points(std::string_view text, std::string_view name,
                               const ContactFileOptions& options) {
  return PointReader(text, name, options).read();
}

}  // namespace palpate::csv

#include <algorithm>
#include <array>
#include <charconv>

#include "core/recognition/samples/side_words.h"
#include "node/csv/contact_csv.h"
#include "node/csv/csv_columns.h"

namespace palpate {
namespace {

template <typename Number>
void append(std::string& text, Number value) {
  std::array<char, 32> digits;
  const auto [end, status] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

}  // namespace

ContactCsvWriter::ContactCsvWriter(const ContactTable& table, std::string& text)
    : table_(table), text_(text) {
  for (const ContactRow& row : table.rows) {
    with_sigma_ |= row.sample.sigma_m != 0.0;
    with_stamp_ |= row.sample.stamp_ns != 0;
    with_object_ |= row.object != 0;
    with_group_ |= row.group != row.probe;
    with_tip_radius_ |= row.context.tip_radius_m != 0.0;
    with_side_ |= row.context.material_side != MaterialSide::Unspecified;
    with_normal_ |= row.detail.normal_sigma_rad > 0.0;
    with_covariance_ |= row.detail.covariance_m2.x() > 0.0;
  }
  const std::array<bool, csv::kColumnCount> used = {true,
                                                    true,
                                                    true,
                                                    true,
                                                    with_sigma_,
                                                    with_stamp_,
                                                    with_object_,
                                                    with_group_,
                                                    with_tip_radius_,
                                                    with_side_,
                                                    with_normal_,
                                                    with_normal_,
                                                    with_normal_,
                                                    with_covariance_,
                                                    with_covariance_,
                                                    with_covariance_};
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    if (i > 0) text_ += ',';
    text_ += csv::kColumnNames[i];
  }
  text_ += '\n';
}

void ContactCsvWriter::write(const ContactRow& row) {
  text_ += table_.names[row.probe];
  const auto field = [this](auto value) {
    text_ += ',';
    append(text_, value);
  };
  field(row.context.patch);
  field(row.sample.position_m.x());
  field(row.sample.position_m.y());
  if (with_sigma_) field(row.sample.sigma_m);
  if (with_stamp_) field(row.sample.stamp_ns);
  if (with_object_) field(row.object);
  if (with_group_) (text_ += ',') += table_.names[row.group];
  if (with_tip_radius_) field(row.context.tip_radius_m);
  if (with_side_) (text_ += ',') += name_of(row.context.material_side);
  if (with_normal_) {
    field(row.detail.normal.x());
    field(row.detail.normal.y());
    field(row.detail.normal_sigma_rad);
  }
  if (with_covariance_) {
    for (const double entry : row.detail.covariance_m2) field(entry);
  }
  text_ += '\n';
}

std::string to_csv(const ContactTable& table) {
  std::string text;
  ContactCsvWriter writer(table, text);
  for (const ContactRow& row : table.rows) {
    writer.write(row);
  }
  return text;
}

}  // namespace palpate

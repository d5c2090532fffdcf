// When the samples of a file are due.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "core/recognition/samples/contact_run.h"
#include "node/csv/contact_table.h"

namespace palpate {

/// The times of a table's samples, of which some may have none.
class SampleTimes {
 public:
  SampleTimes(const ContactTable& table, double rate_hz) : period_ns_(1e9 / rate_hz) {
    for (const ContactRow& row : table.rows) {
      const std::int64_t stamp_ns = row.sample.stamp_ns;
      if (stamp_ns > 0 && (first_ns_ == 0 || stamp_ns < first_ns_)) first_ns_ = stamp_ns;
      is_stamped_ |= stamp_ns > kStartNs;
    }
  }

  /// Groups come one after the other, whatever their times: those of one say nothing of the next.
  void begin_group() { due_ns_ = first_ns_; }

  /// Until its first sample with a stamp, the samples of a run are due with that one. A run without
  /// any is due with the one before it in the group.
  void begin_run(const ContactRun& run) {
    const auto stamped =
        std::find_if(run.samples.begin(), run.samples.end(),
                     [](const ContactSample& sample) { return sample.stamp_ns != 0; });
    if (stamped != run.samples.end()) due_ns_ = stamped->stamp_ns;
  }

  /// The stamp of a run's next sample; 0 = not known. In a file without stamps the samples of a
  /// probe follow one another at the rate.
  std::int64_t stamp_ns(const std::string& probe, const ContactSample& sample) {
    if (!is_stamped_) {
      return due_ns_ = std::llround(period_ns_ * static_cast<double>(++taken_[probe]));
    }
    if (sample.stamp_ns != 0) due_ns_ = sample.stamp_ns;
    return sample.stamp_ns;
  }

  /// When the latest sample is due; one without a stamp, with the one before.
  std::int64_t due_ns() const { return due_ns_; }

 private:
  // A time of 0, as it is read. A file with no other has no times.
  static constexpr std::int64_t kStartNs = 1;

  double period_ns_;
  bool is_stamped_ = false;
  std::int64_t first_ns_ = 0;  ///< the least of the stamps
  std::int64_t due_ns_ = 0;
  std::map<std::string, std::int64_t> taken_;
};

}  // namespace palpate

// The last minutes of every group, to look back at: one home for all browsers, whenever they came.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/curves/pose2.h"
#include "node/tool/contact_groups.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// The samples of one object while none of them was left out. Those of the present are in its
/// group; they come here when the group lets go of them.
struct SampleEra {
  std::optional<ContactGroup> past;
};

/// How a group looked when an answer came.
struct Moment {
  std::string group;
  std::int64_t time_ms = 0;  ///< Unix time
  std::string answer;        ///< a v1::Recognition
  Vec2 origin_m = Vec2::Zero();
  std::uint64_t samples_received = 0;
  std::shared_ptr<SampleEra> era;
  std::vector<std::uint32_t> counts;  ///< samples of each run
};

class LiveHistory {
 public:
  /// Moments of a group are this far apart, but for the last of an object.
  static constexpr std::int64_t kLeastInterval_ms = 200;
  static constexpr std::int64_t kLongest_ms = 3 * 60 * 1000;
  /// Of all moments and the samples that only they hold. A moment of usual size is 4 kB: three
  /// minutes of ten groups.
  static constexpr std::size_t kMostBytes = std::size_t{48} << 20;

  /// Keeps it; the oldest go.
  void add(Moment moment);
  /// Takes the samples that the era's moments still need; its group has let go of it.
  void seal(std::shared_ptr<SampleEra> era, const ContactGroup& samples);

  /// Times of a group's moments, the oldest first. [ms]
  std::vector<std::int64_t> times(std::string_view group) const;
  /// The group's moment nearest to a time; null where there is none.
  const Moment* nearest(std::string_view group, std::int64_t time_ms) const;

  std::size_t bytes() const { return bytes_; }

 private:
  void drop_oldest();

  std::deque<Moment> moments_;  // in the order of their coming
  std::size_t bytes_ = 0;
};

}  // namespace palpate

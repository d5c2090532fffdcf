// The last minutes of every group, for browsers to look back at. All browsers share it.
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

/// The samples of one object for as long as none of them was dropped. Those of the present object
/// are in its group; they are moved to `past` when the group gives them up.
struct SampleEra {
  std::optional<ContactGroup> past;
};

/// The state of a group when an answer came.
struct Moment {
  std::string group;
  std::int64_t time_ms = 0;  ///< Unix time
  std::string answer;        ///< a serialised v1::Recognition
  Vec2 origin_m = Vec2::Zero();
  std::uint64_t samples_received = 0;
  std::shared_ptr<SampleEra> era;
  std::vector<std::uint32_t> counts;  ///< number of samples of each run
};

class LiveHistory {
 public:
  /// Shortest time between two moments of a group, except for the last one of an object.
  static constexpr std::int64_t kLeastInterval_ms = 200;
  static constexpr std::int64_t kLongest_ms = 3 * 60 * 1000;
  /// Maximum memory of all moments and of the samples that only they hold. A moment usually has 4
  /// kB, so this is three minutes of ten groups.
  static constexpr std::size_t kMostBytes = std::size_t{48} << 20;

  /// Adds a moment; deletes the oldest ones beyond the bound.
  void add(Moment moment);
  /// Takes the samples that the era's moments still need, when the group gives them up.
  void seal(std::shared_ptr<SampleEra> era, const ContactGroup& samples);

  /// Times of a group's moments, oldest first. [ms]
  std::vector<std::int64_t> times(std::string_view group) const;
  /// The group's moment nearest to a time; nullptr if there is none.
  const Moment* nearest(std::string_view group, std::int64_t time_ms) const;

  std::size_t bytes() const { return bytes_; }

 private:
  void drop_oldest();

  std::deque<Moment> moments_;  // in order of arrival
  std::size_t bytes_ = 0;
};

}  // namespace palpate

// The present state that `palpate view` shows: groups with their contacts and answers, probes,
// recognizers. Does no I/O, and is bounded whatever arrives.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "node/intake/rate_meter.h"
#include "node/process/clock.h"
#include "node/tool/contact_groups.h"
#include "node/tool/view/live_history.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/node_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// Samples kept of one group's object, 32 bytes each (80 with normals or covariances). If there are
/// more, every second one is dropped, and the page says how many are shown.
inline constexpr std::size_t kMostSamplesKept = 20000;
/// Groups kept; as many as a recognizer has by default. The one silent for longest is replaced.
inline constexpr std::size_t kMostGroupsKept = 64;
/// Maximum of probes shown of one recognizer, and of recognizers shown.
inline constexpr int kMostProbesShown = 256;
inline constexpr std::size_t kMostNodesKept = 8;

struct LiveGroup {
  /// Contacts of the present object, a run for each stroke.
  ContactGroup touched;
  std::uint64_t samples_received = 0;
  std::size_t samples_kept = 0;
  /// Drawn coordinates are relative to this point, so that they are short numbers.
  Vec2 origin_m = Vec2::Zero();
  /// Changes when samples are dropped or replaced, not when samples are added.
  std::uint64_t generation = 0;

  v1::Recognition answer;
  bool has_answer = false;
  std::int64_t answer_received_ns = 0;  ///< Unix time
  RateMeter answer_rate;
  /// Changes with every answer and object, so with everything that the group's picture shows.
  std::uint64_t version = 0;
  SteadyTime last_heard;
  SteadyTime last_touched;  ///< an answer may come long after its touch

  /// The era of the present samples, which moments of the history refer to.
  std::shared_ptr<SampleEra> era = std::make_shared<SampleEra>();
  std::int64_t last_moment_ns = 0;  // Unix time

  // The object before, to detect an answer that was on its way when the object changed.
  std::uint64_t previous_object = 0;
  bool has_previous_object = false;
  bool has_object = false;
  /// The stroke of each probe that its next samples continue if nothing tells of another.
  struct OpenRun {
    std::size_t run = 0;
    std::uint64_t epoch = 0;
  };
  std::map<std::string, OpenRun, std::less<>> open_runs;
};

struct LiveNode {
  v1::NodeStatus status;
  SteadyTime last_heard;
};

class LiveState {
 public:
  void take(const v1::ContactBatch& batch, SteadyTime now);
  /// `received_ns`: wall clock, for the latency shown.
  void take(const v1::Recognition& answer, SteadyTime now, std::int64_t received_ns);
  void take(const v1::NodeStatus& status, SteadyTime now);

  const std::map<std::string, LiveGroup, std::less<>>& groups() const { return groups_; }
  const std::map<std::string, LiveNode, std::less<>>& nodes() const { return nodes_; }
  const LiveHistory& history() const { return history_; }
  /// Times of a group's moments, including the present one. [Unix time, ms]
  std::vector<std::int64_t> moments_of(std::string_view name);
  /// A group as it was at a moment of the history, as far as its data are still kept.
  LiveGroup group_at(const Moment& moment) const;

  /// nullptr if there is no group of that name.
  LiveGroup* find(std::string_view name);
  /// The group to show to a viewer that follows the touch: `shown` as long as it is touched, else
  /// the one touched last; empty if there is none.
  std::string followed_group(std::string_view shown, SteadyTime now) const;
  /// Changes when the probes or recognizers in the overview change in a way to be shown at once.
  std::uint64_t status_version() const { return status_version_; }

 private:
  LiveGroup& group(std::string_view name, SteadyTime now);
  void begin_object(LiveGroup& group, std::uint64_t object);
  void keep_moment(LiveGroup& group);
  void seal_era(LiveGroup& group);
  void place_origin(LiveGroup& group, const Vec2& first);
  static ContactRun& run_of(LiveGroup& group, const v1::ContactBatch& batch);

  std::map<std::string, LiveGroup, std::less<>> groups_;
  std::map<std::string, LiveNode, std::less<>> nodes_;
  LiveHistory history_;
  // Shared by all groups, so that a group that comes back does not look like its former self.
  std::uint64_t next_version_ = 0;
  std::uint64_t status_version_ = 0;
};

}  // namespace palpate

// Decides what each browser is sent next.
#pragma once

#include <map>
#include <string>

#include "node/tool/view/live_state.h"
#include "node/tool/view/picture_json.h"

namespace palpate {

/// The state of one browser's feed. It is sent the newest state; states in between are skipped.
struct Viewer {
  std::string wanted;  ///< group chosen; empty = follow the one being touched
  std::string shown;   ///< group that was sent last
  std::uint64_t sent_version = 0;
  std::uint64_t sent_details_version = 0;
  SentSamples sent_samples;
  std::uint64_t sent_overview = 0;  ///< number of the last overview sent
};

/// A picture is made when a viewer is due for it, once for all viewers. Words and numbers are made
/// only a few times a second.
class LiveFeed {
 public:
  explicit LiveFeed(LiveState& state) : state_(state) {}

  /// The viewer's next message; empty if it has everything.
  std::string next_message(Viewer& viewer, SteadyTime now);

 private:
  // The JSON of a group.
  struct Drawn {
    std::uint64_t version = 0;
    std::string picture;
    std::uint64_t details_version = 0;
    SteadyTime details_drawn;
    std::string details;
  };

  struct Overview {
    std::uint64_t number = 0;
    std::uint64_t status_version = 0;
    SteadyTime drawn;
    std::string text;
  };

  std::string group_for(const Viewer& viewer, SteadyTime now);
  const Drawn& drawn_now(LiveGroup& group, SteadyTime now);
  const Overview& overview_now(SteadyTime now);
  void add_group(LiveGroup& group, Viewer& viewer, SteadyTime now, JsonText& message);

  LiveState& state_;
  std::map<std::string, Drawn, std::less<>> drawn_;
  Overview overview_;
};

}  // namespace palpate

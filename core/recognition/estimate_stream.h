// The sliding windows of all probes: every estimate once, in order, taken back to the surface.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "core/local/stream/sliding_window.h"
#include "core/recognition/localized_contact.h"
#include "core/recognition/samples/contact_sample.h"

namespace palpate {

/// One window a probe, over its newest patch: another patch begins another window. Estimates wait
/// until they are taken, those of a round tip until it is known on which side of it the material
/// lies; of those that wait too long the oldest go.
class EstimateStream {
 public:
  explicit EstimateStream(const SlidingOptions& options) : options_(options) {}

  /// Samples that are not finite, have a negative noise or repeat the place of the one before are
  /// left out, as SampleMemory refuses them.
  void add(const PatchContext& context, std::span<const ContactSample> samples);

  /// +1: the tip's centre lies left of travel, -1: right, 0: not known.
  using SideOf = std::function<int(std::uint32_t probe, std::uint32_t patch)>;

  /// What has come since the last call, in order for each probe; t is 0. `side_of` is asked where
  /// the probe does not say.
  std::vector<LocalizedContact> take(const SideOf& side_of);

  void clear() { probes_.clear(); }

  /// Estimates of a probe that may wait: a second of a fast probe's (1 kHz, one every 4 samples).
  static constexpr std::size_t kMostWaiting = 256;

 private:
  struct Waiting {
    PatchContext context;
    LocalEstimate estimate;
  };
  struct Probe {
    PatchContext context;
    SlidingWindow window;
    Vec2 newest_m = Vec2::Zero();
    std::deque<Waiting> waiting = {};
  };

  SlidingOptions options_;
  std::vector<Probe> probes_;
};

}  // namespace palpate

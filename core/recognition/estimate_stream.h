// The sliding windows of all probes: each estimate is given once, in order, at a surface point.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "core/local/stream/sliding_window.h"
#include "core/recognition/localized_contact.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

/// Each probe has one window, on its newest stroke; a new one (is_of_one_stroke) begins a new
/// window. Estimates wait until they are taken, those of a round tip until the material's side is
/// known. If too many wait, the oldest are dropped.
class EstimateStream {
 public:
  explicit EstimateStream(const SlidingOptions& options) : options_(options) {}

  /// Leaves out samples that cannot be used (sample_faults.h), and those that repeat the place of
  /// the one before, which say nothing new of the path.
  void add(const PatchContext& context, std::span<const ContactSample> samples,
           std::span<const SampleDetail> details);

  /// Side of travel on which the tip's centre lies: +1 left, -1 right, 0 not known.
  using SideOf = std::function<int(std::uint32_t probe, std::uint32_t patch)>;

  /// Estimates since the last call, in order for each probe; t is 0. Calls `side_of` where the
  /// probe does not state the side.
  std::vector<LocalizedContact> take(const SideOf& side_of);

  void clear() { probes_.clear(); }

  /// Most waiting estimates of a probe: a second of a fast probe (1 kHz, one estimate per 4
  /// samples).
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

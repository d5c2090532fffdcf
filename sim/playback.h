// Publishes the messages of a scene in time.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "node/client/contact_publisher.h"
#include "sim/contact_export.h"

namespace palpate::sim {

struct PlaybackCounts {
  std::uint64_t messages = 0;
  std::uint64_t samples = 0;
  std::uint64_t refused = 0;  ///< messages that had no room: the recognizer is behind or gone
  bool stopped = false;       ///< by a signal
};

/// Publishes the batches in order, each when its last sample is due, `speed` times as fast as the
/// scene; 0 = as fast as there is room for them, and ends early where there is none for
/// `longest_wait_s`. Stamps the samples with the Unix time at which they are due. Ends
/// early when `stop_fd` is readable. Calls say() with the publisher's news of the recognizer.
/// Modifies the batches.
PlaybackCounts play(std::span<TimedBatch> batches, std::span<const SimulatedProbe> probes,
                    double speed, double longest_wait_s, int stop_fd,
                    client::ContactPublisher& publisher,
                    const std::function<void(const std::string&)>& say);

}  // namespace palpate::sim

#include "sim/playback.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "node/process/clock.h"

namespace palpate::sim {
namespace {

/// Waits for room, `longest_wait_s` at most or until a stop is asked for.
bool publish(const std::string& probe, v1::ContactBatch& batch, double longest_wait_s, int stop_fd,
             client::ContactPublisher& publisher) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  return publisher.publish_when_room(probe, batch, [&] {
    return std::chrono::duration<double>(Clock::now() - start).count() >= longest_wait_s ||
           wait_or_stop(0.0, stop_fd);
  });
}

}  // namespace

bool wait_or_stop(double seconds, int stop_fd) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(seconds));
  pollfd stop{stop_fd, POLLIN, 0};
  for (;;) {
    const auto left = std::max(deadline - Clock::now(), Clock::duration::zero());
    const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(left).count();
    const timespec timeout{nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000};
    if (ppoll(&stop, 1, &timeout, nullptr) > 0) return true;
    if (Clock::now() >= deadline) return false;
  }
}

PlaybackCounts play(std::span<TimedBatch> batches, std::span<const SimulatedProbe> probes,
                    double speed, double longest_wait_s, int stop_fd,
                    client::ContactPublisher& publisher) {
  PlaybackCounts counts;
  const bool paced = speed > 0.0;
  const double scale = paced ? 1.0 / speed : 0.0;
  const std::int64_t start_ns = unix_time_ns();
  const auto due_ns = [&](double time_s) { return start_ns + std::llround(time_s * scale * 1e9); };
  for (TimedBatch& timed : batches) {
    const double wait_s =
        paced ? 1e-9 * static_cast<double>(due_ns(timed.time_s) - unix_time_ns()) : 0.0;
    // Called even without a wait, to notice a stop.
    if (wait_or_stop(std::max(wait_s, 0.0), stop_fd)) {
      counts.stopped = true;
      break;
    }
    const std::int64_t now_ns = unix_time_ns();
    for (v1::ContactSample& sample : *timed.batch.mutable_samples()) {
      sample.set_stamp_ns(paced ? due_ns(1e-9 * static_cast<double>(sample.stamp_ns())) : now_ns);
    }
    // At the scene's pace it does as probes do, which wait for nobody.
    const double give_up_s = paced ? 0.0 : longest_wait_s;
    const bool taken =
        publish(probes[timed.probe].name, timed.batch, give_up_s, stop_fd, publisher);
    // What a stop keeps from waiting for room is like all that comes after it: not played.
    if (!taken && !paced && wait_or_stop(0.0, stop_fd)) {
      counts.stopped = true;
      break;
    }
    counts.refused += taken ? 0 : 1;
    ++counts.messages;
    counts.samples += static_cast<std::uint64_t>(timed.batch.samples_size());
    if (!taken && !paced) break;
  }
  return counts;
}

}  // namespace palpate::sim

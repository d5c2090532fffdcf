#include "sim/playback.h"

#include <chrono>
#include <cmath>

#include "node/process/clock.h"
#include "node/process/stop_signals.h"

namespace palpate::sim {
PlaybackCounts play(std::span<TimedBatch> batches, std::span<const SimulatedProbe> probes,
                    double speed, double longest_wait_s, int stop_fd,
                    client::ContactPublisher& publisher,
                    const std::function<void(const std::string&)>& say) {
  PlaybackCounts counts;
  const bool paced = speed > 0.0;
  const double scale = paced ? 1.0 / speed : 0.0;
  const std::int64_t start_ns = unix_time_ns();
  const auto due_ns = [&](double time_s) { return start_ns + std::llround(time_s * scale * 1e9); };
  for (TimedBatch& timed : batches) {
    const std::chrono::nanoseconds wait(paced ? due_ns(timed.time_s) - unix_time_ns() : 0);
    counts.stopped = stop_requested_before(now_steady() + wait, stop_fd);
    if (counts.stopped) break;
    const std::int64_t now_ns = unix_time_ns();
    for (v1::ContactSample& sample : *timed.batch.mutable_samples()) {
      sample.set_stamp_ns(paced ? due_ns(1e-9 * static_cast<double>(sample.stamp_ns())) : now_ns);
    }
    const std::string& probe = probes[timed.probe].name;
    // At the scene's pace it does as probes do, which wait for nobody.
    const bool taken = paced
                           ? publisher.publish(probe, timed.batch)
                           : publisher.publish_when_room(
                                 probe, timed.batch, std::chrono::duration<double>(longest_wait_s),
                                 [&] { return counts.stopped = stop_requested(stop_fd); });
    if (const std::string news = publisher.news_of_recognizer(); !news.empty()) say(news);
    // What a stop keeps from waiting for room is like all that comes after it: not played.
    if (counts.stopped) break;
    counts.refused += taken ? 0 : 1;
    ++counts.messages;
    counts.samples += static_cast<std::uint64_t>(timed.batch.samples_size());
    if (!taken && !paced) break;
  }
  return counts;
}

}  // namespace palpate::sim

// The work of `palpate view` for its browsers: 16 groups with 30 updates a second, and eight
// browsers each showing another group, on a simulated clock. Count instructions, which do not
// depend on the load of the machine:
//   valgrind --tool=callgrind --toggle-collect=palpate_feed_call
//   build/strict/tests/bench/view/bench_feed
// Prints what the browsers were sent.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/tool/view/live_feed.h"
#include "node/wire/convert.h"

/// The function whose instructions are counted. The barrier prevents a tail call.
extern "C" [[gnu::noinline]] void palpate_feed_call(const std::function<void()>& call) {
  call();
  asm volatile("" : : : "memory");
}

namespace palpate {
namespace {

constexpr int kGroups = 16;
constexpr int kViewers = 8;
constexpr int kRate_hz = 30;
constexpr int kSeconds = 5;
constexpr int kSamplesABatch = 10;
constexpr int kBatchesBefore = 20;
constexpr double kRadius_m = 0.02, kStep_rad = 0.01, kSigma_m = 2e-5;

/// A point of a circle around (0.3, 0.1), with repeatable noise.
Vec2 touched(int number) {
  const double radius = kRadius_m + kSigma_m * std::numbers::sqrt2 * std::sin(12.9898 * number);
  return Vec2(0.3 + radius * std::cos(kStep_rad * number),
              0.1 + radius * std::sin(kStep_rad * number));
}

v1::ContactBatch batch_of(const std::string& probe, int first) {
  v1::ContactBatch batch;
  batch.mutable_header()->set_source(probe);
  batch.set_object(1);
  for (int i = first; i < first + kSamplesABatch; ++i) {
    const Vec2 point = touched(i);
    v1::ContactSample& sample = *batch.add_samples();
    sample.set_x_m(point.x());
    sample.set_y_m(point.y());
    sample.set_sigma_m(kSigma_m);
  }
  return batch;
}

/// The recognizer's answer to the first samples, also used for the later ones.
v1::Recognition answer_to_first() {
  Recognizer recognizer;
  std::vector<ContactSample> samples;
  for (int i = 0; i < kBatchesBefore * kSamplesABatch; ++i) {
    samples.push_back({touched(i), kSigma_m, 0});
  }
  (void)recognizer.add({}, samples);
  v1::Recognition answer;
  to_wire(
      recognizer.recognize(), [](std::uint32_t, std::uint32_t) { return ContactSource(); }, answer);
  answer.set_object(1);
  return answer;
}

int run() {
  using namespace std::chrono_literals;
  LiveState state;
  LiveFeed feed(state);
  std::vector<Viewer> viewers(kViewers);
  v1::Recognition answer = answer_to_first();
  SteadyTime now = SteadyTime(1h);
  std::int64_t now_ns = 1'000'000'000;
  std::size_t messages = 0, bytes = 0;
  const auto update = [&](int round) {
    for (int group = 0; group < kGroups; ++group) {
      const std::string name = "finger-" + std::to_string(group);
      const v1::ContactBatch batch = batch_of(name, kSamplesABatch * round);
      answer.set_group(name);
      palpate_feed_call([&] {
        state.take(batch, now);
        state.take(answer, now, now_ns);
      });
    }
  };
  for (int round = 0; round < kBatchesBefore; ++round) update(round);
  for (int i = 0; i < kViewers; ++i) viewers[i].wanted = "finger-" + std::to_string(i);
  for (int round = 0; round < kSeconds * kRate_hz; ++round) {
    update(kBatchesBefore + round);
    for (Viewer& viewer : viewers) {
      palpate_feed_call([&] {
        const std::string message = feed.next_message(viewer, now);
        messages += message.empty() ? 0 : 1;
        bytes += message.size();
      });
    }
    constexpr std::int64_t kPeriod_ns = 1'000'000'000 / kRate_hz;
    now += std::chrono::nanoseconds(kPeriod_ns);
    now_ns += kPeriod_ns;
  }
  std::printf("%zu messages, %zu bytes\n", messages, bytes);
  return messages == std::size_t{kViewers} * kSeconds * kRate_hz ? 0 : 1;
}

}  // namespace
}  // namespace palpate

int main() { return palpate::run(); }

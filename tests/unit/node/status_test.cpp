#include "node/publish/status.h"

#include <gtest/gtest.h>

#include <chrono>

#include "contact_messages.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::contact_topic;
using testing::line_batch;

TEST(RateMeter, ASteadyStreamIsMeasuredRight) {
  RateMeter meter;
  SteadyTime now{seconds(50)};
  for (int i = 0; i < 3000; ++i) {
    meter.add(now, 5);
    now += milliseconds(2);
  }
  // 500 events a second of 5; the window holds 1.0 to 1.1 s, and one event more or less.
  EXPECT_NEAR(meter.per_second(now), 2500.0, 2500.0 / 500.0 * 1.1);
  now += milliseconds(1200);
  EXPECT_EQ(meter.per_second(now), 0.0);
}

TEST(RateMeter, ATimeBeforeTheLatestEventIsNoRateOfZero) {
  RateMeter meter;
  const SteadyTime now{seconds(50)};
  for (int i = 0; i < 10; ++i) meter.add(now + milliseconds(100 * i + 10), 100);
  // The latest event is in the next tenth of a second.
  EXPECT_NEAR(meter.per_second(now + milliseconds(895)), 1000.0, 1e-9);
}

TEST(ComputeTimes, QuantilesOfALongPeriod) {
  ComputeTimes times;
  EXPECT_EQ(times.quantile(0.5), 0);
  for (int i = 1; i <= 101; ++i) times.add(i);
  EXPECT_EQ(times.quantile(0.0), 1);
  EXPECT_EQ(times.quantile(0.5), 51);
  EXPECT_EQ(times.quantile(0.99), 100);
  EXPECT_EQ(times.quantile(1.0), 101);
  for (int i = 0; i < 100000; ++i) times.add(7);
  EXPECT_EQ(times.quantile(0.99), 7);
  times.clear();
  EXPECT_EQ(times.quantile(0.5), 0);
}

TEST(Status, SaysWhatHappened) {
  Intake intake{IntakeOptions()};
  ComputeTimes times;
  times.add(1000);
  SteadyTime now{seconds(100)};
  for (const std::uint64_t seq : {0, 1, 5}) {
    v1::ContactBatch batch = line_batch("p", 9, seq);
    batch.mutable_header()->set_stamp_ns(23);
    batch.set_object(seq < 5 ? 1 : 2);
    intake.take(2, contact_topic("p"), batch.SerializeAsString(), now, 100);
  }
  intake.take(1, "x", "", now, 0);
  v1::ContactBatch bad = line_batch("p", 9, 6);
  bad.set_tip_radius_m(-1.0);
  intake.take(2, contact_topic("p"), bad.SerializeAsString(), now, 0);
  now += milliseconds(400);
  EXPECT_EQ(update_liveness(intake.probes(), milliseconds(500), now), 0);

  v1::NodeStatus status;
  fill_status(intake, times, {12.5, "1.2.3", 3, 2}, now, status);
  EXPECT_EQ(status.uptime_s(), 12.5);
  EXPECT_EQ(status.version(), "1.2.3");
  EXPECT_EQ(status.messages_received(), 5U);
  EXPECT_EQ(status.messages_accepted(), 3U);
  EXPECT_EQ(status.samples_received(), 30U);
  EXPECT_EQ(status.malformed(), 1U);
  ASSERT_EQ(status.rejected_size(), 2);
  EXPECT_EQ(status.rejected(0).reason(), v1::REJECT_REASON_FRAMES);
  EXPECT_EQ(status.rejected(1).reason(), v1::REJECT_REASON_TIP_RADIUS);
  EXPECT_EQ(status.missing(), 3U);
  EXPECT_EQ(status.gaps(), 1U);
  EXPECT_EQ(status.objects_superseded(), 1U);
  EXPECT_EQ(status.recognitions_published(), 3U);
  EXPECT_EQ(status.clients_denied(), 2U);
  EXPECT_EQ(status.compute_p50_ns(), 1000);
  EXPECT_EQ(status.groups(), 1U);
  EXPECT_GT(status.memory_bytes(), 1000000U);  // no program that links this is smaller
  ASSERT_EQ(status.probes_size(), 1);
  const v1::ProbeStatus& probe = status.probes(0);
  EXPECT_EQ(probe.probe(), "p");
  EXPECT_TRUE(probe.alive());
  EXPECT_NEAR(probe.age_s(), 0.4, 1e-9);
  EXPECT_EQ(probe.messages(), 3U);
  EXPECT_EQ(probe.rejected(), 1U);
  EXPECT_EQ(probe.epoch(), 9U);
  EXPECT_EQ(probe.seq(), 5U);
  EXPECT_EQ(probe.latency_ns(), 77);

  now += milliseconds(200);
  EXPECT_EQ(update_liveness(intake.probes(), milliseconds(500), now), 1);
  fill_status(intake, times, {}, now, status);
  EXPECT_FALSE(status.probes(0).alive());
  EXPECT_EQ(update_liveness(intake.probes(), milliseconds(500), now), 0);
}

}  // namespace
}  // namespace palpate

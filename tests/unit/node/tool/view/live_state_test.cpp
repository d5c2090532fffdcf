#include "node/tool/view/live_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "node/tool/view/details_json.h"
#include "node/tool/view/live_feed.h"
#include "node/tool/view/picture_json.h"

namespace palpate {
namespace {

using namespace std::chrono_literals;

const SteadyTime kStart = SteadyTime(std::chrono::hours(1));

v1::ContactBatch batch_of(int samples, std::uint64_t object = 1, std::uint32_t patch = 0,
                          const std::string& probe = "finger") {
  v1::ContactBatch batch;
  batch.mutable_header()->set_source(probe);
  batch.set_group("part");
  batch.set_object(object);
  batch.set_patch(patch);
  for (int i = 0; i < samples; ++i) {
    v1::ContactSample& sample = *batch.add_samples();
    sample.set_x_m(0.3 + 1e-4 * i);
    sample.set_y_m(0.1);
  }
  return batch;
}

v1::Recognition answer_of(std::uint64_t object, const std::string& group = "part") {
  v1::Recognition answer;
  answer.set_group(group);
  answer.set_object(object);
  answer.set_status(v1::RECOGNITION_STATUS_COLLECTING);
  answer.set_sample_count(7);
  return answer;
}

TEST(LiveState, KeepsOneRunAProbeAndPatchHoweverTheirBatchesAlternate) {
  LiveState state;
  for (int i = 0; i < 5; ++i) {
    state.take(batch_of(10, 1, 0, "left"), kStart);
    state.take(batch_of(10, 1, 0, "right"), kStart);
  }
  state.take(batch_of(3, 1, 1, "left"), kStart);
  const LiveGroup& group = *state.find("part");
  ASSERT_EQ(group.touched.runs.size(), 3U);
  EXPECT_EQ(group.touched.runs[0].samples.size(), 50U);
  EXPECT_EQ(group.touched.runs[2].samples.size(), 3U);
  EXPECT_EQ(group.samples_kept, 103U);
}

TEST(LiveState, ANewObjectClearsAndItsForerunnersLateAnswerIsNotShown) {
  LiveState state;
  state.take(batch_of(10, 1), kStart);
  state.take(answer_of(1), kStart, 0);
  EXPECT_TRUE(state.find("part")->has_answer);
  state.take(batch_of(2, 2), kStart);
  EXPECT_FALSE(state.find("part")->has_answer);
  EXPECT_EQ(state.find("part")->samples_kept, 2U);
  state.take(answer_of(1), kStart, 0);
  EXPECT_FALSE(state.find("part")->has_answer);
  EXPECT_EQ(state.find("part")->samples_kept, 2U);
  // Contacts may be lost on the way: an answer alone tells of the next object too.
  state.take(answer_of(3), kStart, 0);
  EXPECT_TRUE(state.find("part")->has_answer);
  EXPECT_EQ(state.find("part")->samples_kept, 0U);
}

TEST(LiveState, IsBoundedAndSaysWhatItDrops) {
  LiveState state;
  for (int i = 0; i < 100; ++i) state.take(batch_of(1000), kStart);
  const LiveGroup& group = *state.find("part");
  EXPECT_LE(group.samples_kept, kMostSamplesKept);
  EXPECT_GT(group.samples_kept, kMostSamplesKept / 4);
  EXPECT_EQ(group.samples_received, 100000U);
  // One-sample patches too.
  for (std::uint32_t i = 0; i < 50000; ++i) state.take(batch_of(1, 2, i), kStart);
  EXPECT_LE(group.samples_kept, kMostSamplesKept);
  EXPECT_EQ(group.touched.runs.size(), group.samples_kept);
  EXPECT_EQ(group.touched.runs.back().context.patch, 49999U);
  for (int i = 0; i < 1000; ++i) {
    state.take(answer_of(1, "group-" + std::to_string(i)), kStart + std::chrono::seconds(1 + i), 0);
    v1::NodeStatus status;
    status.mutable_header()->set_source("node-" + std::to_string(i));
    for (int k = 0; k < 1000; ++k) status.add_probes();
    state.take(status, kStart + std::chrono::seconds(1 + i));
  }
  EXPECT_EQ(state.groups().size(), kMostGroupsKept);
  EXPECT_EQ(state.nodes().size(), kMostNodesKept);
  EXPECT_EQ(state.nodes().begin()->second.status.probes_size(), kMostProbesShown);
  EXPECT_EQ(state.followed_group("", kStart + 1h), "group-999");
}

TEST(LiveState, TakesNothingThatIsNoContact) {
  LiveState state;
  v1::ContactBatch batch = batch_of(3);
  batch.mutable_samples(1)->set_x_m(std::numeric_limits<double>::quiet_NaN());
  state.take(batch, kStart);
  batch = batch_of(3);
  batch.set_group("<b>");
  state.take(batch, kStart);
  batch = batch_of(3, 1, 0, "a b");
  state.take(batch, kStart);
  state.take(batch_of(0), kStart);
  state.take(answer_of(1, "a/b"), kStart, 0);
  EXPECT_TRUE(state.groups().empty());
}

constexpr std::int64_t kNsPerMs = 1'000'000;

TEST(LiveHistory, ShowsAGroupAsItWasThroughNewSamplesAndObjects) {
  LiveState state;
  SteadyTime now = kStart;
  for (int i = 1; i <= 3; ++i) {
    state.take(batch_of(10, 1), now);
    v1::Recognition answer = answer_of(1);
    answer.set_sample_count(static_cast<std::uint64_t>(10 * i));
    // A second apart; then one that comes soon after: the last look of an object is kept too.
    state.take(answer, now, (i < 3 ? 1000 * i : 2050) * kNsPerMs);
  }
  EXPECT_EQ(state.history().times("part"), (std::vector<std::int64_t>{1000, 2000}));
  state.take(batch_of(4, 2), now);
  EXPECT_EQ(state.history().times("part"), (std::vector<std::int64_t>{1000, 2000, 2050}));
  EXPECT_TRUE(state.history().times("another").empty());
  EXPECT_EQ(state.history().nearest("another", 0), nullptr);
  for (const auto& [time_ms, samples] :
       {std::pair<std::int64_t, std::size_t>{-5, 10}, {1400, 10}, {2000, 20}, {9999, 30}}) {
    const LiveGroup then = state.group_at(*state.history().nearest("part", time_ms));
    EXPECT_EQ(then.touched.object, 1U);
    EXPECT_EQ(then.samples_kept, samples) << time_ms;
    EXPECT_EQ(then.answer.sample_count(), samples);
    ASSERT_EQ(then.touched.runs.size(), 1U);
    EXPECT_EQ(then.touched.runs[0].samples.size(), samples);
  }
}

TEST(LiveHistory, KeepsThePresentWhenItIsAskedFor) {
  LiveState state;
  state.take(batch_of(10), kStart);
  state.take(answer_of(1), kStart, 1000 * kNsPerMs);
  state.take(answer_of(1), kStart, 1050 * kNsPerMs);
  EXPECT_EQ(state.moments_of("part"), (std::vector<std::int64_t>{1000, 1050}));
  EXPECT_EQ(state.moments_of("part"), (std::vector<std::int64_t>{1000, 1050}));
  EXPECT_TRUE(state.moments_of("nobody").empty());
}

TEST(LiveHistory, IsBoundedInTimeAndBytes) {
  LiveState state;
  std::int64_t time_ns = 0;
  v1::Recognition answer = answer_of(1);
  for (int i = 0; i < 2000; ++i) {
    time_ns += 200 * kNsPerMs;
    state.take(answer, kStart, time_ns);
  }
  EXPECT_LE(state.history().times("part").size(), 901U);
  EXPECT_GE(state.history().times("part").front(), 220'000);
  // Answers and samples of any size: every object's samples are kept until there is no room.
  answer.mutable_header()->set_frame(std::string(100'000, 'x'));
  for (int i = 0; i < 2000; ++i) {
    time_ns += 200 * kNsPerMs;
    const auto object = static_cast<std::uint64_t>(2 + i);
    answer.set_object(object);
    state.take(batch_of(5000, object), kStart);
    state.take(answer, kStart, time_ns);
    ASSERT_LE(state.history().bytes(), LiveHistory::kMostBytes);
  }
  EXPECT_GT(state.history().times("part").size(), 100U);
  // When they have all gone, so has what they held.
  state.take(answer_of(1, "other"), kStart, time_ns + 10 * LiveHistory::kLongest_ms * kNsPerMs);
  EXPECT_LT(state.history().bytes(), 1000U);
}

TEST(LiveHistory, SamplesLeftOutLaterAreInTheMomentsBefore) {
  LiveState state;
  state.take(batch_of(static_cast<int>(kMostSamplesKept)), kStart);
  state.take(answer_of(1), kStart, 1000 * kNsPerMs);
  state.take(batch_of(10), kStart);
  EXPECT_LT(state.find("part")->samples_kept, kMostSamplesKept);
  EXPECT_EQ(state.group_at(*state.history().nearest("part", 1000)).samples_kept, kMostSamplesKept);
}

TEST(LiveFeed, TellsEachViewerWhatItDoesNotKnowAndNothingTwice) {
  LiveState state;
  LiveFeed feed(state);
  Viewer viewer;
  SteadyTime now = kStart;
  state.take(batch_of(10), now);
  state.take(answer_of(1), now, 0);
  auto message = nlohmann::json::parse(feed.next_message(viewer, now));
  EXPECT_EQ(message["group"], "part");
  EXPECT_EQ(message["picture"]["sampleCount"], 7);
  EXPECT_EQ(message["samples"]["runs"][0]["points"].size(), 20U);
  EXPECT_TRUE(message["samples"]["anew"]);
  EXPECT_EQ(feed.next_message(viewer, now + 1ms), "");
  // Only the new samples; the picture has not changed.
  state.take(batch_of(4), now);
  message = nlohmann::json::parse(feed.next_message(viewer, now + 2ms));
  EXPECT_FALSE(message.contains("picture"));
  EXPECT_EQ(message["samples"]["runs"][0]["points"].size(), 8U);
  // A viewer that comes late gets everything.
  Viewer late;
  message = nlohmann::json::parse(feed.next_message(late, now + 3ms));
  EXPECT_EQ(message["samples"]["runs"][0]["points"].size(), 28U);
}

/// The group that a viewer sees then.
std::string shown_at(SteadyTime now, LiveFeed& feed, Viewer& viewer) {
  (void)feed.next_message(viewer, now);
  return viewer.shown;
}

TEST(LiveFeed, FollowsTheGroupThatIsTouchedUnlessOneIsChosen) {
  LiveState state;
  LiveFeed feed(state);
  Viewer viewer;
  const auto shown = [&](SteadyTime now) { return shown_at(now, feed, viewer); };
  state.take(answer_of(1, "one"), kStart, 0);
  EXPECT_EQ(shown(kStart), "one");
  // Two groups touched at once do not make the picture flicker.
  state.take(answer_of(1, "two"), kStart + 100ms, 0);
  EXPECT_EQ(shown(kStart + 100ms), "one");
  EXPECT_EQ(shown(kStart + 300ms), "two");
  viewer.wanted = "one";
  EXPECT_EQ(shown(kStart + 2s), "one");
  viewer.wanted = "not-there";
  EXPECT_EQ(shown(kStart + 3s), "not-there");
}

TEST(LiveFeed, FollowsTouchesNotTheAnswersToThem) {
  LiveState state;
  LiveFeed feed(state);
  Viewer viewer;
  const auto shown = [&](SteadyTime now) { return shown_at(now, feed, viewer); };
  // Single touches, two a second, on one group after the other.
  const char* names[] = {"one", "two", "three"};
  for (int i = 0; i < 9; ++i) {
    const SteadyTime now = kStart + i * 500ms;
    v1::ContactBatch touch = batch_of(1, 1, static_cast<std::uint32_t>(i));
    touch.set_group(names[i % 3]);
    state.take(touch, now);
    EXPECT_EQ(shown(now + 1ms), names[i % 3]) << i;
    // What a busy recognizer says of the touch before comes after this one.
    v1::Recognition late = answer_of(1, names[(i + 2) % 3]);
    late.set_sample_count(static_cast<std::uint64_t>(i + 2) / 3);
    if (i > 0) state.take(late, now + 400ms, 0);
    EXPECT_EQ(shown(now + 499ms), names[i % 3]) << i;
  }
}

TEST(PictureJson, NumbersThatAreNoneAndTextOfAnyBytesGiveValidJson) {
  LiveState state;
  v1::Recognition answer = answer_of(1);
  answer.set_curve_class(v1::CURVE_CLASS_CIRCLE);
  answer.mutable_parameters()->set_a(0.02);
  answer.mutable_pose()->set_x_m(0.3);
  for (int i = 0; i < 16; ++i) answer.add_covariance(std::numeric_limits<double>::infinity());
  v1::Decision& decision = *answer.add_decisions();
  decision.set_test("<b>\"\\\n</script>");
  decision.set_value(std::numeric_limits<double>::quiet_NaN());
  v1::Invariant& invariant = *answer.add_invariants();
  invariant.set_name("Ic1");
  invariant.set_curve_class(v1::CURVE_CLASS_ELLIPSE);
  invariant.set_value(163.4);
  invariant.set_sigma(16.0);
  state.take(answer, kStart, 0);
  LiveGroup& group = *state.find("part");
  const Drawing drawing = make_drawing(group.touched, group.answer, Curvature::Along);
  JsonText json;
  write_picture(group, drawing, json);
  const auto picture = nlohmann::json::parse(json.take());
  write_details(group, drawing, kStart, json);
  const auto details = nlohmann::json::parse(json.take());
  EXPECT_TRUE(details["decisions"][0]["pValue"].is_null());
  EXPECT_EQ(details["invariants"][0]["name"], "Ic1");
  EXPECT_EQ(details["invariants"][0]["class"], "ellipse");
  EXPECT_EQ(details["invariants"][0]["text"], "163 +- 16");
  EXPECT_EQ(details["decisions"][0]["test"], "<b>\"\\\n</script>");
  EXPECT_TRUE(details["decisions"][0]["value"].is_null());
  EXPECT_EQ(picture["curve"]["points"].size(), 482U);
  EXPECT_FALSE(picture["curve"].contains("left"));
}

}  // namespace
}  // namespace palpate

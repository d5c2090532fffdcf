// What counts and what does not: sequence, objects, frames.
#include "node/groups/intake.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "contact_messages.h"
#include "intake_fixture.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;
using testing::contact_topic;
using testing::kTaken;
using testing::line_batch;

class IntakeTest : public testing::IntakeFixture {};

TEST_F(IntakeTest, AKeyThatMayNotPublishAsAProbeChangesNothingOfIt) {
  const ProbeNames left{"left"};
  const Sender sender{"KEY", &left};
  const auto send = [&](const std::string& topic, const std::string& bytes) {
    return intake_.take(2, topic, bytes, now_, 0, sender);
  };
  EXPECT_EQ(give("right", line_batch("right", 5, 0)), kTaken);
  EXPECT_EQ(send(contact_topic("right"), line_batch("right", 5, 1).SerializeAsString()),
            v1::REJECT_REASON_NOT_ALLOWED);
  EXPECT_EQ(send(contact_topic("right"), "nonsense"), v1::REJECT_REASON_NOT_ALLOWED);
  EXPECT_EQ(send("nonsense", "nonsense"), v1::REJECT_REASON_TOPIC);
  EXPECT_EQ(send(contact_topic("new"), line_batch("new", 5, 0).SerializeAsString()),
            v1::REJECT_REASON_NOT_ALLOWED);
  EXPECT_EQ(intake_.probes().find("new"), nullptr);
  EXPECT_EQ(intake_.probes().find("right")->rejected, 0U);
  EXPECT_EQ(give("right", line_batch("right", 5, 1)), kTaken);  // its seq was not used up
  EXPECT_EQ(send(contact_topic("left"), line_batch("left", 5, 0).SerializeAsString()), kTaken);
  const IntakeCounters& counters = intake_.counters();
  EXPECT_EQ(counters.rejected[v1::REJECT_REASON_NOT_ALLOWED], 3U);
  EXPECT_EQ(counters.rejected_last[v1::REJECT_REASON_NOT_ALLOWED],
            "new, which the key KEY may not publish as");
  EXPECT_EQ(counters.messages_received, counters.messages_accepted + rejected_sum(intake_));
}

TEST_F(IntakeTest, TheLedgerIsExact) {
  EXPECT_EQ(give("p", line_batch("p", 1, 0)), kTaken);
  EXPECT_EQ(give("p", line_batch("p", 1, 4)), kTaken);                         // 3 missing
  EXPECT_EQ(give("p", line_batch("p", 1, 4)), v1::REJECT_REASON_SEQUENCE);     // duplicate
  EXPECT_EQ(give("p", line_batch("p", 1, 2)), v1::REJECT_REASON_SEQUENCE);     // late
  EXPECT_EQ(give("p", line_batch("p", 2, 0)), kTaken);                         // restart
  EXPECT_EQ(give("p", line_batch("p", 1, 5)), v1::REJECT_REASON_STALE_EPOCH);  // before it
  EXPECT_EQ(intake_.take(3, "x", "y", now_, 0), v1::REJECT_REASON_FRAMES);
  const IntakeCounters& counters = intake_.counters();
  EXPECT_EQ(counters.messages_received, 7U);
  EXPECT_EQ(counters.messages_accepted, 3U);
  EXPECT_EQ(counters.messages_accepted + rejected_sum(intake_), counters.messages_received);
  EXPECT_EQ(counters.samples_received, 30U);
  const Probe& probe = *intake_.probes().find("p");
  EXPECT_EQ(probe.messages, 3U);
  EXPECT_EQ(probe.rejected, 3U);
  EXPECT_EQ(intake_.probes().missing(), 3U);
  EXPECT_EQ(intake_.probes().gaps(), 1U);
  EXPECT_EQ(intake_.probes().restarts(), 1U);
}

TEST_F(IntakeTest, ARejectedMessageChangesNothingButACount) {
  give("p", line_batch("p", 1, 0));
  v1::ContactBatch bad = line_batch("p", 1, 900);
  bad.mutable_samples(0)->set_x_m(1e308);
  EXPECT_EQ(give("p", bad), v1::REJECT_REASON_COORDINATE);
  bad = line_batch("q", 1, 0);
  bad.clear_samples();
  EXPECT_EQ(give("q", bad), v1::REJECT_REASON_EMPTY);
  EXPECT_EQ(intake_.probes().find("q"), nullptr);
  EXPECT_EQ(intake_.groups().size(), 1U);
  EXPECT_EQ(give("p", line_batch("p", 1, 1)), kTaken);
  EXPECT_EQ(intake_.probes().missing(), 0U);
}

TEST_F(IntakeTest, AStampThatCannotBeSubtractedIsShownAsZero) {
  v1::ContactBatch batch = line_batch("p", 1, 0);
  batch.mutable_header()->set_stamp_ns(std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(give("p", batch), kTaken);
  EXPECT_EQ(intake_.probes().find("p")->latency_ns, 0);
}

TEST_F(IntakeTest, WithoutAStampThereIsNoLatency) {
  constexpr std::int64_t kNow = 1'700'000'000'000'000'000;
  v1::ContactBatch batch = line_batch("p", 1, 0);
  batch.mutable_header()->set_stamp_ns(kNow - 5);
  EXPECT_EQ(intake_.take(2, contact_topic("p"), batch.SerializeAsString(), now_, kNow), kTaken);
  EXPECT_EQ(intake_.probes().find("p")->latency_ns, 5);
  batch.mutable_header()->set_seq(1);
  batch.mutable_header()->set_stamp_ns(0);
  EXPECT_EQ(intake_.take(2, contact_topic("p"), batch.SerializeAsString(), now_, kNow), kTaken);
  EXPECT_EQ(intake_.probes().find("p")->latency_ns, 0);
}

TEST_F(IntakeTest, GroupsMayBeReplayedOneAfterTheOther) {
  IntakeOptions options;
  for (const bool by_group : {false, true}) {
    options.sequence_by_group = by_group;
    Intake intake(options);
    const v1::RejectReason late = by_group ? kTaken : v1::REJECT_REASON_SEQUENCE;
    for (const std::uint64_t seq : {0, 2, 4}) {
      EXPECT_EQ(give(intake, "p", in_group("cup", 1, line_batch("p", 1, seq))), kTaken);
    }
    for (const std::uint64_t seq : {1, 3}) {
      EXPECT_EQ(give(intake, "p", in_group("plate", 1, line_batch("p", 1, seq))), late);
    }
    // What comes twice in a group is a duplicate, and so it is after a newer object.
    EXPECT_EQ(give(intake, "p", in_group("plate", 2, line_batch("p", 1, 5))), kTaken);
    EXPECT_EQ(give(intake, "p", in_group("plate", 1, line_batch("p", 1, 3))),
              v1::REJECT_REASON_SEQUENCE);
    EXPECT_EQ(give(intake, "p", in_group("plate", 2, line_batch("p", 1, 5))),
              v1::REJECT_REASON_SEQUENCE);
  }
}

TEST_F(IntakeTest, ContinuityDoesNotDependOnTheOrderOfTheGroups) {
  IntakeOptions options;
  options.sequence_by_group = true;
  const std::map<std::string, std::vector<std::uint64_t>> numbers{{"cup", {0, 2, 4}},
                                                                  {"plate", {1, 3, 5, 6}}};
  const auto give_all = [&](Intake& intake, const std::string& group, std::uint64_t from,
                            std::uint64_t to) {
    for (const std::uint64_t seq : numbers.at(group)) {
      if (seq < from || seq >= to) continue;
      EXPECT_EQ(give(intake, "p", in_group(group, 1, line_batch("p", 1, seq))), kTaken);
    }
  };
  const auto continuity_of_plate = [](Intake& intake) {
    std::vector<Continuity> all;
    intake.groups()
        .begin_work(*intake.groups().find("plate"))
        ->contacts.for_each([&](const QueuedContacts& message, const auto&, const auto&) {
          all.push_back(message.continuity);
        });
    return all;
  };
  const std::vector<Continuity> expected{Continuity::Anew, Continuity::SamplesMissing,
                                         Continuity::SamplesMissing, Continuity::Unbroken};
  Intake late(options);
  give_all(late, "cup", 0, 10);
  give_all(late, "plate", 0, 10);
  EXPECT_EQ(continuity_of_plate(late), expected);
  Intake early(options);
  give_all(early, "plate", 0, 10);
  give_all(early, "cup", 0, 10);
  EXPECT_EQ(continuity_of_plate(early), expected);
  Intake as_sent(options);
  for (std::uint64_t seq = 0; seq < 10; ++seq) {
    give_all(as_sent, "cup", seq, seq + 1);
    give_all(as_sent, "plate", seq, seq + 1);
  }
  EXPECT_EQ(continuity_of_plate(as_sent), expected);
}

TEST_F(IntakeTest, InTheOrderOfEachGroupAnObjectChangesAfterAnotherGroupsMessage) {
  IntakeOptions options;
  options.sequence_by_group = true;
  Intake intake(options);
  EXPECT_EQ(give(intake, "p", in_group("cup", 1, line_batch("p", 1, 0))), kTaken);
  EXPECT_EQ(give(intake, "q", in_group("cup", 1, line_batch("q", 1, 0))), kTaken);
  EXPECT_EQ(give(intake, "p", in_group("plate", 1, line_batch("p", 1, 2))), kTaken);
  EXPECT_EQ(give(intake, "p", in_group("cup", 2, line_batch("p", 1, 1))), kTaken);
  EXPECT_EQ(give(intake, "q", in_group("plate", 1, line_batch("q", 1, 2))), kTaken);
  // Of the old object, and not p's word that it is back.
  EXPECT_EQ(give(intake, "r", in_group("cup", 1, line_batch("r", 1, 0))),
            v1::REJECT_REASON_STALE_OBJECT);
}

TEST_F(IntakeTest, ANewObjectForgetsTheOld) {
  give("p", in_group("cup", 1, line_batch("p", 1, 0, 50)));
  EXPECT_EQ(recognized_samples("cup"), 50U);
  EXPECT_EQ(give("p", in_group("cup", 2, line_batch("p", 1, 1, 30))), kTaken);
  EXPECT_EQ(intake_.groups().find("cup")->object(), 2U);
  EXPECT_EQ(recognized_samples("cup"), 30U);
}

TEST_F(IntakeTest, ARestartedProbeGoesOnWithItsObject) {
  give("p", in_group("cup", 1, line_batch("p", 1, 7, 50)));
  EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 2, 0, 30, 1.0))), kTaken);
  EXPECT_EQ(recognized_samples("cup"), 80U);
}

TEST_F(IntakeTest, AProbeIsHeardAgainAfterAStrayMessageUnderItsName) {
  EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 1, 40))), kTaken);
  EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 2, 0))), kTaken);  // the stray one
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 1, 41 + i))),
              v1::REJECT_REASON_STALE_EPOCH);
    now_ += milliseconds(1000);
  }
  now_ += milliseconds(1);
  EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 1, 51))), kTaken);
  EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 1, 52))), kTaken);
  EXPECT_EQ(give("p", in_group("cup", 1, line_batch("p", 2, 1))), v1::REJECT_REASON_STALE_EPOCH);
}

TEST_F(IntakeTest, AProbeThatIsStartedAnewDoesNotBringAnOldObjectBack) {
  EXPECT_EQ(give("a", in_group("cup", 1, line_batch("a", 1, 0))), kTaken);
  EXPECT_EQ(give("b", in_group("cup", 1, line_batch("b", 1, 0))), kTaken);
  EXPECT_EQ(give("a", in_group("cup", 2, line_batch("a", 1, 1))), kTaken);
  EXPECT_EQ(give("b", in_group("cup", 2, line_batch("b", 1, 1))), kTaken);
  // It counts its objects from 1 again.
  EXPECT_EQ(give("b", in_group("cup", 1, line_batch("b", 2, 0))), v1::REJECT_REASON_STALE_OBJECT);
  EXPECT_EQ(give("a", in_group("cup", 2, line_batch("a", 1, 2))), kTaken);
  // A new object may begin with a restart.
  EXPECT_EQ(give("b", in_group("cup", 3, line_batch("b", 3, 0))), kTaken);
  EXPECT_EQ(give("a", in_group("cup", 3, line_batch("a", 1, 3))), kTaken);
}

TEST_F(IntakeTest, StragglersOfTheOldObjectNeitherMixNorReturn) {
  give("a", in_group("cup", 1, line_batch("a", 1, 0, 50)));
  give("b", in_group("cup", 1, line_batch("b", 1, 0, 50, 1.0)));
  EXPECT_EQ(give("a", in_group("cup", 2, line_batch("a", 1, 1, 30))), kTaken);
  EXPECT_EQ(give("b", in_group("cup", 1, line_batch("b", 1, 1, 50, 1.1))),
            v1::REJECT_REASON_STALE_OBJECT);
  EXPECT_EQ(intake_.groups().find("cup")->object(), 2U);
  EXPECT_EQ(recognized_samples("cup"), 30U);
  EXPECT_EQ(give("b", in_group("cup", 2, line_batch("b", 1, 2, 20, 1.2))), kTaken);
  EXPECT_EQ(recognized_samples("cup"), 50U);
}

TEST_F(IntakeTest, AProbeOfAnotherMindIsHeardAfterTheOthersSilence) {
  give("a", in_group("cup", 1, line_batch("a", 1, 0)));
  EXPECT_EQ(give("b", in_group("cup", 7, line_batch("b", 1, 0))), v1::REJECT_REASON_STALE_OBJECT);
  now_ += milliseconds(1001);
  EXPECT_EQ(give("b", in_group("cup", 7, line_batch("b", 1, 0))), kTaken);
  EXPECT_EQ(intake_.groups().find("cup")->object(), 7U);
}

TEST_F(IntakeTest, FramesAreNotMixed) {
  v1::ContactBatch batch = line_batch("p", 1, 0);
  batch.mutable_header()->set_frame("table");
  EXPECT_EQ(give("p", batch), kTaken);
  EXPECT_EQ(give("p", line_batch("p", 1, 1)), v1::REJECT_REASON_FRAME_NAME);
  EXPECT_EQ(recognize("p")->answer.recognition.header().frame(), "table");
}

TEST_F(IntakeTest, ContactsAreNamedAsTheProbeNamesThem) {
  v1::ContactBatch batch = in_group("cup", 1, line_batch("left", 1, 0));
  batch.set_patch(5);
  give("left", batch);
  batch = in_group("cup", 1, line_batch("right", 1, 0, 10, 1.0));
  batch.set_patch(9);
  give("right", batch);
  batch = in_group("cup", 1, line_batch("right", 1, 1, 10, 2.0));
  batch.set_patch(10);
  give("right", batch);
  const std::shared_ptr<GroupRecognizer> group = recognize("cup");
  EXPECT_EQ(group->source_of(0, 0).probe, "left");
  EXPECT_EQ(group->source_of(0, 0).patch, 5U);
  EXPECT_EQ(group->source_of(1, 1).probe, "right");
  EXPECT_EQ(group->source_of(1, 1).patch, 10U);
  EXPECT_EQ(group->source_of(2, 0).probe, "");
}

}  // namespace
}  // namespace palpate

// What counts and what does not: sequence, objects, bounds, turns.
#include "node/groups/intake.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "contact_messages.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::contact_topic;
using testing::line_batch;

constexpr v1::RejectReason kTaken = v1::REJECT_REASON_UNSPECIFIED;

class IntakeTest : public ::testing::Test {
 protected:
  v1::RejectReason give(Intake& intake, const std::string& probe, const v1::ContactBatch& batch) {
    return intake.take(2, contact_topic(probe), batch.SerializeAsString(), now_, 0);
  }

  v1::RejectReason give(const std::string& probe, const v1::ContactBatch& batch) {
    return give(intake_, probe, batch);
  }

  static v1::ContactBatch in_group(const std::string& group, std::uint64_t object,
                                   v1::ContactBatch batch) {
    batch.set_group(group);
    batch.set_object(object);
    return batch;
  }

  static std::uint64_t rejected_sum(const Intake& intake) {
    const auto& rejected = intake.counters().rejected;
    return std::accumulate(rejected.begin(), rejected.end(), std::uint64_t{0});
  }

  // What a worker would do.
  std::shared_ptr<GroupRecognizer> recognize(const std::string& group) {
    std::shared_ptr<GroupRecognizer> recognizer =
        intake_.groups().begin_work(*intake_.groups().find(group));
    recognizer->run();
    intake_.groups().end_work(*intake_.groups().find(group));
    return recognizer;
  }

  // The same without the computation, as if it had cost so much.
  void serve(Group& group, std::int64_t cost_ns) {
    const std::shared_ptr<GroupRecognizer> recognizer = intake_.groups().begin_work(group);
    recognizer->contacts.clear();
    recognizer->answer.processor_ns = cost_ns;
    intake_.groups().end_work(group);
  }

  std::uint64_t recognized_samples(const std::string& group) {
    return recognize(group)->answer.recognition.sample_count();
  }

  SteadyTime now_ = SteadyTime(seconds(1000));
  Intake intake_{IntakeOptions()};
};

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

TEST_F(IntakeTest, SamplesThatWaitInVainAreCounted) {
  IntakeOptions options;
  options.groups.max_groups_per_probe = 1;
  Intake intake(options);
  give(intake, "p", in_group("cup", 1, line_batch("p", 1, 0, 50)));
  intake.groups().begin_work(*intake.groups().find("cup"))->contacts.clear();
  intake.groups().end_work(*intake.groups().find("cup"));
  EXPECT_EQ(intake.groups().superseded_samples(), 0U);
  give(intake, "p", in_group("cup", 1, line_batch("p", 1, 1, 7)));
  give(intake, "p", in_group("cup", 2, line_batch("p", 1, 2, 30)));
  EXPECT_EQ(intake.groups().superseded_samples(), 7U);
  give(intake, "p", in_group("plate", 3, line_batch("p", 1, 3, 20)));
  EXPECT_EQ(intake.groups().find("cup"), nullptr);
  EXPECT_EQ(intake.groups().superseded_samples(), 37U);
}

TEST_F(IntakeTest, AGroupThatAnotherProbeHasTakenOverIsNotGivenUp) {
  IntakeOptions options;
  options.groups.max_groups_per_probe = 2;
  Intake intake(options);
  give(intake, "opener", in_group("cup", 1, line_batch("opener", 1, 0)));
  give(intake, "heir", in_group("plate", 1, line_batch("heir", 1, 0)));
  now_ += seconds(60);
  give(intake, "heir", in_group("cup", 2, line_batch("heir", 1, 1)));
  give(intake, "opener", in_group("dish", 1, line_batch("opener", 1, 1)));
  now_ += seconds(1);
  give(intake, "opener", in_group("bowl", 1, line_batch("opener", 1, 2)));
  EXPECT_NE(intake.groups().find("dish"), nullptr);  // the cup is no longer the opener's
  now_ += seconds(1);
  give(intake, "opener", in_group("pan", 1, line_batch("opener", 1, 3)));
  EXPECT_NE(intake.groups().find("cup"), nullptr);
  EXPECT_EQ(intake.groups().find("dish"), nullptr);
}

TEST_F(IntakeTest, AProbeWhoseGroupsOthersHaveTakenOverMayOpenMore) {
  IntakeOptions options;
  options.groups.max_groups_per_probe = 2;
  Intake intake(options);
  std::uint64_t seq = 0;
  for (const char* name : {"cup", "plate"}) {
    give(intake, "opener", in_group(name, 1, line_batch("opener", 1, seq++)));
  }
  now_ += seconds(60);
  give(intake, "heir", in_group("cup", 2, line_batch("heir", 1, 0)));
  give(intake, "heir", in_group("plate", 2, line_batch("heir", 1, 1)));
  EXPECT_EQ(give(intake, "opener", in_group("dish", 1, line_batch("opener", 1, seq++))), kTaken);
  EXPECT_EQ(intake.groups().size(), 3U);
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

TEST_F(IntakeTest, AForgottenProbeIsForgottenByTheGroupsToo) {
  IntakeOptions options;
  options.sequence_by_group = true;
  options.max_probes = 1;
  Intake intake(options);
  EXPECT_EQ(give(intake, "p", in_group("cup", 1, line_batch("p", 1, 0))), kTaken);
  EXPECT_NE(intake.groups().find("cup")->sequence_of("p"), nullptr);
  now_ += seconds(60);
  EXPECT_EQ(give(intake, "q", in_group("cup", 2, line_batch("q", 1, 0))), kTaken);
  EXPECT_EQ(intake.groups().find("cup")->sequence_of("p"), nullptr);
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

TEST_F(IntakeTest, TenThousandNamesStayWithinTheBoundsAndDisplaceNobody) {
  IntakeOptions options;
  options.max_probes = 8;
  options.groups.max_groups = 4;
  Intake intake(options);
  EXPECT_EQ(give(intake, "good", line_batch("good", 1, 0)), kTaken);
  for (int i = 0; i < 10000; ++i) {
    const std::string name = "invented" + std::to_string(i);
    give(intake, name, line_batch(name, 1, 0, 1));
    now_ += milliseconds(1);
    if (i % 1000 == 999) {
      const auto seq = static_cast<std::uint64_t>(i / 1000 + 1);
      EXPECT_EQ(give(intake, "good", line_batch("good", 1, seq)), kTaken);
    }
  }
  EXPECT_LE(intake.probes().all().size(), 8U);
  EXPECT_LE(intake.groups().size(), 4U);
  EXPECT_EQ(intake.probes().find("good")->messages, 11U);
  const IntakeCounters& counters = intake.counters();
  EXPECT_EQ(counters.messages_accepted + rejected_sum(intake), counters.messages_received);
  EXPECT_GT(counters.rejected[v1::REJECT_REASON_TOO_MANY_GROUPS], 9900U);
}

TEST_F(IntakeTest, TheIdleMakeRoom) {
  IntakeOptions options;
  options.max_probes = 2;
  options.groups.max_groups = 2;
  Intake intake(options);
  give(intake, "a", line_batch("a", 1, 0));
  now_ += seconds(1);
  give(intake, "b", line_batch("b", 1, 0));
  EXPECT_EQ(give(intake, "c", line_batch("c", 1, 0)), v1::REJECT_REASON_TOO_MANY_PROBES);
  now_ += milliseconds(9500);  // a silent for 10.5 s, b for 9.5 s
  EXPECT_EQ(give(intake, "c", line_batch("c", 1, 0)), kTaken);
  EXPECT_EQ(intake.probes().find("a"), nullptr);
  EXPECT_NE(intake.probes().find("b"), nullptr);
  const Intake::Forgotten forgotten = intake.take_forgotten();
  ASSERT_EQ(forgotten.groups.size(), 1U);
  EXPECT_EQ(forgotten.groups.front(), "a");
  ASSERT_EQ(forgotten.probes.size(), 1U);
  EXPECT_EQ(forgotten.probes.front(), "a");
  EXPECT_EQ(intake.groups().evicted_count(), 1U);
  EXPECT_EQ(intake.probes().evicted_count(), 1U);
}

TEST_F(IntakeTest, AProbeThatOpensGroupAfterGroupLosesItsOwnOnly) {
  IntakeOptions options;
  options.groups.max_groups_per_probe = 3;
  Intake intake(options);
  give(intake, "good", in_group("good", 1, line_batch("good", 1, 0)));
  for (std::uint64_t seq = 0; seq < 500; ++seq) {
    now_ += milliseconds(1);
    EXPECT_EQ(
        give(intake, "greedy", in_group(std::to_string(seq), 1, line_batch("greedy", 1, seq))),
        kTaken);
  }
  EXPECT_EQ(intake.groups().size(), 4U);
  EXPECT_NE(intake.groups().find("good"), nullptr);
  EXPECT_NE(intake.groups().find("499"), nullptr);
  EXPECT_EQ(intake.groups().find("496"), nullptr);
  // A group that somebody else touches too is not given up for one more.
  for (const char* name : {"497", "498", "499"}) {
    const std::string helper = std::string("helper").append(name);
    EXPECT_EQ(give(intake, helper, in_group(name, 1, line_batch(helper, 1, 0))), kTaken);
  }
  EXPECT_EQ(give(intake, "greedy", in_group("more", 1, line_batch("greedy", 1, 500))),
            v1::REJECT_REASON_TOO_MANY_GROUPS);
}

TEST_F(IntakeTest, AGroupHasSoManyProbes) {
  IntakeOptions options;
  options.group.max_probes_per_group = 2;
  Intake intake(options);
  EXPECT_EQ(give(intake, "a", in_group("g", 1, line_batch("a", 1, 0))), kTaken);
  EXPECT_EQ(give(intake, "b", in_group("g", 1, line_batch("b", 1, 0))), kTaken);
  EXPECT_EQ(give(intake, "c", in_group("g", 1, line_batch("c", 1, 0))),
            v1::REJECT_REASON_TOO_MANY_PROBES_IN_GROUP);
}

TEST_F(IntakeTest, AModestGroupIsServedBeforeBusyOnes) {
  constexpr std::int64_t kCost = 1'000'000;
  std::uint64_t seq = 0;
  const auto serve_next = [&](std::int64_t cost_ns) {
    serve(*intake_.groups().next_waiting(), cost_ns);
  };
  const auto all_busy_ones_wait = [&] {
    for (const char* name : {"busy1", "busy2", "busy3"}) give(name, line_batch(name, 1, seq));
    ++seq;
  };
  GroupRegistry& groups = intake_.groups();
  all_busy_ones_wait();
  for (int turn = 0; turn < 100; ++turn) {
    ASSERT_NE(groups.next_waiting(), nullptr);
    serve_next(kCost);
    all_busy_ones_wait();
  }
  // Comes anew, with nothing saved up, and waits for nobody who has had as much.
  give("modest", line_batch("modest", 1, 0));
  int turns = 0;
  while (groups.next_waiting()->name() != "modest") {
    serve_next(kCost);
    all_busy_ones_wait();
    ASSERT_LE(++turns, 3);  // at most those that stood at the same level before it
  }
  serve_next(kCost / 10);
  EXPECT_NE(groups.next_waiting()->name(), "modest");
}

TEST_F(IntakeTest, WhatComesDuringARecognitionIsAnsweredAtOnceAfterIt) {
  GroupRegistry& groups = intake_.groups();
  give("p", line_batch("p", 1, 0, 20));
  Group& group = *groups.next_waiting();
  const std::shared_ptr<GroupRecognizer> recognizer = groups.begin_work(group);
  for (std::uint64_t seq = 1; seq <= 5; ++seq) {
    give("p", line_batch("p", 1, seq, 10, 0.02 + 0.01 * static_cast<double>(seq - 1)));
    EXPECT_EQ(groups.next_waiting(), nullptr);  // one answer of a group at a time
  }
  recognizer->run();
  EXPECT_EQ(groups.end_work(group).recognition.sample_count(), 20U);
  EXPECT_EQ(groups.next_waiting(), &group);
  EXPECT_EQ(recognized_samples("p"), 70U);
  EXPECT_EQ(groups.next_waiting(), nullptr);
  EXPECT_FALSE(groups.has_work());
}

TEST_F(IntakeTest, AnObjectThatEndsDuringARecognitionIsAnsweredUnderItsOwnNumber) {
  give("a", in_group("cup", 1, line_batch("a", 1, 0, 20)));
  Group& group = *intake_.groups().next_waiting();
  const std::shared_ptr<GroupRecognizer> recognizer = intake_.groups().begin_work(group);
  give("a", in_group("cup", 1, line_batch("a", 1, 1, 20, 0.02)));
  give("a", in_group("cup", 2, line_batch("a", 1, 2, 30)));
  recognizer->run();
  EXPECT_EQ(intake_.groups().end_work(group).recognition.object(), 1U);
  const std::shared_ptr<GroupRecognizer> next = recognize("cup");
  EXPECT_EQ(next->answer.recognition.object(), 2U);
  EXPECT_EQ(next->answer.recognition.sample_count(), 30U);
}

TEST_F(IntakeTest, AGroupAtAWorkersIsNotForgotten) {
  IntakeOptions options;
  options.groups.max_groups = 1;
  Intake intake(options);
  give(intake, "a", line_batch("a", 1, 0));
  Group& group = *intake.groups().next_waiting();
  const std::shared_ptr<GroupRecognizer> recognizer = intake.groups().begin_work(group);
  now_ += seconds(20);
  EXPECT_EQ(give(intake, "b", line_batch("b", 1, 0)), v1::REJECT_REASON_TOO_MANY_GROUPS);
  recognizer->run();
  intake.groups().end_work(group);
  EXPECT_EQ(give(intake, "b", line_batch("b", 1, 0)), kTaken);
  EXPECT_EQ(intake.groups().find("a"), nullptr);
}

TEST_F(IntakeTest, WhatWaitsIsBoundedAndNobodyTakesAllOfIt) {
  IntakeOptions options;
  options.groups.max_waiting_bytes = 100'000;
  Intake intake(options);
  const auto flood = [&](const std::string& name) {
    std::uint64_t taken = 0;
    for (std::uint64_t seq = 0; seq < 1000; ++seq) {
      taken += give(intake, name, line_batch(name, 1, seq)) == kTaken ? 1 : 0;
    }
    return taken;
  };
  // Each has as much as is left to all others: a half, a quarter, an eighth.
  const std::uint64_t first = flood("a");
  const std::uint64_t second = flood("b");
  const std::uint64_t third = flood("c");
  EXPECT_GT(first, second);
  EXPECT_GT(second, third);
  EXPECT_GT(third, 0U);
  EXPECT_EQ(give(intake, "good", line_batch("good", 1, 0)), kTaken);
  std::size_t queued = 0;
  for (const char* name : {"a", "b", "c", "good"})
    queued += intake.groups().find(name)->queued_bytes();
  EXPECT_LE(queued, options.groups.max_waiting_bytes);
  const IntakeCounters& counters = intake.counters();
  EXPECT_EQ(counters.rejected[v1::REJECT_REASON_OVERLOAD], 3000 - first - second - third);
  EXPECT_EQ(counters.messages_accepted + rejected_sum(intake), counters.messages_received);
  // What did not fit is a hole in seq like any other loss.
  Group& group = *intake.groups().find("a");
  intake.groups().begin_work(group)->run();
  intake.groups().end_work(group);
  EXPECT_EQ(give(intake, "a", line_batch("a", 1, 1000)), kTaken);
  EXPECT_EQ(intake.probes().missing(), 1000 - first);
}

TEST_F(IntakeTest, SlowGroupsAreKnownByTheirLastAnswers) {
  const std::int64_t limit = std::chrono::nanoseconds(Group::kQuickCompute).count();
  give("slow", line_batch("slow", 1, 0));
  serve(*intake_.groups().next_waiting(), 4 * limit);
  give("slow", line_batch("slow", 1, 1));
  EXPECT_EQ(intake_.groups().next_waiting(/*only_quick=*/true), nullptr);
  give("quick", line_batch("quick", 1, 0));
  ASSERT_NE(intake_.groups().next_waiting(/*only_quick=*/true), nullptr);
  EXPECT_EQ(intake_.groups().next_waiting(/*only_quick=*/true)->name(), "quick");
  EXPECT_NE(intake_.groups().next_waiting(), nullptr);

  // The first samples of its next object are answered at once: that does not make the group quick,
  // several such do.
  Group& slow = *intake_.groups().find("slow");
  EXPECT_EQ(slow.expected_compute(), std::chrono::nanoseconds(4 * limit));
  serve(slow, 1);
  EXPECT_FALSE(slow.is_quick());
  give("slow", line_batch("slow", 2, 2));
  serve(slow, 1);
  EXPECT_TRUE(slow.is_quick());
  give("slow", line_batch("slow", 2, 3));
  serve(slow, 2 * limit);
  EXPECT_FALSE(slow.is_quick());
}

}  // namespace
}  // namespace palpate

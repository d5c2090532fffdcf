// Who finds room, who makes it, and whose turn it is.
#include "node/groups/group_registry.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "contact_messages.h"
#include "intake_fixture.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::kTaken;
using testing::line_batch;

class GroupRegistryTest : public testing::IntakeFixture {
 protected:
  // What a worker would do, without the computation, as if it had cost so much.
  void serve(Group& group, std::int64_t cost_ns) {
    const std::shared_ptr<GroupRecognizer> recognizer = intake_.groups().begin_work(group);
    recognizer->contacts.clear();
    recognizer->answer.processor_ns = cost_ns;
    intake_.groups().end_work(group);
  }
};

TEST_F(GroupRegistryTest, SamplesThatWaitInVainAreCounted) {
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

TEST_F(GroupRegistryTest, ObjectsWithoutAnAnswerAreCounted) {
  IntakeOptions options;
  options.groups.max_groups_per_probe = 1;
  Intake intake(options);
  give(intake, "p", in_group("cup", 1, line_batch("p", 1, 0)));
  Group& cup = *intake.groups().find("cup");
  // The first object is being recognised while the others come, and is no longer waiting.
  intake.groups().begin_work(cup)->contacts.clear();
  std::uint64_t seq = 0;
  for (const std::uint64_t object : {2, 3, 3, 4}) {
    give(intake, "p", in_group("cup", object, line_batch("p", 1, ++seq)));
  }
  EXPECT_EQ(intake.groups().superseded_objects(), 2U);
  intake.groups().end_work(cup);
  intake.groups().begin_work(cup)->contacts.clear();
  intake.groups().end_work(cup);
  give(intake, "p", in_group("cup", 5, line_batch("p", 1, 20)));
  EXPECT_EQ(intake.groups().superseded_objects(), 2U);
  give(intake, "p", in_group("plate", 6, line_batch("p", 1, 21)));
  EXPECT_EQ(intake.groups().superseded_objects(), 3U);
}

TEST_F(GroupRegistryTest, AGroupThatAnotherProbeHasTakenOverIsNotGivenUp) {
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

TEST_F(GroupRegistryTest, AProbeWhoseGroupsOthersHaveTakenOverMayOpenMore) {
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

TEST_F(GroupRegistryTest, AForgottenProbeIsForgottenByTheGroupsToo) {
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

TEST_F(GroupRegistryTest, TenThousandNamesStayWithinTheBoundsAndDisplaceNobody) {
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

TEST_F(GroupRegistryTest, TheIdleMakeRoom) {
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

TEST_F(GroupRegistryTest, AProbeThatOpensGroupAfterGroupLosesItsOwnOnly) {
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

TEST_F(GroupRegistryTest, AGroupHasSoManyProbes) {
  IntakeOptions options;
  options.group.max_probes_per_group = 2;
  Intake intake(options);
  EXPECT_EQ(give(intake, "a", in_group("g", 1, line_batch("a", 1, 0))), kTaken);
  EXPECT_EQ(give(intake, "b", in_group("g", 1, line_batch("b", 1, 0))), kTaken);
  EXPECT_EQ(give(intake, "c", in_group("g", 1, line_batch("c", 1, 0))),
            v1::REJECT_REASON_TOO_MANY_PROBES_IN_GROUP);
}

TEST_F(GroupRegistryTest, AModestGroupIsServedBeforeBusyOnes) {
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

TEST_F(GroupRegistryTest, WhatComesDuringARecognitionIsAnsweredAtOnceAfterIt) {
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

TEST_F(GroupRegistryTest, AnObjectThatEndsDuringARecognitionIsAnsweredUnderItsOwnNumber) {
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

TEST_F(GroupRegistryTest, AGroupAtAWorkersIsNotForgotten) {
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

TEST_F(GroupRegistryTest, WhatWaitsIsBoundedAndNobodyTakesAllOfIt) {
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

TEST_F(GroupRegistryTest, SlowGroupsAreKnownByTheirLastAnswers) {
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

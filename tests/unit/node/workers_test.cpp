// Work on other threads: given out, taken back, and left behind where it does not end.
#include "node/groups/workers.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <thread>
#include <utility>

namespace palpate {
namespace {

class Task : public Work {
 public:
  explicit Task(std::function<void()> what) : what_(std::move(what)) {}
  void run() override { what_(); }

 private:
  std::function<void()> what_;
};

std::size_t next_finished(Workers& workers) {
  for (;;) {
    if (const std::optional<std::size_t> worker = workers.take_finished()) return *worker;
    pollfd finished{workers.finished_fd(), POLLIN, 0};
    ::poll(&finished, 1, /*timeout=*/-1);
  }
}

TEST(Workers, WhatTheyDoIsSeenByWhoGaveIt) {
  Workers workers(2);
  int sum = 0;  // touched by the worker, then by us: the sanitizer watches
  for (int i = 1; i <= 1000; ++i) {
    const std::size_t worker = workers.start(std::make_shared<Task>([&sum, i] { sum += i; }));
    EXPECT_EQ(next_finished(workers), worker);
  }
  EXPECT_EQ(sum, 500500);
  EXPECT_EQ(workers.busy_count(), 0U);
}

// What the calling thread has of the system's scheduler.
struct Scheduled {
  int nice;
  std::chrono::nanoseconds slice;  // 0 before Linux 6.12
};

Scheduled scheduled_here() {
  struct {
    std::uint32_t size, policy;
    std::uint64_t flags;
    std::int32_t nice;
    std::uint32_t priority;
    std::uint64_t slice_ns, deadline_ns, period_ns;
  } said{};
  ::syscall(SYS_sched_getattr, 0, &said, sizeof(said), 0U);
  return {said.nice, std::chrono::nanoseconds(said.slice_ns)};
}

TEST(Workers, AskForAsLongAsTheirWorkTakes) {
  using std::chrono::milliseconds;
  Workers workers(1, 1);
  const auto scheduled_for = [&workers](Workers::Pace pace, milliseconds expected) {
    Scheduled there{};
    workers.start(std::make_shared<Task>([&there] { there = scheduled_here(); }), pace, expected);
    next_finished(workers);
    return there;
  };
  const Scheduled here = scheduled_here();
  const Scheduled brief = scheduled_for(Workers::Pace::Quick, milliseconds(1));
  const Scheduled longer = scheduled_for(Workers::Pace::Quick, milliseconds(15));
  const Scheduled slow = scheduled_for(Workers::Pace::Slow, milliseconds(60));
  EXPECT_EQ(brief.nice, here.nice);
  EXPECT_EQ(longer.nice, here.nice);
  EXPECT_EQ(slow.nice, std::min(here.nice + 10, 19));
  if (brief.slice.count() == 0) GTEST_SKIP() << "this system's scheduler knows no slices";
  EXPECT_EQ(brief.slice, here.slice);
  EXPECT_EQ(longer.slice, milliseconds(30));
  EXPECT_EQ(slow.slice, milliseconds(100));  // the longest there is
  EXPECT_EQ(scheduled_for(Workers::Pace::Quick, milliseconds(2)).slice, milliseconds(4));
}

TEST(Workers, NoFinishIsMissedHoweverTheyCome) {
  constexpr int kWorks = 20'000;
  Workers workers(4);
  std::atomic<int> done = 0;
  int given = 0;
  int taken = 0;
  while (taken < kWorks) {
    while (given < kWorks && workers.has_idle(Workers::Pace::Quick)) {
      workers.start(std::make_shared<Task>([&done] { ++done; }));
      ++given;
    }
    next_finished(workers);
    ++taken;
    while (workers.take_finished()) ++taken;
  }
  EXPECT_EQ(done, kWorks);
  EXPECT_EQ(workers.busy_count(), 0U);
}

TEST(Workers, ALongWorkHoldsUpNoOther) {
  Workers workers(2);
  std::promise<void> release;
  const std::size_t held =
      workers.start(std::make_shared<Task>([&] { release.get_future().wait(); }));
  for (int i = 0; i < 100; ++i) {
    const std::size_t other = workers.start(std::make_shared<Task>([] {}));
    EXPECT_NE(other, held);
    EXPECT_EQ(next_finished(workers), other);
  }
  EXPECT_EQ(workers.busy_count(), 1U);
  release.set_value();
  EXPECT_EQ(next_finished(workers), held);
}

TEST(Workers, TheEndDoesNotWaitForAWorkThatDoesNotEnd) {
  std::promise<void> release;
  std::promise<void> ended;
  auto begun = std::make_shared<std::promise<void>>();
  {
    Workers workers(2);
    workers.start(std::make_shared<Task>([begun, released = release.get_future().share(), &ended] {
      begun->set_value();
      released.wait();
      ended.set_value();
    }));
    begun->get_future().wait();
    EXPECT_EQ(workers.busy_count(), 1U);
  }  // would never be passed
  release.set_value();
  ended.get_future().wait();  // it has lived on, with what it needs
}

}  // namespace
}  // namespace palpate

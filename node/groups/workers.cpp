#include "node/groups/workers.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace palpate {
namespace {

// Added to the nice value of the process. Next to a quick thread on the same core, a slow one gets
// a tenth of it.
constexpr int kSlowNice = 10;

// The kernel's sched_attr in its first version. glibc has none before 2.41, and Linux' own header
// conflicts with <sched.h>.
struct SchedulingWanted {
  std::uint32_t size = sizeof(SchedulingWanted);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t slice_ns = 0;
  std::uint64_t deadline_ns = 0;
  std::uint64_t period_ns = 0;
};
static_assert(sizeof(SchedulingWanted) == 48);

// The longest slice that the scheduler gives by default: 0.7 ms, times four from eight cores on.
constexpr std::uint64_t kLongestOwnSlice_ns = 2'800'000;

/// The calling thread's request to the scheduler. Since Linux 6.6 a thread keeps its core until its
/// slice ends, which is checked at a tick of up to 4 ms. Since 6.12 a thread that asks for a
/// shorter slice gets the core at once. So each work asks for a slice as long as it will take, and
/// shorter works go first.
class Turn {
 public:
  explicit Turn(Workers::Pace pace) {
    wanted_.nice = ::getpriority(PRIO_PROCESS, 0);  // on Linux, of this thread alone
    if (pace == Workers::Pace::Quick) return;
    // A thread cannot undo this without privileges, so slow works have threads of their own.
    wanted_.nice += kSlowNice;
    wanted_.policy = SCHED_BATCH;  // does not preempt others when it wakes up
    // A sandbox may not know sched_setattr; the older call sets the nice value at least.
    if (!ask()) (void)!::nice(kSlowNice);
  }

  /// 0 = not known: use the default slice. So do works shorter than it: a request below the default
  /// would take the core from the node's own thread. Asks for twice the expected time, up to the
  /// kernel's bound of 100 ms, because a thread that uses up its slice falls behind those that gave
  /// way to it.
  void ask_for(std::chrono::nanoseconds expected) {
    auto slice_ns = static_cast<std::uint64_t>(2 * expected.count());
    if (slice_ns <= kLongestOwnSlice_ns) slice_ns = 0;
    // Most answers take about as long as the one before and need no call.
    if (slice_ns <= 2 * wanted_.slice_ns && wanted_.slice_ns <= 2 * slice_ns) return;
    wanted_.slice_ns = slice_ns;
    (void)ask();  // a kernel without slices has its own rule for all threads
  }

 private:
  bool ask() { return ::syscall(SYS_sched_setattr, 0, &wanted_, 0U) == 0; }

  SchedulingWanted wanted_;
};

}  // namespace

/// Shared by the node's thread and the worker's thread. Lives as long as either needs it.
struct Workers::Worker {
  // Setting the state hands `work` and `expected` to the other thread.
  enum class State { Idle, Ordered, Finished };

  explicit Worker(std::shared_ptr<Bell> finished_bell)
      : ordered(Bell::Hearing::Waits), finished(std::move(finished_bell)) {}

  void serve(Pace pace) {
    Turn turn(pace);
    for (;;) {
      ordered.hear();
      if (state.load(std::memory_order_acquire) == State::Ordered) {
        turn.ask_for(expected);
        work->run();
        state.store(State::Finished, std::memory_order_release);
        finished->ring();
      }
      if (end.load(std::memory_order_acquire)) return;
    }
  }

  std::shared_ptr<Work> work;
  std::chrono::nanoseconds expected{0};
  std::atomic<State> state{State::Idle};
  std::atomic<bool> end{false};
  Bell ordered;
  std::shared_ptr<Bell> finished;
  std::thread thread;  // used by the node's thread
};

Workers::Workers(std::size_t quick_count, std::size_t slow_count)
    : finished_(std::make_shared<Bell>(Bell::Hearing::AtOnce)), quick_count_(quick_count) {
  for (std::size_t i = 0; i < quick_count + slow_count; ++i) {
    const Pace pace = i < quick_count ? Pace::Quick : Pace::Slow;
    auto worker = std::make_shared<Worker>(finished_);
    worker->thread = std::thread([worker, pace] { worker->serve(pace); });
    // Shown by top and debuggers; at most 15 characters.
    pthread_setname_np(
        worker->thread.native_handle(),
        ((pace == Pace::Slow ? "slow" : "recognize") + std::to_string(i % 10000)).c_str());
    workers_.push_back(std::move(worker));
  }
}

Workers::~Workers() {
  for (const std::shared_ptr<Worker>& worker : workers_) {
    worker->end.store(true, std::memory_order_release);
    worker->ordered.ring();
    if (worker->state.load(std::memory_order_acquire) == Worker::State::Ordered) {
      worker->thread.detach();
    } else {
      worker->thread.join();
    }
  }
}

std::optional<std::size_t> Workers::idle(Pace pace) const {
  const std::size_t begin = pace == Pace::Quick ? 0 : quick_count_;
  const std::size_t end = pace == Pace::Quick ? quick_count_ : workers_.size();
  for (std::size_t i = begin; i < end; ++i) {
    if (workers_[i]->state.load(std::memory_order_relaxed) == Worker::State::Idle) return i;
  }
  return std::nullopt;
}

std::size_t Workers::start(std::shared_ptr<Work> work, Pace pace,
                           std::chrono::nanoseconds expected) {
  const std::optional<std::size_t> number = idle(pace);
  assert(number);
  Worker& worker = *workers_[*number];
  worker.work = std::move(work);
  worker.expected = expected;
  worker.state.store(Worker::State::Ordered, std::memory_order_release);
  worker.ordered.ring();
  ++busy_count_;
  return *number;
}

std::optional<std::size_t> Workers::take_finished() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (workers_[i]->state.load(std::memory_order_acquire) != Worker::State::Finished) continue;
      workers_[i]->work.reset();
      workers_[i]->state.store(Worker::State::Idle, std::memory_order_relaxed);
      --busy_count_;
      return i;
    }
    // A worker that finishes after this signals again. Looking once more misses nobody. Clearing
    // the signal twice could lose the one of a worker that has finished since.
    if (attempt == 0) finished_->hear();
  }
  return std::nullopt;
}

int Workers::finished_fd() const { return finished_->fd(); }

}  // namespace palpate

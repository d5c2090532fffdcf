#include "node/groups/workers.h"

#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
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

// Above what the process has: beside a quick thread on the same core, a slow one has a tenth of it.
constexpr int kSlowNice = 10;

// The system's sched_attr in its first form; glibc has none before 2.41, and Linux' own header does
// not go with <sched.h>.
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

// What the system gives who asks for none: 0.7 ms, times four from eight cores on.
constexpr std::uint64_t kLongestOwnSlice_ns = 2'800'000;

/// What the calling thread asks of the system's scheduler. Since Linux 6.6 whoever is on a core
/// keeps it until the end of its slice, found out at a tick of up to 4 ms, whatever waits, unless
/// that asks for a shorter one (6.12): then it has the core at once. So each work asks for as long
/// as it will take, and the shorter goes first.
class Turn {
 public:
  explicit Turn(Workers::Pace pace) {
    wanted_.nice = ::getpriority(PRIO_PROCESS, 0);  // of this thread alone, on Linux
    if (pace == Workers::Pace::Quick) return;
    // A thread cannot take this back without privileges: what is slow has threads of its own.
    wanted_.nice += kSlowNice;
    wanted_.policy = SCHED_BATCH;  // nor does it take a core from others when it wakes
    // Where a sandbox knows nothing of slices, the older call does this half.
    if (!ask()) (void)!::nice(kSlowNice);
  }

  /// 0 = not known, the system's own slice; so are shorter ones, who asks for less than the node's
  /// thread takes the core from it. Twice as much is asked for, up to the system's bound of 100 ms:
  /// who has used up its slice falls behind who has given way to it.
  void ask_for(std::chrono::nanoseconds expected) {
    auto slice_ns = static_cast<std::uint64_t>(2 * expected.count());
    if (slice_ns <= kLongestOwnSlice_ns) slice_ns = 0;
    // Most answers take about as long as the one before, and need no call.
    if (slice_ns <= 2 * wanted_.slice_ns && wanted_.slice_ns <= 2 * slice_ns) return;
    wanted_.slice_ns = slice_ns;
    (void)ask();  // a system that knows no slices has its own rule for all
  }

 private:
  bool ask() { return ::syscall(SYS_sched_setattr, 0, &wanted_, 0U) == 0; }

  SchedulingWanted wanted_;
};

}  // namespace

/// An eventfd: rung by one thread, heard by another.
struct Workers::Bell {
  explicit Bell(int flags) : fd(::eventfd(0, EFD_CLOEXEC | flags)) {
    if (fd < 0) throw std::runtime_error("no eventfd");
  }
  ~Bell() { ::close(fd); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;

  void ring() const { (void)::eventfd_write(fd, 1); }
  void hear() const {
    eventfd_t count = 0;
    (void)::eventfd_read(fd, &count);
  }

  const int fd;
};

/// What the node's thread and the worker's share. Lives as long as either needs it.
struct Workers::Worker {
  // Who sets a state gives `work` and `expected` to the side that waits for it.
  enum class State { Idle, Ordered, Finished };

  explicit Worker(std::shared_ptr<Bell> finished_bell)
      : ordered(0), finished(std::move(finished_bell)) {}

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
  std::thread thread;  // of the node's side
};

Workers::Workers(std::size_t quick_count, std::size_t slow_count)
    : finished_(std::make_shared<Bell>(EFD_NONBLOCK)), quick_count_(quick_count) {
  for (std::size_t i = 0; i < quick_count + slow_count; ++i) {
    const Pace pace = i < quick_count ? Pace::Quick : Pace::Slow;
    auto worker = std::make_shared<Worker>(finished_);
    worker->thread = std::thread([worker, pace] { worker->serve(pace); });
    // Fifteen letters at most, for top and debuggers.
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
    // Who finishes after this rings again: looked for once more, nobody is missed. Heard twice, the
    // ring of who has finished since would be lost.
    if (attempt == 0) finished_->hear();
  }
  return std::nullopt;
}

int Workers::finished_fd() const { return finished_->fd; }

}  // namespace palpate

#include "node/groups/workers.h"

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace palpate {

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
  // Who sets a state gives `work` to the side that waits for it.
  enum class State { Idle, Ordered, Finished };

  explicit Worker(std::shared_ptr<Bell> finished_bell)
      : ordered(0), finished(std::move(finished_bell)) {}

  void serve() {
    for (;;) {
      ordered.hear();
      if (state.load(std::memory_order_acquire) == State::Ordered) {
        work->run();
        state.store(State::Finished, std::memory_order_release);
        finished->ring();
      }
      if (end.load(std::memory_order_acquire)) return;
    }
  }

  std::shared_ptr<Work> work;
  std::atomic<State> state{State::Idle};
  std::atomic<bool> end{false};
  Bell ordered;
  std::shared_ptr<Bell> finished;
  std::thread thread;  // of the node's side
};

Workers::Workers(std::size_t count) : finished_(std::make_shared<Bell>(EFD_NONBLOCK)) {
  for (std::size_t i = 0; i < count; ++i) {
    auto worker = std::make_shared<Worker>(finished_);
    worker->thread = std::thread([worker] { worker->serve(); });
    // Fifteen letters at most, for top and debuggers.
    pthread_setname_np(worker->thread.native_handle(),
                       ("recognize" + std::to_string(i % 10000)).c_str());
    workers_.push_back(std::move(worker));
  }
  idle_count_ = count;
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

std::size_t Workers::start(std::shared_ptr<Work> work) {
  const auto idle = std::find_if(workers_.begin(), workers_.end(), [](const auto& worker) {
    return worker->state.load(std::memory_order_relaxed) == Worker::State::Idle;
  });
  assert(idle != workers_.end());
  (*idle)->work = std::move(work);
  (*idle)->state.store(Worker::State::Ordered, std::memory_order_release);
  (*idle)->ordered.ring();
  --idle_count_;
  return static_cast<std::size_t>(idle - workers_.begin());
}

std::optional<std::size_t> Workers::take_finished() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (workers_[i]->state.load(std::memory_order_acquire) != Worker::State::Finished) continue;
      workers_[i]->work.reset();
      workers_[i]->state.store(Worker::State::Idle, std::memory_order_relaxed);
      ++idle_count_;
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

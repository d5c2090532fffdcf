// Threads that compute, so that the thread that serves the sockets never does.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "node/groups/work.h"
#include "node/process/bell.h"

namespace palpate {

/// Each worker has one work at a time; the caller decides what comes next. A work passes to the
/// worker and back by one atomic variable, and an eventfd wakes the other side; there is no lock.
/// All members belong to the node's thread.
class Workers {
 public:
  enum class Pace { Quick, Slow };

  /// `quick_count` workers for works that somebody waits for, `slow_count` for long works, which
  /// yield the core to the others. Throws std::runtime_error if the system provides no descriptors
  /// or threads.
  explicit Workers(std::size_t quick_count, std::size_t slow_count = 0);

  /// Does not wait for a worker that still computes and cannot be interrupted: it ends by itself,
  /// together with its work.
  ~Workers();

  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  std::size_t size() const { return workers_.size(); }
  std::size_t busy_count() const { return busy_count_; }
  bool has_idle(Pace pace) const { return idle(pace).has_value(); }

  /// Gives the work to an idle worker of that pace and returns the worker's number. Needs
  /// has_idle(pace). `expected`: processor time, 0 = not known. When cores are short, shorter works
  /// go first.
  std::size_t start(std::shared_ptr<Work> work, Pace pace = Pace::Quick,
                    std::chrono::nanoseconds expected = {});

  /// Number of a worker that has finished its work, now idle; nullopt if none has.
  std::optional<std::size_t> take_finished();

  /// Readable after a work has finished. Calling take_finished() until it returns nullopt resets
  /// it.
  int finished_fd() const;

 private:
  struct Worker;

  std::optional<std::size_t> idle(Pace pace) const;

  std::shared_ptr<Bell> finished_;
  std::vector<std::shared_ptr<Worker>> workers_;  // quick workers first
  std::size_t quick_count_;
  std::size_t busy_count_ = 0;
};

}  // namespace palpate

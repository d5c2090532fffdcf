// Threads that compute, so that the one which serves the sockets never does.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "node/groups/work.h"

namespace palpate {

/// Each worker has one work at a time; who gives it out decides what comes next. A work passes to
/// the worker and back by one atomic word each way, and an eventfd wakes the other side: no lock.
/// All members belong to one thread, that of the node.
class Workers {
 public:
  enum class Pace { Quick, Slow };

  /// `quick_count` for works that somebody waits for, `slow_count` for those that take long, which
  /// give way to the others on a core. Throws std::runtime_error where the system gives no
  /// descriptors or threads.
  explicit Workers(std::size_t quick_count, std::size_t slow_count = 0);

  /// A worker that still computes cannot be interrupted and is not waited for: it ends by itself,
  /// and its work with it.
  ~Workers();

  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  std::size_t size() const { return workers_.size(); }
  std::size_t busy_count() const { return busy_count_; }
  bool has_idle(Pace pace) const { return idle(pace).has_value(); }

  /// Gives the work to an idle worker of that pace and returns its number; needs has_idle(pace).
  /// `expected` of a core's time, 0 = not known: who needs less goes first where cores are short.
  std::size_t start(std::shared_ptr<Work> work, Pace pace = Pace::Quick,
                    std::chrono::nanoseconds expected = {});

  /// A worker that has finished its work; it is idle from now on. nullopt where none has.
  std::optional<std::size_t> take_finished();

  /// Readable once a work has been finished; take_finished() until there is none empties it.
  int finished_fd() const;

 private:
  struct Bell;
  struct Worker;

  std::optional<std::size_t> idle(Pace pace) const;

  std::shared_ptr<Bell> finished_;
  std::vector<std::shared_ptr<Worker>> workers_;  // the quick ones first
  std::size_t quick_count_;
  std::size_t busy_count_ = 0;
};

}  // namespace palpate

// A long computation, to be done on another thread.
#pragma once

namespace palpate {

class Work {
 public:
  Work() = default;
  virtual ~Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Called on a worker's thread. Whatever it uses belongs to that thread until it returns.
  virtual void run() = 0;
};

}  // namespace palpate

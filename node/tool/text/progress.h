// Progress of long work: one line that is redrawn, on a terminal only.
#pragma once

#include <unistd.h>

#include <chrono>
#include <iostream>
#include <string>

namespace palpate {

class Progress {
 public:
  Progress() = default;
  ~Progress() { end(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Erases the line, to make room for the final output.
  void end() {
    if (drawn_) std::cerr << "\r\033[K" << std::flush;
    drawn_ = false;
  }

  /// Shows the line that `text()` returns. Calls it no more often than a person can read.
  template <typename Text>
  void tell(Text&& text) {
    if (!is_seen_) return;
    const auto now = std::chrono::steady_clock::now();
    if (drawn_ && now - last_ < kPeriod) return;
    last_ = now;
    drawn_ = true;
    std::cerr << "\r" << text() << "\033[K" << std::flush;
  }

 private:
  static constexpr std::chrono::milliseconds kPeriod{200};

  bool is_seen_ = ::isatty(STDERR_FILENO) == 1;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace palpate

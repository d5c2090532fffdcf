// How far long work is: one line on a terminal, drawn anew; nothing where nobody looks on.
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

  /// Takes the line away, for what is said at the end.
  void end() {
    if (drawn_) std::cerr << "\r\033[K" << std::flush;
    drawn_ = false;
  }

  /// `text()` gives the line; it is asked for no more often than a person can read.
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

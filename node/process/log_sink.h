// Log sink for standard error that never blocks.
#pragma once

#include <poll.h>
#include <spdlog/details/null_mutex.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include <climits>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// Writes a line only if the descriptor accepts it at once: a pipe that nobody reads or a stopped
/// terminal must not stop the node. Counts lost lines and reports them with the next line written.
/// Not thread-safe.
class LogSink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  explicit LogSink(int fd) : fd_(fd) {}

  std::uint64_t lost() const { return lost_; }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    std::string text;
    if (lost_ > 0) text = fmt::format("({} lines of log lost: nobody read them)\n", lost_);
    text.append(line.data(), line.size());
    if (text.size() > kMostBytes) {  // cut, but still a line
      text.resize(kMostBytes);
      text.back() = '\n';
    }
    if (write(text)) {
      lost_ = 0;
    } else {
      ++lost_;
    }
  }

  void flush_() override {}

 private:
  // A pipe that is ready accepts this many bytes without blocking.
  static constexpr std::size_t kMostBytes = PIPE_BUF;

  bool write(std::string_view text) const {
    pollfd ready{fd_, POLLOUT, 0};
    if (::poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0) return false;
    return ::write(fd_, text.data(), text.size()) > 0;
  }

  int fd_;
  std::uint64_t lost_ = 0;
};

}  // namespace palpate

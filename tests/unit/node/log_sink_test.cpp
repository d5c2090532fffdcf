// A log that nobody reads.
#include "node/process/log_sink.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/logger.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <memory>
#include <string>

namespace palpate {
namespace {

TEST(LogSink, AFullPipeLosesLinesAndSaysSoLater) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  const auto sink = std::make_shared<LogSink>(pipe[1]);
  spdlog::logger logger("test", sink);
  logger.set_pattern("%v");
  const std::string line(1000, 'x');
  for (int i = 0; i < 10'000; ++i) logger.info(line);  // ten times what a pipe holds: would block
  const std::uint64_t lost = sink->lost();
  EXPECT_GT(lost, 0U);
  std::array<char, 65536> read{};
  std::size_t lines = 0;
  const ssize_t got = ::read(pipe[0], read.data(), read.size());
  ASSERT_GT(got, 0);
  for (ssize_t i = 0; i < got; ++i) lines += read[static_cast<std::size_t>(i)] == '\n' ? 1U : 0U;
  EXPECT_EQ(lines + lost, 10'000U);
  logger.info("again");
  const ssize_t more = ::read(pipe[0], read.data(), read.size());
  ASSERT_GT(more, 0);
  EXPECT_EQ(std::string(read.data(), static_cast<std::size_t>(more)),
            fmt::format("({} lines of log lost: nobody read them)\nagain\n", lost));
  EXPECT_EQ(sink->lost(), 0U);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(LogSink, ALineLongerThanAPipeTakesAtOnceIsCutAndStaysALine) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  spdlog::logger logger("test", std::make_shared<LogSink>(pipe[1]));
  logger.set_pattern("%v");
  logger.info(std::string(2 * PIPE_BUF, 'x'));
  logger.info("next");
  std::array<char, 4 * PIPE_BUF> read{};
  const ssize_t got = ::read(pipe[0], read.data(), read.size());
  ASSERT_GT(got, 0);
  EXPECT_EQ(std::string(read.data(), static_cast<std::size_t>(got)),
            std::string(PIPE_BUF - 1, 'x') + "\nnext\n");
  ::close(pipe[0]);
  ::close(pipe[1]);
}

}  // namespace
}  // namespace palpate

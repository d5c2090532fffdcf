#include "node/gateway/spool.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::gateway {
namespace {

class SpoolTest : public ::testing::Test {
 protected:
  SpoolTest() { std::filesystem::remove_all(folder_); }
  ~SpoolTest() override { std::filesystem::remove_all(folder_); }

  std::vector<std::string> all_of(Spool& spool, bool release = true) const {
    std::vector<std::string> payloads;
    while (auto taken = spool.next()) {
      EXPECT_EQ(taken->message.topic, "contact/f/");
      payloads.push_back(taken->message.payload);
      if (release) spool.release(taken->segment);
    }
    return payloads;
  }
  std::size_t files() const {
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder_)) {
      count += file.path().extension() == ".recording";
    }
    return count;
  }

  std::string folder_ = ::testing::TempDir() + "spool_test." + std::to_string(::getpid());
  static constexpr std::uint64_t kBound = 16'000;
};

std::vector<std::string> numbers(int first, int last) {
  std::vector<std::string> all;
  for (int i = first; i < last; ++i) all.push_back(std::to_string(i));
  return all;
}

TEST_F(SpoolTest, WhatGoesInComesOutInOrderAndLeavesTheDisk) {
  Spool spool(folder_, kBound);
  for (const std::string& number : numbers(0, 100)) spool.add("contact/f/", number);
  EXPECT_EQ(spool.size(), 100U);
  EXPECT_GT(files(), 1U);
  EXPECT_EQ(all_of(spool), numbers(0, 100));
  EXPECT_TRUE(spool.empty());
  EXPECT_EQ(files(), 0U);
  EXPECT_EQ(spool.bytes(), 0U);
  // And again, while some of it is still to be released.
  for (const std::string& number : numbers(0, 5)) spool.add("contact/f/", number);
  EXPECT_EQ(all_of(spool, false), numbers(0, 5));
  spool.add("contact/f/", "5");
  EXPECT_EQ(all_of(spool), numbers(5, 6));
  EXPECT_EQ(files(), 1U);
}

TEST_F(SpoolTest, ANewProcessTakesUpWhatIsNotReleased) {
  {
    Spool spool(folder_, kBound);
    for (const std::string& number : numbers(0, 30)) spool.add("contact/f/", number);
    for (int i = 0; i < 10; ++i) (void)spool.next();  // sent, but nobody said that it is stored
  }
  Spool spool(folder_, kBound);
  EXPECT_EQ(all_of(spool), numbers(0, 30));
}

TEST_F(SpoolTest, BeyondTheBoundTheOldestGoAndAreCounted) {
  Spool spool(folder_, kBound);
  for (const std::string& number : numbers(0, 1000)) spool.add("contact/f/", number);
  EXPECT_LE(spool.bytes(), kBound);
  EXPECT_GT(spool.lost(), 0U);
  EXPECT_EQ(spool.size() + spool.lost(), 1000U);
  const std::vector<std::string> left = all_of(spool);
  EXPECT_EQ(left, numbers(1000 - static_cast<int>(left.size()), 1000));
}

TEST_F(SpoolTest, TheBoundMayTakeWhatIsBeingRead) {
  Spool spool(folder_, kBound);
  for (const std::string& number : numbers(0, 300)) spool.add("contact/f/", number);
  const auto taken = spool.next();
  ASSERT_TRUE(taken);
  for (const std::string& number : numbers(300, 1000)) spool.add("contact/f/", number);
  spool.release(taken->segment);
  const std::size_t left = all_of(spool).size();
  EXPECT_EQ(1 + left + spool.lost(), 1000U);
}

TEST_F(SpoolTest, ARecordThatIsBrokenOffIsLeftOut) {
  {
    Spool spool(folder_, kBound);
    for (const std::string& number : numbers(0, 10)) spool.add("contact/f/", number);
  }
  for (const auto& file : std::filesystem::directory_iterator(folder_)) {
    if (file.path().extension() == ".recording") {
      std::filesystem::resize_file(file.path(), file.file_size() - 3);
    }
  }
  std::ofstream(folder_ + "/0000000000000000.recording") << "no segment";
  std::ofstream(folder_ + "/stranger") << "none either";
  Spool spool(folder_, kBound);
  EXPECT_EQ(all_of(spool), numbers(0, 9));
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/stranger"));
}

TEST_F(SpoolTest, WhatIsDamagedIsCountedAsLost) {
  std::string file;
  {
    Spool spool(folder_, kBound);
    for (const std::string& number : numbers(0, 10)) spool.add("contact/f/", number);
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path().extension() == ".recording") file = entry.path().string();
    }
  }
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
    bytes.put('\xff');
  }
  Spool spool(folder_, kBound);
  EXPECT_EQ(spool.lost(), 1U);
  EXPECT_EQ(all_of(spool).size(), 9U);
  EXPECT_EQ(spool.lost(), 1U);
  EXPECT_EQ(files(), 0U);
}

TEST_F(SpoolTest, AFullDiskLeavesNoFileForEachMessage) {
  Spool spool(folder_, kBound);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{0, before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);  // then a write fails, as on a full disk
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  for (const std::string& number : numbers(0, 10)) spool.add("contact/f/", number);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(spool.lost(), 10U);
  EXPECT_FALSE(spool.error().empty());
  EXPECT_EQ(files(), 0U);
  for (const std::string& number : numbers(10, 20)) spool.add("contact/f/", number);
  EXPECT_EQ(spool.error(), "");
  EXPECT_EQ(all_of(spool), numbers(10, 20));
}

TEST_F(SpoolTest, AFullDiskIsToldWithItsReason) {
  Spool spool(folder_, kBound);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{20, before.rlim_max};  // room for a beginning, and for no message [bytes]
  std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  spool.add("contact/f/", "0");
  const std::string said = spool.error();
  spool.add_before(spool.next_segment(), "contact/f/", "1");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  for (const std::string& each : {said, spool.error()}) {
    EXPECT_TRUE(each.ends_with(": cannot be written: File too large")) << each;
  }
}

TEST_F(SpoolTest, WhatIsKeptAtTheEndComesBeforeWhatWasAddedSince) {
  {
    Spool spool(folder_, kBound);
    for (const std::string& number : numbers(0, 5)) spool.add("contact/f/", number);
    EXPECT_EQ(all_of(spool, false), numbers(0, 5));
    const std::uint64_t next = spool.next_segment();  // 5 to 9 go past the disk
    for (const std::string& number : numbers(10, 15)) spool.add("contact/f/", number);
    EXPECT_EQ(all_of(spool, false), numbers(10, 15));
    const std::uint64_t later = spool.next_segment();  // so do 15 to 19
    for (const std::string& number : numbers(5, 10)) spool.add_before(next, "contact/f/", number);
    for (const std::string& number : numbers(15, 20)) spool.add_before(later, "contact/f/", number);
  }
  Spool spool(folder_, kBound);
  EXPECT_EQ(all_of(spool), numbers(0, 20));
  spool.add("contact/f/", "20");
  EXPECT_EQ(all_of(spool), numbers(20, 21));
}

TEST_F(SpoolTest, ASecondEndKeepsToo) {
  {
    Spool spool(folder_, kBound);
    for (const std::string& number : numbers(0, 5)) {
      spool.add_before(spool.next_segment(), "contact/f/", number);
    }
  }
  {
    Spool spool(folder_, kBound);
    EXPECT_EQ(all_of(spool, false), numbers(0, 5));  // sent, but nobody said that it is stored
    for (const std::string& number : numbers(5, 10)) {
      spool.add_before(spool.next_segment(), "contact/f/", number);
    }
    EXPECT_EQ(spool.lost(), 0U);
    EXPECT_EQ(spool.error(), "");
  }
  Spool spool(folder_, kBound);
  EXPECT_EQ(all_of(spool), numbers(0, 10));
}

TEST_F(SpoolTest, WhatHasNoRoomAtTheEndIsCounted) {
  Spool spool(folder_, kBound);
  for (const std::string& number : numbers(0, 1000)) {
    spool.add_before(spool.next_segment(), "contact/f/", number);
  }
  EXPECT_LE(spool.bytes(), kBound);
  EXPECT_GT(spool.lost(), 0U);
}

TEST_F(SpoolTest, OneProcessAFolder) {
  Spool spool(folder_, kBound);
  EXPECT_THROW(Spool(folder_, kBound), std::runtime_error);
}

}  // namespace
}  // namespace palpate::gateway

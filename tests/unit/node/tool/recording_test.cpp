// Recordings: written, read, broken off, damaged.
#include "node/tool/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace palpate {
namespace {

using testing::HasSubstr;

class RecordingFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "palpate-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    path_ = folder_ + "/recording.pb";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(int count) {
    RecordingWriter writer;
    ASSERT_EQ(writer.open(path_), "");
    for (int i = 0; i < count; ++i) {
      v1::RecordedMessage message;
      message.set_received_ns(i);
      message.set_topic("contact/p/");
      message.set_payload(std::string(static_cast<std::size_t>(i) * 50, '\0') + "x");
      ASSERT_TRUE(writer.write(message));
    }
  }

  std::string folder_;
  std::string path_;
};

TEST_F(RecordingFile, ComesBackAsItWasWritten) {
  write(20);
  EXPECT_TRUE(is_recording(path_));
  const Result<Recording> read = read_recording(path_);
  ASSERT_TRUE(read.value.has_value()) << read.error;
  EXPECT_EQ(read.value->truncated_at, 0U);
  ASSERT_EQ(read.value->messages.size(), 20U);
  for (int i = 0; i < 20; ++i) {
    const v1::RecordedMessage& message = read.value->messages[static_cast<std::size_t>(i)];
    EXPECT_EQ(message.received_ns(), i);
    EXPECT_EQ(message.payload().size(), static_cast<std::size_t>(i) * 50 + 1);
  }
}

TEST_F(RecordingFile, IsNeverOverwritten) {
  write(1);
  RecordingWriter writer;
  EXPECT_THAT(writer.open(path_), HasSubstr("exists already"));
}

TEST_F(RecordingFile, BrokenOffAnywhereGivesWhatIsWhole) {
  write(5);
  const auto size = std::filesystem::file_size(path_);
  std::size_t before = 5;
  for (auto length = size; length-- > 8;) {
    std::filesystem::resize_file(path_, length);
    const Result<Recording> read = read_recording(path_);
    ASSERT_TRUE(read.value.has_value()) << read.error;
    EXPECT_LE(read.value->messages.size(), before);
    before = read.value->messages.size();
    // Either it ends between two messages, or it is said where the whole part ends.
    if (read.value->truncated_at > 0) {
      EXPECT_LT(read.value->truncated_at, length);
    }
  }
  EXPECT_EQ(before, 0U);
}

TEST_F(RecordingFile, DamageIsNamedByItsByte) {
  write(3);
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(9);
  file.put('\x07');  // a field of wire type 7, which there is none of
  file.close();
  EXPECT_THAT(read_recording(path_).error, HasSubstr("byte 9"));
}

TEST_F(RecordingFile, AnotherFileIsNoRecording) {
  std::ofstream(path_) << "probe,patch,x_m,y_m\n";
  EXPECT_FALSE(is_recording(path_));
  EXPECT_THAT(read_recording(path_).error, HasSubstr("no recording"));
  EXPECT_FALSE(read_recording(folder_ + "/absent").value.has_value());
}

}  // namespace
}  // namespace palpate

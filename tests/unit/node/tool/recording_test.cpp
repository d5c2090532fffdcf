// Recordings: written, read, broken off, damaged.
#include "node/files/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "palpate/v1/recording.pb.h"

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

  static RecordedMessage message_of(int i) {
    RecordedMessage message;
    message.received_ns = i;
    message.topic = "contact/p/";
    message.payload = std::string(static_cast<std::size_t>(i) * 50, '\0') + "x";
    return message;
  }

  void write(int count) {
    RecordingWriter writer;
    ASSERT_EQ(writer.open(path_), "");
    for (int i = 0; i < count; ++i) ASSERT_EQ(writer.write(message_of(i)), "");
  }

  struct Read {
    std::string error;
    std::vector<RecordedMessage> messages;
    std::uint64_t damaged = 0;
    std::uint64_t skipped_bytes = 0;
    bool breaks_off = false;
  };

  Read read() const {
    RecordingReader reader;
    Read read;
    read.error = reader.open(path_);
    if (!read.error.empty()) return read;
    for (RecordedMessage message; reader.next(message);) read.messages.push_back(message);
    read.damaged = reader.damaged();
    read.skipped_bytes = reader.skipped_bytes();
    read.breaks_off = reader.breaks_off();
    return read;
  }

  std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  void put(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }

  std::string folder_;
  std::string path_;
};

void expect_equal(const RecordedMessage& a, const RecordedMessage& b) {
  EXPECT_EQ(a.received_ns, b.received_ns);
  EXPECT_EQ(a.frame_count, b.frame_count);
  EXPECT_EQ(a.topic, b.topic);
  EXPECT_EQ(a.payload, b.payload);
}

TEST_F(RecordingFile, ComesBackAsItWasWritten) {
  write(20);
  EXPECT_TRUE(is_recording(path_));
  const Read back = read();
  ASSERT_EQ(back.error, "");
  EXPECT_EQ(back.damaged, 0U);
  EXPECT_FALSE(back.breaks_off);
  ASSERT_EQ(back.messages.size(), 20U);
  for (int i = 0; i < 20; ++i)
    expect_equal(back.messages[static_cast<std::size_t>(i)], message_of(i));
}

TEST_F(RecordingFile, KeepsAnyBytesAsTheyCame) {
  RecordedMessage message;
  message.received_ns = std::numeric_limits<std::int64_t>::min();
  message.frame_count = 7;
  message.topic = "contact/\xff\xfe/\xA7rec";  // no UTF-8, and a mark of records within
  message.payload = std::string("\0\xA7rec\xA7rec", 9);
  {
    RecordingWriter writer;
    ASSERT_EQ(writer.open(path_), "");
    ASSERT_EQ(writer.write(message), "");
    ASSERT_EQ(writer.write(message_of(3)), "");
  }
  const Read back = read();
  ASSERT_EQ(back.messages.size(), 2U);
  expect_equal(back.messages[0], message);
  expect_equal(back.messages[1], message_of(3));
}

TEST_F(RecordingFile, NoFlippedBitPassesAndNoOtherMessageIsLost) {
  write(4);
  const std::string good = bytes();
  for (std::size_t at = 8; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << (at % 8)));
    put(bad);
    const Read back = read();
    ASSERT_EQ(back.messages.size(), 3U) << "byte " << at;
    EXPECT_TRUE(back.damaged == 1 || back.breaks_off) << "byte " << at;
    int expected = 0;
    for (const RecordedMessage& message : back.messages) {
      if (message.received_ns != expected) ++expected;  // the damaged one
      expect_equal(message, message_of(expected++));
    }
  }
}

TEST_F(RecordingFile, TheFormerFormatIsRead) {
  std::string former = "palpate1";
  for (int i = 0; i < 3; ++i) {
    v1::RecordedMessage message;
    message.set_received_ns(i);
    message.set_topic(i == 1 ? "contact/\xff/" : "contact/p/");
    message.set_payload("x");
    const std::string body = message.SerializeAsString();
    former += static_cast<char>(body.size());
    former += body;
  }
  put(former);
  EXPECT_TRUE(is_recording(path_));
  Read back = read();
  ASSERT_EQ(back.messages.size(), 3U);
  EXPECT_EQ(back.messages[1].topic, "contact/\xff/");
  // Its lengths are all there is to go by: a message that is none is left out.
  former[9] = '\x07';  // a field of wire type 7, which there is none of
  put(former);
  back = read();
  EXPECT_EQ(back.messages.size(), 2U);
  EXPECT_EQ(back.damaged, 1U);
  put(former.substr(0, former.size() - 1));
  EXPECT_TRUE(read().breaks_off);
}

TEST_F(RecordingFile, AFileBeyondTwoGibibytesIsRead) {
  write(1);
  constexpr std::uintmax_t kFar = std::uintmax_t{5}
                                  << 29U;  // of zeros that take no room on the disk
  const std::string record = bytes().substr(8);
  std::filesystem::resize_file(path_, kFar);
  std::ofstream(path_, std::ios::binary | std::ios::app) << record;
  const Read back = read();
  ASSERT_EQ(back.messages.size(), 2U);
  expect_equal(back.messages[1], message_of(0));
  EXPECT_EQ(back.damaged, 1U);
  EXPECT_GT(back.skipped_bytes, std::uint64_t{1} << 31U);
}

TEST_F(RecordingFile, IsNeverOverwritten) {
  write(1);
  RecordingWriter writer;
  EXPECT_THAT(writer.open(path_), HasSubstr("exists already"));
}

TEST_F(RecordingFile, BrokenOffAnywhereGivesWhatIsWhole) {
  write(5);
  const auto size = std::filesystem::file_size(path_);
  std::set<std::uintmax_t> ends{8};  // of whole messages: each after a header of 28 bytes
  for (int i = 0; i < 5; ++i) {
    ends.insert(*ends.rbegin() + 28 + message_of(i).topic.size() + message_of(i).payload.size());
  }
  std::size_t before = 5;
  for (auto length = size; length-- > 8;) {
    std::filesystem::resize_file(path_, length);
    const Read back = read();
    ASSERT_EQ(back.error, "");
    EXPECT_LE(back.messages.size(), before);
    EXPECT_EQ(back.damaged, 0U);
    // Either it ends between two messages, or it is said that it does not.
    EXPECT_EQ(back.breaks_off, !ends.contains(length)) << length;
    before = back.messages.size();
  }
  EXPECT_EQ(before, 0U);
}

TEST_F(RecordingFile, AnotherFileIsNoRecording) {
  std::ofstream(path_) << "probe,patch,x_m,y_m\n";
  EXPECT_FALSE(is_recording(path_));
  EXPECT_THAT(read().error, HasSubstr("no recording"));
  EXPECT_NE(RecordingReader().open(folder_ + "/absent"), "");
}

}  // namespace
}  // namespace palpate

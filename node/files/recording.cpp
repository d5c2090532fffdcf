#include "node/files/recording.h"

#include <google/protobuf/io/coded_stream.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "node/files/written_file.h"
#include "palpate/v1/recording.pb.h"

namespace palpate {
namespace {

constexpr std::string_view kMark = "\xA7rec";
// Layout of a record: mark, received_ns, frame_count, topic size, payload size, checksum.
constexpr std::size_t kTimeAt = kMark.size();
constexpr std::size_t kFramesAt = kTimeAt + 8;
constexpr std::size_t kTopicAt = kFramesAt + 4;
constexpr std::size_t kPayloadAt = kTopicAt + 4;
constexpr std::size_t kChecksumAt = kPayloadAt + 4;
constexpr std::size_t kHeaderBytes = kChecksumAt + 4;
constexpr std::size_t kReadBytes = 64 * 1024;
// Former format: longest message including tags and lengths of its fields.
constexpr std::size_t kMostFormerBytes = kMostRecordBytes + 64;
constexpr std::size_t kLongestVarint = 10;

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFFU);
}

std::uint64_t get(std::string_view in, std::size_t at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(in[at + static_cast<std::size_t>(i)])}
             << (8 * i);
  }
  return value;
}

/// Checksum of the header (without mark and checksum) and of what follows it.
std::uint32_t checksum(std::string_view header, std::string_view body) {
  const auto bytes = [](std::string_view text) {
    return reinterpret_cast<const Bytef*>(text.data());
  };
  const std::string_view fields = header.substr(kTimeAt, kChecksumAt - kTimeAt);
  uLong crc = ::crc32(0, bytes(fields), static_cast<uInt>(fields.size()));
  if (!body.empty()) crc = ::crc32(crc, bytes(body), static_cast<uInt>(body.size()));
  return static_cast<std::uint32_t>(crc);
}

}  // namespace

std::string RecordingWriter::open(const std::string& path) {
  if (std::filesystem::exists(path)) {
    return path + ": exists already";
  }
  path_ = path;
  file_.open(path, std::ios::binary | std::ios::trunc);
  if (!file_) return path + ": " + std::strerror(errno);
  if (!(file_ << kRecordingMagic << std::flush)) {
    std::string why = path + ": " + std::strerror(errno);
    file_.close();
    // A file without a beginning is no recording, and would be in the way of the next attempt.
    std::error_code failed;
    std::filesystem::remove(path, failed);
    return why;
  }
  return {};
}

std::string RecordingWriter::write(const RecordedMessage& message) {
  buffer_ = kMark;
  put(buffer_, static_cast<std::uint64_t>(message.received_ns), 8);
  put(buffer_, message.frame_count, 4);
  put(buffer_, message.topic.size(), 4);
  put(buffer_, message.payload.size(), 4);
  const std::string body = message.topic + message.payload;
  put(buffer_, checksum(buffer_ + std::string(4, '\0'), body), 4);
  buffer_ += body;
  errno = 0;
  file_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size())).flush();
  return file_ ? std::string() : cannot_be_written(path_);
}

bool is_recording(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kRecordingMagic.size()> start{};
  file.read(start.data(), start.size());
  const std::string_view magic(start.data(), start.size());
  return file && (magic == kRecordingMagic || magic == kFormerRecordingMagic);
}

std::string RecordingReader::open(const std::string& path) {
  file_.open(path, std::ios::binary);
  if (!file_) return path + ": " + std::strerror(errno);
  if (!fill(kRecordingMagic.size()) ||
      (!rest().starts_with(kRecordingMagic) && !rest().starts_with(kFormerRecordingMagic))) {
    return path + ": no recording: it does not begin with \"palpate2\" or \"palpate1\"";
  }
  former_ = rest().starts_with(kFormerRecordingMagic);
  consume(kRecordingMagic.size());
  return {};
}

/// Reads until `bytes` bytes are available. Returns false if the file has fewer; all that it has
/// are then available.
bool RecordingReader::fill(std::size_t bytes) {
  while (rest().size() < bytes && file_) {
    if (at_ > kReadBytes) {
      buffer_.erase(0, at_);
      at_ = 0;
    }
    const std::size_t length = buffer_.size();
    buffer_.resize(length + std::max(kReadBytes, bytes - rest().size()));
    file_.read(buffer_.data() + length, static_cast<std::streamsize>(buffer_.size() - length));
    buffer_.resize(length + static_cast<std::size_t>(file_.gcount()));
  }
  return rest().size() >= bytes;
}

void RecordingReader::consume(std::size_t bytes) {
  at_ += bytes;
  in_damage_ = false;
}

void RecordingReader::skip(std::size_t bytes) {
  if (!in_damage_) ++damaged_;
  at_ += bytes;
  in_damage_ = true;
  skipped_bytes_ += bytes;
}

bool RecordingReader::next(RecordedMessage& message) {
  const bool found = former_ ? next_former(message) : next_checked(message);
  if (found) ++messages_;
  return found;
}

bool RecordingReader::next_checked(RecordedMessage& message) {
  while (fill(1)) {
    const bool whole_header = fill(kHeaderBytes);
    const std::string_view start = rest();
    if (!start.starts_with(kMark.substr(0, start.size()))) {
      // Skip to the next mark, or to where one may begin.
      const std::size_t mark = start.find(kMark.front(), 1);
      skip(std::min(mark, start.size()));
      continue;
    }
    if (whole_header) {
      const std::size_t topic_size = get(start, kTopicAt, 4);
      const std::size_t payload_size = get(start, kPayloadAt, 4);
      if (topic_size + payload_size > kMostRecordBytes) {
        skip(1);
        continue;
      }
      if (fill(kHeaderBytes + topic_size + payload_size)) {
        const std::string_view header = rest().substr(0, kHeaderBytes);
        const std::string_view body = rest().substr(kHeaderBytes, topic_size + payload_size);
        if (checksum(header, body) != get(header, kChecksumAt, 4)) {
          skip(1);
          continue;
        }
        message.received_ns = static_cast<std::int64_t>(get(header, kTimeAt, 8));
        message.frame_count = static_cast<std::uint32_t>(get(header, kFramesAt, 4));
        message.topic = body.substr(0, topic_size);
        message.payload = body.substr(topic_size);
        consume(kHeaderBytes + body.size());
        return true;
      }
    }
    // Either the file is incomplete here, or a length is damaged and intact records follow.
    if (rest().find(kMark, 1) == std::string_view::npos) {
      breaks_off_ = true;
      return false;
    }
    skip(1);
  }
  return false;
}

bool RecordingReader::next_former(RecordedMessage& message) {
  while (fill(1)) {
    fill(kLongestVarint);
    const auto here = std::min(rest().size(), kLongestVarint);
    google::protobuf::io::CodedInputStream coded(
        reinterpret_cast<const std::uint8_t*>(rest().data()), static_cast<int>(here));
    std::uint64_t length = 0;
    const bool has_length = coded.ReadVarint64(&length);
    const auto begin = static_cast<std::size_t>(coded.CurrentPosition());
    if ((!has_length && here < kLongestVarint) ||
        (has_length && length <= kMostFormerBytes && !fill(begin + length))) {
      breaks_off_ = true;
      return false;
    }
    if (!has_length || length > kMostFormerBytes) {
      // The start of the next message is unknown.
      while (fill(1)) skip(rest().size());
      return false;
    }
    v1::RecordedMessage recorded;
    if (!recorded.ParseFromArray(rest().data() + begin, static_cast<int>(length))) {
      skip(begin + length);
      continue;
    }
    message.received_ns = recorded.received_ns();
    message.frame_count = 2;
    message.topic = std::move(*recorded.mutable_topic());
    message.payload = std::move(*recorded.mutable_payload());
    consume(begin + length);
    return true;
  }
  return false;
}

}  // namespace palpate

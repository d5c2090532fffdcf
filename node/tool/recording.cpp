#include "node/tool/recording.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>

namespace palpate {
namespace {

constexpr std::string_view kMagic = "palpate1";

}  // namespace

std::string RecordingWriter::open(const std::string& path) {
  if (std::filesystem::exists(path)) {
    return path + ": exists already";
  }
  file_.open(path, std::ios::binary | std::ios::trunc);
  if (!file_ || !(file_ << kMagic << std::flush)) {
    return path + ": " + std::strerror(errno);
  }
  return {};
}

bool RecordingWriter::write(const v1::RecordedMessage& message) {
  buffer_.clear();
  {
    google::protobuf::io::StringOutputStream stream(&buffer_);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.WriteVarint64(message.ByteSizeLong());
    message.SerializeWithCachedSizes(&coded);
  }
  return static_cast<bool>(file_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))
                               .flush());
}

bool is_recording(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kMagic.size()> start{};
  file.read(start.data(), start.size());
  return file && std::string_view(start.data(), start.size()) == kMagic;
}

Result<Recording> read_recording(const std::string& path) {
  using Read = Result<Recording>;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Read::fail(path + ": " + std::strerror(errno));
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (!std::string_view(text).starts_with(kMagic)) {
    return Read::fail(path + ": no recording: it does not begin with \"palpate1\"");
  }
  if (text.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return Read::fail(path + ": longer than 2 GiB");
  }
  Recording recording;
  std::size_t at = kMagic.size();
  while (at < text.size()) {
    google::protobuf::io::CodedInputStream coded(
        reinterpret_cast<const std::uint8_t*>(text.data()) + at, static_cast<int>(text.size() - at));
    std::uint64_t length = 0;
    constexpr std::size_t kLongestVarint = 10;
    if (!coded.ReadVarint64(&length)) {
      if (text.size() - at < kLongestVarint) {
        recording.truncated_at = at;
        break;
      }
      return Read::fail(path + ": byte " + std::to_string(at) + ": no length of a message");
    }
    const std::size_t begin = at + static_cast<std::size_t>(coded.CurrentPosition());
    if (length > text.size() - begin) {
      recording.truncated_at = at;
      break;
    }
    v1::RecordedMessage message;
    if (!message.ParseFromArray(text.data() + begin, static_cast<int>(length))) {
      return Read::fail(path + ": byte " + std::to_string(begin) + ": no recorded message");
    }
    recording.messages.push_back(std::move(message));
    at = begin + static_cast<std::size_t>(length);
  }
  return Read::ok(std::move(recording));
}

}  // namespace palpate

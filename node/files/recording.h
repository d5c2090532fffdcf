// Recordings: messages in a file, written and read one at a time, so that a file may have any
// length.
//
// The file begins with the eight bytes "palpate2". Records follow. A record is the four bytes
// "\xA7rec"; then, little-endian, received_ns (8 bytes), the number of frames, the lengths of topic
// and payload in bytes, and the CRC-32 of these fields and of what follows (4 bytes each); then
// topic and payload as they came. Files of the former format ("palpate1": protobuf's
// RecordedMessage, each after its length) can be read too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "node/files/result.h"

namespace palpate {

/// What a recording begins with, in this format and in the former one.
inline constexpr std::string_view kRecordingMagic = "palpate2";
inline constexpr std::string_view kFormerRecordingMagic = "palpate1";

/// A message as it came; it may be malformed.
struct RecordedMessage {
  std::int64_t received_ns = 0;  ///< Unix time at the recorder; never decreases
  /// 2 = topic and payload. Of any other number, at most the first two frames are kept.
  std::uint32_t frame_count = 2;
  std::string topic;
  std::string payload;
};

/// Longest topic plus payload that is recorded or accepted on reading. [bytes]
inline constexpr std::size_t kMostRecordBytes = std::size_t{16} << 20;

/// Appends messages to a file. If the process is killed, at most the message being written is lost.
class RecordingWriter {
 public:
  /// Creates a new file; never overwrites one. Returns an empty string, or an error and leaves no
  /// file.
  std::string open(const std::string& path);

  /// Returns an empty string, or why the file cannot be written.
  std::string write(const RecordedMessage& message);

 private:
  std::string path_;
  std::ofstream file_;
  std::string buffer_;
};

class RecordingReader {
 public:
  /// Returns an empty string or an error.
  std::string open(const std::string& path);

  /// Reads the next intact message; returns false at the end. Skips and counts damage: a record
  /// with a wrong checksum, and all bytes up to the next intact one. The former format has no
  /// checksums: there, a message that cannot be parsed is skipped, and an impossible length ends
  /// the file.
  bool next(RecordedMessage& message);

  std::uint64_t messages() const { return messages_; }  ///< returned
  std::uint64_t damaged() const { return damaged_; }    ///< places where bytes were skipped
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }  ///< total
  bool breaks_off() const { return breaks_off_; }  ///< the last message is incomplete

 private:
  bool next_checked(RecordedMessage& message);
  bool next_former(RecordedMessage& message);
  bool fill(std::size_t bytes);
  void consume(std::size_t bytes);
  void skip(std::size_t bytes);
  std::string_view rest() const { return std::string_view(buffer_).substr(at_); }

  std::ifstream file_;
  std::string buffer_;  // bytes read; those from at_ on are not consumed
  std::size_t at_ = 0;
  bool former_ = false;
  bool in_damage_ = false;
  std::uint64_t messages_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint64_t skipped_bytes_ = 0;
  bool breaks_off_ = false;
};

/// True if the file begins like a recording.
bool is_recording(const std::string& path);

}  // namespace palpate

// Recorded messages in a file, written and read one by one: of any length.
//
// The file begins with the eight bytes "palpate2". Each record follows: the four bytes "\xA7rec",
// then little-endian received_ns (8 bytes), number of frames, bytes of topic and of payload, CRC-32
// of all that and of what follows (4 bytes each), then topic and payload as they came. Files of the
// former format ("palpate1": protobuf's RecordedMessage after its length) are read too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "node/files/result.h"

namespace palpate {

/// A message as it came, whatever it is.
struct RecordedMessage {
  std::int64_t received_ns = 0;   ///< Unix time at the recorder, by a clock that never steps back
  std::uint32_t frame_count = 2;  ///< 2 = topic and payload; of others, the first two are kept
  std::string topic;
  std::string payload;
};

/// Longest topic and payload together that are recorded or believed. [bytes]
inline constexpr std::size_t kMostRecordBytes = std::size_t{16} << 20;

/// Appends messages; what has been written survives a kill, but for the message being written.
class RecordingWriter {
 public:
  /// Makes a new file; never overwrites. Returns an empty string, or what went wrong.
  std::string open(const std::string& path);

  /// False where it cannot be written.
  bool write(const RecordedMessage& message);

 private:
  std::ofstream file_;
  std::string buffer_;
};

class RecordingReader {
 public:
  /// Returns an empty string, or what went wrong.
  std::string open(const std::string& path);

  /// The next whole message; false at the end. What is damaged is skipped and counted: a record
  /// whose checksum is wrong, and all up to the next whole one. In the former format, which has no
  /// checksums, a message that is none is skipped, and a length that is none ends the file.
  bool next(RecordedMessage& message);

  std::uint64_t messages() const { return messages_; }  ///< given out
  std::uint64_t damaged() const { return damaged_; }    ///< places where bytes were skipped
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }  ///< in all of them
  bool breaks_off() const { return breaks_off_; }                 ///< the last message is not whole

 private:
  bool next_checked(RecordedMessage& message);
  bool next_former(RecordedMessage& message);
  bool fill(std::size_t bytes);
  void consume(std::size_t bytes);
  void skip(std::size_t bytes);
  std::string_view rest() const { return std::string_view(buffer_).substr(at_); }

  std::ifstream file_;
  std::string buffer_;  // read but not yet consumed, from at_ on
  std::size_t at_ = 0;
  bool former_ = false;
  bool in_damage_ = false;
  std::uint64_t messages_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint64_t skipped_bytes_ = 0;
  bool breaks_off_ = false;
};

/// Whether the file begins like a recording.
bool is_recording(const std::string& path);

}  // namespace palpate

// Recorded messages in a file: eight bytes "palpate1", then RecordedMessages, each after its length.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "node/result.h"
#include "palpate/v1/recording.pb.h"

namespace palpate {

/// Appends messages; what has been written survives a kill, but for the message being written.
class RecordingWriter {
 public:
  /// Makes a new file; never overwrites. Returns an empty string, or what went wrong.
  std::string open(const std::string& path);

  /// False where it cannot be written.
  bool write(const v1::RecordedMessage& message);

 private:
  std::ofstream file_;
  std::string buffer_;
};

/// All messages of a file. A file that breaks off within a message (or whose message claims to be longer
/// than the rest: the two look alike) gives those before it, and `truncated_at` the byte where the whole
/// part ends; any other damage is an error that names the byte.
struct Recording {
  std::vector<v1::RecordedMessage> messages;
  std::uint64_t truncated_at = 0;  ///< 0 = whole
};
Result<Recording> read_recording(const std::string& path);

/// Whether the file begins like a recording.
bool is_recording(const std::string& path);

}  // namespace palpate

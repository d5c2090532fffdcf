// Messages kept on disk while the plant cannot be reached.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "node/files/recording.h"
#include "node/wire/path_lock.h"

namespace palpate::gateway {

/// A first-in first-out queue that survives a kill of the process (not a loss of power: nothing is
/// synced). It is a folder of recordings, each at most a sixteenth of the bound, which `palpate
/// replay` can read too. A recording is written, then read, and deleted when everything read from
/// it has been released. Beyond the bound the oldest recording is deleted and counted.
class Spool {
 public:
  /// Continues with what an earlier process has left in `folder`; creates it if necessary. Throws
  /// std::runtime_error if the folder cannot be used or another process uses it.
  Spool(const std::string& folder, std::uint64_t most_bytes);

  /// True if nothing is unread.
  bool empty() const { return unread_ == 0; }

  void add(std::string_view topic, std::string_view payload);

  /// The number of the segment that the next message begins if it begins one. Messages that are not
  /// added now come before it.
  std::uint64_t next_segment() const { return next_number_; }

  /// Adds a message that came when next_segment() was `next_segment`, before all that were added
  /// since. For the end of a process: the message is not read by this one. Within one number, in
  /// the order of the calls; numbers must not decrease.
  void add_before(std::uint64_t next_segment, std::string_view topic, std::string_view payload);

  struct Taken {
    std::uint64_t segment = 0;
    RecordedMessage message;
  };
  /// Reads the oldest unread message; nullopt if there is none.
  std::optional<Taken> next();

  /// A message of that segment is done.
  void release(std::uint64_t segment);

  std::uint64_t size() const { return unread_; }
  std::uint64_t bytes() const { return bytes_; }
  /// Messages lost because of the bound, because the disk could not be written, or in places of an
  /// earlier process's files that are damaged, each for one.
  std::uint64_t lost() const { return lost_; }
  /// The last error of the disk; empty if there was none.
  const std::string& error() const { return error_; }

 private:
  struct Segment {
    std::uint64_t messages = 0;  ///< unread
    std::uint64_t bytes = 0;
    std::uint64_t unreleased = 0;
    bool is_closed = false;
    bool is_read = false;  ///< to its end
  };

  std::string path_of(std::uint64_t segment) const;
  void take_up(const std::string& file);
  bool begin_segment();
  void drop_oldest();
  void remove_where_done(std::uint64_t segment);
  /// Writes a message. One that is not is counted as lost, and the writer is closed.
  bool write_or_lose(std::optional<RecordingWriter>& writer, std::string_view topic,
                     std::string_view payload);

  std::string folder_;
  std::uint64_t most_bytes_;
  PathLock lock_;
  std::map<std::uint64_t, Segment> segments_;  ///< by number, oldest first
  std::optional<RecordingWriter> writer_;      ///< of the last segment, unless it is closed
  std::optional<RecordingReader> reader_;
  std::uint64_t read_segment_ = 0;
  std::uint64_t next_number_ = 2;               ///< even; add_before() uses the odd ones
  std::optional<RecordingWriter> kept_writer_;  ///< of add_before()
  std::uint64_t kept_number_ = 0;
  std::uint64_t unread_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t lost_ = 0;
  std::string error_;
};

}  // namespace palpate::gateway

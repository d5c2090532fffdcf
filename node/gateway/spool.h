// Messages on disk while the plant is away.
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

/// First in, first out, over a kill of the process too (not over a loss of power: nothing is
/// synced). A folder of recordings, each of at most a sixteenth of the bound, which `palpate
/// replay` reads as well. One is first written and then read, and deleted when all that was read of
/// it has been released. Beyond the bound the oldest one goes, counted.
class Spool {
 public:
  /// Takes up what a former process has left in `folder`, which is made where it is not. Throws
  /// std::runtime_error where it cannot be used, or another process uses it.
  Spool(const std::string& folder, std::uint64_t most_bytes);

  /// Nothing to be read.
  bool empty() const { return unread_ == 0; }

  void add(std::string_view topic, std::string_view payload);

  struct Taken {
    std::uint64_t segment = 0;
    RecordedMessage message;
  };
  /// The oldest that has not been read; nullopt where there is none.
  std::optional<Taken> next();

  /// A message taken from there is done with.
  void release(std::uint64_t segment);

  std::uint64_t size() const { return unread_; }
  std::uint64_t bytes() const { return bytes_; }
  /// Messages that the bound, or a disk that cannot be written, has cost.
  std::uint64_t lost() const { return lost_; }
  /// What last went wrong with the disk; empty where nothing did.
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

  std::string folder_;
  std::uint64_t most_bytes_;
  PathLock lock_;
  std::map<std::uint64_t, Segment> segments_;  ///< by number, oldest first
  std::optional<RecordingWriter> writer_;      ///< of the last segment, where it is not closed
  std::optional<RecordingReader> reader_;
  std::uint64_t read_segment_ = 0;
  std::uint64_t next_number_ = 1;
  std::uint64_t unread_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t lost_ = 0;
  std::string error_;
};

}  // namespace palpate::gateway

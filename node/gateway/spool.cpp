#include "node/gateway/spool.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/process/clock.h"

namespace palpate::gateway {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSegments = 16;
constexpr std::string_view kEnding = ".recording";
// Bytes of a record besides topic and payload; see node/files/recording.h.
constexpr std::uint64_t kRecordBytes = 28;

}  // namespace

Spool::Spool(const std::string& folder, std::uint64_t most_bytes)
    : folder_(folder), most_bytes_(most_bytes) {
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) throw std::runtime_error(folder_ + ": " + failed.message());
  Result<PathLock> lock = PathLock::acquire(folder_ + "/spool");
  if (!lock) throw std::runtime_error(lock.error);
  lock_ = std::move(*lock.value);
  fs::directory_iterator files(folder_, failed);
  if (failed) throw std::runtime_error(folder_ + ": " + failed.message());
  for (const fs::directory_entry& file : files) take_up(file.path().string());
  while (bytes_ > most_bytes_) drop_oldest();
}

std::string Spool::path_of(std::uint64_t segment) const {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "/%016llu", static_cast<unsigned long long>(segment));
  return folder_ + name.data() + std::string(kEnding);
}

/// Takes over a segment of an earlier process. Reads it once to its end to count its messages.
void Spool::take_up(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  std::uint64_t number = 0;
  const auto parsed = std::from_chars(name.data(), name.data() + name.size(), number);
  if (parsed.ec != std::errc() || number == 0 || path_of(number) != file) return;
  Segment segment;
  segment.is_closed = true;
  RecordingReader reader;
  if (reader.open(file).empty()) {
    RecordedMessage message;
    while (reader.next(message)) ++segment.messages;
  }
  // How many messages were there nobody can tell.
  if (const std::uint64_t at_least = reader.damaged() + (reader.breaks_off() ? 1 : 0);
      at_least > 0) {
    lost_ += at_least;
    spdlog::error("{}: damaged in {} places, {} bytes skipped{}: at least {} messages lost", file,
                  reader.damaged(), reader.skipped_bytes(),
                  reader.breaks_off() ? ", breaks off" : "", at_least);
  }
  std::error_code failed;
  segment.bytes = fs::file_size(file, failed);
  if (failed) return;
  // Two above an odd number, so that add_before() does not need the same file again.
  next_number_ = std::max(next_number_, ((number + 1) / 2 + 1) * 2);
  unread_ += segment.messages;
  bytes_ += segment.bytes;
  segments_[number] = segment;
  if (segment.messages == 0) {
    segments_[number].is_read = true;
    remove_where_done(number);
  }
}

bool Spool::begin_segment() {
  if (writer_) return true;
  const std::uint64_t number = next_number_;
  writer_.emplace();
  if (const std::string why = writer_->open(path_of(number)); !why.empty()) {
    error_ = why;
    writer_.reset();
    // Otherwise the number is used again: the disk may be full for long.
    std::error_code failed;
    if (fs::exists(path_of(number), failed)) next_number_ += 2;
    return false;
  }
  next_number_ += 2;
  segments_[number] = {};
  return true;
}

bool Spool::write_or_lose(std::optional<RecordingWriter>& writer, std::string_view topic,
                          std::string_view payload) {
  const std::string why =
      writer->write({unix_time_ns(), 2, std::string(topic), std::string(payload)});
  if (why.empty()) return true;
  error_ = why;
  ++lost_;
  writer.reset();
  return false;
}

void Spool::add_before(std::uint64_t next_segment, std::string_view topic,
                       std::string_view payload) {
  const std::uint64_t size = kRecordBytes + topic.size() + payload.size();
  const std::uint64_t number = next_segment - 1;
  if (number != kept_number_) {
    kept_number_ = number;
    kept_writer_.emplace();
    if (const std::string why = kept_writer_->open(path_of(number)); !why.empty()) {
      error_ = why;
      kept_writer_.reset();
    }
  }
  // The oldest are what the bound takes.
  const bool has_room = bytes_ + size <= most_bytes_;
  if (!kept_writer_ || !has_room) {
    ++lost_;
    return;
  }
  if (write_or_lose(kept_writer_, topic, payload)) bytes_ += size;
}

void Spool::add(std::string_view topic, std::string_view payload) {
  const std::uint64_t size = kRecordBytes + topic.size() + payload.size();
  if (writer_ && segments_.rbegin()->second.bytes + size > most_bytes_ / kSegments) {
    segments_.rbegin()->second.is_closed = true;
    writer_.reset();
  }
  while (bytes_ + size > most_bytes_ && !segments_.empty()) drop_oldest();
  if (!begin_segment()) {
    ++lost_;
    return;
  }
  if (!write_or_lose(writer_, topic, payload)) {
    // The part of the record on disk ends this file; the next record gets a new file.
    segments_.rbegin()->second.is_closed = true;
    return;
  }
  error_.clear();
  Segment& segment = segments_.rbegin()->second;
  ++segment.messages;
  segment.bytes += size;
  ++unread_;
  bytes_ += size;
}

std::optional<Spool::Taken> Spool::next() {
  while (unread_ > 0) {
    if (!reader_) {
      const auto oldest = std::find_if(segments_.begin(), segments_.end(),
                                       [](const auto& s) { return !s.second.is_read; });
      if (oldest == segments_.end()) break;
      if (!oldest->second.is_closed) {
        oldest->second.is_closed = true;
        writer_.reset();
      }
      read_segment_ = oldest->first;
      reader_.emplace();
      if (const std::string why = reader_->open(path_of(read_segment_)); !why.empty()) error_ = why;
    }
    Segment& segment = segments_[read_segment_];
    Taken taken;
    taken.segment = read_segment_;
    if (segment.messages > 0 && reader_->next(taken.message)) {
      --segment.messages;
      ++segment.unreleased;
      --unread_;
      return taken;
    }
    // The rest is damaged.
    lost_ += segment.messages;
    unread_ -= segment.messages;
    segment.messages = 0;
    segment.is_read = true;
    reader_.reset();
    remove_where_done(read_segment_);
  }
  // All is read: the last segment is deleted after its last release.
  if (reader_) {
    segments_[read_segment_].is_read = true;
    reader_.reset();
    remove_where_done(read_segment_);
  }
  return std::nullopt;
}

void Spool::release(std::uint64_t number) {
  const auto segment = segments_.find(number);
  if (segment == segments_.end()) return;  // deleted already, because of the bound
  --segment->second.unreleased;
  remove_where_done(number);
}

void Spool::remove_where_done(std::uint64_t number) {
  const auto segment = segments_.find(number);
  if (segment == segments_.end() || !segment->second.is_read || segment->second.unreleased > 0) {
    return;
  }
  bytes_ -= segment->second.bytes;
  segments_.erase(segment);
  std::error_code failed;
  fs::remove(path_of(number), failed);
}

void Spool::drop_oldest() {
  const auto oldest = segments_.begin();
  const std::uint64_t number = oldest->first;
  if (reader_ && read_segment_ == number) reader_.reset();
  if (!oldest->second.is_closed) writer_.reset();
  lost_ += oldest->second.messages;
  unread_ -= oldest->second.messages;
  bytes_ -= oldest->second.bytes;
  segments_.erase(oldest);
  std::error_code failed;
  fs::remove(path_of(number), failed);
}

}  // namespace palpate::gateway

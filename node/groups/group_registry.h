// The groups in memory and their waiting messages, never more than bounds, and whose turn it is to
// be recognised.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "node/groups/group.h"

namespace palpate {

struct GroupBounds {
  std::size_t max_groups = 64;
  std::size_t max_groups_per_probe = 8;  ///< that it has opened
  /// Memory of the messages that wait for recognition, of all groups together. [bytes]
  std::size_t max_waiting_bytes = std::size_t{32} << 20;
  /// Who is silent for longer may be forgotten to make room for another.
  std::chrono::duration<double> evict_idle{10.0};
};

class GroupRegistry {
 public:
  GroupRegistry(const GroupBounds& bounds, const RecognizerOptions& recognizer,
                const GroupOptions& options)
      : bounds_(bounds), recognizer_options_(recognizer), group_options_(options) {}

  Group* find(std::string_view name);

  /// True where add() would find room for a group that this probe opens.
  bool has_room(std::string_view probe, SteadyTime now) const {
    return place_for(probe, now).has_value();
  }

  /// Adds an unknown group on a free place or, where there is none, on that of the one idle for
  /// longest, if that is long enough. A probe that has opened as many as it may loses the oldest of
  /// them that it touches alone: a flood of invented names costs nobody else a place. The name of
  /// who goes is put into `evicted`. Needs has_room().
  Group& add(std::string_view name, std::string_view probe, SteadyTime now, std::string& evicted);

  /// Whether so much more may wait for the group (nullptr: a new one). Nobody may hold more than is
  /// left to all others: who has had no answer yet always finds room.
  bool has_room_to_wait(const Group* group, std::size_t bytes) const {
    const std::size_t left =
        bounds_.max_waiting_bytes - std::min(bounds_.max_waiting_bytes, queued_bytes_);
    return (group == nullptr ? 0 : group->queued_bytes()) + bytes <= left;
  }

  /// Takes a message for the group: it waits for its turn.
  void take(Group& group, const ContactMessage& message, Continuity continuity, SteadyTime now);

  /// The waiting group that has had the least computing time so far, nullptr where none waits. So
  /// a group that asks for little is served at once, however many others keep the recognizer busy.
  /// `only_quick`: of those that are quick.
  Group* next_waiting(bool only_quick = false);

  /// Gives the group to a worker: it is no more waiting, until more comes.
  std::shared_ptr<GroupRecognizer> begin_work(Group& group);

  /// The worker has answered.
  GroupRecognizer::Answer& end_work(Group& group);

  /// Messages wait, or are being worked on.
  bool has_work() const;

  std::size_t size() const { return groups_.size(); }
  std::uint64_t evicted_count() const { return evicted_count_; }

 private:
  struct Entry {
    Group group;
    std::string opened_by;
    bool waiting = false;
    std::uint64_t waiting_since = 0;  // in order of arrival
    std::int64_t served_ns = 0;
  };
  using Entries = std::map<std::string, Entry, std::less<>>;

  // That of another group, or end() for a free one; nullopt where there is none.
  std::optional<Entries::const_iterator> place_for(std::string_view probe, SteadyTime now) const;

  GroupBounds bounds_;
  RecognizerOptions recognizer_options_;
  GroupOptions group_options_;
  Entries groups_;
  std::uint64_t arrivals_ = 0;
  std::int64_t served_floor_ns_ = 0;
  std::size_t queued_bytes_ = 0;
  std::uint64_t evicted_count_ = 0;
};

}  // namespace palpate

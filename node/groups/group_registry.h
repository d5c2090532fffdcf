// All groups in memory with their waiting messages, within fixed bounds. Decides which group is
// recognised next.
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
  /// That this probe has opened, without those whose present object only others touch.
  std::size_t max_groups_per_probe = 8;
  /// Memory of the messages that wait for recognition, of all groups together. [bytes]
  std::size_t max_waiting_bytes = std::size_t{32} << 20;
  /// A group or probe that is silent for longer may be forgotten to make room.
  std::chrono::duration<double> evict_idle{10.0};
};

class GroupRegistry {
 public:
  GroupRegistry(const GroupBounds& bounds, const RecognizerOptions& recognizer,
                const GroupOptions& options)
      : bounds_(bounds), recognizer_options_(recognizer), group_options_(options) {}

  Group* find(std::string_view name);

  /// True if add() would find room for a group that this probe opens.
  bool has_room(std::string_view probe, SteadyTime now) const {
    return place_for(probe, now).has_value();
  }

  /// Adds a new group. If there is no room, it replaces the group idle for longest, if that is idle
  /// for longer than evict_idle. A probe that has opened its maximum number of groups replaces the
  /// oldest of those that it touches alone, so a flood of invented names costs no other probe its
  /// group. `evicted` receives the name of the group replaced. Needs has_room().
  Group& add(std::string_view name, std::string_view probe, SteadyTime now, std::string& evicted);

  /// Whether `bytes` more may wait for the group (nullptr: a new one). No group may hold more than
  /// is left to all others, so that a group that has had no answer yet always finds room.
  bool has_room_to_wait(const Group* group, std::size_t bytes) const {
    const std::size_t left =
        bounds_.max_waiting_bytes - std::min(bounds_.max_waiting_bytes, queued_bytes_);
    return (group == nullptr ? 0 : group->queued_bytes()) + bytes <= left;
  }

  /// Forgets what the groups know of the messages of a probe that the node has forgotten.
  void forget_probe(std::string_view probe) {
    for (auto& [name, entry] : groups_) entry.group.forget_probe(probe);
  }

  /// Queues an accepted message for the group.
  void take(Group& group, const ContactMessage& message, Continuity continuity, SteadyTime now);

  /// The waiting group with the least computing time so far; nullptr if none waits. A group that
  /// needs little is thus served at once, however busy the others keep the recognizer.
  /// `only_quick`: only among the quick groups.
  Group* next_waiting(bool only_quick = false);

  /// Hands the group to a worker. It no longer waits, until further messages come.
  std::shared_ptr<GroupRecognizer> begin_work(Group& group);

  /// Call it when the worker has answered.
  GroupRecognizer::Answer& end_work(Group& group);

  /// True if messages wait or are being processed.
  bool has_work() const;

  std::size_t size() const { return groups_.size(); }
  std::uint64_t evicted_count() const { return evicted_count_; }
  /// Samples of accepted messages that have waited in vain: for an object that another one has
  /// followed, or in a group that was evicted.
  std::uint64_t superseded_samples() const { return superseded_samples_; }
  /// Objects that had no answer before another one followed or their group was evicted.
  std::uint64_t superseded_objects() const { return superseded_objects_; }

 private:
  struct Entry {
    Group group;
    std::string opened_by;
    bool waiting = false;
    std::uint64_t waiting_since = 0;  // order of arrival
    std::int64_t served_ns = 0;
  };
  using Entries = std::map<std::string, Entry, std::less<>>;

  // The group to replace, or end() if there is a free place; nullopt if there is no room.
  std::optional<Entries::const_iterator> place_for(std::string_view probe, SteadyTime now) const;

  void count_superseded(const Superseded& more);

  GroupBounds bounds_;
  RecognizerOptions recognizer_options_;
  GroupOptions group_options_;
  Entries groups_;
  std::uint64_t arrivals_ = 0;
  std::int64_t served_floor_ns_ = 0;
  std::size_t queued_bytes_ = 0;
  std::uint64_t evicted_count_ = 0;
  std::uint64_t superseded_samples_ = 0;
  std::uint64_t superseded_objects_ = 0;
};

}  // namespace palpate

// The groups in memory, never more than a bound, and whose turn it is to be recognised.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "node/group.h"

namespace palpate {

class GroupRegistry {
 public:
  GroupRegistry(std::size_t max_groups, std::chrono::duration<double> evict_idle,
                const RecognizerOptions& recognizer, const GroupOptions& options)
      : max_groups_(max_groups),
        evict_idle_(evict_idle),
        recognizer_options_(recognizer),
        group_options_(options) {}

  Group* find(std::string_view name);

  /// True where add() would find room: a free place, or a group idle for long enough.
  bool has_room(SteadyTime now) const;

  /// Adds an unknown group, in place of the one idle for longest where there is no free place; that
  /// one's name goes to `evicted`. Needs has_room().
  Group& add(std::string_view name, std::string& evicted);

  /// The group has new samples.
  void mark_waiting(const Group& group);

  /// The waiting group that has had the least computing time so far, nullptr where none waits. So
  /// a group that asks for little is served at once, however many others keep the recognizer busy.
  Group* next_waiting();

  /// The group has been recognised, at this cost.
  void mark_served(const Group& group, std::int64_t compute_ns);

  std::size_t size() const { return groups_.size(); }
  std::uint64_t evicted_count() const { return evicted_count_; }

 private:
  struct Entry {
    Group group;
    bool waiting = false;
    std::uint64_t waiting_since = 0;  // in order of arrival
    std::int64_t served_ns = 0;
  };
  using Entries = std::map<std::string, Entry, std::less<>>;

  Entries::const_iterator most_idle() const;

  std::size_t max_groups_;
  std::chrono::duration<double> evict_idle_;
  RecognizerOptions recognizer_options_;
  GroupOptions group_options_;
  Entries groups_;
  std::uint64_t arrivals_ = 0;
  std::int64_t served_floor_ns_ = 0;
  std::uint64_t evicted_count_ = 0;
};

}  // namespace palpate

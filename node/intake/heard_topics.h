// What is known of each topic that is heard, within a fixed bound.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <string>
#include <string_view>

#include "node/process/clock.h"

namespace palpate {

/// At the bound the topic that has been silent for longest makes room, if it has been for longer
/// than `idle`. A node repeats the latest message of every group each second, so what is silent for
/// longer is one of its past. One that is still repeated must stay known, or its message would be
/// new again with each repeat.
template <typename Known>
class HeardTopics {
 public:
  HeardTopics(std::size_t most, std::chrono::seconds idle) : most_(most), idle_(idle) {}
  HeardTopics(const HeardTopics&) = delete;
  HeardTopics& operator=(const HeardTopics&) = delete;

  /// What is known of a topic of which a message has come, at first a Known(); nullptr if there is
  /// no room for it. `now` never goes back.
  Known* hear(std::string_view topic, SteadyTime now) {
    auto found = topics_.find(topic);
    if (found == topics_.end()) {
      if (!make_room(now)) return nullptr;
      found = topics_.try_emplace(std::string(topic)).first;
      found->second.place = by_time_.insert(by_time_.end(), found);
    }
    found->second.heard = now;
    by_time_.splice(by_time_.end(), by_time_, found->second.place);
    return &found->second.known;
  }

  /// nullptr if nothing is.
  const Known* find(std::string_view topic) const {
    const auto found = topics_.find(topic);
    return found == topics_.end() ? nullptr : &found->second.known;
  }

  /// Calls visit(const std::string&) for each topic, by name.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (const auto& [topic, entry] : topics_) visit(topic);
  }

 private:
  struct Entry;
  using Topics = std::map<std::string, Entry, std::less<>>;
  using ByTime = std::list<typename Topics::iterator>;  // heard last stands last
  struct Entry {
    Known known;
    SteadyTime heard;
    typename ByTime::iterator place;
  };

  bool make_room(SteadyTime now) {
    if (topics_.size() < most_) return true;
    if (by_time_.empty() || now - by_time_.front()->second.heard <= idle_) return false;
    topics_.erase(by_time_.front());
    by_time_.pop_front();
    return true;
  }

  std::size_t most_;
  std::chrono::seconds idle_;
  Topics topics_;
  ByTime by_time_;
};

}  // namespace palpate

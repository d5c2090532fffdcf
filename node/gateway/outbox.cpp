#include "node/gateway/outbox.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace palpate::gateway {
namespace {

// What a killed process may lose while the plant is reachable: a tenth of a second of the busiest
// cell.
constexpr std::size_t kMostMessages = 4096;
constexpr std::size_t kMostBytes = std::size_t{16} << 20;

/// The name of a lane. No subject contains a slash, so the two kinds cannot collide.
std::string lane_of(const Addressed& to) { return to.group.empty() ? to.subject : to.group + "/"; }

}  // namespace

bool Outbox::has_room(SteadyTime now) const {
  return plant_.is_connected() && now >= held_until_ && !is_failing_ && size_ < kMostMessages &&
         bytes_ < kMostBytes;
}

void Outbox::add(Outgoing message, SteadyTime now) {
  ++size_;
  bytes_ += message.payload.size();
  Lane& lane = lanes_[lane_of(message.to)];
  lane.push_back({std::move(message), ++last_ticket_, false});
  send(lane, now);
}

void Outbox::send(Lane& lane, SteadyTime now) {
  if (lane.empty() || now < held_until_ || !plant_.is_connected()) return;
  const std::uint64_t object = lane.front().message.to.object;
  for (auto entry = lane.begin(); entry != lane.end(); ++entry) {
    const Addressed& to = entry->message.to;
    if (to.object != object) return;
    const bool is_behind = std::any_of(lane.begin(), entry, [&](const Entry& before) {
      return before.message.to.subject == to.subject;
    });
    if (is_behind || entry->is_under_way) continue;
    entry->is_under_way = true;
    plant_.store(this, to.subject, entry->message.payload, {{"Nats-Msg-Id", to.id}},
                 [this, lane_name = lane_of(to), ticket = entry->ticket](const Stored& stored) {
                   answered(lane_name, ticket, stored);
                 });
  }
}

void Outbox::answered(const std::string& lane_name, std::uint64_t ticket, const Stored& stored) {
  const auto found = lanes_.find(lane_name);
  if (found == lanes_.end()) return;
  Lane& lane = found->second;
  const auto entry = std::find_if(lane.begin(), lane.end(),
                                  [&](const Entry& each) { return each.ticket == ticket; });
  if (entry == lane.end()) return;
  const SteadyTime now = now_steady();
  End end = End::Stored;
  switch (stored.verdict) {
    case Stored::Verdict::Yes:
      break;
    case Stored::Verdict::Before:
      end = End::StoredBefore;
      break;
    case Stored::Verdict::TooLong:
      end = End::Refused;
      break;
    case Stored::Verdict::NotTheLast:  // not expected here; handled like no answer
    case Stored::Verdict::NotNow:
      entry->is_under_way = false;
      is_failing_ = true;
      failed_at_ = now;
      return;
  }
  is_failing_ = false;
  const Outgoing message = std::move(entry->message);
  --size_;
  bytes_ -= message.payload.size();
  lane.erase(entry);
  if (lane.empty()) {
    lanes_.erase(found);
  } else {
    send(lane, now);
  }
  ended_(message, end);
}

std::vector<Outgoing> Outbox::take_all() {
  std::vector<Entry> entries;
  for (auto& [name, lane] : lanes_) {
    std::move(lane.begin(), lane.end(), std::back_inserter(entries));
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.ticket < b.ticket; });
  std::vector<Outgoing> messages;
  messages.reserve(entries.size());
  for (Entry& entry : entries) messages.push_back(std::move(entry.message));
  plant_.forget(this);
  lanes_.clear();
  size_ = bytes_ = 0;
  return messages;
}

void Outbox::tend(SteadyTime now) {
  // If no stream has the subject, the answer comes at once; so wait before asking again.
  constexpr std::chrono::milliseconds kAgain{100};
  if (is_failing_ && now < failed_at_ + kAgain) return;
  for (auto& [name, lane] : lanes_) send(lane, now);
}

}  // namespace palpate::gateway

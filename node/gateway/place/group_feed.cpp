#include "node/gateway/place/group_feed.h"

#include <algorithm>
#include <utility>

namespace palpate::gateway {

const FedContact* GroupFeed::next() const {
  if (waiting_.empty() || in_flight_.size() >= kMostInFlight) return nullptr;
  const FedContact& first = waiting_.front();
  // (All in flight are of one object.)
  if (!in_flight_.empty() && in_flight_.back().object != first.object) return nullptr;
  const bool is_unique = find(first.probe, first.epoch, first.seq) == in_flight_.end();
  return is_unique ? &first : nullptr;
}

void GroupFeed::given() {
  in_flight_.push_back(std::move(waiting_.front()));
  FedContact& given = in_flight_.back();
  in_flight_bytes_ += given.bytes;
  given.payload = std::string();
  waiting_.pop_front();
}

GroupFeed::InFlight::iterator GroupFeed::find(std::uint64_t stream_seq) {
  return std::find_if(in_flight_.begin(), in_flight_.end(),
                      [&](const FedContact& contact) { return contact.stream_seq == stream_seq; });
}

GroupFeed::InFlight::const_iterator GroupFeed::find(std::string_view probe, std::uint64_t epoch,
                                                    std::uint64_t seq) const {
  return std::find_if(in_flight_.begin(), in_flight_.end(), [&](const FedContact& contact) {
    return contact.seq == seq && contact.epoch == epoch && contact.probe == probe;
  });
}

void GroupFeed::accepted(std::uint64_t stream_seq) {
  const auto contact = find(stream_seq);
  if (contact == in_flight_.end() || object_ == contact->object) return;
  object_ = contact->object;
  begin_ = contact->stream_seq;
}

std::optional<FedContact> GroupFeed::rejected(std::uint64_t stream_seq) {
  const auto contact = find(stream_seq);
  if (contact == in_flight_.end()) return std::nullopt;
  FedContact out = std::move(*contact);
  in_flight_.erase(contact);
  in_flight_bytes_ -= out.bytes;
  return out;
}

std::optional<AnsweredSpan> GroupFeed::answered(std::string_view probe, std::uint64_t epoch,
                                                std::uint64_t seq) {
  const auto newest = find(probe, epoch, seq);
  if (newest == in_flight_.end()) return std::nullopt;  // the node repeats its latest answer
  AnsweredSpan span;
  span.through = newest->stream_seq;
  span.begin = begin_;
  span.object = newest->object;
  for (auto contact = in_flight_.cbegin(); contact != std::next(newest); ++contact) {
    in_flight_bytes_ -= contact->bytes;
    if (!contact->is_new) continue;
    if (span.contacts++ == 0) span.from = contact->stream_seq;
  }
  in_flight_.erase(in_flight_.cbegin(), std::next(newest));
  if (span.contacts == 0) return std::nullopt;
  return span;
}

}  // namespace palpate::gateway

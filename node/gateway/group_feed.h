// A group's contacts on their way through a recogniser: which may be given to it, and which of them
// an answer holds. Speaks to nobody.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace palpate::gateway {

struct FedContact {
  std::uint64_t stream_seq = 0;
  bool is_new = true;  ///< false: answered already, given again to rebuild the object
  std::string probe;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
  std::uint64_t object = 0;
  std::string payload;    ///< until it is given
  std::size_t bytes = 0;  ///< of the payload
};

/// What an answer answers: all of the group's new contacts from stream_seq `from` to `through`, of
/// an object whose first contact is `begin`.
struct AnsweredSpan {
  std::uint64_t from = 0;
  std::uint64_t through = 0;
  std::uint64_t begin = 0;
  std::uint64_t object = 0;
  std::size_t contacts = 0;
};

class GroupFeed {
 public:
  /// In the stream's order.
  void add(FedContact contact) { waiting_.push_back(std::move(contact)); }

  /// The contact that may be given next; nullptr where it must wait: while contacts of another
  /// object are unanswered, which the node would answer no more once it knows of the new object;
  /// while one of the same number is, which an answer could not be told from; and beyond some at a
  /// time, so that the node never has to reject what waits.
  const FedContact* next() const;

  /// next() has been given.
  void given();

  /// The node has taken a contact: the first of a new object begins it.
  void accepted(std::uint64_t stream_seq);

  /// The node has not: gives it back, out of the feed.
  std::optional<FedContact> rejected(std::uint64_t stream_seq);

  /// An answer of the node's whose newest contact is this one; nullopt where it answers nothing
  /// new.
  std::optional<AnsweredSpan> answered(std::string_view probe, std::uint64_t epoch,
                                       std::uint64_t seq);

  /// Given, and neither answered nor rejected.
  std::size_t in_flight_count() const { return in_flight_.size(); }
  std::size_t in_flight_bytes() const { return in_flight_bytes_; }

 private:
  static constexpr std::size_t kMostInFlight = 32;

  using InFlight = std::deque<FedContact>;
  InFlight::iterator find(std::uint64_t stream_seq);
  InFlight::const_iterator find(std::string_view probe, std::uint64_t epoch,
                                std::uint64_t seq) const;

  std::deque<FedContact> waiting_;
  InFlight in_flight_;
  std::size_t in_flight_bytes_ = 0;
  std::optional<std::uint64_t> object_;
  std::uint64_t begin_ = 0;
};

}  // namespace palpate::gateway

// A group's contacts on their way through a recognizer: which may be sent to it, and which of them
// an answer covers. Does no I/O.
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
  bool is_new = true;  ///< false: already answered; sent again to rebuild the object
  std::string probe;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
  std::uint64_t object = 0;
  std::string payload;    ///< until it is sent
  std::size_t bytes = 0;  ///< of the payload
};

/// The contacts that an answer covers: all new contacts of the group from stream_seq `from` to
/// `through`. `begin` is the first contact of their object.
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

  /// The contact that may be sent next; nullptr if it must wait. It waits while contacts of another
  /// object are unanswered, because the node would not answer them after it has seen the new
  /// object; while a contact with the same (probe, epoch, seq) is unanswered, because their answers
  /// could not be told apart; and while too many are unanswered, so that the node never has to
  /// reject for overload.
  const FedContact* next() const;

  /// next() has been sent.
  void given();

  /// The node has accepted a contact. The first one of a new object begins that object.
  void accepted(std::uint64_t stream_seq);

  /// The node has rejected a contact: removes it from the feed and returns it.
  std::optional<FedContact> rejected(std::uint64_t stream_seq);

  /// The node has sent an answer whose newest contact is this one. nullopt if it covers nothing
  /// new.
  std::optional<AnsweredSpan> answered(std::string_view probe, std::uint64_t epoch,
                                       std::uint64_t seq);

  /// Number of contacts sent, and neither answered nor rejected yet.
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

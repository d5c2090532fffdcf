// Counts each contact of a place once, however often it is delivered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

namespace palpate::gateway {

/// Contacts by their numbers in the stream, as long as it is known to be the same one.
class ContactLedger {
 public:
  /// True if the contact was not taken before.
  bool take(std::uint64_t stream_seq) { return waiting_.insert(stream_seq).second; }

  /// The contact has its answer. True if it was taken and waited for it.
  bool answered(std::uint64_t stream_seq) { return waiting_.erase(stream_seq) > 0; }

  /// The contact will never have an answer.
  void refuse(std::uint64_t stream_seq) {
    waiting_.erase(stream_seq);
    refused_.insert(stream_seq);
    if (refused_.size() > kMostRefused) refused_.erase(refused_.begin());
  }
  bool is_refused(std::uint64_t stream_seq) const { return refused_.contains(stream_seq); }

  /// No contact before this one comes again.
  void begin_at(std::uint64_t stream_seq) {
    waiting_.erase(waiting_.begin(), waiting_.lower_bound(stream_seq));
  }

  /// A stream that was made again counts from 1: a contact of it may have the number of one that
  /// was refused.
  void forget() {
    waiting_.clear();
    refused_.clear();
  }

 private:
  // Refused contacts may be delivered again until all contacts before them are done, and the plant
  // delivers 8,192 contacts ahead (contact_consumer.cpp).
  static constexpr std::size_t kMostRefused = 16'384;

  std::set<std::uint64_t> waiting_;  // have neither an answer nor a refusal yet
  std::set<std::uint64_t> refused_;  // the latest ones
};

}  // namespace palpate::gateway

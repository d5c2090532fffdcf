// Checks order and completeness of one topic's messages by their (epoch, seq).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate {

enum class SequenceEvent {
  First,        ///< the first message of this sender
  Next,         ///< follows the last one
  Gap,          ///< messages before it are missing
  Restart,      ///< a new epoch, or seq counted anew in the same one
  NotNewer,     ///< a duplicate or out of order: do not use
  TooFarAhead,  ///< more messages missing than possible: do not use
  StaleEpoch,   ///< from before a restart: do not use
};

/// True if the message is to be used.
constexpr bool is_news(SequenceEvent event) {
  return event != SequenceEvent::NotNewer && event != SequenceEvent::TooFarAhead &&
         event != SequenceEvent::StaleEpoch;
}

class SequenceTracker {
 public:
  /// A sender of 1 kHz needs 50 days for so many messages.
  static constexpr std::uint64_t kLargestGap = std::uint64_t{1} << 32U;

  /// Classifies a message of (epoch, seq) without recording it.
  SequenceEvent judge(std::uint64_t epoch, std::uint64_t seq) const {
    if (!started_) return SequenceEvent::First;
    if (epoch != epoch_) {
      for (std::size_t i = 0; i < retired_count_; ++i) {
        if (retired_[i] == epoch) return SequenceEvent::StaleEpoch;
      }
      return SequenceEvent::Restart;
    }
    if (seq > seq_ && seq - seq_ > kLargestGap) return SequenceEvent::TooFarAhead;
    // A single wrong number must not shut out a sender that continues where it was. And a sender
    // that never sets its epoch cannot show a restart in any other way.
    if (seq < seq_ && (seq_ - seq > kLargestGap || epoch == 0)) return SequenceEvent::Restart;
    if (seq <= seq_) return SequenceEvent::NotNewer;
    return seq == seq_ + 1 ? SequenceEvent::Next : SequenceEvent::Gap;
  }

  /// Classifies the message, and records it if it is to be used.
  SequenceEvent take(std::uint64_t epoch, std::uint64_t seq) {
    const SequenceEvent event = judge(epoch, seq);
    if (!is_news(event)) return event;
    // A restarted sender counts from 0, so all messages below seq were lost. For the first message
    // of an unknown sender there is no such knowledge.
    const std::uint64_t lost = event == SequenceEvent::Gap       ? seq - seq_ - 1
                               : event == SequenceEvent::Restart ? seq
                                                                 : 0;
    if (lost > 0) ++gaps_;
    missing_ += lost;
    if (event == SequenceEvent::Restart) {
      ++restarts_;
      if (epoch != epoch_) retire(epoch_);
    }
    started_ = true;
    epoch_ = epoch;
    seq_ = seq;
    return event;
  }

  /// Takes a former epoch back, in place of the present one: its next message is a first one.
  void readmit(std::uint64_t epoch) {
    retire(epoch_);
    for (std::size_t i = 0; i < retired_count_; ++i) {
      if (retired_[i] == epoch) retired_[i] = epoch_;
    }
    started_ = false;
  }

  std::uint64_t epoch() const { return epoch_; }
  std::uint64_t seq() const { return seq_; }
  std::uint64_t gaps() const { return gaps_; }          ///< number of gaps
  std::uint64_t missing() const { return missing_; }    ///< messages missing in the gaps
  std::uint64_t restarts() const { return restarts_; }  ///< new epochs, or seq counted anew

 private:
  void retire(std::uint64_t epoch) {
    retired_[next_retired_] = epoch;
    next_retired_ = (next_retired_ + 1) % retired_.size();
    if (retired_count_ < retired_.size()) ++retired_count_;
  }

  // Number of former epochs remembered. Old connections drain within seconds, so a handful of
  // restarts is enough.
  static constexpr std::size_t kRetiredEpochs = 8;

  bool started_ = false;
  std::uint64_t epoch_ = 0;
  std::uint64_t seq_ = 0;
  std::uint64_t gaps_ = 0;
  std::uint64_t missing_ = 0;
  std::uint64_t restarts_ = 0;
  std::array<std::uint64_t, kRetiredEpochs> retired_{};
  std::size_t retired_count_ = 0;
  std::size_t next_retired_ = 0;
};

}  // namespace palpate

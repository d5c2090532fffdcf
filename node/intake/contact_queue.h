// The messages of one group that wait for its recognizer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "node/intake/ingest.h"

namespace palpate {

/// How a message follows the previous one of its probe in the same group.
enum class Continuity { Unbroken, SamplesMissing, Anew };

/// An accepted message. The queue holds its samples.
struct QueuedContacts {
  std::string probe;
  std::string frame;  ///< frame of the object that the message begins; empty if it begins none
  bool begins_object = false;
  Continuity continuity = Continuity::Anew;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
  std::uint64_t object = 0;
  std::uint32_t patch = 0;
  double tip_radius_m = 0.0;
  MaterialSide material_side = MaterialSide::Unspecified;
  std::int64_t newest_sample_stamp_ns = 0;
  std::size_t sample_count = 0;
  std::size_t detail_count = 0;  ///< sample_count or 0
};

class ContactQueue {
 public:
  /// Memory that a message takes while it waits. [bytes]
  static std::size_t bytes_of(const ContactMessage& message) {
    return sizeof(QueuedContacts) + message.probe.size() + message.frame.size() +
           message.samples.size() * sizeof(ContactSample) +
           message.details.size() * sizeof(SampleDetail);
  }

  void push(const ContactMessage& message, Continuity continuity, bool begins_object) {
    messages_.push_back({std::string(message.probe),
                         std::string(begins_object ? message.frame : std::string_view()),
                         begins_object, continuity, message.epoch, message.seq, message.object,
                         message.patch, message.tip_radius_m, message.material_side,
                         message.newest_sample_stamp_ns, message.samples.size(),
                         message.details.size()});
    samples_.insert(samples_.end(), message.samples.begin(), message.samples.end());
    details_.insert(details_.end(), message.details.begin(), message.details.end());
    bytes_ += bytes_of(message);
  }

  /// Calls visit(const QueuedContacts&, std::span<const ContactSample>, std::span<const
  /// SampleDetail>) for each message in the order of arrival.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    std::size_t first = 0;
    std::size_t first_detail = 0;
    for (const QueuedContacts& message : messages_) {
      visit(message, std::span(samples_).subspan(first, message.sample_count),
            std::span(details_).subspan(first_detail, message.detail_count));
      first += message.sample_count;
      first_detail += message.detail_count;
    }
  }

  /// Empties the queue. Keeps an ordinary amount of memory for reuse and frees that of a burst.
  void clear() {
    if (bytes_ > kOrdinaryBytes) {
      messages_ = {};
      samples_ = {};
      details_ = {};
    }
    messages_.clear();
    samples_.clear();
    details_.clear();
    bytes_ = 0;
  }

  bool empty() const { return messages_.empty(); }
  std::size_t sample_count() const { return samples_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  // What a probe of 1 kHz sends during an ordinary recognition of some milliseconds.
  static constexpr std::size_t kOrdinaryBytes = 16 * 1024;

  std::vector<QueuedContacts> messages_;
  std::vector<ContactSample> samples_;
  std::vector<SampleDetail> details_;  ///< only of the messages that have them
  std::size_t bytes_ = 0;
};

}  // namespace palpate

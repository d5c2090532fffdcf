// What is wrong with a probe's stream, told to its author.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "node/check/patch_check.h"
#include "node/intake/ingest.h"
#include "node/intake/sequence_tracker.h"
#include "node/security/sender.h"

namespace palpate {

/// Takes messages as they come off the wire, judges them at the end.
class StreamCheck {
 public:
  /// One message that arrived at `now_unix_ns`.
  void take(std::size_t frame_count, std::string_view topic, std::string_view payload,
            std::int64_t now_unix_ns, const Sender& sender = {});

  /// Worst first.
  std::vector<Finding> findings() const;

  std::uint64_t messages() const { return messages_; }

 private:
  struct Probe {
    SequenceTracker sequence;
    std::uint64_t samples = 0;
    std::uint64_t messages = 0;
    std::uint64_t without_epoch = 0;
    std::uint64_t stamps_backwards = 0;
    std::uint64_t stamps_missing = 0;
    std::uint64_t stamps_in_future = 0;
    std::uint64_t stamps = 0;
    bool stamps_differ = false;
    std::int64_t last_stamp_ns = 0;
    std::int64_t largest_delay_ns = 0;
    std::uint64_t patch_count = 0;
    std::uint64_t objects = 0;  ///< how often another one began, the first included
    std::uint64_t longest_object_samples = 0;
    std::uint64_t samples_of_object = 0;  ///< of the latest
    std::vector<CheckedPatch> patches;    ///< the latest
  };

  ContactDecoder decoder_;
  std::uint64_t messages_ = 0;
  std::map<std::pair<std::string, v1::RejectReason>, std::uint64_t> rejected_;
  std::map<std::string, Probe, std::less<>> probes_;
};

}  // namespace palpate

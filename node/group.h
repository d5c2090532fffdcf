// The probes that touch one object, and its recognizer.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/convert.h"
#include "node/ingest.h"
#include "node/patch_numbering.h"
#include "node/probe_registry.h"

namespace palpate {

struct GroupOptions {
  std::size_t max_probes_per_group = 16;
  /// A probe that keeps another object's number is heard once the others have been silent so long.
  std::chrono::duration<double> object_takeover{1.0};
  /// After lost messages the arc is broken where the hole exceeds this many sample spacings.
  double gap_break_spacings = 10.0;
};

class Group {
 public:
  /// A probe that has touched the present object. Its index is its number in the recognizer.
  struct Member {
    std::string probe;
    PatchNumbering patches;
    SteadyTime last_taken;
  };

  /// Where the samples taken last came from.
  struct Newest {
    std::string source;
    std::uint64_t epoch = 0;
    std::uint64_t seq = 0;
    std::int64_t sample_stamp_ns = 0;  ///< the latest of all samples of the object
  };

  Group(std::string_view name, const RecognizerOptions& recognizer, const GroupOptions& options)
      : name_(name), options_(options), recognizer_(recognizer) {}

  /// Whether the message may be taken; REJECT_REASON_UNSPECIFIED = yes. `probe` is its sender,
  /// nullptr where unknown so far. Changes nothing.
  v1::RejectReason judge(const ContactMessage& message, const Probe* probe, SteadyTime now) const;

  /// How a message follows the one that its probe sent to this group before.
  enum class Continuity { Unbroken, SamplesMissing, Anew };

  /// Takes a message that judge() lets pass. Returns the number of samples that the recognizer
  /// refused.
  std::size_t take(const ContactMessage& message, Continuity continuity, SteadyTime now);

  Recognition recognize() { return recognizer_.recognize(); }

  /// Name of a probe and its own patch number, for the recognizer's numbers of both. Views a name
  /// that lives until the next take().
  ContactSource source_of(std::uint32_t probe, std::uint32_t run) const;

  const std::string& name() const { return name_; }
  const std::string& frame() const { return frame_; }
  std::uint64_t object() const { return object_; }
  const std::vector<Member>& members() const { return members_; }
  const Newest& newest() const { return newest_; }
  SteadyTime last_taken() const { return last_taken_; }

 private:
  bool is_stale_object(const ContactMessage& message, const Probe* probe, SteadyTime now) const;
  const Member* find_member(std::string_view probe) const;
  void begin_object(const ContactMessage& message);

  std::string name_;
  GroupOptions options_;
  Recognizer recognizer_;
  std::string frame_;
  std::uint64_t object_ = 0;
  std::vector<Member> members_;  ///< empty = no object yet
  Newest newest_;
  SteadyTime last_taken_;
};

}  // namespace palpate

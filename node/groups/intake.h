// Takes a message from the wire to its group. The only place that decides whether a message counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "node/groups/group_registry.h"
#include "node/intake/ingest.h"
#include "node/intake/probe_registry.h"
#include "node/security/sender.h"

namespace palpate {

struct IntakeOptions {
  IngestLimits limits;
  std::size_t max_probes = 256;
  GroupBounds groups;  ///< evict_idle applies to probes too
  /// Accept a message whose seq is older than the probe's latest in another group, as long as it is
  /// newer than all of the probe in its own.
  bool sequence_by_group = false;
  GroupOptions group;
  RecognizerOptions recognizer;
};

struct IntakeCounters {
  std::uint64_t messages_received = 0;
  std::uint64_t messages_accepted = 0;
  std::uint64_t samples_received = 0;  ///< of the messages accepted
  std::uint64_t samples_refused = 0;   ///< of these, refused by the recognizer
  std::array<std::uint64_t, v1::RejectReason_ARRAYSIZE> rejected{};  ///< by RejectReason
  /// By RejectReason: the probe named in the topic of the last such message; empty if the topic is
  /// invalid. For NOT_ALLOWED with the sender's key.
  std::array<std::string, v1::RejectReason_ARRAYSIZE> rejected_last;
};

class Intake {
 public:
  explicit Intake(const IntakeOptions& options);

  /// Accepts one message or counts why not; a rejected message changes nothing else. `now_unix_ns`:
  /// wall clock, for the latency shown.
  v1::RejectReason take(std::size_t frame_count, std::string_view topic, std::string_view payload,
                        SteadyTime now, std::int64_t now_unix_ns, const Sender& sender = {});

  GroupRegistry& groups() { return groups_; }
  ProbeRegistry& probes() { return probes_; }
  const GroupRegistry& groups() const { return groups_; }
  const ProbeRegistry& probes() const { return probes_; }
  const IntakeCounters& counters() const { return counters_; }

  /// Counts accepted samples that the recognizer has refused.
  void count_refused(std::size_t samples) { counters_.samples_refused += samples; }

  /// Names of groups and probes forgotten since the last call.
  struct Forgotten {
    std::vector<std::string> groups;
    std::vector<std::string> probes;
  };
  Forgotten take_forgotten();

 private:
  void reject(v1::RejectReason reason, const Sender& sender, Probe* probe);
  v1::RejectReason judge(const Probe* probe, const Group* group, SteadyTime now) const;

  bool sequence_by_group_;
  ContactDecoder decoder_;
  ProbeRegistry probes_;
  GroupRegistry groups_;
  IntakeCounters counters_;
  Forgotten forgotten_;
};

}  // namespace palpate

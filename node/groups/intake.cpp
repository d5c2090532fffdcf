#include "node/groups/intake.h"

#include <chrono>
#include <utility>

#include "node/security/decode_from.h"

namespace palpate {
namespace {

using v1::RejectReason;

Continuity continuity_of(SequenceEvent event, bool same_group) {
  if (same_group && event == SequenceEvent::Next) return Continuity::Unbroken;
  if (same_group && event == SequenceEvent::Gap) return Continuity::SamplesMissing;
  return Continuity::Anew;
}

// A sender may set any stamp; if the difference overflows, the latency is 0. So it is without a
// stamp.
std::int64_t latency_between(std::int64_t sent_ns, std::int64_t received_ns) {
  std::int64_t latency = 0;
  if (sent_ns == 0) return latency;
  return __builtin_sub_overflow(received_ns, sent_ns, &latency) ? 0 : latency;
}

bool is_news_to(const Group* group, const ContactMessage& message) {
  const SequenceTracker* sequence = group == nullptr ? nullptr : group->sequence_of(message.probe);
  return sequence == nullptr || is_news(sequence->judge(message.epoch, message.seq));
}

/// Old connections drain within seconds. What comes of a former epoch when the present one has been
/// silent for longer is of a probe whose name another process had, for one message at least.
constexpr std::chrono::seconds kDrained{10};

bool is_back(const Probe& probe, const ContactMessage& message, SteadyTime now) {
  return now - probe.last_heard > kDrained &&
         probe.sequence.judge(message.epoch, message.seq) == SequenceEvent::StaleEpoch;
}

}  // namespace

Intake::Intake(const IntakeOptions& options)
    : sequence_by_group_(options.sequence_by_group),
      decoder_(options.limits),
      probes_(options.max_probes, options.groups.evict_idle),
      groups_(options.groups, options.recognizer, options.group) {}

RejectReason Intake::judge(const Probe* probe, const Group* group, SteadyTime now) const {
  const ContactMessage& message = decoder_.message();
  if (probe == nullptr && !probes_.has_room(now)) return v1::REJECT_REASON_TOO_MANY_PROBES;
  if (probe != nullptr) {
    const SequenceEvent event = probe->sequence.judge(message.epoch, message.seq);
    if (!is_news(event) && !(sequence_by_group_ && is_news_to(group, message))) {
      return event == SequenceEvent::StaleEpoch ? v1::REJECT_REASON_STALE_EPOCH
                                                : v1::REJECT_REASON_SEQUENCE;
    }
  }
  if (group == nullptr && !groups_.has_room(message.probe, now)) {
    return v1::REJECT_REASON_TOO_MANY_GROUPS;
  }
  if (group != nullptr) {
    const RejectReason reason = group->judge(message, probe, now);
    if (reason != v1::REJECT_REASON_UNSPECIFIED) return reason;
  }
  return groups_.has_room_to_wait(group, ContactQueue::bytes_of(message))
             ? v1::REJECT_REASON_UNSPECIFIED
             : v1::REJECT_REASON_OVERLOAD;
}

void Intake::reject(RejectReason reason, const Sender& sender, Probe* probe) {
  const auto number = static_cast<std::size_t>(reason);
  ++counters_.rejected[number];
  std::string& last = counters_.rejected_last[number];
  last = decoder_.probe();
  if (reason == v1::REJECT_REASON_NOT_ALLOWED) {
    last.append(", which the key ").append(sender.key).append(" may not publish as");
  } else if (probe != nullptr) {
    ++probe->rejected;  // messages sent by others under its name do not count
  }
}

RejectReason Intake::take(std::size_t frame_count, std::string_view topic, std::string_view payload,
                          SteadyTime now, std::int64_t now_unix_ns, const Sender& sender) {
  ++counters_.messages_received;
  RejectReason reason = decode_from(sender, decoder_, frame_count, topic, payload);
  Probe* probe = decoder_.probe().empty() ? nullptr : probes_.find(decoder_.probe());
  const ContactMessage& message = decoder_.message();
  Group* group = nullptr;
  if (reason == v1::REJECT_REASON_UNSPECIFIED) {
    group = groups_.find(message.group);
    if (!sequence_by_group_ && probe != nullptr && is_back(*probe, message, now)) {
      probe->sequence.readmit(message.epoch);
    }
    reason = judge(probe, group, now);
  }
  if (reason != v1::REJECT_REASON_UNSPECIFIED) {
    reject(reason, sender, probe);
    return reason;
  }

  std::string evicted;
  if (probe == nullptr) {
    probe = &probes_.add(message.probe, now, evicted);
    if (!evicted.empty()) {
      groups_.forget_probe(evicted);
      forgotten_.probes.push_back(std::move(evicted));
    }
  }
  if (group == nullptr) {
    group = &groups_.add(message.group, message.probe, now, evicted);
    if (!evicted.empty()) forgotten_.groups.push_back(std::move(evicted));
  }
  const SequenceEvent event = probe->sequence.take(message.epoch, message.seq);
  // In the order of each group alone, an answer must not depend on which group came first.
  const Continuity continuity =
      sequence_by_group_ ? continuity_of(group->take_sequence(message), /*same_group=*/true)
                         : continuity_of(event, probe->group == message.group);
  groups_.take(*group, message, continuity, now);

  const std::size_t count = message.samples.size();
  probe->group = message.group;
  probe->object = message.object;
  probe->last_heard = now;
  ++probe->messages;
  probe->samples += count;
  probe->message_rate.add(now, 1);
  probe->sample_rate.add(now, count);
  probe->latency_ns = latency_between(message.published_ns, now_unix_ns);
  ++counters_.messages_accepted;
  counters_.samples_received += count;
  return v1::REJECT_REASON_UNSPECIFIED;
}

Intake::Forgotten Intake::take_forgotten() { return std::exchange(forgotten_, {}); }

}  // namespace palpate

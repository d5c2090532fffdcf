#include "node/publish/status.h"

#include <unistd.h>

#include <fstream>

namespace palpate {
namespace {

void fill_probe(Probe& probe, SteadyTime now, v1::ProbeStatus& out) {
  out.set_probe(probe.name);
  out.set_group(probe.group);
  out.set_alive(probe.alive);
  out.set_message_rate_hz(probe.message_rate.per_second(now));
  out.set_sample_rate_hz(probe.sample_rate.per_second(now));
  out.set_age_s(std::chrono::duration<double>(now - probe.last_heard).count());
  out.set_messages(probe.messages);
  out.set_samples(probe.samples);
  out.set_gaps(probe.sequence.gaps());
  out.set_missing(probe.sequence.missing());
  out.set_restarts(probe.sequence.restarts());
  out.set_rejected(probe.rejected);
  out.set_epoch(probe.sequence.epoch());
  out.set_seq(probe.sequence.seq());
  out.set_latency_ns(probe.latency_ns);
}

}  // namespace

void fill_status(Intake& intake, ComputeTimes& compute_times, const NodeVitals& vitals,
                 SteadyTime now, v1::NodeStatus& out) {
  out.Clear();
  out.set_uptime_s(vitals.uptime_s);
  out.set_version(vitals.version.data(), vitals.version.size());
  const IntakeCounters& counters = intake.counters();
  out.set_messages_received(counters.messages_received);
  out.set_messages_accepted(counters.messages_accepted);
  out.set_samples_received(counters.samples_received);
  out.set_samples_refused(counters.samples_refused);
  out.set_samples_superseded(intake.groups().superseded_samples());
  out.set_objects_superseded(intake.groups().superseded_objects());
  std::uint64_t malformed = 0;
  for (std::size_t i = 0; i < counters.rejected.size(); ++i) {
    if (counters.rejected[i] == 0) continue;
    const auto reason = static_cast<v1::RejectReason>(i);
    v1::RejectCount& rejected = *out.add_rejected();
    rejected.set_reason(reason);
    rejected.set_count(counters.rejected[i]);
    if (is_malformed(reason)) malformed += counters.rejected[i];
  }
  out.set_malformed(malformed);
  ProbeRegistry& probes = intake.probes();
  out.set_gaps(probes.gaps());
  out.set_missing(probes.missing());
  out.set_restarts(probes.restarts());
  out.set_probes_evicted(probes.evicted_count());
  out.set_groups(static_cast<std::uint32_t>(intake.groups().size()));
  out.set_groups_evicted(intake.groups().evicted_count());
  out.set_recognitions_published(vitals.recognitions_published);
  out.set_clients_denied(vitals.clients_denied);
  out.set_connections_cut(vitals.connections_cut);
  constexpr double kMedian = 0.5;
  constexpr double kTail = 0.99;
  out.set_compute_p50_ns(compute_times.quantile(kMedian));
  out.set_compute_p99_ns(compute_times.quantile(kTail));
  out.set_memory_bytes(resident_memory_bytes());
  for (auto& [name, probe] : probes.all()) fill_probe(probe, now, *out.add_probes());
}

int update_liveness(ProbeRegistry& probes, std::chrono::duration<double> timeout, SteadyTime now) {
  int changes = 0;
  for (auto& [name, probe] : probes.all()) {
    const bool alive = now - probe.last_heard <= timeout;
    if (alive != probe.alive) ++changes;
    probe.alive = alive;
  }
  return changes;
}

std::uint64_t resident_memory_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t total_pages = 0;
  std::uint64_t resident_pages = 0;
  if (!(file >> total_pages >> resident_pages)) return 0;
  return resident_pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace palpate

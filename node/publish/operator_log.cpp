#include "node/publish/operator_log.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstddef>
#include <utility>

namespace palpate {
namespace {

// A probe on its way to the next place is not reported as silent; a probe that has been switched
// off is, after this time.
constexpr std::chrono::seconds kSilent{5};
// Lines of one kind per call: a flood of invented names must not flood the log.
constexpr std::size_t kMostLines = 10;

}  // namespace

void OperatorLog::tell_probes(ProbeRegistry& probes, SteadyTime now) {
  std::size_t changes = 0;
  for (auto& [name, probe] : probes.all()) {
    const bool silent = now - probe.last_heard >= kSilent;
    const Probe::Told is = silent ? Probe::Told::Silent : Probe::Told::Up;
    if (probe.told == is) continue;
    const bool is_new = probe.told == Probe::Told::Nothing;
    probe.told = is;
    if (++changes > kMostLines) continue;
    if (silent) {
      spdlog::warn("probe {}: silent for {:.0f} s", name,
                   std::chrono::duration<double>(now - probe.last_heard).count());
    } else {
      spdlog::info("probe {}: {}, group \"{}\"", name, is_new ? "up" : "heard again", probe.group);
    }
  }
  if (changes > kMostLines) {
    spdlog::info("{} more probes have come or fallen silent", changes - kMostLines);
  }
}

void OperatorLog::tell(Intake& intake, const ZapHandler* zap, SteadyTime now) {
  tell_probes(intake.probes(), now);
  const IntakeCounters& counters = intake.counters();
  for (std::size_t i = 0; i < counters.rejected.size(); ++i) {
    if (counters.rejected[i] == rejections_told_[i]) continue;
    const std::string& probe = counters.rejected_last[i];
    spdlog::warn("{} messages rejected: {}{}", counters.rejected[i] - rejections_told_[i],
                 v1::RejectReason_Name(static_cast<v1::RejectReason>(i)),
                 probe.empty() ? ", of no probe's topic" : ", the last of probe " + probe);
  }
  rejections_told_ = counters.rejected;
  const std::uint64_t superseded = intake.groups().superseded_objects();
  const std::uint64_t before = std::exchange(superseded_told_, superseded);
  if (superseded > before) {
    spdlog::warn(
        "{} objects without an answer: the next one of their group, or a new group, came too soon",
        superseded - before);
  }
  if (zap != nullptr && zap->denied_count() != denied_told_) {
    spdlog::warn("{} clients denied: their keys are not on the list; the last from {}",
                 zap->denied_count() - denied_told_, zap->last_denied());
    denied_told_ = zap->denied_count();
  }
}

}  // namespace palpate

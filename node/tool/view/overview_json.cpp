#include "node/tool/view/overview_json.h"

#include <algorithm>

#include "node/tool/text/recognition_text.h"
#include "node/tool/view/details_json.h"
#include "node/tool/view/json_numbers.h"

namespace palpate {
namespace {

using nlohmann::json;

double seconds_between(SteadyTime before, SteadyTime now) {
  return significant(std::chrono::duration<double>(now - before).count(), 4);
}

double probability_of_best(const v1::Recognition& answer) {
  return answer.hypotheses().empty() ? 0.0 : answer.hypotheses(0).probability();
}

json probes_json(const v1::NodeStatus& status, double status_age_s) {
  json probes = json::array();
  for (const v1::ProbeStatus& probe : status.probes()) {
    probes.push_back(
        {{"name", probe.probe()},
         {"group", probe.group()},
         {"alive", probe.alive()},
         {"samplesPerS", significant(probe.sample_rate_hz(), 4)},
         {"batchesPerS", significant(probe.message_rate_hz(), 4)},
         {"ageS", significant(std::max(probe.age_s(), 0.0) + status_age_s, 4)},
         {"gaps", probe.gaps()},
         {"missing", probe.missing()},
         {"restarts", probe.restarts()},
         {"rejected", probe.rejected()},
         {"latencyMs", significant(1e-6 * static_cast<double>(probe.latency_ns()), 4)}});
  }
  return probes;
}

}  // namespace

json overview_json(const LiveState& state, SteadyTime now) {
  json groups = json::array();
  for (const auto& [name, group] : state.groups()) {
    groups.push_back({{"name", name},
                      {"object", std::to_string(group.touched.object)},
                      {"status", status_word(group.answer)},
                      {"class", spoken_name(group.answer.curve_class())},
                      {"probability", probability_of_best(group.answer)},
                      {"ageS", seconds_between(group.last_heard, now)}});
  }
  json nodes = json::array();
  for (const auto& [name, node] : state.nodes()) {
    const v1::NodeStatus& status = node.status;
    const double age_s = seconds_between(node.last_heard, now);
    nodes.push_back(
        {{"name", name},
         {"version", status.version()},
         {"silentS", age_s},
         {"uptimeS", significant(status.uptime_s() + age_s, 6)},
         {"received", status.messages_received()},
         {"accepted", status.messages_accepted()},
         {"gaps", status.gaps()},
         {"missing", status.missing()},
         {"computeP50Ms", significant(1e-6 * static_cast<double>(status.compute_p50_ns()), 3)},
         {"computeP99Ms", significant(1e-6 * static_cast<double>(status.compute_p99_ns()), 3)},
         {"probes", probes_json(status, age_s)}});
  }
  return {{"groups", std::move(groups)}, {"nodes", std::move(nodes)}};
}

}  // namespace palpate

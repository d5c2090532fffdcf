#include "node/tool/view/overview_json.h"

#include <algorithm>
#include <chrono>
#include <string>

#include "node/tool/text/recognition_text.h"
#include "node/tool/view/details_json.h"

namespace palpate {
namespace {

double seconds_between(SteadyTime before, SteadyTime now) {
  return std::chrono::duration<double>(now - before).count();
}

double probability_of_best(const v1::Recognition& answer) {
  return answer.hypotheses().empty() ? 0.0 : answer.hypotheses(0).probability();
}

void write_group(const std::string& name, const LiveGroup& group, SteadyTime now, JsonText& json) {
  json.begin_object();
  json.member("name", name);
  json.member("object", std::to_string(group.touched.object));
  json.member("status", status_word(group.answer));
  json.member("class", spoken_name(group.answer.curve_class()));
  json.member("probability", probability_of_best(group.answer));
  json.member("ageS", seconds_between(group.last_heard, now), 4);
  json.end_object();
}

void write_probe(const v1::ProbeStatus& probe, double status_age_s, JsonText& json) {
  json.begin_object();
  json.member("name", probe.probe());
  json.member("group", probe.group());
  json.member("alive", probe.alive());
  json.member("samplesPerS", probe.sample_rate_hz(), 4);
  json.member("batchesPerS", probe.message_rate_hz(), 4);
  json.member("ageS", probe.age_s() + status_age_s, 4);
  json.member("gaps", probe.gaps());
  json.member("missing", probe.missing());
  json.member("restarts", probe.restarts());
  json.member("rejected", probe.rejected());
  json.end_object();
}

void write_node(const std::string& name, const LiveNode& node, SteadyTime now, JsonText& json) {
  const v1::NodeStatus& status = node.status;
  const double age_s = seconds_between(node.last_heard, now);
  json.begin_object();
  json.member("name", name);
  json.member("version", status.version());
  json.member("silentS", age_s, 4);
  json.member("uptimeS", status.uptime_s() + age_s, 6);
  json.member("received", status.messages_received());
  json.member("accepted", status.messages_accepted());
  json.member("gaps", status.gaps());
  json.member("missing", status.missing());
  json.member("objectsSuperseded", status.objects_superseded());
  json.member("computeP50Ms", 1e-6 * static_cast<double>(status.compute_p50_ns()), 3);
  json.member("computeP99Ms", 1e-6 * static_cast<double>(status.compute_p99_ns()), 3);
  json.key("probes").begin_array();
  for (const v1::ProbeStatus& probe : status.probes()) write_probe(probe, age_s, json);
  json.end_array();
  json.end_object();
}

}  // namespace

void write_overview(const LiveState& state, SteadyTime now, JsonText& json) {
  json.begin_object();
  json.key("groups").begin_array();
  for (const auto& [name, group] : state.groups()) write_group(name, group, now, json);
  json.end_array();
  json.key("nodes").begin_array();
  for (const auto& [name, node] : state.nodes()) write_node(name, node, now, json);
  json.end_array();
  json.end_object();
}

}  // namespace palpate

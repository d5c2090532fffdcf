#include "node/tool/view/live_state.h"

#include <algorithm>
#include <cmath>

#include "node/wire/topics.h"

namespace palpate {
namespace {

// Who follows leaves a group that has been silent for so long for one that is touched.
constexpr std::chrono::milliseconds kFollowAfter{1000};

/// Keeps every second sample of every run; of runs that have a single one, the later half.
void thin(LiveGroup& group) {
  std::vector<ContactRun> kept;
  const std::size_t runs = group.touched.runs.size();
  for (std::size_t number = 0; number < runs; ++number) {
    ContactRun& run = group.touched.runs[number];
    if (run.samples.size() == 1 && 2 * number < runs) continue;
    for (std::size_t i = 0; 2 * i < run.samples.size(); ++i) run.samples[i] = run.samples[2 * i];
    run.samples.resize((run.samples.size() + 1) / 2);
    kept.push_back(std::move(run));
  }
  group.touched.runs = std::move(kept);
  group.run_of.clear();
  group.samples_kept = 0;
  for (std::size_t i = 0; i < group.touched.runs.size(); ++i) {
    const ContactRun& run = group.touched.runs[i];
    group.run_of[{group.touched.probes[run.context.probe], run.context.patch}] = i;
    group.samples_kept += run.samples.size();
  }
}

MaterialSide side_of(v1::MaterialSide side) {
  return side == v1::MATERIAL_SIDE_LEFT    ? MaterialSide::Left
         : side == v1::MATERIAL_SIDE_RIGHT ? MaterialSide::Right
                                           : MaterialSide::Unspecified;
}

/// Names come from the bus: where one is none, the message is not for us.
bool is_drawable(const v1::ContactBatch& batch) {
  const auto is_finite = [](const v1::ContactSample& sample) {
    return std::isfinite(sample.x_m()) && std::isfinite(sample.y_m()) &&
           std::isfinite(sample.sigma_m());
  };
  return is_valid_name(batch.header().source()) &&
         (batch.group().empty() || is_valid_name(batch.group())) &&
         std::isfinite(batch.tip_radius_m()) && !batch.samples().empty() &&
         std::all_of(batch.samples().begin(), batch.samples().end(), is_finite);
}

template <typename Map>
void make_room(Map& map, std::size_t most) {
  if (map.size() < most) return;
  map.erase(std::min_element(map.begin(), map.end(), [](const auto& a, const auto& b) {
    return a.second.last_heard < b.second.last_heard;
  }));
}

}  // namespace

LiveGroup* LiveState::find(std::string_view name) {
  const auto found = groups_.find(name);
  return found == groups_.end() ? nullptr : &found->second;
}

std::string LiveState::followed_group(std::string_view shown, SteadyTime now) const {
  const auto present = groups_.find(shown);
  if (present != groups_.end() && now - present->second.last_heard < kFollowAfter) {
    return present->first;
  }
  const auto latest = std::max_element(
      groups_.begin(), groups_.end(),
      [](const auto& a, const auto& b) { return a.second.last_heard < b.second.last_heard; });
  return latest == groups_.end() ? "" : latest->first;
}

LiveGroup& LiveState::group(std::string_view name, SteadyTime now) {
  auto found = groups_.find(name);
  if (found == groups_.end()) {
    make_room(groups_, kMostGroupsKept);
    found = groups_.emplace(std::string(name), LiveGroup()).first;
    found->second.touched.name = std::string(name);
  }
  found->second.last_heard = now;
  return found->second;
}

void LiveState::begin_object(LiveGroup& group, std::uint64_t object) {
  group.has_previous_object = group.has_object;
  group.previous_object = group.touched.object;
  group.has_object = true;
  group.touched.object = object;
  group.touched.probes.clear();
  group.touched.runs.clear();
  group.run_of.clear();
  group.samples_received = 0;
  group.samples_kept = 0;
  group.answer.Clear();
  group.has_answer = false;
  group.generation = ++next_version_;
  group.version = next_version_;
}

void LiveState::place_origin(LiveGroup& group, const Vec2& first) {
  if (group.samples_kept == 0 && !group.has_answer) group.origin_m = first;
}

void LiveState::take(const v1::ContactBatch& batch, SteadyTime now) {
  if (!is_drawable(batch)) return;
  const std::string& probe = batch.header().source();
  LiveGroup& live = group(batch.group().empty() ? probe : batch.group(), now);
  if (!live.has_object || live.touched.object != batch.object()) begin_object(live, batch.object());
  place_origin(live, {batch.samples(0).x_m(), batch.samples(0).y_m()});
  const auto [found, is_new] =
      live.run_of.try_emplace({probe, batch.patch()}, live.touched.runs.size());
  if (is_new) {
    auto& probes = live.touched.probes;
    const auto known = std::find(probes.begin(), probes.end(), probe);
    const auto number = static_cast<std::uint32_t>(known - probes.begin());
    if (known == probes.end()) probes.push_back(probe);
    live.touched.runs.push_back(
        {{number, batch.patch(), batch.tip_radius_m(), side_of(batch.material_side())}, {}});
  }
  ContactRun& run = live.touched.runs[found->second];
  for (const v1::ContactSample& sample : batch.samples()) {
    run.samples.push_back({{sample.x_m(), sample.y_m()}, sample.sigma_m(), sample.stamp_ns()});
  }
  const auto count = static_cast<std::size_t>(batch.samples_size());
  live.samples_received += count;
  live.samples_kept += count;
  while (live.samples_kept > kMostSamplesKept) {
    thin(live);
    live.generation = ++next_version_;
  }
}

void LiveState::take(const v1::Recognition& answer, SteadyTime now, std::int64_t received_ns) {
  if (!is_valid_name(answer.group())) return;
  const LiveGroup* known = find(answer.group());
  const bool is_late = known != nullptr && known->has_previous_object &&
                       known->previous_object == answer.object() &&
                       known->touched.object != answer.object();
  if (is_late) return;
  LiveGroup& live = group(answer.group(), now);
  if (!live.has_object || live.touched.object != answer.object()) {
    begin_object(live, answer.object());
  }
  if (!answer.contacts().empty()) {
    place_origin(live, {answer.contacts(0).x_m(), answer.contacts(0).y_m()});
  }
  live.answer = answer;
  live.has_answer = true;
  live.answer_received_ns = received_ns;
  live.answer_rate.add(now, 1);
  live.version = ++next_version_;
}

void LiveState::take(const v1::NodeStatus& status, SteadyTime now) {
  const std::string& name = status.header().source();
  if (!is_valid_name(name)) return;
  auto found = nodes_.find(name);
  if (found == nodes_.end()) {
    make_room(nodes_, kMostNodesKept);
    found = nodes_.emplace(name, LiveNode()).first;
  }
  found->second.status = status;
  auto& probes = *found->second.status.mutable_probes();
  if (probes.size() > kMostProbesShown) {
    probes.DeleteSubrange(kMostProbesShown, probes.size() - kMostProbesShown);
  }
  found->second.last_heard = now;
  ++status_version_;
}

}  // namespace palpate

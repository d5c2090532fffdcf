#include "node/tool/view/live_state.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "node/wire/convert.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;

// A viewer that follows the touch leaves a group that has not been touched for this long if another
// one is: longer than from batch to batch of a stroke, so that strokes on two groups at once do not
// make it flicker, and shorter than from touch to touch.
constexpr std::chrono::milliseconds kFollowAfter{250};

template <typename Entry>
void keep_every_second(std::vector<Entry>& entries) {
  for (std::size_t i = 0; 2 * i < entries.size(); ++i) entries[i] = entries[2 * i];
  entries.resize((entries.size() + 1) / 2);
}

/// Keeps every second sample of every run; of runs with a single sample, the later half of the
/// runs.
void thin(LiveGroup& group) {
  std::vector<ContactRun> kept;
  const std::size_t runs = group.touched.runs.size();
  std::vector<std::size_t> place_of(runs, runs);  // where a run is kept; `runs` = nowhere
  for (std::size_t number = 0; number < runs; ++number) {
    ContactRun& run = group.touched.runs[number];
    if (run.samples.size() == 1 && 2 * number < runs) continue;
    keep_every_second(run.samples);
    keep_every_second(run.details);
    place_of[number] = kept.size();
    kept.push_back(std::move(run));
  }
  group.touched.runs = std::move(kept);
  for (auto& [probe, open] : group.open_runs) open.run = place_of[open.run];
  std::erase_if(group.open_runs, [&](const auto& open) { return open.second.run == runs; });
  group.samples_kept = 0;
  for (const ContactRun& run : group.touched.runs) group.samples_kept += run.samples.size();
}

SampleDetail detail_of(const v1::ContactSample& sample) {
  return {Vec2(sample.normal_x(), sample.normal_y()), sample.normal_sigma_rad(),
          Eigen::Vector3d(sample.cov_xx_m2(), sample.cov_xy_m2(), sample.cov_yy_m2())};
}

void append(const v1::ContactSample& sample, ContactRun& run) {
  const SampleDetail detail = detail_of(sample);
  const bool has_covariance = detail.covariance_m2.x() > 0.0;
  if (says_more(detail) || !run.details.empty()) {
    run.details.resize(run.samples.size());
    run.details.push_back(detail);
  }
  run.samples.push_back({{sample.x_m(), sample.y_m()},
                         has_covariance ? mean_sigma_m(detail.covariance_m2) : sample.sigma_m(),
                         sample.stamp_ns()});
}

/// False for a batch with invalid names or numbers: it is not ours to draw.
bool is_drawable(const v1::ContactBatch& batch) {
  const auto is_finite = [](const v1::ContactSample& sample) {
    return std::isfinite(sample.x_m()) && std::isfinite(sample.y_m()) &&
           std::isfinite(sample.sigma_m()) && is_sound(detail_of(sample));
  };
  return is_valid_name(batch.header().source()) &&
         (batch.group().empty() || is_valid_name(batch.group())) &&
         std::isfinite(batch.tip_radius_m()) && !batch.samples().empty() &&
         std::all_of(batch.samples().begin(), batch.samples().end(), is_finite);
}

/// The entry to remove if the map is full; end() if there is room.
template <typename Map>
auto one_too_many(Map& map, std::size_t most) {
  if (map.size() < most) return map.end();
  return std::min_element(map.begin(), map.end(), [](const auto& a, const auto& b) {
    return a.second.last_heard < b.second.last_heard;
  });
}

}  // namespace

LiveGroup* LiveState::find(std::string_view name) {
  const auto found = groups_.find(name);
  return found == groups_.end() ? nullptr : &found->second;
}

std::string LiveState::followed_group(std::string_view shown, SteadyTime now) const {
  const auto present = groups_.find(shown);
  if (present != groups_.end() && now - present->second.last_touched < kFollowAfter) {
    return present->first;
  }
  const auto latest = std::max_element(
      groups_.begin(), groups_.end(),
      [](const auto& a, const auto& b) { return a.second.last_touched < b.second.last_touched; });
  return latest == groups_.end() ? "" : latest->first;
}

LiveGroup& LiveState::group(std::string_view name, SteadyTime now) {
  auto found = groups_.find(name);
  if (found == groups_.end()) {
    if (const auto gone = one_too_many(groups_, kMostGroupsKept); gone != groups_.end()) {
      seal_era(gone->second);
      groups_.erase(gone);
    }
    found = groups_.emplace(std::string(name), LiveGroup()).first;
    found->second.touched.name = std::string(name);
  }
  found->second.last_heard = now;
  return found->second;
}

void LiveState::keep_moment(LiveGroup& group) {
  Moment moment{group.touched.name,
                group.answer_received_ns / kNsPerMs,
                group.answer.SerializeAsString(),
                group.origin_m,
                group.samples_received,
                group.era,
                {}};
  for (const ContactRun& run : group.touched.runs) {
    moment.counts.push_back(static_cast<std::uint32_t>(run.samples.size()));
  }
  group.last_moment_ns = group.answer_received_ns;
  history_.add(std::move(moment));
}

void LiveState::seal_era(LiveGroup& group) {
  history_.seal(std::exchange(group.era, std::make_shared<SampleEra>()), group.touched);
}

std::vector<std::int64_t> LiveState::moments_of(std::string_view name) {
  LiveGroup* const present = find(name);
  const bool is_news = present != nullptr && present->has_answer &&
                       present->last_moment_ns != present->answer_received_ns;
  if (is_news) keep_moment(*present);
  return history_.times(name);
}

LiveGroup LiveState::group_at(const Moment& moment) const {
  LiveGroup then;
  const auto present = groups_.find(moment.group);
  if (moment.era->past) {
    then.touched = *moment.era->past;
  } else if (present != groups_.end() && present->second.era == moment.era) {
    then.touched = present->second.touched;
  }
  auto& runs = then.touched.runs;
  runs.resize(std::min(runs.size(), moment.counts.size()));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].samples.resize(std::min<std::size_t>(runs[i].samples.size(), moment.counts[i]));
    runs[i].details.resize(std::min(runs[i].details.size(), runs[i].samples.size()));
    then.samples_kept += runs[i].samples.size();
  }
  then.samples_received = moment.samples_received;
  then.origin_m = moment.origin_m;
  then.answer.ParseFromString(moment.answer);
  then.has_answer = true;
  then.answer_received_ns = moment.time_ms * kNsPerMs;
  then.touched.name = moment.group;
  then.touched.object = then.answer.object();
  return then;
}

void LiveState::begin_object(LiveGroup& group, std::uint64_t object) {
  // The last state of an object is always kept, however soon it follows the one before.
  if (group.has_answer && group.last_moment_ns != group.answer_received_ns) keep_moment(group);
  seal_era(group);
  group.has_previous_object = group.has_object;
  group.previous_object = group.touched.object;
  group.has_object = true;
  group.touched.object = object;
  group.touched.probes.clear();
  group.touched.runs.clear();
  group.open_runs.clear();
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

/// The stroke that a batch continues, or a new one, as the node sees it: a patch number that comes
/// again after another is of a new touch.
ContactRun& LiveState::run_of(LiveGroup& group, const v1::ContactBatch& batch) {
  const std::string& probe = batch.header().source();
  auto& probes = group.touched.probes;
  auto& runs = group.touched.runs;
  const auto known = std::find(probes.begin(), probes.end(), probe);
  const PatchContext context = {
      static_cast<std::uint32_t>(known - probes.begin()), batch.patch(), batch.tip_radius_m(),
      from_wire(batch.material_side()).value_or(MaterialSide::Unspecified)};
  if (known == probes.end()) probes.push_back(probe);
  const auto open = group.open_runs.find(probe);
  if (open != group.open_runs.end() && open->second.epoch == batch.header().epoch()) {
    ContactRun& run = runs[open->second.run];
    if (is_of_one_stroke(run.context, context)) {
      run.context = continued(run.context, context);
      return run;
    }
  }
  group.open_runs[probe] = {runs.size(), batch.header().epoch()};
  runs.push_back({context, {}, {}});
  return runs.back();
}

void LiveState::take(const v1::ContactBatch& batch, SteadyTime now) {
  if (!is_drawable(batch)) return;
  const std::string& probe = batch.header().source();
  LiveGroup& live = group(batch.group().empty() ? probe : batch.group(), now);
  if (!live.has_object || live.touched.object != batch.object()) begin_object(live, batch.object());
  place_origin(live, {batch.samples(0).x_m(), batch.samples(0).y_m()});
  live.last_touched = now;
  ContactRun& run = run_of(live, batch);
  for (const v1::ContactSample& sample : batch.samples()) append(sample, run);
  const auto count = static_cast<std::size_t>(batch.samples_size());
  live.samples_received += count;
  live.samples_kept += count;
  while (live.samples_kept > kMostSamplesKept) {
    seal_era(live);
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
  // Of touches whose contacts were lost, or came before this view.
  if (answer.sample_count() > live.samples_received) live.last_touched = now;
  live.answer = answer;
  live.has_answer = true;
  live.answer_received_ns = received_ns;
  live.answer_rate.add(now, 1);
  live.version = ++next_version_;
  // The distance in time, in either direction, because the clock may have been set.
  if (std::abs(received_ns - live.last_moment_ns) >= LiveHistory::kLeastInterval_ms * kNsPerMs) {
    keep_moment(live);
  }
}

void LiveState::take(const v1::NodeStatus& status, SteadyTime now) {
  const std::string& name = status.header().source();
  if (!is_valid_name(name)) return;
  auto found = nodes_.find(name);
  if (found == nodes_.end()) {
    if (const auto gone = one_too_many(nodes_, kMostNodesKept); gone != nodes_.end()) {
      nodes_.erase(gone);
    }
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

#include "core/recognition/samples/sample_memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/recognition/samples/dwell_means.h"
#include "core/recognition/samples/mean_on_path.h"
#include "core/recognition/samples/merged_samples.h"
#include "core/recognition/samples/sample_faults.h"

namespace palpate {
namespace {

/// Replaces sample `to` by the mean of samples `from` and `from` + 1. `to` must be <= `from`.
void merge_into(StoredPatch* patch, std::size_t to, std::size_t from) {
  std::vector<StoredSample>& samples = patch->samples;
  const StoredSample mean = merged(samples[from], samples[from + 1]);
  if (!patch->details.empty()) {
    std::vector<SampleDetail>& details = patch->details;
    details[to] = merged(samples[from], details[from], samples[from + 1], details[from + 1]);
  }
  samples[to] = mean;
  if (!patch->details.empty() && patch->details[to].covariance_m2.x() > 0.0) {
    samples[to].sigma_m = mean_sigma_m(patch->details[to].covariance_m2);
  }
}

/// Merges neighbours pairwise. An odd last sample stays alone, to be filled up later.
void merge_pairs(StoredPatch* patch) {
  std::vector<StoredSample>& samples = patch->samples;
  const std::size_t pairs = samples.size() / 2;
  for (std::size_t k = 0; k < pairs; ++k) {
    merge_into(patch, k, 2 * k);
  }
  const std::size_t left = samples.size() - pairs;
  if (left > pairs) {
    samples[pairs] = samples.back();
    if (!patch->details.empty()) patch->details[pairs] = patch->details.back();
  }
  samples.resize(left);
  if (!patch->details.empty()) patch->details.resize(left);
  patch->contacts_per_sample *= 2.0;
}

/// Merges the dwells of a patch if that frees at least a quarter of its samples; otherwise too many
/// calls would gain too little. Returns whether it did.
bool merge_dwells(StoredPatch* patch) {
  StoredPatch moved = without_dwells(*patch, 0.0);
  if (4 * moved.samples.size() > 3 * patch->samples.size()) {
    return false;
  }
  *patch = std::move(moved);
  return true;
}

std::size_t contacts_of(const StoredPatch& patch) {
  double count = 0.0;
  for (const StoredSample& sample : patch.samples) {
    count += sample.contacts;
  }
  return static_cast<std::size_t>(count);
}

MemoryOptions at_least_usable(MemoryOptions options) {
  options.most_samples_per_patch = std::max(options.most_samples_per_patch, kFewestMeans);
  options.most_patches = std::max<std::size_t>(options.most_patches, 1);
  options.most_lone_touches = std::max<std::size_t>(options.most_lone_touches, 1);
  return options;
}

}  // namespace

SampleMemory::SampleMemory(const MemoryOptions& options) : options_(at_least_usable(options)) {}

AddResult SampleMemory::add(const PatchContext& context, std::span<const ContactSample> samples,
                            std::span<const SampleDetail> details) {
  AddResult result;
  if (const SampleFault fault = fault_of_all(context, samples, details);
      fault != SampleFault::None) {
    (fault == SampleFault::TipRadius ? result.rejected_tip_radius : result.rejected_detail) =
        samples.size();
    return result;
  }
  StoredPatch* patch = patches_.find(context);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ContactSample& sample = samples[i];
    if (const SampleFault fault = fault_of(i, samples, details); fault != SampleFault::None) {
      ++(fault == SampleFault::NotFinite       ? result.rejected_not_finite
         : fault == SampleFault::NegativeSigma ? result.rejected_negative_sigma
                                               : result.rejected_detail);
      continue;
    }
    if (patch == nullptr) {
      patch = patches_.begin(context);
    }
    std::vector<StoredSample>& stored = patch->samples;
    const bool is_touch_or_was = stored.size() <= 1;
    if (!stored.empty() && patch->newest_m == sample.position_m && !options_.takes_repeated) {
      ++result.repeated;
      continue;
    }
    patch->context = continued(patch->context, context);
    patch->newest_m = sample.position_m;
    ++result.accepted;
    const bool detailed = !details.empty() && says_more(details[i]);
    result.detailed += detailed ? 1 : 0;
    const bool fills_up = !stored.empty() && stored.back().contacts < patch->contacts_per_sample;
    if (!fills_up && stored.size() >= options_.most_samples_per_patch &&
        (options_.takes_repeated || !merge_dwells(patch))) {
      merge_pairs(patch);
    }
    stored.push_back({sample.position_m, sample.sigma_m, 1.0});
    if (detailed || !patch->details.empty()) {
      patch->details.resize(stored.size());
      if (detailed) patch->details.back() = details[i];
    }
    if (fills_up) {
      merge_into(patch, stored.size() - 2, stored.size() - 2);
      stored.pop_back();
      if (!patch->details.empty()) patch->details.pop_back();
      continue;
    }
    if (is_touch_or_was) {
      result.forgotten += make_room(&patch);
    }
  }
  return result;
}

std::size_t SampleMemory::make_room(StoredPatch** growing) {
  const bool lone = (*growing)->samples.size() == 1;
  lone_touches_ = lone ? lone_touches_ + 1 : lone_touches_ - 1;
  const bool fits = lone ? lone_touches_ <= options_.most_lone_touches
                         : patches_.size() - lone_touches_ <= options_.most_patches;
  if (fits) {
    return 0;
  }
  lone_touches_ -= lone ? 1 : 0;
  return contacts_of(patches_.take_oldest(lone, growing));
}

std::size_t SampleMemory::sample_count() const {
  std::size_t count = 0;
  for (const StoredPatch& patch : patches_.patches()) {
    count += contacts_of(patch);
  }
  return count;
}

ContactRun as_contacts(const StoredPatch& patch) {
  ContactRun run;
  run.context = patch.context;
  run.details = patch.details;
  run.samples.reserve(patch.samples.size());
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const StoredSample& stored = patch.samples[i];
    ContactSample& sample = run.samples.emplace_back();
    sample.position_m = mean_on_path(patch, i);
    sample.sigma_m = stored.sigma_m / std::sqrt(stored.weight);
    if (!run.details.empty()) run.details[i].covariance_m2 /= stored.weight;
  }
  return run;
}

}  // namespace palpate

#include "core/recognition/samples/sample_memory.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Mean of two stored samples. sigma_m is the noise of one contact: variances are pooled, unknown
/// stays unknown.
StoredSample merged(const StoredSample& a, const StoredSample& b) {
  StoredSample mean;
  mean.weight = a.weight + b.weight;
  mean.position_m = (a.weight * a.position_m + b.weight * b.position_m) / mean.weight;
  if (a.sigma_m > 0.0 && b.sigma_m > 0.0) {
    mean.sigma_m = std::sqrt(
        mean.weight / (a.weight / (a.sigma_m * a.sigma_m) + b.weight / (b.sigma_m * b.sigma_m)));
  }
  return mean;
}

/// Merges neighbours pairwise; an odd last sample stays to be filled up.
void merge_pairs(StoredPatch* patch) {
  std::vector<StoredSample>& samples = patch->samples;
  const std::size_t pairs = samples.size() / 2;
  for (std::size_t k = 0; k < pairs; ++k) {
    samples[k] = merged(samples[2 * k], samples[2 * k + 1]);
  }
  if (samples.size() % 2 == 1) {
    samples[pairs] = samples.back();
    samples.resize(pairs + 1);
  } else {
    samples.resize(pairs);
  }
  patch->contacts_per_sample *= 2.0;
  // A turn d between chords of length w means kappa = d / w (noise included: rather too much).
  for (std::size_t k = 2; k < pairs; ++k) {
    const Vec2 before = samples[k - 1].position_m - samples[k - 2].position_m;
    const Vec2 after = samples[k].position_m - samples[k - 1].position_m;
    const double turn = std::abs(std::atan2(cross(before, after), before.dot(after)));
    patch->merge_bias_m = std::max(patch->merge_bias_m, turn * after.norm() / 24.0);
  }
}

std::size_t contacts_of(const StoredPatch& patch) {
  double count = 0.0;
  for (const StoredSample& sample : patch.samples) {
    count += sample.weight;
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

AddResult SampleMemory::add(const PatchContext& context, std::span<const ContactSample> samples) {
  AddResult result;
  auto place = std::find_if(patches_.begin(), patches_.end(), [&](const StoredPatch& patch) {
    return patch.context.probe == context.probe && patch.context.patch == context.patch;
  });
  for (const ContactSample& sample : samples) {
    if (!sample.position_m.allFinite() || !std::isfinite(sample.sigma_m)) {
      ++result.rejected_not_finite;
      continue;
    }
    if (sample.sigma_m < 0.0) {
      ++result.rejected_negative_sigma;
      continue;
    }
    if (place == patches_.end()) {
      StoredPatch patch;
      patch.context = context;
      patches_.push_back(std::move(patch));
      place = patches_.end() - 1;
    }
    std::vector<StoredSample>& stored = place->samples;
    if (!stored.empty() && place->newest_m == sample.position_m) {
      ++result.repeated;
      continue;
    }
    place->newest_m = sample.position_m;
    ++result.accepted;
    const StoredSample contact{sample.position_m, sample.sigma_m, 1.0};
    if (!stored.empty() && stored.back().weight < place->contacts_per_sample) {
      stored.back() = merged(stored.back(), contact);
      continue;
    }
    if (stored.size() >= options_.most_samples_per_patch) {
      merge_pairs(&*place);
    }
    stored.push_back(contact);
    if (stored.size() <= 2) {
      const bool lone = stored.size() == 1;
      result.forgotten +=
          make_room(lone, lone ? options_.most_lone_touches : options_.most_patches, &place);
    }
  }
  return result;
}

std::size_t SampleMemory::make_room(bool lone, std::size_t most, Patch* growing) {
  const auto is_such = [&](const StoredPatch& patch) {
    return (patch.samples.size() == 1) == lone;
  };
  const auto count = std::count_if(patches_.begin(), patches_.end(), is_such);
  if (static_cast<std::size_t>(count) <= most) {
    return 0;
  }
  auto oldest = std::find_if(patches_.begin(), patches_.end(), is_such);
  if (oldest == *growing) {
    oldest = std::find_if(oldest + 1, patches_.end(), is_such);
  }
  const std::size_t contacts = contacts_of(*oldest);
  const auto grown = *growing - patches_.begin() - (oldest < *growing ? 1 : 0);
  patches_.erase(oldest);
  *growing = patches_.begin() + grown;
  return contacts;
}

std::size_t SampleMemory::sample_count() const {
  std::size_t count = 0;
  for (const StoredPatch& patch : patches_) {
    count += contacts_of(patch);
  }
  return count;
}

std::size_t SampleMemory::stored_count() const {
  std::size_t count = 0;
  for (const StoredPatch& patch : patches_) {
    count += patch.samples.size();
  }
  return count;
}

}  // namespace palpate

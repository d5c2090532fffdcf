// What is kept of a patch: its samples, some of them means of several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

/// A sample in memory: one contact, or the mean of several consecutive ones.
struct StoredSample {
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;   ///< noise of ONE of the contacts that it stands for; 0 = not known
  double weight = 1.0;    ///< how many contacts with noise of their own it says as much as
  double contacts = 1.0;  ///< how many it stands for
};

struct StoredPatch {
  PatchContext context;
  std::vector<StoredSample> samples;  ///< in their order along the arc
  /// Of the samples; empty where none of them says more. Of a mean of several the covariance is
  /// that of ONE of them, the normal and its deviation those of their mean.
  std::vector<SampleDetail> details = {};
  double contacts_per_sample = 1.0;  ///< that a stored sample is the mean of; where the probe stood
                                     ///< still, of more (dwells.h)
  Vec2 newest_m = Vec2::Zero();      ///< last contact taken
  /// How far a mean of contacts over an arc w lies off the curve: kappa w^2 / 24, the largest [m]
  double merge_bias_m = 0.0;
  /// Touches strung into a run (touches/strung_touches.h): it changes anywhere, not only at its
  /// end.
  bool strung = false;
  /// Of a touch alone that lies on the way through such runs: the way's direction, unit, and the
  /// turn of its step there [rad]; zero where there is none.
  Vec2 direction = Vec2::Zero();
  double turn = 0.0;
};

/// A run of samples or points of one patch, in their order along the arc: [begin, end).
struct PatchSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

/// What tells that a patch of a memory, whose samples come at its end, is still the same.
struct PatchVersion {
  std::uint32_t probe = 0;
  std::uint32_t patch = 0;
  std::size_t samples = 0;
  double contacts_per_sample = 0.0;
  Vec2 newest_m = Vec2::Zero();

  bool operator==(const PatchVersion&) const = default;
};

inline PatchVersion version_of(const StoredPatch& patch) {
  return {patch.context.probe, patch.context.patch, patch.samples.size(), patch.contacts_per_sample,
          patch.newest_m};
}

}  // namespace palpate

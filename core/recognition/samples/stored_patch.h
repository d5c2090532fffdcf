// What is kept of a patch: its samples, some of them means of several contacts.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

/// A sample in memory: one contact, or the mean of several consecutive ones.
struct StoredSample {
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;       ///< noise of ONE of its contacts; 0 = not known [m]
  double weight = 1.0;        ///< number of contacts with independent noise that it is worth
  double contacts = 1.0;      ///< number of contacts that it stands for
  bool is_off_dwell = false;  ///< a spike beside the place where the probe stood still

  bool operator==(const StoredSample&) const = default;
};

/// Noise of one contact of a sample: as stated, or else the default. 0 = not known [m]
inline double sigma_m_of(const StoredSample& sample, double default_sigma_m) {
  return sample.sigma_m > 0.0 ? sample.sigma_m : default_sigma_m;
}

/// Mean variance of the samples, of which there are some, each a mean of several contacts, as their
/// noise is stated; nullopt unless it is stated of all. [m^2]
inline std::optional<double> stated_variance_m2(std::span<const StoredSample> samples,
                                                double default_sigma_m) {
  double sum = 0.0;
  for (const StoredSample& sample : samples) {
    const double sigma_m = sigma_m_of(sample, default_sigma_m);
    if (!(sigma_m > 0.0)) {
      return std::nullopt;
    }
    sum += sigma_m * sigma_m / sample.weight;
  }
  return sum / static_cast<double>(samples.size());
}

struct StoredPatch {
  PatchContext context;
  std::vector<StoredSample> samples;  ///< in their order along the arc
  /// One per sample; empty if no sample has one. For a mean of several contacts: the covariance of
  /// ONE of them, but the normal and its standard deviation of their mean.
  std::vector<SampleDetail> details = {};
  /// Contacts per stored sample; a dwell's sample stands for more (dwells.h).
  double contacts_per_sample = 1.0;
  Vec2 newest_m = Vec2::Zero();  ///< the last contact added
  /// True for a run of single touches (touches/joined_touches.h).
  bool is_joined = false;
  /// For a single touch that lies on the way through such runs: direction of the way, unit, and the
  /// turn of the way's step there [rad]. Zero if unknown.
  Vec2 direction = Vec2::Zero();
  double turn = 0.0;

  bool operator==(const StoredPatch&) const = default;
};

/// What is said of a patch's first sample: of a single touch all there is.
inline SampleDetail first_detail(const StoredPatch& patch) {
  return patch.details.empty() ? SampleDetail{} : patch.details.front();
}

/// Whether most of the patches are of one sample: no neighbours tell noise, order or directions.
inline bool are_mostly_touches(std::span<const StoredPatch> patches) {
  const auto lone = std::count_if(patches.begin(), patches.end(), [](const StoredPatch& patch) {
    return patch.samples.size() == 1;
  });
  return 2 * lone > static_cast<std::ptrdiff_t>(patches.size());
}

/// Number of their samples, a mean of several counted once.
inline std::size_t count_samples(std::span<const StoredPatch> patches) {
  std::size_t count = 0;
  for (const StoredPatch& patch : patches) {
    count += patch.samples.size();
  }
  return count;
}

/// The box that holds all samples. [m]
inline Eigen::AlignedBox2d box_of(std::span<const StoredPatch> patches) {
  Eigen::AlignedBox2d box;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      box.extend(sample.position_m);
    }
  }
  return box;
}

/// Half the longer side of a box; 0 if it holds nothing. [m]
inline double half_extent_m(const Eigen::AlignedBox2d& box) {
  return box.isEmpty() ? 0.0 : 0.5 * box.sizes().maxCoeff();
}

/// A range of samples or points of one patch, in their order along the arc: [begin, end).
struct PatchSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool is_joined = false;  ///< StoredPatch's
  std::size_t size() const { return end - begin; }
};

}  // namespace palpate

// Sensor spikes, found by the fit that explains all other points.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// Samples that lie farther from the best class than noise lets any.
struct FarSamples {
  /// One flag a sample, where they are outliers: those that were set aside before are, too. Empty
  /// if there are no more.
  std::vector<bool> aside;
  /// More of them follow one another than spikes do: the part leaves the class there.
  bool are_form = false;
};

/// Gaussian noise puts a sample so far anywhere in a scene with probability
/// `false_outlier_probability`. They are no outliers if the curve itself does not fit: runs of more
/// than three, more than two plus a twentieth of all points, or a misfit of the other points.
/// `weighing`: of the points of `data` that have no flag in `aside`. Where nobody states the
/// noise, most residuals tell it, and the limit is Student's quantile.
FarSamples far_samples(const Weighing& weighing, const FitData& data, std::vector<bool> aside,
                       double false_outlier_probability);

struct SetAside {
  StoredSample sample;
  double tip_radius_m = 0.0;
};

/// The samples with a flag: one flag per sample, or none at all.
std::vector<SetAside> flagged_samples(std::span<const StoredPatch> patches,
                                      const std::vector<bool>& flagged);

/// Where they lie. [m]
std::vector<Vec2> places_of(std::span<const SetAside> samples);

/// One flag per sample of `all`: it is not in `used`, or flagged there (one flag per sample, or
/// none at all).
std::vector<bool> samples_set_aside(std::span<const StoredPatch> all,
                                    std::span<const StoredPatch> used,
                                    const std::vector<bool>& flagged);

/// True if so many of the `stored` samples are set aside that spikes among the `used` ones may have
/// been missed.
bool may_have_missed_spikes(std::size_t stored, std::size_t used);

/// One flag per point of `all`: not in `kept`, which has the others in their order.
std::vector<bool> left_out(const FitData& all, const FitData& kept);

}  // namespace palpate

// Sensor spikes, found by the fit that explains all other points.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// `data` without the outliers of the best class: points whose residual exceeds a limit. Gaussian
/// noise exceeds it anywhere in a scene with probability `false_outlier_probability`. nullopt if
/// there are none. Also nullopt if the curve itself does not fit: runs of more than three such
/// points, more than two plus a twentieth of all points, or a misfit of the other points.
/// `sigma_known`: as given by make_fit_data; if false, the limit is Student's quantile, because
/// the residuals themselves determine the noise.
std::optional<FitData> without_outliers(const Weighing& weighing, const FitData& data,
                                        bool sigma_known, double false_outlier_probability);

/// Positions of the samples of `all` that are not in `used`, or flagged there: one flag per sample,
/// or none at all.
std::vector<Vec2> places_set_aside(std::span<const StoredPatch> all,
                                   std::span<const StoredPatch> used,
                                   const std::vector<bool>& flagged);

/// True if so many of the `stored` samples are set aside that spikes among the `used` ones may have
/// been missed.
bool may_have_missed_spikes(std::size_t stored, std::size_t used);

/// One flag per point of `all`: not in `kept`, which has the others in their order.
std::vector<bool> left_out(const FitData& all, const FitData& kept);

}  // namespace palpate

// Sensor spikes, found by the fit that explains all other points.
#pragma once

#include <optional>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// `data` without the points whose residual from the best class is larger than Gaussian noise makes
/// any of the scene's points, with probability `false_outlier_probability`. nullopt if there are
/// none. Also nullopt if the curve just does not fit: runs of more than three such points, more
/// than two plus a twentieth of all points, or the other points misfit too. `sigma_known`: as given
/// by make_fit_data; if false, the limit is Student's quantile, because the residuals themselves
/// determine the noise.
std::optional<FitData> without_outliers(const Weighing& weighing, const FitData& data,
                                        bool sigma_known, double false_outlier_probability);

}  // namespace palpate

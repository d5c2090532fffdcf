// Spikes of the sensor, told by the fit that explains all the other points.
#pragma once

#include <optional>
#include <vector>

#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// `data` without the points whose residual from the best class exceeds what Gaussian noise reaches
/// in any point of a scene with probability `false_outlier_probability`. Runs of more than
/// three such points, or more than two and a twentieth of all, are no leftovers of the spike
/// detection but a curve that does not fit: nullopt, as when there are none.
/// `sigma_known`: as make_fit_data says; a noise that the residuals themselves must tell is known
/// by so many of them only.
std::optional<FitData> without_outliers(const Weighing& weighing, const FitData& data,
                                        bool sigma_known, double false_outlier_probability);

/// One flag per point of `all`: not in `kept`, which has the others in their order.
std::vector<bool> left_out(const FitData& all, const FitData& kept);

}  // namespace palpate

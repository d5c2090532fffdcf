#include "core/recognition/given/given_correlation.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

ResidualCorrelation count_correlation(std::span<const GivenPoint> points, GivenFit* fit) {
  if (!has_curve(*fit)) {
    return {};
  }
  FitData data;
  std::vector<double> residuals;
  std::size_t stroke = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].set_aside) {
      continue;
    }
    if (points[i].stroke == 0 || points[i].stroke != stroke) {
      data.patches.push_back({data.points.size(), data.points.size()});
    }
    stroke = points[i].stroke;
    data.points.push_back({points[i].position_m});
    data.patches.back().end = data.points.size();
    residuals.push_back(fit->residuals[i].distance_m);
  }
  ResidualCorrelation correlation = correlation_of(data, residuals);
  if (fit->sigma_stated && fit->dof > 0) {
    correlation.time = 1.0 + std::min(1.0, fit->chi2 / fit->dof) * (correlation.time - 1.0);
  }
  fit->covariance *= correlation.time;
  return correlation;
}

}  // namespace palpate

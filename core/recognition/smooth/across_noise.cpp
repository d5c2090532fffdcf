#include "core/recognition/smooth/across_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

double variance_along(const Vec2& n, const Eigen::Vector3d& c) {
  return c.x() * n.x() * n.x() + 2.0 * c.y() * n.x() * n.y() + c.z() * n.y() * n.y();
}

/// Of a section whose samples' own noise does not turn its direction. By reduced point.
std::vector<bool> told_directions(const SmoothModel& smooth, const FitData& data) {
  double longest = 0.0;  // variance
  for (const PointDetail& detail : data.details) {
    longest = std::max(longest, detail.covariance.x() + detail.covariance.z());
  }
  const double least_length = kNegligibleDeviations * std::sqrt(longest);
  std::vector<bool> told(smooth.reduced.points.size(), false);
  for (const ReducedSection& section : smooth.sections) {
    if (!section.kept && 2.0 * section.half_length > least_length) {
      std::fill(told.begin() + static_cast<std::ptrdiff_t>(section.begin),
                told.begin() + static_cast<std::ptrdiff_t>(section.end), true);
    }
  }
  return told;
}

}  // namespace

void weigh_across(const Vec2& n, double rounding, PointDetail* detail, FitPoint* point) {
  if (detail->covariance.x() > 0.0) {
    const double least = rounding * rounding;
    const double across = std::max(variance_along(n, detail->covariance), least);
    const double along = std::max(variance_along(left_of(n), detail->covariance), least);
    point->inverse_sigma = 1.0 / std::sqrt(across);
    point->along_over_across = std::sqrt(along / across);
    detail->covariance.setZero();
  }
}

bool weigh_across_path(const SmoothModel& smooth, FitData* data) {
  const double rounding = rounding_level(*data);
  const std::vector<bool> told = told_directions(smooth, *data);
  bool any = false;
  for (std::size_t i = 0; i < data->details.size(); ++i) {
    PointDetail& detail = data->details[i];
    if (told[smooth.nearest_reduced[i]] && detail.covariance.x() > 0.0) {
      weigh_across(left_of(data->points[i].tangent), rounding, &detail, &data->points[i]);
      any = true;
    }
  }
  return any;
}

}  // namespace palpate

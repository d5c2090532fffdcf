#include "core/recognition/smooth/across_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/recognition/smooth/longest_variance.h"

namespace palpate {
namespace {

/// a . C b.
double between(const Vec2& a, const Eigen::Vector3d& c, const Vec2& b) {
  return c.x() * a.x() * b.x() + c.y() * (a.x() * b.y() + a.y() * b.x()) + c.z() * a.y() * b.y();
}

/// Weighs and moves what is as told by the path of `data`. Whether any is; by point.
std::vector<bool> moved_along(const FitData& as_told, FitData* data) {
  const double rounding = rounding_level(*data);
  std::vector<bool> is_moved(data->points.size(), false);
  for (std::size_t i = 0; i < data->points.size(); ++i) {
    const Vec2 travel = data->details[i].travel;
    const double off_path = data->details[i].off_path;
    const Eigen::Vector3d& covariance = as_told.details[i].covariance;
    data->points[i] = as_told.points[i];
    if (!travel.isZero() && covariance.x() > 0.0) {
      const Vec2 normal = left_of(travel);
      const double along_by_across =
          between(travel, covariance, normal) / between(normal, covariance, normal);
      PointDetail weighed = as_told.details[i];
      weigh_across(normal, rounding, &weighed, &data->points[i]);
      data->points[i].position -= along_by_across * off_path * travel;
      is_moved[i] = true;
    }
  }
  return is_moved;
}

}  // namespace

bool has_covariances(const FitData& data) {
  return std::any_of(data.details.begin(), data.details.end(),
                     [](const PointDetail& detail) { return detail.covariance.x() > 0.0; });
}

void weigh_across(const Vec2& n, double rounding, PointDetail* detail, FitPoint* point) {
  if (detail->covariance.x() > 0.0) {
    const double least = rounding * rounding;
    const double across = std::max(between(n, detail->covariance, n), least);
    const Vec2 t = left_of(n);
    const double along = std::max(between(t, detail->covariance, t), least);
    point->inverse_sigma = 1.0 / std::sqrt(across);
    point->along_over_across = std::sqrt(along / across);
    detail->covariance.setZero();
  }
}

SmoothModel smooth_across(bool sigma_known, const SectionSource& source, FitData* data) {
  constexpr int kMostRounds = 10;  // of which each leaves half of an error, at most
  constexpr double kSame = 1.0;    // of chi-square: odds that no answer depends on
  const FitData as_told = *data;
  for (std::size_t i = 0; i < data->points.size(); ++i) {
    data->points[i].inverse_sigma = 1.0 / std::sqrt(longest_variance(as_told, i));
  }
  SmoothModel smooth = fit_smooth_model(data, sigma_known, StatedNoise::MayBeTooLow, source);
  std::vector<bool> is_moved;
  for (int round = 0; round < kMostRounds; ++round) {
    is_moved = moved_along(as_told, data);
    SmoothModel next = fit_smooth_model(data, sigma_known);
    next.fitted += smooth.fitted;
    const bool stays = std::abs(next.chi2 - smooth.chi2) <= kSame;
    smooth = std::move(next);
    if (stays || std::find(is_moved.begin(), is_moved.end(), true) == is_moved.end()) {
      break;
    }
  }
  for (std::size_t i = 0; i < is_moved.size(); ++i) {
    if (is_moved[i]) {
      data->details[i].covariance.setZero();
    }
  }
  return smooth;
}

}  // namespace palpate

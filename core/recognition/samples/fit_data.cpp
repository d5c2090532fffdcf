#include "core/recognition/samples/fit_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace palpate {

namespace {

struct Extents {
  Pose2 frame;
  double half_extent = 0.0;
};

template <typename Function>
void for_each_sample(std::span<const StoredPatch> patches, const Function& function) {
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      function(sample);
    }
  }
}

/// The box of the points along their principal axes; nullopt without points.
std::optional<Extents> extents_of(std::span<const StoredPatch> patches) {
  double count = 0.0;
  Vec2 any = Vec2::Zero();
  for_each_sample(patches, [&](const StoredSample& sample) {
    count += sample.weight;
    any = sample.position_m;
  });
  if (!(count > 0.0)) {
    return std::nullopt;
  }
  Vec2 sum = Vec2::Zero();  // relative to one point: keeps the digits far from the origin
  for_each_sample(patches, [&](const StoredSample& sample) {
    sum += sample.weight * (sample.position_m - any);
  });
  const Vec2 mean = any + sum / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for_each_sample(patches, [&](const StoredSample& sample) {
    const Vec2 d = sample.position_m - mean;
    scatter += sample.weight * d * d.transpose();
  });
  const double angle = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  const Pose2 axes{mean.x(), mean.y(), angle};
  const ToLocal to_axes(axes);
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for_each_sample(patches, [&](const StoredSample& sample) {
    const Vec2 p = to_axes(sample.position_m);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  });
  const Vec2 centre = axes * (low + 0.5 * (high - low));
  return Extents{{centre.x(), centre.y(), angle}, 0.5 * (high - low).maxCoeff()};
}

/// Copies the normals of single touches.
void set_normals(std::span<const StoredPatch> patches, FitData* data) {
  // A direction known to rounding would be more precise than the computed normal of a curve. [rad]
  constexpr double kLeastSigma = 1e-7;
  auto span = data->patches.begin();
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    if (is_directed_touch(patch)) {
      const SampleDetail& detail = patch.details.front();
      FitPoint& point = data->points[span->begin];
      point.normal = data->frame.rotate_back(detail.normal);
      point.inverse_normal_sigma = 1.0 / std::max(detail.normal_sigma_rad, kLeastSigma);
    }
    ++span;
  }
}

}  // namespace

bool is_directed_touch(const StoredPatch& patch) {
  // Standard deviation of a direction anywhere in half a turn, pi / sqrt(12): no information. [rad]
  constexpr double kAnywhere = 0.9069;
  if (patch.samples.size() != 1 || patch.details.empty()) {
    return false;
  }
  const double sigma = patch.details.front().normal_sigma_rad;
  return sigma > 0.0 && sigma < kAnywhere;
}

std::size_t residual_count(const FitData& data) {
  std::size_t count = data.points.size();
  for (const PatchSpan& patch : data.patches) {
    count += patch.size() == 1 && data.points[patch.begin].inverse_normal_sigma > 0.0 ? 1 : 0;
  }
  return count;
}

double rms_sigma(const FitData& data) {
  double sum = 0.0;
  for (const FitPoint& point : data.points) {
    sum += 1.0 / (point.inverse_sigma * point.inverse_sigma);
  }
  return std::sqrt(sum / static_cast<double>(data.points.size()));
}

double noise_over_means(std::span<const StoredPatch> patches, double default_sigma_m) {
  double of_contacts = 0.0;
  double of_means = 0.0;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      const double sigma_m = sample.sigma_m > 0.0 ? sample.sigma_m : default_sigma_m;
      const double variance = sigma_m > 0.0 ? sigma_m * sigma_m : 1.0;
      of_contacts += variance;
      of_means += variance / sample.weight;
    }
  }
  return of_means > 0.0 ? std::sqrt(of_contacts / of_means) : 1.0;
}

double least_sigma(std::span<const FitPoint> points) {
  double sharpest = 0.0;
  for (const FitPoint& point : points) {
    sharpest = std::max(sharpest, point.inverse_sigma);
  }
  return 1.0 / sharpest;
}

double most_chi2_of_noise(std::span<const FitPoint> points) {
  double information = 0.0;
  for (const FitPoint& point : points) {
    information += point.inverse_sigma * point.inverse_sigma;
  }
  return kLargestNoise * kLargestNoise * information;
}

bool has_tips(std::span<const FitPoint> points) {
  return std::any_of(points.begin(), points.end(),
                     [](const FitPoint& point) { return point.offset > 0.0; });
}

double rounding_level(const FitData& data) {
  // A coordinate has an error of half a unit in the last place; a few of them add up in a residual.
  constexpr double kRoundings = 4.0;
  const double largest = data.frame.translation().cwiseAbs().maxCoeff() + data.scale;
  return kRoundings * std::numeric_limits<double>::epsilon() * largest / data.scale;
}

FitData make_fit_data(std::span<const StoredPatch> patches, double default_sigma_m,
                      bool* sigma_known) {
  FitData data;
  *sigma_known = true;
  const std::optional<Extents> extents = extents_of(patches);
  if (!extents) {
    return data;
  }
  data.frame = extents->frame;
  data.scale = extents->half_extent > 0.0 ? extents->half_extent : 1.0;
  const double least_sigma = rounding_level(data);
  const ToLocal to_frame(data.frame);
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    const std::size_t begin = data.points.size();
    for (const StoredSample& sample : patch.samples) {
      const double sigma_m = sample.sigma_m > 0.0 ? sample.sigma_m : default_sigma_m;
      *sigma_known = *sigma_known && sigma_m > 0.0;
      FitPoint point;
      point.position = to_frame(sample.position_m) / data.scale;
      point.tangent = data.frame.rotate_back(patch.direction);
      point.offset = patch.context.tip_radius_m / data.scale;
      const double sigma = sigma_m > 0.0 ? std::max(sigma_m / data.scale, least_sigma) : 1.0;
      point.inverse_sigma = std::sqrt(sample.weight) / sigma;
      data.points.push_back(point);
    }
    data.patches.push_back({begin, data.points.size()});
  }
  if (!*sigma_known) {
    // Stated and unstated noise do not mix: if one is not stated, the noise of all is estimated.
    std::size_t i = 0;
    for (const StoredPatch& patch : patches) {
      for (const StoredSample& sample : patch.samples) {
        data.points[i++].inverse_sigma = std::sqrt(sample.weight);
      }
    }
    return data;
  }
  set_normals(patches, &data);
  return data;
}

}  // namespace palpate

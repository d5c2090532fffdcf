#include "core/recognition/samples/fit_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/local/reading_step.h"
#include "core/recognition/samples/mean_on_path.h"

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

/// True if a normal shows a direction: its standard deviation is below that of a direction anywhere
/// in half a turn, pi / sqrt(12).
bool tells_direction(const SampleDetail& detail) {
  constexpr double kAnywhere = 0.9069;  // [rad]
  return detail.normal_sigma_rad > 0.0 && detail.normal_sigma_rad < kAnywhere;
}

/// Covariance [xx, xy, yy] of a stored sample, the mean of its contacts; normalised, in the frame.
Eigen::Vector3d covariance_in_frame(const Eigen::Vector3d& c, const StoredSample& sample,
                                    const FitData& data) {
  Eigen::Matrix2d in_world;
  in_world << c.x(), c.y(), c.y(), c.z();
  Eigen::Matrix2d axes;  // of the frame, in the world
  axes << data.frame.rotate(Vec2::UnitX()), data.frame.rotate(Vec2::UnitY());
  const double unit = data.scale * data.scale * sample.weight;
  const Eigen::Matrix2d there = axes.transpose() * in_world * axes / unit;
  return {there(0, 0), there(0, 1), there(1, 1)};
}

/// Copies normals and covariances. The normal of a tip that touched once is its direction.
void set_details(std::span<const StoredPatch> patches, FitData* data) {
  // A direction known to rounding would be more precise than the computed normal of a curve. [rad]
  constexpr double kLeastSigma = 1e-7;
  // A normal known to that leaves no doubt on which side a tip lies (tips/tip_sides.cpp), and the
  // tip taken off along it misses the surface by a fiftieth of its radius: what is left of that the
  // rounds that remove tips take away (weigh/fit_way.cpp). [rad]
  constexpr double kToldSigma = 0.2;
  auto span = data->patches.begin();
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    for (std::size_t k = 0; k < patch.details.size(); ++k) {
      const SampleDetail& detail = patch.details[k];
      FitPoint& point = data->points[span->begin + k];
      const bool alone = patch.samples.size() == 1;
      PointDetail said;
      if (tells_direction(detail)) {
        (alone ? point.normal : said.normal) = data->frame.rotate_back(detail.normal);
        (alone ? point.inverse_normal_sigma : said.inverse_normal_sigma) =
            1.0 / std::max(detail.normal_sigma_rad, kLeastSigma);
        if (alone && point.offset > 0.0 && detail.normal_sigma_rad <= kToldSigma) {
          point.tangent = -left_of(point.normal);
          point.tangent_sigma = detail.normal_sigma_rad;
        }
      }
      if (detail.covariance_m2.x() > 0.0) {
        said.covariance = covariance_in_frame(detail.covariance_m2, patch.samples[k], *data);
      }
      said.contacts = patch.samples[k].contacts;
      if (said.says_more()) {
        data->details.resize(data->points.size());
        data->details[span->begin + k] = said;
      }
    }
    ++span;
  }
}

double reading_noise_m(std::span<const StoredPatch> patches) {
  std::vector<Vec2> positions;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      positions.push_back(sample.position_m);
    }
  }
  return noise_of_rounding_m(reading_step_m(positions));
}

}  // namespace

std::size_t residual_count(const FitData& data) {
  std::size_t count = data.points.size();
  if (data.normals_along_strokes) {
    return count + static_cast<std::size_t>(std::count_if(
                       data.points.begin(), data.points.end(),
                       [](const FitPoint& point) { return point.inverse_normal_sigma > 0.0; }));
  }
  for (const PatchSpan& patch : data.patches) {
    count += patch.size() == 1 && data.points[patch.begin].inverse_normal_sigma > 0.0 ? 1 : 0;
  }
  return count;
}

FitData without_points(const FitData& data, const std::vector<bool>& is_out) {
  FitData kept = data;
  kept.points.clear();
  kept.patches.clear();
  kept.details.clear();
  for (const PatchSpan& patch : data.patches) {
    const std::size_t begin = kept.points.size();
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      if (!is_out[i]) {
        kept.points.push_back(data.points[i]);
        if (!data.details.empty()) kept.details.push_back(data.details[i]);
      }
    }
    kept.patches.push_back({begin, kept.points.size(), patch.is_joined});
  }
  return kept;
}

std::size_t contacts_with_details(const FitData& data) {
  double count = 0.0;
  for (const PointDetail& detail : data.details) {
    count += detail.says_more() ? detail.contacts : 0.0;
  }
  return static_cast<std::size_t>(std::lround(count));
}

double rms_sigma(const FitData& data) {
  double sum = 0.0;
  for (const FitPoint& point : data.points) {
    sum += 1.0 / (point.inverse_sigma * point.inverse_sigma);
  }
  return std::sqrt(sum / static_cast<double>(data.points.size()));
}

bool all_lie_apart(const FitData& data) {
  return std::all_of(data.patches.begin(), data.patches.end(),
                     [](const PatchSpan& patch) { return patch.size() <= 1; });
}

double noise_over_means(std::span<const StoredPatch> patches, double default_sigma_m) {
  double of_contacts = 0.0;
  double of_means = 0.0;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      const double sigma_m = sigma_m_of(sample, default_sigma_m);
      const double variance = sigma_m > 0.0 ? sigma_m * sigma_m : 1.0;
      of_contacts += variance;
      of_means += variance / sample.weight;
    }
  }
  return of_means > 0.0 ? std::sqrt(of_contacts / of_means) : 1.0;
}

double mean_step(const FitData& data) {
  double path = 0.0;
  std::size_t steps = 0;
  for (const PatchSpan& patch : data.patches) {
    for (std::size_t i = patch.begin + 1; i < patch.end; ++i) {
      path += (data.points[i].position - data.points[i - 1].position).norm();
      ++steps;
    }
  }
  return steps > 0 ? path / static_cast<double>(steps) : 0.0;
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

double largest_offset(std::span<const FitPoint> points) {
  double largest = 0.0;
  for (const FitPoint& point : points) {
    largest = std::max(largest, point.offset);
  }
  return largest;
}

double rounding_level(const FitData& data) {
  // A coordinate has an error of half a unit in the last place; a few of them add up in a residual.
  constexpr double kRoundings = 4.0;
  const double largest = data.frame.translation().cwiseAbs().maxCoeff() + data.scale;
  return kRoundings * std::numeric_limits<double>::epsilon() * largest / data.scale;
}

FitData make_fit_data(std::span<const StoredPatch> patches, double default_sigma_m) {
  FitData data;
  const std::optional<Extents> extents = extents_of(patches);
  if (!extents) {
    return data;
  }
  data.frame = extents->frame;
  data.scale = extents->half_extent > 0.0 ? extents->half_extent : 1.0;
  const double least_sigma = rounding_level(data);
  const ToLocal to_frame(data.frame);
  data.points.reserve(count_samples(patches));
  data.patches.reserve(patches.size());
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    const std::size_t begin = data.points.size();
    const Vec2 direction = data.frame.rotate_back(patch.direction);
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
      const StoredSample& sample = patch.samples[i];
      const double sigma_m = sigma_m_of(sample, default_sigma_m);
      data.noise_is_stated = data.noise_is_stated && sigma_m > 0.0;
      FitPoint point;
      point.position = to_frame(mean_on_path(patch, i)) / data.scale;
      point.tangent = direction;
      point.offset = patch.context.tip_radius_m / data.scale;
      const double sigma = sigma_m > 0.0 ? std::max(sigma_m / data.scale, least_sigma) : 1.0;
      point.inverse_sigma = std::sqrt(sample.weight) / sigma;
      data.points.push_back(point);
    }
    data.patches.push_back({begin, data.points.size(), patch.is_joined});
  }
  if (!data.noise_is_stated) {
    data.reading_noise = std::max(reading_noise_m(patches) / data.scale, kFinest);
    // Stated and unstated noise do not mix: if one is not stated, the noise of all is estimated.
    std::size_t i = 0;
    for (const StoredPatch& patch : patches) {
      for (const StoredSample& sample : patch.samples) {
        data.points[i++].inverse_sigma = std::sqrt(sample.weight);
      }
    }
    return data;
  }
  set_details(patches, &data);
  return data;
}

}  // namespace palpate

// Long strokes along curves of every class and of none, with the true geometry beside each sample.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/curves/pose2.h"
#include "core/local/local_estimate.h"

namespace palpate::test {

/// A curve walked along by arc length: points and true geometry at equal steps, some 20 um, so that
/// the geometry between two of them is a straight line to 1e-7.
struct TrueStroke {
  std::string name;
  double step_m = 0.0;
  std::vector<LocalEstimate> truth;  ///< covariance zero

  /// Every `stride`-th position.
  std::vector<Vec2> samples(std::size_t stride) const;

  /// (tangent angle, kappa, kappa_s) of the estimate less the truth at the foot of its position.
  Eigen::Vector3d error_of(const LocalEstimate& estimate) const;
};

/// A stroke of that length on a part of about 25 mm: the eight classes, a superellipse of exponent
/// 4 and a logarithmic spiral. Where it begins and how the part is turned is random.
TrueStroke random_stroke(std::size_t shape, double length_m, std::mt19937_64& rng);
inline constexpr std::size_t kStrokeShapes = 10;

/// For samples 0.2 mm apart, closer where those would be fewer than 60.
std::size_t usual_stride(const TrueStroke& stroke);

}  // namespace palpate::test

// Long strokes along curves of every class and of none, with the true geometry at each sample.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/curves/pose2.h"
#include "core/local/local_estimate.h"

namespace palpate::test {

/// A curve sampled at equal arc lengths of about 20 um: points and true geometry. Between two
/// points the geometry is linear to 1e-7.
struct TrueStroke {
  std::string name;
  double step_m = 0.0;
  std::vector<LocalEstimate> truth;  ///< covariance zero

  /// Every `stride`-th position.
  std::vector<Vec2> samples(std::size_t stride) const;

  /// (tangent angle, kappa, kappa_s) of the estimate minus the truth at the foot point of its
  /// position.
  Eigen::Vector3d error_of(const LocalEstimate& estimate) const;
};

/// A stroke of that length on a part of about 25 mm: one of the eight classes, a superellipse of
/// exponent 4, or a logarithmic spiral. Its start and the orientation of the part are random.
TrueStroke random_stroke(std::size_t shape, double length_m, std::mt19937_64& rng);
inline constexpr std::size_t kStrokeShapes = 10;

/// The stride for samples 0.2 mm apart; closer if there would be fewer than 60.
std::size_t usual_stride(const TrueStroke& stroke);

}  // namespace palpate::test

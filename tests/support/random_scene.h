// Random touched curves with known truth, computed by formulas of their own (no curve code of
// core).
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate::test {

struct SceneOptions {
  int patches = 2;
  int points_per_patch = 111;
  /// Noise divided by the half diagonal of the whole curve piece.
  double sigma_over_size = 1e-3;
  /// Arc of each patch as a fraction of the whole curve piece, uniform in [least, most].
  double least_fraction = 0.06;
  double most_fraction = 0.25;
  /// If most_arc_over_size > 0: arc of each patch in units of size_m instead, log-uniform in
  /// [least, most].
  double least_arc_over_size = 0.0;
  double most_arc_over_size = 0.0;
  double size_m = 0.05;  ///< half diagonal of the whole curve piece [m]
  /// Permits a patch across a cusp or next to it. No stroke can follow that, but single touches may
  /// lie so.
  bool across_cusp = false;
};

struct Scene {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  Pose2 world_T_curve;
  double sigma_m = 0.0;
  std::vector<std::vector<Vec2>> patches;  ///< noisy samples in the world frame [m]
  std::vector<std::vector<double>> t;      ///< true curve parameter of each sample
};

/// Shapes of none of the eight classes, to test that the recognizer is never confidently wrong.
enum class OutsideShape { Sinusoid, Superellipse, LogSpiral, Quartic };

/// A scene of random shape and pose. Its patches are on disjoint parts of the curve, in random
/// order and with random directions of travel.
Scene random_scene(CurveClass curve_class, const SceneOptions& options, std::mt19937_64& rng);
/// One stretch of an ellipse, arc_rad of its eccentric angle t from a random start. The patches
/// share it: each covers 98 % of its part (least_fraction and most_fraction are not used).
Scene random_ellipse_arc(double arc_rad, const SceneOptions& options, std::mt19937_64& rng);
Scene random_outside_scene(OutsideShape shape, const SceneOptions& options, std::mt19937_64& rng);

}  // namespace palpate::test

// Exact local estimates along a canonical curve at a pose, and random shapes of every class.
#pragma once

#include <Eigen/Core>
#include <random>
#include <span>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"
#include "core/invariants/measured_geometry.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate::test {

struct PlacedCurve {
  CurveClass curve_class = CurveClass::Ellipse;
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();
  Pose2 world_T_curve;
};

/// The classes that have invariants of their own: all except line and circle.
std::span<const CurveClass> invariant_classes();

/// A shape of size about 1 m at a random pose: well-conditioned and far from the limits of its
/// class.
PlacedCurve random_curve(CurveClass curve_class, std::mt19937_64& rng);

/// Curve parameters spread over the curved part of the curve.
std::vector<double> random_places(const PlacedCurve& curve, int count, std::mt19937_64& rng);

/// The exact estimate at t, with travel along increasing t (direction 1) or against it (-1).
LocalEstimate exact_estimate(const PlacedCurve& curve, double t, int direction = 1);

/// Exact estimates, each on its own patch with a random direction of travel.
std::vector<TreePoint> exact_points(const PlacedCurve& curve, std::span<const double> places,
                                    std::mt19937_64& rng);

std::vector<MeasuredGeometry> measured(std::span<const TreePoint> points);

/// The curve with all lengths multiplied by `factor`.
PlacedCurve scaled(const PlacedCurve& curve, double factor);

}  // namespace palpate::test

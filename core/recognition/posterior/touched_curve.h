// A curve of a class against the reduced points, in touched coordinates.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/pose2.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/touched_coordinates.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Where a class was touched: a place of a first fit and the tangent there. Offset and turn are
/// counted from it, and are 0 at that fit.
struct Touch {
  CurveClass curve_class = CurveClass::Unclassified;
  TouchedShape shape;            ///< of that fit
  Vec2 place = Vec2::Zero();     ///< normalised frame
  Vec2 tangent = Vec2::UnitX();  ///< of increasing t
  double weight = 1.0;           ///< that residuals are multiplied with, beside their noise's
  /// Of measured normals, by point; empty where there are none. As of the fit: a curve that is
  /// tried is weighed with what was found.
  std::vector<double> normal_weights = {};
};

/// A curve of the class near the touch, the points' feet on it, and the model linear about it.
struct TouchedCurve {
  TouchedVector z = TouchedVector::Zero();
  TouchedShape shape;
  Pose2 frame_T_curve;    ///< normalised
  std::vector<double> t;  ///< feet of the points
  double chi2 = 0.0;
  double log_prior = 0.0;
  TouchedVector widths = TouchedVector::Zero();
  /// By the coordinates in units of the widths, of the residuals r over their noise: the lower
  /// triangular root of J^T J and the prior's curvature, that of normal laws as high; J^T r.
  TouchedMatrix root = TouchedMatrix::Identity();
  TouchedVector gradient = TouchedVector::Zero();
};

/// The pose, in the normalised frame, that puts `place` t of the curve where offset and turn of z
/// say.
Pose2 pose_of(const Touch& touch, const TouchedVector& z, const Curve& curve, double t);

/// The touch of a fit, and the curve itself there; `fit` has a point for each of `data`, which are
/// surface points. nullopt where the fit is no curve of its class in double precision.
std::optional<Touch> touch_of(const CanonicalFit& fit, const FitData& data);
/// The same class touched at that point, in the direction of the points beside it: what fits short
/// arcs too well may cross them.
Touch along_patch(Touch touch, const FitData& data);
std::optional<TouchedCurve> curve_at(const Touch& touch, const CanonicalFit& fit,
                                     const FitData& data);

/// The curve at coordinates `z`, the feet followed from those of `from`. nullopt outside of the
/// class.
std::optional<TouchedCurve> curve_at(const Touch& touch, const TouchedVector& z,
                                     const TouchedCurve& from, const FitData& data);

}  // namespace palpate

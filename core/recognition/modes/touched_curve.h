// A curve of a class, in touched coordinates, and its fit to the reduced points.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/pose2.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/prior/touched_coordinates.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Where a class was touched: a place of a first fit, and the tangent there. Offset and turn are
/// relative to it and are 0 for that fit.
struct Touch {
  CurveClass curve_class = CurveClass::Unclassified;
  bool as_arc = false;           ///< its coordinates: Chart
  TouchedShape shape;            ///< of that fit
  Vec2 place = Vec2::Zero();     ///< normalised frame
  Vec2 tangent = Vec2::UnitX();  ///< direction of increasing t
  double weight = 1.0;           ///< factor on the residuals, in addition to 1 / noise
  /// Weights of measured normals, one per point; empty without normals. They come from the fit and
  /// stay fixed for trial curves.
  std::vector<double> normal_weights = {};

  Chart chart() const { return {curve_class, as_arc}; }
};

/// A curve of the class near the touch, with the points' feet and the linear model about it.
struct TouchedCurve {
  TouchedVector z = TouchedVector::Zero();
  TouchedShape shape;     ///< not of an arc: z has it all
  Pose2 frame_T_curve;    ///< normalised; of an arc: the touched place, x along the tangent there
  std::vector<double> t;  ///< feet of the points; of an arc: their s (arc_coordinates.h)
  double chi2 = 0.0;
  double log_prior = 0.0;
  TouchedVector widths = TouchedVector::Zero();
  /// By the coordinates in units of the widths, r being residuals over noise. `root`: lower
  /// triangular root of J^T J plus the prior's curvature (that of normal laws of the same height).
  /// `gradient`: J^T r.
  TouchedMatrix root = TouchedMatrix::Identity();
  TouchedVector gradient = TouchedVector::Zero();
  /// Of -log(likelihood times prior), on to the mode, as the linear model has it: what a descent
  /// that has settled leaves out (mode_search.h).
  double left_to_gain = 0.0;
};

/// The pose, in the normalised frame, that puts place `t` of the curve where offset and turn of z
/// put it.
Pose2 pose_of(const Touch& touch, const TouchedVector& z, const Curve& curve, double t);

/// The touch of a fit. `fit` must have a point for each of `data`, which are surface points.
/// nullopt if double precision cannot hold the fit as a curve of its class.
std::optional<Touch> touch_of(const CanonicalFit& fit, const FitData& data);

/// The same touch, with the direction of the neighbouring points: a curve that fits short arcs too
/// well may cross them.
Touch along_patch(Touch touch, const FitData& data);
/// The curve of the fit itself; nullopt as for touch_of().
std::optional<TouchedCurve> curve_at(const Touch& touch, const CanonicalFit& fit,
                                     const FitData& data);

/// The curve at coordinates `z`, with the feet followed from those of `from`. nullopt outside the
/// class.
std::optional<TouchedCurve> curve_at(const Touch& touch, const TouchedVector& z,
                                     const TouchedCurve& from, const FitData& data);

/// An arc with shape, frame and feet of the spline that it is; other curves as they are. nullopt
/// where double precision cannot hold its vertex.
std::optional<TouchedCurve> in_canonical_form(const Touch& touch, TouchedCurve curve);

}  // namespace palpate

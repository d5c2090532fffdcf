// The points on a curve in touched coordinates: feet, chi-square and the linear model about it.
// touched_curve.cpp and touched_arc.cpp say how the curve moves with its coordinates.
#pragma once

#include <cmath>

#include "core/numerics/matrices/triangular_root.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/modes/touched_curve.h"
#include "core/recognition/modes/trial_foot.h"
#include "core/recognition/prior/touched_prior.h"

namespace palpate {

/// The weights of measured normals, as the fit has them.
inline void set_normal_weights(const CanonicalFit& fit, const FitData& data, Touch* touch) {
  if (residual_count(data) > data.points.size()) {
    for (const FittedPoint& point : fit.points) {
      touch->normal_weights.push_back(point.normal_weight);
    }
  }
}

/// Prior of `curve`, whose z and frame are set.
inline void set_prior(const Touch& touch, TouchedCurve* curve) {
  curve->widths = prior_widths(touch.chart(), curve->z);
  curve->log_prior = log_prior(touch.chart(), curve->z);
  curve->chi2 = 0.0;
}

/// The measured normals' part of chi-square and its derivatives, the feet found. On its own, so
/// that points without do not pay. `derivatives_at(t)`: of the curve; `touched`: the touched place
/// on it; `turn_by(k, t, foot, there, lever)`: by coordinate k of the shape.
template <typename DerivativesAt, typename TurnBy>
[[gnu::noinline]] void add_normals(const Touch& touch, const FitData& data, const Vec2& touched,
                                   const DerivativesAt& derivatives_at, const TurnBy& turn_by,
                                   TouchedCurve* curve) {
  const int own = shape_coordinates(touch.curve_class);
  const Pose2& pose = curve->frame_T_curve;
  const Vec2 offset_direction = pose.rotate_back(left_of(touch.tangent));
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const double weight = touch.weight * touch.normal_weights[i];
    const CurveDerivatives foot = derivatives_at(curve->t[i]);
    const double speed = foot.first.norm();
    if (!(weight > 0.0) || !(speed > 0.0)) {
      continue;
    }
    const Vec2 normal = left_of(foot.first) / speed;
    const Vec2 away = pose.to_local(data.points[i].position) - foot.position;
    const NormalAtFoot there{normal, foot.first, foot.second, away.dot(normal)};
    const double residual = weight * normal_miss(pose.rotate_back(data.points[i].normal), normal);
    curve->chi2 += residual * residual;
    if (!there.is_followed()) {
      continue;
    }
    const Vec2 lever = left_of(foot.position - touched);
    TouchedVector row = TouchedVector::Zero();
    for (int k = 0; k < own; ++k) {
      row[k] = turn_by(k, curve->t[i], foot, there, lever);
    }
    row[own] = there.turn_by(offset_direction, Vec2::Zero());
    row[own + 1] = there.turn_by(lever, left_of(foot.first));
    row = weight * row.cwiseProduct(curve->widths);
    Eigen::Matrix<double, 1, kMostCoordinates> one = row.transpose();
    absorb_rows(&one, &curve->root);
    curve->gradient += residual * row;
  }
}

/// Feet of the points, their part of chi-square and of its derivatives. `curve`: all but these set.
/// `touched`: the touched place on the curve; `row_of(foot, normal, lever)`: how a foot moves along
/// the normal with the coordinates of the shape. false if a foot has run away: no number tells how
/// far the point is.
template <typename C, typename RowOf>
bool add_points(const Touch& touch, const FitData& data, const C& canonical, const Vec2& touched,
                const RowOf& row_of, TouchedCurve* curve) {
  const auto own = static_cast<Eigen::Index>(shape_coordinates(touch.curve_class));
  const Vec2 offset_direction = curve->frame_T_curve.rotate_back(left_of(touch.tangent));
  const ToLocal to_local(curve->frame_T_curve);
  constexpr Eigen::Index kRows = 8;  // at a time
  Eigen::Matrix<double, kRows, kMostCoordinates> rows;
  rows.setZero();
  Eigen::Index r = 0;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Vec2 point = to_local(data.points[i].position);
    const double weight = touch.weight * data.points[i].inverse_sigma;
    const TrialFoot foot = trial_foot(canonical, point, curve->t[i], 1.0 / weight);
    curve->t[i] = foot.t;
    const Vec2 away = point - foot.position;
    const double foot_speed = foot.first.norm();
    if (!std::isfinite(foot_speed)) {
      return false;
    }
    // At a cusp the distance has no normal of the curve; it is its own.
    const Vec2 normal = foot_speed > 0.0    ? Vec2(left_of(foot.first) / foot_speed)
                        : !away.isZero(0.0) ? away.normalized()
                                            : Vec2(0.0, 1.0);
    const double residual = weight * away.dot(normal);
    curve->chi2 += residual * residual;
    const double lever = normal.dot(left_of(foot.position - touched));
    TouchedVector row = TouchedVector::Zero();
    row.head<4>() = row_of(foot, normal, lever);
    row[own] = normal.dot(offset_direction);
    row[own + 1] = lever;
    row = -weight * row.cwiseProduct(curve->widths);
    curve->gradient += residual * row;
    rows.row(r) = row;
    if (++r == kRows) {
      absorb_rows(&rows, &curve->root);
      rows.setZero();
      r = 0;
    }
  }
  if (r > 0) {
    absorb_rows(&rows, &curve->root);
  }
  return true;
}

}  // namespace palpate

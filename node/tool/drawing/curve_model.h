// A recognised curve as it stands in a message, made into something that can be evaluated.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/recognition.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// A curve at a place of the world, and how well both are known.
struct CurveModel {
  Curve curve;
  Pose2 world_T_curve;
  /// Of [shape parameters; x; y; theta]; 0 x 0 where none is given or an entry is not determined.
  ShapePoseCovariance covariance;

  Vec2 world_position(double t) const { return world_T_curve * position(curve, t); }
  /// Unit vector to the left of increasing t; zero at a cusp.
  Vec2 world_left(double t) const;
};

/// The most probable curve; nullopt where the message names none.
std::optional<CurveModel> model_of(const v1::Recognition& answer);

/// A hypothesis' curve, without covariance; nullopt where it has no shape.
std::optional<CurveModel> model_of(const v1::Hypothesis& hypothesis);

/// The model with `step` added to [shape parameters; x; y; theta]; nullopt where that leaves the
/// canonical form's range (an ellipse whose b would exceed its a). Its covariance is empty.
std::optional<CurveModel> moved(const CurveModel& model, const Eigen::VectorXd& step);

/// Curve parameters from `from` to `to`.
struct CurveSpan {
  double from = 0.0;
  double to = 0.0;
  bool closed = false;
};

/// The piece to draw: all of a closed curve, else what the touched points span and half as much arc
/// again beyond either end. nullopt where nothing was touched.
std::optional<CurveSpan> drawn_span(const CurveModel& model, std::span<const Vec2> touched);

}  // namespace palpate

// Makes a curve that can be evaluated from a recognition message.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/recognition.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// A curve at its pose in the world, and the covariance of both.
struct CurveModel {
  Curve curve;
  Pose2 world_T_curve;
  /// Of [shape parameters; x; y; theta]; 0 x 0 if the message has none or an entry is infinite.
  ShapePoseCovariance covariance;

  Vec2 world_position(double t) const { return world_T_curve * position(curve, t); }
  /// Unit vector to the left of increasing t; zero at a cusp.
  Vec2 world_left(double t) const;
};

/// The most probable curve; nullopt if the message has none.
std::optional<CurveModel> model_of(const v1::Recognition& answer);

/// The curve of a hypothesis, without covariance; nullopt if it has no shape.
std::optional<CurveModel> model_of(const v1::Hypothesis& hypothesis);

/// The model with `step` added to [shape parameters; x; y; theta]; nullopt if that leaves the range
/// of the canonical form (an ellipse whose b would exceed its a). Its covariance is empty.
std::optional<CurveModel> moved(const CurveModel& model, const Eigen::VectorXd& step);

/// The curve parameters from `from` to `to`.
struct CurveSpan {
  double from = 0.0;
  double to = 0.0;
  bool closed = false;
};

/// The piece to draw: all of a closed curve, else the arc that the touched points span, extended by
/// half its length at both ends. nullopt if there are no touched points.
std::optional<CurveSpan> drawn_span(const CurveModel& model, std::span<const Vec2> touched);

}  // namespace palpate

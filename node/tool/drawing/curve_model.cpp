#include "node/tool/drawing/curve_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/wire/convert.h"

namespace palpate {
namespace {

Eigen::Vector3d values_of(CurveClass curve_class, const v1::Parameters& parameters) {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  Eigen::Index index = 0;
  for (const char letter : parameter_letters(curve_class)) {
    values[index++] = letter == 'a'   ? parameters.a()
                      : letter == 'b' ? parameters.b()
                                      : parameters.c();
  }
  return values;
}

std::optional<CurveModel> model_placed(v1::CurveClass wire_class, const v1::Parameters& parameters,
                                       const v1::Pose2& pose) {
  const CurveClass curve_class = from_wire(wire_class);
  const std::optional<Curve> curve = make_curve(curve_class, values_of(curve_class, parameters));
  const bool is_finite =
      std::isfinite(pose.x_m()) && std::isfinite(pose.y_m()) && std::isfinite(pose.theta_rad());
  if (!curve || !is_finite) return std::nullopt;
  return CurveModel{*curve, {pose.x_m(), pose.y_m(), pose.theta_rad()}, {}};
}

// Chords are accurate enough for a picture and need no quadrature; a rival may have any shape.
constexpr int kChords = 64;

double chord(const Curve& curve, double t, double step) {
  return (position(curve, t + step) - position(curve, t)).norm();
}

/// The t at which the chords from t0 have the given length.
double parameter_beyond(const Curve& curve, double t0, double step, double length) {
  double left = length;
  double t = t0;
  for (int i = 0; i < kChords; ++i, t += step) {
    const double next = chord(curve, t, step);
    if (!(next < left)) return t + step * (next > 0.0 ? left / next : 0.0);
    left -= next;
  }
  return t;
}

}  // namespace

Vec2 CurveModel::world_left(double t) const {
  const Vec2 along = derivatives(curve, t).first;
  const double speed = along.norm();
  return speed > 0.0 ? Vec2(left_of(world_T_curve.rotate(along / speed))) : Vec2(Vec2::Zero());
}

std::optional<CurveModel> model_of(const v1::Recognition& answer) {
  if (!answer.has_pose()) return std::nullopt;
  std::optional<CurveModel> model =
      model_placed(answer.curve_class(), answer.parameters(), answer.pose());
  if (!model) return std::nullopt;
  const auto letters = static_cast<Eigen::Index>(parameter_letters(class_of(model->curve)).size());
  const Eigen::Index size = letters + 3;
  if (answer.covariance_size() != size * size) return model;
  ShapePoseCovariance covariance(size, size);
  for (Eigen::Index i = 0; i < size * size; ++i) {
    covariance(i / size, i % size) = answer.covariance(static_cast<int>(i));
  }
  if (covariance.allFinite() && covariance.diagonal().minCoeff() >= 0.0) {
    model->covariance = covariance;
  }
  return model;
}

std::optional<CurveModel> model_of(const v1::Hypothesis& hypothesis) {
  if (!hypothesis.has_pose()) return std::nullopt;
  return model_placed(hypothesis.curve_class(), hypothesis.parameters(), hypothesis.pose());
}

std::optional<CurveModel> moved(const CurveModel& model, const Eigen::VectorXd& step) {
  const Eigen::Index letters = step.size() - 3;
  Eigen::Vector3d values = parameters(model.curve);
  values.head(letters) += step.head(letters);
  const std::optional<Curve> curve = make_curve(class_of(model.curve), values);
  if (!curve) return std::nullopt;
  const Pose2& pose = model.world_T_curve;
  return CurveModel{*curve,
                    {pose.x + step[letters], pose.y + step[letters + 1],
                     wrap_angle(pose.theta + step[letters + 2])},
                    {}};
}

std::optional<CurveSpan> drawn_span(const CurveModel& model, std::span<const Vec2> touched) {
  if (const double period = domain(model.curve).period; period > 0.0) {
    return CurveSpan{-0.5 * period, 0.5 * period, true};
  }
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Vec2& point : touched) {
    const double t = foot_point(model.curve, model.world_T_curve.to_local(point)).t;
    least = std::min(least, t);
    most = std::max(most, t);
  }
  if (!(most > least)) return std::nullopt;
  constexpr double kBeyond = 0.5;  // of the touched arc, at either end
  const double step = (most - least) / kChords;
  double touched_arc = 0.0;
  for (int i = 0; i < kChords; ++i) touched_arc += chord(model.curve, least + i * step, step);
  return CurveSpan{parameter_beyond(model.curve, least, -step, kBeyond * touched_arc),
                   parameter_beyond(model.curve, most, step, kBeyond * touched_arc), false};
}

}  // namespace palpate

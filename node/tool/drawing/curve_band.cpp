#include "node/tool/drawing/curve_band.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/matrices/symmetric_eigen.h"

namespace palpate {
namespace {

/// Derivative of the curve's displacement along its left normal by [shape parameters; x; y; theta].
Eigen::VectorXd offset_gradient(const CurveModel& model, double t, const Vec2& left) {
  const Eigen::Index size = model.covariance.rows();
  const Eigen::Index letters = size - 3;
  Eigen::VectorXd gradient(size);
  const Vec2 left_in_curve = model.world_T_curve.rotate_back(left);
  gradient.head(letters) =
      position_by_parameters(model.curve, t).leftCols(letters).transpose() * left_in_curve;
  gradient[letters] = left.x();
  gradient[letters + 1] = left.y();
  gradient[letters + 2] = left_in_curve.dot(left_of(position(model.curve, t)));
  return gradient;
}

/// Displacement, along `left`, from `point` to the nearest point of another curve.
double offset_to(const CurveModel& other, const Vec2& point, const Vec2& left, double t) {
  const FootPoint foot = foot_point_near(other.curve, other.world_T_curve.to_local(point), t);
  return left.dot(other.world_T_curve * foot.position - point);
}

}  // namespace

std::optional<BandWidth> band_at(const CurveModel& model, double t) {
  if (model.covariance.size() == 0) return std::nullopt;
  const Vec2 left = model.world_left(t);
  const Eigen::VectorXd gradient = offset_gradient(model, t, left);
  const Eigen::VectorXd towards = model.covariance * gradient;
  const double sigma = std::sqrt(std::max(gradient.dot(towards), 0.0));
  if (!std::isfinite(sigma)) return std::nullopt;
  if (sigma == 0.0) return BandWidth{};
  const Vec2 point = model.world_position(t);
  const auto border = [&](double side) {
    const double linear = side * kBandSigmas * sigma;
    const auto other = moved(model, (side * kBandSigmas / sigma) * towards);
    if (!other) return linear;
    const double offset = offset_to(*other, point, left, t);
    // If the foot point is on the wrong side, or several times as far, it is on another part of the
    // curve.
    constexpr double kSamePart = 4.0;
    const bool is_same_part =
        offset * side > 0.0 && std::abs(offset) < kSamePart * std::abs(linear);
    return is_same_part ? offset : linear;
  };
  return BandWidth{border(1.0), border(-1.0)};
}

CurvatureDeviation::CurvatureDeviation(const CurveModel& model) : model_(model) {
  if (model.covariance.size() == 0) return;
  if (!model.covariance.allFinite()) return;
  const SymmetricEigen axes = symmetric_eigen(model.covariance);
  for (Eigen::Index i = 0; i < model.covariance.rows(); ++i) {
    const Eigen::VectorXd step = std::sqrt(std::max(axes.values[i], 0.0)) * axes.vectors.col(i);
    const auto minus = moved(model, -step);
    const auto plus = moved(model, step);
    const double apart = (minus ? 1.0 : 0.0) + (plus ? 1.0 : 0.0);
    if (apart > 0.0) axes_.push_back({minus.value_or(model), plus.value_or(model), apart});
  }
}

std::optional<double> CurvatureDeviation::at(double t) const {
  if (axes_.empty()) return std::nullopt;
  const Vec2 point = model_.world_position(t);
  const auto kappa_beside = [&](const CurveModel& other) {
    const double foot = foot_point_near(other.curve, other.world_T_curve.to_local(point), t).t;
    return geometry(other.curve, foot).kappa;
  };
  double variance = 0.0;
  for (const Axis& axis : axes_) {
    const double slope =
        (kappa_beside(axis.plus) - kappa_beside(axis.minus)) / axis.deviations_apart;
    variance += slope * slope;
  }
  return std::sqrt(variance);
}

}  // namespace palpate

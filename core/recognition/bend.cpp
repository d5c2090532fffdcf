#include "core/recognition/bend.h"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/determined.h"

namespace palpate {
namespace {

constexpr double kDeviations = 2.0;
/// E[(k / 2)^4] of a standard normal k.
constexpr double kSecondMoment = 3.0 / 16.0;
/// The bend is smooth along the arcs, and nearly all of it an error of shape and pose: least
/// squares over twice as many points as these have components tell it.
constexpr int kMostAsked = 12;

using Offsets = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostAsked, 1>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostAsked, 6>;

/// A point of the fitted curve where a sample touched it.
struct Asked {
  double t = 0.0;
  Vec2 point = Vec2::Zero();  ///< the curve's frame [m]
  Vec2 normal = Vec2::Zero();
  double inverse_sd = 0.0;  ///< over the noise of all samples that it stands for [1/m]
};

struct Moved {
  Curve curve;
  Pose2 fitted_T_moved;
};

std::optional<Moved> moved_by(const ShapePoseVector& change, const CanonicalFit& fit) {
  const Eigen::Index letters = change.size() - 3;
  Eigen::Vector3d values = fit.shape.values;
  values.head(letters) += change.head(letters);
  const auto curve = make_curve(fit.shape.curve_class, values);
  if (!curve || !change.allFinite()) {
    return std::nullopt;
  }
  const Vec2 shift = fit.world_T_curve.rotate_back(change.segment<2>(letters));
  return Moved{*curve, Pose2{shift.x(), shift.y(), change[letters + 2]}};
}

/// How far a curve that passes near `asked` lies from it, counted along its normal: Newton's method
/// until the square of the angle between the offset and the normal, twice the relative error of the
/// length, no longer counts.
double offset(const Moved& moved, const Asked& asked) {
  constexpr int kMostSteps = 4;
  constexpr double kSquaredAngle = 1e-4;
  const Vec2 point = moved.fitted_T_moved.to_local(asked.point);
  double t = asked.t;
  Vec2 away = Vec2::Zero();
  for (int i = 0; i <= kMostSteps; ++i) {
    const CurveDerivatives d = derivatives(moved.curve, t);
    away = d.position - point;
    const double along = away.dot(d.first);
    const double speed2 = d.first.squaredNorm();
    if (along * along <= kSquaredAngle * speed2 * away.squaredNorm()) {
      break;
    }
    const double slope = speed2 + away.dot(d.second);
    t -= along / (slope > 0.0 ? slope : speed2);
  }
  return std::copysign(away.norm(), away.dot(moved.fitted_T_moved.rotate_back(asked.normal)));
}

Offsets offsets(const Moved& moved, const std::vector<Asked>& asked) {
  Offsets result(static_cast<Eigen::Index>(asked.size()));
  for (std::size_t i = 0; i < asked.size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = asked[i].inverse_sd * offset(moved, asked[i]);
  }
  return result;
}

/// Every so many of the points, each standing for its neighbours.
std::vector<Asked> ask(const Curve& curve, const CanonicalFit& fit, const FitData& data,
                       double inflation) {
  const std::size_t n = fit.points.size();
  const std::size_t count = std::min<std::size_t>(n, kMostAsked);
  const double share = static_cast<double>(n) / static_cast<double>(count);
  const double scale = std::sqrt(share / inflation) / data.scale;
  std::vector<Asked> asked;
  asked.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (2 * k + 1) * n / (2 * count);
    const FittedPoint& point = fit.points[i];
    asked.push_back({point.t, position(curve, point.t), fit.world_T_curve.rotate_back(point.normal),
                     scale * data.points[i].inverse_sigma});
  }
  return asked;
}

/// By [shape; x; y; theta], each in units of its standard deviation.
Rows jacobian(const Curve& curve, const CanonicalFit& fit, const std::vector<Asked>& asked,
              const ShapePoseVector& deviations) {
  const Eigen::Index letters = deviations.size() - 3;
  Rows rows(static_cast<Eigen::Index>(asked.size()), deviations.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Asked& a = asked[i];
    const Eigen::Vector3d by_shape = position_by_parameters(curve, a.t).transpose() * a.normal;
    ShapePoseVector row(deviations.size());
    row.head(letters) = by_shape.head(letters);
    row.segment<2>(letters) = fit.world_T_curve.rotate(a.normal);
    row[letters + 2] = a.normal.dot(left_of(a.point));
    rows.row(static_cast<Eigen::Index>(i)) = a.inverse_sd * row.cwiseProduct(deviations);
  }
  return rows;
}

/// A step of r of the natural size bends the curve by some r^2 / 2 of the extent: with r one
/// standard deviation, at two of them by twice that r^2 over the noise of the mean of all points.
/// Where that is below this limit, the square of a standard deviation grows by less than a
/// hundredth.
bool may_bend(double relative_variance, const FitData& data, double inflation) {
  constexpr double kLeastBend = 0.1;
  double weight = 0.0;
  for (const FitPoint& point : data.points) {
    weight += point.inverse_sigma * point.inverse_sigma;
  }
  return relative_variance * std::sqrt(inflation * weight) >= kLeastBend;
}

}  // namespace

std::optional<Bend> bend_of(const CanonicalFit& fit, const FitData& data, double inflation) {
  assert(fit.points.size() == data.points.size());
  const ShapePoseCovariance& covariance = fit.covariance;
  Bend bend;
  bend.displacement = ShapePoseVector::Zero(covariance.rows());
  const LoosestComponent loosest = loosest_component(fit.shape, covariance, data.scale);
  if (!may_bend(loosest.relative_variance, data, inflation)) {
    return bend;
  }
  const ShapePoseVector step = kDeviations *
                               std::sqrt(inflation / covariance(loosest.index, loosest.index)) *
                               covariance.col(loosest.index);
  const auto curve = make_curve(fit.shape.curve_class, fit.shape.values);
  const auto forth = moved_by(step, fit);
  const auto back = moved_by(-step, fit);
  if (!curve || !forth || !back) {
    return std::nullopt;
  }
  const std::vector<Asked> asked = ask(*curve, fit, data, inflation);
  const ShapePoseVector deviations = (inflation * covariance.diagonal()).cwiseSqrt();
  const Rows rows = jacobian(*curve, fit, asked, deviations);
  // What the shape and the pose make of offsets, in deviations of the bound: the first rows of Q^T.
  const Eigen::ColPivHouseholderQR<Rows> qr(rows);
  const auto in_deviations = [&](const Offsets& all) {
    return ShapePoseVector((qr.householderQ().adjoint() * all).head(qr.rank()));
  };
  const Offsets half_sum = 0.5 * (offsets(*forth, asked) + offsets(*back, asked));
  const ShapePoseVector bent = in_deviations(half_sum);
  bend.displacement = deviations.cwiseProduct(ShapePoseVector(qr.solve(half_sum)));
  bend.variance_ratio = kSecondMoment * bent.squaredNorm();

  // A deviation of 0 is that of a free component, which stays.
  const ShapePoseVector step_in_deviations =
      (deviations.array() > 0.0).select(step.cwiseQuotient(deviations), 0.0);
  const Offsets linear = rows * step_in_deviations;
  const ShapePoseVector straight = in_deviations(linear);
  // By I + (3/16) bent bent^T, the published covariance in these units.
  const auto squared_distance = [&](const ShapePoseVector& v) {
    const double along = v.dot(bent);
    return v.squaredNorm() - kSecondMoment * along * along / (1.0 + bend.variance_ratio);
  };
  for (const double sign : {1.0, -1.0}) {
    const auto end = moved_by(sign * step - bend.displacement, fit);
    if (!end) {
      return std::nullopt;
    }
    const ShapePoseVector left = in_deviations(offsets(*end, asked) - sign * linear);
    const double nonlinearity = squared_distance(left) / squared_distance(sign * straight - bent);
    if (!std::isfinite(nonlinearity)) {
      return std::nullopt;
    }
    bend.nonlinearity = std::max(bend.nonlinearity, nonlinearity);
  }
  return bend;
}

ShapePoseCovariance with_bend(const ShapePoseCovariance& covariance, const Bend& bend) {
  return covariance + kSecondMoment * bend.displacement * bend.displacement.transpose();
}

}  // namespace palpate

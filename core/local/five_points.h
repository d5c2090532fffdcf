// What the two estimators from the literature share: the choice of five points, spread evenly over
// the samples of a window, and the propagation of their noise.
#pragma once

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "core/local/jet_estimator.h"
#include "core/local/local_status.h"

namespace palpate {

template <typename T>
using PlanePoint = std::array<T, 2>;

template <typename T>
PlanePoint<T> operator-(const PlanePoint<T>& a, const PlanePoint<T>& b) {
  return {a[0] - b[0], a[1] - b[1]};
}

template <typename T>
T length(const PlanePoint<T>& v) {
  using std::sqrt;
  return sqrt(v[0] * v[0] + v[1] * v[1]);
}

/// Angle from direction u to direction v, in (-pi, pi).
template <typename T>
T turn(const PlanePoint<T>& u, const PlanePoint<T>& v) {
  using std::atan2;
  return atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
}

/// Chords must be longer than kMinChordSigmas * sqrt(2) * sigma. Then a chord turns by less than a
/// right angle at six standard deviations of its noise, and its angle is nearly linear in the
/// noise.
inline constexpr double kMinChordSigmas = 6.0;

/// `geometry` takes std::array<PlanePoint<T>, 5>, in units of about one spacing, and returns
/// (tangent angle, kappa, kappa_s) at the middle point. That point is also the position of the
/// estimate. Noise that is not given is that of a jet fitted to the window; if the window is too
/// short for a jet, the diagonal of the covariance is infinite.
template <typename Geometry>
LocalResult five_point_estimate(std::span<const Vec2> samples, double sigma_m,
                                Geometry&& geometry) {
  using Jet = ceres::Jet<double, 10>;
  LocalResult result;
  if (samples.size() < 5) {
    return result;
  }
  // Chosen so that the reversed window gives the same five points.
  const auto sample = [&](std::size_t i) -> const Vec2& {
    const std::size_t last = samples.size() - 1;
    return i <= 2 ? samples[i * last / 4] : samples[last - (4 - i) * last / 4];
  };
  const Vec2& middle = sample(2);
  double unit = 0.0;
  double shortest = std::numeric_limits<double>::infinity();
  bool forwards = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 chord = sample(i + 1) - sample(i);
    unit += chord.norm() / 4.0;
    shortest = std::min(shortest, chord.norm());
    forwards = forwards && (i == 0 || chord.dot(sample(i) - sample(i - 1)) > 0.0);
  }
  if (!std::isfinite(unit)) {
    result.status = LocalStatus::NotFinite;
    return result;
  }
  double sigma = sigma_m;
  bool sigma_known = sigma_m > 0.0;
  if (!sigma_known) {
    const LocalResult jet = jet_estimate(samples);
    sigma_known = jet.status == LocalStatus::Ok;
    sigma = jet.estimate.sigma_m;
  }
  if (!(unit > 0.0)) {
    result.status = LocalStatus::NoExtent;
    return result;
  }
  if (!(shortest > kMinChordSigmas * std::numbers::sqrt2 * sigma)) {
    result.status = LocalStatus::Unresolved;
    return result;
  }
  if (!forwards) {
    result.status = LocalStatus::DoublesBack;
    return result;
  }

  std::array<PlanePoint<Jet>, 5> points;
  for (std::size_t i = 0; i < 5; ++i) {
    const Vec2 p = (sample(i) - middle) / unit;
    points[i] = {Jet(p.x(), static_cast<int>(2 * i)), Jet(p.y(), static_cast<int>(2 * i + 1))};
  }
  const std::array<Jet, 3> at = geometry(points);

  LocalEstimate& e = result.estimate;
  e.position = middle;
  e.tangent_angle = wrap_angle(at[0].a);
  e.kappa = at[1].a / unit;
  e.kappa_s = at[2].a / (unit * unit);
  // The error of the middle point moves it along the normal (the offset) and along the curve, where
  // the true angle and kappa are different.
  const Vec2 tangent(std::cos(e.tangent_angle), std::sin(e.tangent_angle));
  Eigen::Matrix<double, 4, 10> jacobian;
  jacobian.setZero();
  jacobian.block<1, 2>(0, 4) = left_of(tangent).transpose();
  for (int row = 0; row < 3; ++row) {
    jacobian.row(row + 1) = at[static_cast<std::size_t>(row)].v.transpose();
  }
  jacobian.block<1, 2>(1, 4) -= at[1].a * tangent.transpose();
  jacobian.block<1, 2>(2, 4) -= at[2].a * tangent.transpose();
  const Eigen::Vector4d units(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit));
  const Eigen::Matrix<double, 4, 10> scaled = units.asDiagonal() * jacobian;
  if (sigma_known) {
    const double relative = sigma / unit;
    e.covariance = relative * relative * scaled * scaled.transpose();
  } else {
    e.covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
  }
  for (std::size_t i = 0; i < 4; ++i) {
    e.window_arc_m += (sample(i + 1) - sample(i)).norm();
  }
  e.window_samples = static_cast<int>(samples.size());
  e.sigma_m = sigma;
  result.status = LocalStatus::Ok;
  if (!std::isfinite(e.kappa_s) || e.covariance.hasNaN()) {
    result = {LocalStatus::NotFinite, {}};
  }
  return result;
}

}  // namespace palpate

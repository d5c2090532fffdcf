#include "core/invariants/conic_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/invariants/jet_propagation.h"

namespace palpate {
namespace {

/// Semi-axes from the product p = ab and the sum (ellipse) or difference (hyperbola) q of the
/// squares. The larger one comes from the root that adds, the smaller one from the product, so
/// neither loses digits by cancellation (a/b = 100 would cost four). Erratum: under the inner root,
/// (29) and (30) must have Ic2^2 - 4 Ic1 instead of Ic2^2 - 4 Ic1^2, as in (34) and (35).
template <typename T>
std::array<T, 2> semi_axes(const T& ic1, const T& ic2, const T& discriminant) {
  using std::abs;
  using std::sqrt;
  const T root = sqrt(discriminant);
  const T larger = sqrt((abs(ic2) + root) / 2.0) / abs(ic1);
  const T product = 1.0 / (abs(ic1) * sqrt(abs(ic1)));
  return {larger, product / larger};
}

/// Rounding of Ic2^2 - 4 Ic1 in units of Ic2^2: both terms carry a few roundings from the
/// evaluation of the invariants. A discriminant above minus this belongs to a circle.
constexpr double kDiscriminantRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// One-sided. A discriminant this many standard deviations below zero excludes an ellipse; by
/// chance it occurs for one circle in 30,000.
constexpr double kDiscriminantSigmas = 4.0;

ConicParameters finish(const Eigen::Vector2d& invariants, const Eigen::Matrix2d& covariance,
                       double discriminant, double floor, bool swap) {
  ConicParameters result;
  const double d = std::max(discriminant, 0.0);
  const auto value = semi_axes(invariants[0], invariants[1], d);
  auto propagated = propagate<2, 2>(invariants, [&](const auto& x) {
    auto e = x[1] * x[1] - 4.0 * x[0];
    e.a = std::max(d, floor);
    return semi_axes(x[0], x[1], e);
  });
  result.a = value[0];
  result.b = value[1];
  result.covariance = propagated.covariance(covariance);
  if (swap) {
    std::swap(result.a, result.b);
    result.covariance = result.covariance.reverse().eval();
  }
  const bool finite = std::isfinite(result.a) && std::isfinite(result.b) &&
                      result.covariance.allFinite() && result.a > 0.0 && result.b > 0.0;
  if (!finite) {
    return {.status = InvariantStatus::NotFinite};
  }
  result.status = InvariantStatus::Ok;
  return result;
}

}  // namespace

ConicParameters ellipse_parameters(double ic1, double ic2, const Eigen::Matrix2d& covariance) {
  if (!std::isfinite(ic1) || !std::isfinite(ic2) || !covariance.allFinite()) {
    return {.status = InvariantStatus::NotFinite};
  }
  if (!(ic1 > 0.0) || !(ic2 > 0.0)) {
    return {.status = InvariantStatus::NotThisClass};
  }
  const double discriminant = ic2 * ic2 - 4.0 * ic1;
  const Eigen::Vector2d gradient(-4.0, 2.0 * ic2);
  const double sd = std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
  const double rounding = kDiscriminantRounding * ic2 * ic2;
  if (discriminant < -(kDiscriminantSigmas * sd + rounding)) {
    return {.status = InvariantStatus::NotThisClass};
  }
  return finish({ic1, ic2}, covariance, discriminant, std::max(sd, rounding), false);
}

ConicParameters hyperbola_parameters(double ic1, double ic2, const Eigen::Matrix2d& covariance) {
  if (!std::isfinite(ic1) || !std::isfinite(ic2) || !covariance.allFinite()) {
    return {.status = InvariantStatus::NotFinite};
  }
  if (!(ic1 < 0.0)) {
    return {.status = InvariantStatus::NotThisClass};
  }
  return finish({ic1, ic2}, covariance, ic2 * ic2 - 4.0 * ic1, 0.0, ic2 < 0.0);
}

ConicParameters parabola_parameters(double ip, double variance) {
  if (!std::isfinite(ip) || !std::isfinite(variance)) {
    return {.status = InvariantStatus::NotFinite};
  }
  if (!(ip > 0.0)) {
    return {.status = InvariantStatus::NotThisClass};
  }
  const auto propagated = propagate<1, 1>(Eigen::Matrix<double, 1, 1>(ip), [](const auto& x) {
    return std::array{0.5 / (x[0] * sqrt(x[0]))};
  });
  ConicParameters result;
  result.a = propagated.value[0];
  result.covariance(0, 0) = propagated.covariance(Eigen::Matrix<double, 1, 1>(variance))(0, 0);
  const bool finite = std::isfinite(result.a) && result.covariance.allFinite();
  if (!finite) {
    return {.status = InvariantStatus::NotFinite};
  }
  result.status = InvariantStatus::Ok;
  return result;
}

}  // namespace palpate

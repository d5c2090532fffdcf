#include "core/invariants/conic_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/invariants/parabola_invariant.h"

namespace palpate {
namespace {

/// Relative standard deviation of u and v due to rounding, a few operations each. It weights exact
/// data, whose covariance is zero.
constexpr double kPointRounding = 8.0 * std::numeric_limits<double>::epsilon();

/// The sign of a curvature is certain if it is this many standard deviations from zero. By noise it
/// is then wrong for one in 30,000 points.
constexpr double kSignSigmas = 4.0;

/// The spread of u exceeds noise if its chi-square exceeds its mean by this many standard
/// deviations; by chance it does for one circle in a hundred.
constexpr double kSpreadSigmas = 3.0;

/// Bounds the time. If the iteration has not converged by then, the last change decides
/// (kSlopeAcceptable).
constexpr int kMaxIterations = 100;
constexpr double kSlopeTolerance = 1e-13;  ///< relative change of the slope: converged if below
constexpr double kSlopeAcceptable =
    1e-6;  ///< usable after kMaxIterations if the relative change is below

/// A point in the (u, v) plane.
struct LinePoint {
  double kappa;
  double kappa_s;
  double u;
  double v;  ///< with kappa_s^2 replaced by its unbiased estimate kappa_s^2 - var(kappa_s)
  Eigen::Matrix2d measured;    ///< covariance of (kappa, kappa_s)
  Eigen::Matrix2d covariance;  ///< of (u, v)
};

/// The factor of kappa_s^2 in v = (1 + kappa_s^2 / (9 kappa^4)) / u, within the parentheses.
double of_square(double kappa) {
  const double square = kappa * kappa;
  return 1.0 / (9.0 * square * square);
}

/// Covariance of (u, v) if the true kappa_s^2 is `m`. For a Gaussian kappa_s the moments of its
/// square are exact: variance 4 m s^2 + 2 s^4, covariance with kappa 2 sqrt(m) cov.
void set_covariance(LinePoint& point, double m) {
  const double variance = point.measured(1, 1);
  const double m_variance = 4.0 * m * variance + 2.0 * variance * variance;
  const double cross = 2.0 * std::copysign(std::sqrt(m), point.kappa_s) * point.measured(0, 1);
  const double factor = of_square(point.kappa);
  // Derivatives of u = |kappa|^(-2/3) and of v by kappa and by m.
  const double u_by_kappa = -2.0 / 3.0 * point.u / point.kappa;
  const double v_by_kappa = (2.0 - 10.0 * factor * m) / (3.0 * point.u * point.kappa);
  const double v_by_m = factor / point.u;
  const double u_u = u_by_kappa * u_by_kappa * point.measured(0, 0);
  const double u_v = u_by_kappa * (v_by_kappa * point.measured(0, 0) + v_by_m * cross);
  const double v_v = v_by_kappa * v_by_kappa * point.measured(0, 0) +
                     v_by_m * (2.0 * v_by_kappa * cross + v_by_m * m_variance);
  const double u_rounding = kPointRounding * point.u;
  const double v_rounding = kPointRounding * point.v;
  point.covariance << u_u + u_rounding * u_rounding, u_v, u_v, v_v + v_rounding * v_rounding;
}

InvariantStatus read_points(std::span<const MeasuredGeometry> points,
                            std::vector<LinePoint>& line_points) {
  line_points.reserve(points.size());
  for (const MeasuredGeometry& point : points) {
    if (!is_finite(point)) {
      return InvariantStatus::NotFinite;
    }
    if (point.kappa == 0.0) {
      return InvariantStatus::ZeroCurvature;
    }
    const double variance = point.covariance(2, 2);
    const double m = point.kappa_s * point.kappa_s - variance;
    const double two_thirds = curvature_two_thirds(point.kappa);
    LinePoint line_point{point.kappa,
                         point.kappa_s,
                         1.0 / two_thirds,
                         two_thirds * (1.0 + m * of_square(point.kappa)),
                         point.covariance.bottomRightCorner<2, 2>(),
                         Eigen::Matrix2d::Zero()};
    set_covariance(line_point, std::max(m, 0.0));
    if (!std::isfinite(line_point.u) || !std::isfinite(line_point.v) ||
        !line_point.covariance.allFinite()) {
      return InvariantStatus::NotFinite;
    }
    line_points.push_back(line_point);
  }
  return InvariantStatus::Ok;
}

bool sign_changes_within_a_patch(std::span<const MeasuredGeometry> points) {
  const auto certain = [](const MeasuredGeometry& p) {
    return std::abs(p.kappa) > kSignSigmas * std::sqrt(p.covariance(1, 1));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      if (points[i].patch == points[j].patch && points[i].kappa * points[j].kappa < 0.0 &&
          certain(points[i]) && certain(points[j])) {
        return true;
      }
    }
  }
  return false;
}

/// kappa_s^2 of the model at a point of the line.
double model_kappa_s_squared(const LinePoint& point, double ic1, double ic2) {
  const double v = ic2 - ic1 * point.u;
  return std::max(0.0, (v * point.u - 1.0) / of_square(point.kappa));
}

/// Weighted mean of v: the line of slope zero. The weights come from the model. Weights from each
/// point's own noisy kappa_s would favour points that happen to lie low.
void fit_parabola(std::vector<LinePoint> points, ConicLine& line) {
  double mean = 0.0;
  for (int iteration = 0; iteration < 3; ++iteration) {
    double weight_sum = 0.0;
    double sum = 0.0;
    for (LinePoint& point : points) {
      if (iteration > 0) {
        set_covariance(point, model_kappa_s_squared(point, 0.0, mean));
      }
      const double weight = 1.0 / point.covariance(1, 1);
      weight_sum += weight;
      sum += weight * point.v;
    }
    mean = sum / weight_sum;
    line.ip_variance = 1.0 / weight_sum;
  }
  line.ip_mean = mean;
  line.ip_dof = static_cast<int>(points.size()) - 1;
  line.ip_chi2 = 0.0;
  for (const LinePoint& point : points) {
    line.ip_chi2 += std::pow(point.v - mean, 2) / point.covariance(1, 1);
  }
}

/// True if the abscissae of the points differ by no more than their errors.
bool too_alike(const std::vector<LinePoint>& points) {
  double weight_sum = 0.0;
  double mean = 0.0;
  for (const LinePoint& point : points) {
    weight_sum += 1.0 / point.covariance(0, 0);
    mean += point.u / point.covariance(0, 0);
  }
  mean /= weight_sum;
  double spread = 0.0;
  for (const LinePoint& point : points) {
    spread += std::pow(point.u - mean, 2) / point.covariance(0, 0);
  }
  const double dof = static_cast<double>(points.size()) - 1.0;
  return spread <= dof + kSpreadSigmas * std::sqrt(2.0 * dof);
}

struct WeightedMeans {
  double weight = 0.0;
  double u = 0.0;
  double v = 0.0;
};

double effective_weight(const LinePoint& point, double slope) {
  return 1.0 / (point.covariance(1, 1) + slope * slope * point.covariance(0, 0) -
                2.0 * slope * point.covariance(0, 1));
}

WeightedMeans weighted_means(const std::vector<LinePoint>& points, double slope) {
  WeightedMeans means;
  for (const LinePoint& point : points) {
    const double weight = effective_weight(point, slope);
    means.weight += weight;
    means.u += weight * point.u;
    means.v += weight * point.v;
  }
  means.u /= means.weight;
  means.v /= means.weight;
  return means;
}

/// York's beta: the most likely abscissa of the point, relative to the mean.
double adjusted_abscissa(const LinePoint& point, const WeightedMeans& means, double slope) {
  const double du = point.u - means.u;
  const double dv = point.v - means.v;
  return effective_weight(point, slope) *
         (du * point.covariance(1, 1) + slope * dv * point.covariance(0, 0) -
          (slope * du + dv) * point.covariance(0, 1));
}

double initial_slope(const std::vector<LinePoint>& points) {
  const WeightedMeans means = weighted_means(points, 0.0);
  double suu = 0.0;
  double suv = 0.0;
  for (const LinePoint& point : points) {
    const double weight = 1.0 / point.covariance(1, 1);
    suu += weight * std::pow(point.u - means.u, 2);
    suv += weight * (point.u - means.u) * (point.v - means.v);
  }
  return suv / suu;
}

}  // namespace

ConicLine fit_conic_line(std::span<const MeasuredGeometry> measured) {
  ConicLine line;
  std::vector<LinePoint> points;
  line.status = read_points(measured, points);
  if (line.status != InvariantStatus::Ok) {
    return line;
  }
  if (points.size() < 2) {
    line.status = InvariantStatus::TooFewPoints;
    return line;
  }
  if (sign_changes_within_a_patch(measured)) {
    line.status = InvariantStatus::SignChange;
    return line;
  }
  fit_parabola(points, line);
  line.dof = static_cast<int>(points.size()) - 2;
  if (too_alike(points)) {
    line.status = InvariantStatus::PointsTooAlike;
    line.ic2 = line.ip_mean;
    line.covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return line;
  }

  double slope = initial_slope(points);
  double change = std::numeric_limits<double>::infinity();
  const double slope_unit = line.ip_mean / points.front().u;  // v / u, the scale for slopes
  WeightedMeans means;
  for (int iteration = 0; iteration < kMaxIterations && change > kSlopeTolerance; ++iteration) {
    means = weighted_means(points, slope);
    double numerator = 0.0;
    double denominator = 0.0;
    for (const LinePoint& point : points) {
      const double weight_beta =
          effective_weight(point, slope) * adjusted_abscissa(point, means, slope);
      numerator += weight_beta * (point.v - means.v);
      denominator += weight_beta * (point.u - means.u);
    }
    const double next = numerator / denominator;
    if (!std::isfinite(next)) {
      line.status = InvariantStatus::NotConverged;
      return line;
    }
    change = std::abs(next - slope) / (std::abs(slope) + slope_unit);
    slope = next;
    const double intercept = means.v - slope * means.u;
    for (LinePoint& point : points) {
      set_covariance(point, model_kappa_s_squared(point, -slope, intercept));
    }
  }
  means = weighted_means(points, slope);

  line.ic1 = -slope;
  line.ic2 = means.v - slope * means.u;
  double adjusted_mean = 0.0;
  for (const LinePoint& point : points) {
    adjusted_mean += effective_weight(point, slope) *
                     (means.u + adjusted_abscissa(point, means, slope)) / means.weight;
  }
  double information = 0.0;
  line.chi2 = 0.0;
  for (const LinePoint& point : points) {
    const double weight = effective_weight(point, slope);
    const double u = means.u + adjusted_abscissa(point, means, slope) - adjusted_mean;
    information += weight * u * u;
    line.chi2 += weight * std::pow(point.v - line.ic2 - slope * point.u, 2);
  }
  const double slope_variance = 1.0 / information;
  line.covariance << slope_variance, adjusted_mean * slope_variance, adjusted_mean * slope_variance,
      1.0 / means.weight + adjusted_mean * adjusted_mean * slope_variance;
  const bool good =
      change < kSlopeAcceptable && line.covariance.allFinite() && std::isfinite(line.chi2);
  line.status = good ? InvariantStatus::Ok : InvariantStatus::NotConverged;
  return line;
}

}  // namespace palpate

#include "core/local/two_round_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/local/aligned_frame.h"
#include "core/local/graph_geometry.h"
#include "core/numerics/polynomials/legendre_fit.h"

namespace palpate {
namespace {

using Quadratic = LegendreFit<2>;
using Coefficients = LegendreVector<3>;

/// First round: the parabola of one window.
struct WindowFit {
  AlignedFrame frame;
  Coefficients c;
  double median_u = 0.0;
  Eigen::Matrix<double, 5, 1> derivatives;  ///< v, v' ... at the abscissa of the median
  GraphGeometry geometry;                   ///< dimensionless
  /// Effect of an error of sample i on (offset, angle, kappa): these rows times P(u_i). World
  /// units.
  Eigen::Matrix<double, 3, 3> influence;
};

double slope(const Coefficients& c, double u) { return c[1] + 3.0 * c[2] * u; }

LocalStatus fit_window(std::span<const Vec2> samples, const TwoRoundOptions& options,
                       WindowFit& window, double& sigma_m) {
  const auto [status, aligned] = aligned_frame(samples);
  if (status != LocalStatus::Ok) {
    return status;
  }
  window.frame = aligned;
  const AlignedFrame& frame = window.frame;
  const double unit = frame.half_extent_m;
  if (!(unit > 0.0)) {
    return LocalStatus::Unresolved;
  }
  Quadratic fit;
  for (const Vec2& p : samples) {
    const Vec2 uv = frame.to_frame(p);
    fit.add(uv.x(), uv.y(), 1.0);
  }
  if (!fit.factorise(options.sigma_m / unit)) {
    return LocalStatus::Unresolved;
  }
  window.c = fit.coefficients();
  double sum = 0.0;
  for (const Vec2& p : samples) {
    const Vec2 uv = frame.to_frame(p);
    const double residual = uv.y() - window.c.dot(legendre<3>(uv.x()));
    const double s = slope(window.c, uv.x());
    sum += residual * residual / (1.0 + s * s);
  }
  const double seen = std::sqrt(sum / (static_cast<double>(samples.size()) - 3.0));
  sigma_m = options.sigma_m > 0.0 ? options.sigma_m : seen * unit;
  if (const LocalStatus order = check_backtrack(frame, options.sigma_m / unit, seen);
      order != LocalStatus::Ok) {
    return order;
  }

  window.median_u = frame.to_frame(samples[samples.size() / 2]).x();
  const Eigen::Matrix<double, 5, 3> basis = legendre_derivatives<5, 3>(window.median_u);
  window.derivatives = basis * window.c;
  window.geometry = graph_geometry(window.derivatives);
  const Eigen::Matrix<double, 3, 3> gradients = window.geometry.jacobian.topRows<3>() * basis;
  for (int row = 0; row < 3; ++row) {
    window.influence.row(row) = fit.influence(gradients.row(row).transpose()).transpose();
  }
  // The rows take errors in units of the half extent and give offset, angle, kappa in world units.
  window.influence.row(1) /= unit;
  window.influence.row(2) /= unit * unit;
  return LocalStatus::Ok;
}

/// Arc length of a window's parabola from its median to a place, by Simpson's rule; negative
/// backwards.
double arc_to(const WindowFit& window, const Vec2& place) {
  const double u0 = window.median_u;
  const double u1 = window.frame.to_frame(place).x();
  const auto speed = [&](double u) { return std::hypot(1.0, slope(window.c, u)); };
  return window.frame.half_extent_m * (u1 - u0) / 6.0 *
         (speed(u0) + 4.0 * speed(0.5 * (u0 + u1)) + speed(u1));
}

TwoRoundOptions in_range(TwoRoundOptions options) {
  options.samples_per_fit = std::max(options.samples_per_fit, 4);
  options.shift = std::max(options.shift, 1);
  options.fits = std::clamp(options.fits, 3, kMaxTwoRoundFits);
  return options;
}

}  // namespace

int two_round_samples(const TwoRoundOptions& options) {
  const TwoRoundOptions o = in_range(options);
  return o.samples_per_fit + (o.fits - 1) * o.shift;
}

LocalResult two_round_estimate(std::span<const Vec2> all_samples, const TwoRoundOptions& given) {
  const TwoRoundOptions options = in_range(given);
  LocalResult result;
  const auto total = static_cast<std::size_t>(two_round_samples(options));
  if (all_samples.size() < total) {
    return result;
  }
  const std::span<const Vec2> samples = all_samples.first(total);
  const auto n = static_cast<std::size_t>(options.samples_per_fit);
  const auto l = static_cast<std::size_t>(options.shift);
  const auto m = static_cast<std::size_t>(options.fits);
  const std::size_t middle = m / 2;

  // First round.
  std::array<WindowFit, kMaxTwoRoundFits> windows;
  std::array<double, kMaxTwoRoundFits> arc;  // of each median, from that of the first window [m]
  arc[0] = 0.0;
  double sigma_m = 0.0;
  for (std::size_t j = 0; j < m; ++j) {
    double sigma_seen_m = 0.0;
    const LocalStatus status =
        fit_window(samples.subspan(j * l, n), options, windows[j], sigma_seen_m);
    if (status != LocalStatus::Ok) {
      result.status = status;
      return result;
    }
    if (j == middle) {
      sigma_m = sigma_seen_m;
    }
    if (j + 1 < m) {
      arc[j + 1] = arc[j] + arc_to(windows[j], samples[(j + 1) * l + n / 2]);
    }
  }

  // Second round: kappa = b2 s^2 + b1 s + b0, with arc lengths scaled to [-1, 1].
  const double arc_unit = 0.5 * arc[m - 1];
  if (!(arc_unit > 0.0)) {
    result.status = LocalStatus::DoublesBack;
    return result;
  }
  const auto scaled_arc = [&](std::size_t j) { return arc[j] / arc_unit - 1.0; };
  Quadratic second;
  for (std::size_t j = 0; j < m; ++j) {
    const WindowFit& w = windows[j];
    second.add(scaled_arc(j), w.geometry.kappa / w.frame.half_extent_m, 1.0);
  }
  if (!second.factorise(0.0)) {
    result.status = LocalStatus::Unresolved;
    return result;
  }
  const Coefficients slope_row =
      legendre_derivatives<2, 3>(scaled_arc(middle)).row(1).transpose() / arc_unit;
  const Coefficients slope_influence = second.influence(slope_row);

  const WindowFit& at = windows[middle];
  const AlignedFrame& frame = at.frame;
  LocalEstimate& e = result.estimate;
  e.position = frame.to_world({at.median_u, at.derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + at.geometry.angle);
  e.kappa = at.geometry.kappa / frame.half_extent_m;
  e.kappa_s = slope_row.dot(second.coefficients());

  // The influence of each sample on the four results, over all windows that contain it.
  for (std::size_t i = 0; i < total; ++i) {
    Eigen::Vector4d influence = Eigen::Vector4d::Zero();
    const std::size_t first = i < n ? 0 : (i - n) / l + 1;
    const std::size_t last = std::min(m - 1, i / l);
    for (std::size_t j = first; j <= last; ++j) {
      const WindowFit& w = windows[j];
      const double u = w.frame.to_frame(samples[i]).x();
      const double s = slope(w.c, u);
      const Coefficients p = std::sqrt(1.0 + s * s) * legendre<3>(u);
      const double on_kappa = w.influence.row(2).dot(p);
      influence[3] += slope_influence.dot(legendre<3>(scaled_arc(j))) * on_kappa;
      if (j == middle) {
        influence.head<3>() = w.influence * p;
      }
    }
    e.covariance += sigma_m * sigma_m * influence * influence.transpose();
  }

  e.window_arc_m = arc_unit * 2.0;
  e.window_arc_m += std::abs(arc_to(windows[0], samples.front()));
  e.window_arc_m += std::abs(arc_to(windows[m - 1], samples.back()));
  e.window_samples = static_cast<int>(total);
  e.sigma_m = sigma_m;
  result.status = LocalStatus::Ok;
  if (!is_finite(e)) {
    result = {LocalStatus::NotFinite, {}};
  }
  return result;
}

}  // namespace palpate

#include "core/local/jet_estimator.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/local/aligned_frame.h"
#include "core/local/graph_geometry.h"
#include "core/local/legendre_curve.h"
#include "core/numerics/polynomials/legendre_fit.h"

namespace palpate {
namespace {

/// Residuals, in addition to the unknowns, that an estimate of the noise needs: with four its
/// relative standard deviation is 1/sqrt(2 * 4) = 35 %.
constexpr std::size_t kSpareResiduals = 4;

/// The polynomial of a window, or why there is none.
template <int Degree>
struct JetFit {
  LocalStatus status = LocalStatus::TooFewSamples;
  AlignedFrame frame;
  LegendreFit<Degree> fit;
  double sigma = 0.0;  ///< noise, given or estimated, in units of the half extent
  double window_arc_m = 0.0;
};

template <int Degree>
JetFit<Degree> fit_window(std::span<const Vec2> samples, double sigma_given_m) {
  constexpr int kSize = Degree + 1;
  JetFit<Degree> result;
  const bool sigma_known = sigma_given_m > 0.0;
  if (samples.size() < kSize + (sigma_known ? 0 : kSpareResiduals)) {
    return result;
  }
  const auto [frame_status, frame] = aligned_frame(samples);
  if (frame_status != LocalStatus::Ok) {
    result.status = frame_status;
    return result;
  }
  result.frame = frame;
  const double unit = frame.half_extent_m;
  double& sigma = result.sigma;
  sigma = sigma_given_m / unit;

  LegendreFit<Degree> plain;
  for (const Vec2& p : samples) {
    const Vec2 uv = frame.to_frame(p);
    plain.add(uv.x(), uv.y(), 1.0);
  }
  result.status = LocalStatus::Unresolved;
  if (!plain.factorise(sigma)) {
    return result;
  }
  // Isotropic noise has the variance sigma^2 (1 + slope^2) along v.
  const LegendreVector<kSize> start = plain.coefficients();
  LegendreFit<Degree>& fit = result.fit;
  for (const Vec2& p : samples) {
    const Vec2 uv = frame.to_frame(p);
    const double s = slope<kSize>(start, uv.x());
    fit.add(uv.x(), uv.y(), 1.0 / (1.0 + s * s));
  }
  if (!fit.factorise(sigma)) {
    return result;
  }
  const LegendreVector<kSize> c = fit.coefficients();

  if (!sigma_known || frame.backtrack > frame.rounding) {
    double sum = 0.0;
    for (const Vec2& p : samples) {
      const Vec2 uv = frame.to_frame(p);
      const double residual = uv.y() - c.dot(legendre<kSize>(uv.x()));
      const double s = slope<kSize>(start, uv.x());
      sum += residual * residual / (1.0 + s * s);
    }
    const double spare = std::max(1.0, static_cast<double>(samples.size()) - kSize);
    const double sigma_seen = std::sqrt(sum / spare);
    if (!sigma_known) {
      sigma = sigma_seen;
      if (!fit.factorise(sigma)) {
        return result;
      }
    }
    if (const LocalStatus order = check_backtrack(frame, sigma_given_m / unit, sigma_seen);
        order != LocalStatus::Ok) {
      result.status = order;
      return result;
    }
  }
  result.window_arc_m = unit * arc_length<kSize>(c, frame.first_u, frame.last_u);
  result.status = LocalStatus::Ok;
  return result;
}

/// The estimate from the polynomial at one place of the window.
template <int Degree>
LocalResult estimate_at(const JetFit<Degree>& window, double place) {
  constexpr int kSize = Degree + 1;
  LocalResult result;
  result.status = window.status;
  if (window.status != LocalStatus::Ok) {
    return result;
  }
  const AlignedFrame& frame = window.frame;
  const double unit = frame.half_extent_m;
  const double u = std::clamp(place, -1.0, 1.0);
  const Eigen::Matrix<double, 5, kSize> basis = legendre_derivatives<5, kSize>(u);
  const Eigen::Matrix<double, 5, 1> derivatives = basis * window.fit.coefficients();
  const GraphGeometry geometry = graph_geometry(derivatives);
  const Eigen::Matrix<double, 4, kSize> rows = geometry.jacobian * basis;
  Eigen::Matrix<double, kSize, 4> spread = window.fit.whitened(rows);
  spread *= Eigen::Vector4d(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit)).asDiagonal();

  LocalEstimate& e = result.estimate;
  e.position = frame.to_world({u, derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  e.covariance = window.sigma * window.sigma * (spread.transpose() * spread);
  e.window_arc_m = window.window_arc_m;
  if (!is_finite(e)) {
    e = {};
    result.status = LocalStatus::NotFinite;
  }
  return result;
}

template <int Degree>
void estimate(std::span<const Vec2> samples, const JetOptions& options,
              std::span<const double> places, std::span<LocalResult> results) {
  const JetFit<Degree> window = fit_window<Degree>(samples, options.sigma_m);
  for (std::size_t i = 0; i < places.size(); ++i) {
    results[i] = estimate_at(window, places[i]);
    if (results[i]) {
      LocalEstimate& e = results[i].estimate;
      e.window_samples = static_cast<int>(samples.size());
      e.sigma_m =
          options.sigma_m > 0.0 ? options.sigma_m : window.sigma * window.frame.half_extent_m;
    }
  }
}

}  // namespace

void jet_estimates(std::span<const Vec2> samples, const JetOptions& options,
                   std::span<const double> places, std::span<LocalResult> results) {
  assert(places.size() == results.size());
  switch (std::clamp(options.degree, kMinJetDegree, kMaxJetDegree)) {
    case 3:
      return estimate<3>(samples, options, places, results);
    case 4:
      return estimate<4>(samples, options, places, results);
    default:
      return estimate<5>(samples, options, places, results);
  }
}

LocalResult jet_estimate(std::span<const Vec2> samples, const JetOptions& options) {
  LocalResult result;
  jet_estimates(samples, options, {&options.place, 1}, {&result, 1});
  return result;
}

}  // namespace palpate

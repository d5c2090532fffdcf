#include "core/local/jet_estimator.h"

#include <algorithm>
#include <cmath>

#include "core/local/aligned_frame.h"
#include "core/local/graph_geometry.h"
#include "core/local/legendre_curve.h"
#include "core/local/legendre_fit.h"

namespace palpate {
namespace {

/// Residuals beyond the unknowns that an estimate of the noise needs: four leave it a relative
/// standard deviation of 1/sqrt(2 * 4) = 35 %.
constexpr std::size_t kSpareResiduals = 4;

template <int Degree>
LocalResult estimate(std::span<const Vec2> samples, const JetOptions& options) {
  constexpr int kSize = Degree + 1;
  LocalResult result;
  const bool sigma_known = options.sigma_m > 0.0;
  if (samples.size() < kSize + (sigma_known ? 0 : kSpareResiduals)) {
    return result;
  }
  const auto [frame_status, frame] = aligned_frame(samples);
  if (frame_status != LocalStatus::Ok) {
    result.status = frame_status;
    return result;
  }
  const double unit = frame.half_extent_m;
  double sigma = options.sigma_m / unit;

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
  LegendreFit<Degree> fit;
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
    if (const LocalStatus order = check_backtrack(frame, options.sigma_m / unit, sigma_seen);
        order != LocalStatus::Ok) {
      result.status = order;
      return result;
    }
  }

  const double u = std::clamp(options.place, -1.0, 1.0);
  const Eigen::Matrix<double, 5, kSize> basis = legendre_derivatives<5, kSize>(u);
  const Eigen::Matrix<double, 5, 1> derivatives = basis * c;
  const GraphGeometry geometry = graph_geometry(derivatives);
  const Eigen::Matrix<double, 4, kSize> rows = geometry.jacobian * basis;
  Eigen::Matrix<double, kSize, 4> spread = fit.whitened(rows);
  spread *= Eigen::Vector4d(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit)).asDiagonal();

  LocalEstimate& e = result.estimate;
  e.position = frame.to_world({u, derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  e.covariance = sigma * sigma * (spread.transpose() * spread);
  e.window_arc_m = unit * arc_length<kSize>(c, frame.first_u, frame.last_u);
  e.window_samples = static_cast<int>(samples.size());
  e.sigma_m = sigma_known ? options.sigma_m : sigma * unit;
  if (!(e.position.allFinite() && std::isfinite(e.kappa) && std::isfinite(e.kappa_s) &&
        e.covariance.allFinite() && std::isfinite(e.window_arc_m))) {
    e = {};
    result.status = LocalStatus::NotFinite;
    return result;
  }
  result.status = LocalStatus::Ok;
  return result;
}

}  // namespace

LocalResult jet_estimate(std::span<const Vec2> samples, const JetOptions& options) {
  switch (std::clamp(options.degree, kMinJetDegree, kMaxJetDegree)) {
    case 3:
      return estimate<3>(samples, options);
    case 4:
      return estimate<4>(samples, options);
    default:
      return estimate<5>(samples, options);
  }
}

}  // namespace palpate

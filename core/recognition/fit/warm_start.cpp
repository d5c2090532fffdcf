#include "core/recognition/fit/warm_start.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "core/recognition/fit/orthogonal/polynomial_problem.h"

namespace palpate {
namespace {

/// The parameter of the place nearest to a point, among places along the curve: so dense that a
/// sharp bend has places on both its arms.
class NearestPlace {
 public:
  /// Of the points before, the feet were between `least` and `most`.
  NearestPlace(const PolynomialCoefficients& c, double least, double most)
      : middle_(0.5 * (least + most)), half_(0.5 * (most - least)) {
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const double t = parameter(k);
      const Vec2 place = position_at(c, t);
      x_[k] = static_cast<float>(place.x());
      y_[k] = static_cast<float>(place.y());
    }
  }

  double operator()(const Vec2& point) {
    const auto x = static_cast<float>(point.x());
    const auto y = static_cast<float>(point.y());
    for (std::size_t k = 0; k < kPlaces; ++k) {
      squares_[k] = (x_[k] - x) * (x_[k] - x) + (y_[k] - y) * (y_[k] - y);
    }
    // The least of them first: that takes several at a time.
    const float least =
        Eigen::Map<const Eigen::Array<float, kPlaces, 1>>(squares_.data()).minCoeff();
    const auto nearest = std::find(squares_.begin(), squares_.end(), least) - squares_.begin();
    return parameter(static_cast<std::size_t>(nearest));
  }

 private:
  // At either end there may be more by three tenths of what there was: a new search is made before
  // there is a quarter more (counted/last_weighing.cpp).
  // Steps of a fortieth: a bend that is sharper has its arms told apart by the points themselves.
  static constexpr std::size_t kPlaces = 129;
  static constexpr double kFarthest = 1.6;  // in half ranges of the feet
  double parameter(std::size_t k) const {
    return middle_ + half_ * kFarthest * (2.0 * static_cast<double>(k) / (kPlaces - 1) - 1.0);
  }

  double middle_;  ///< of the feet
  double half_;    ///< half their range
  // Single precision is plenty for a start.
  std::array<float, kPlaces> x_;
  std::array<float, kPlaces> y_;
  std::array<float, kPlaces> squares_;  ///< of distances from the point last asked for
};

struct ParameterRange {
  double least = 0.0;
  double most = 0.0;
};

/// Seeks the feet of points that lie farther from the curve than noise, from the places found:
/// between the arms of a cusp, which are nearer to one another than places are, they may be on the
/// wrong one. Not beyond the `range` of the feet before: there a cubic may come back to any point.
void seek_far_feet(std::span<const FitPoint> points, const ParameterRange& range,
                   PolynomialFit* fit) {
  const auto residual_of = [&](std::size_t i) {
    const double last_step = last_foot_step(1.0 / points[i].inverse_sigma);
    return place_on(*fit, fit->t[i], points[i], last_step).signed_distance *
           points[i].inverse_sigma;
  };
  for (const std::size_t i : few_far_points(points.size(), residual_of)) {
    const double t = nearest_parameter(fit->coefficients, points[i].position);
    if (t >= range.least && t <= range.most) {
      fit->t[i] = t;
    }
  }
}

std::optional<PolynomialFit> carried(const std::optional<PolynomialFit>& fit, const WarmStart& warm,
                                     const FitData& reduced) {
  if (!fit) {
    return std::nullopt;
  }
  PolynomialFit start;
  start.chi2 = fit->chi2;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Vec2 scaled = warm.scale * fit->coefficients.col(k);
    start.coefficients.col(k) = (k == 0 ? reduced.frame.to_local(warm.frame * scaled)
                                        : reduced.frame.rotate_back(warm.frame.rotate(scaled))) /
                                reduced.scale;
  }
  const auto [least, most] = std::minmax_element(fit->t.begin(), fit->t.end());
  NearestPlace nearest(start.coefficients, *least, *most);
  start.t.reserve(reduced.points.size());
  for (const FitPoint& point : reduced.points) {
    start.t.push_back(nearest(point.position));
  }
  seek_far_feet(reduced.points, {*least, *most}, &start);
  return start;
}

}  // namespace

WarmStart warm_start_from(const ClassFits& fits, const FitData& reduced) {
  WarmStart warm;
  warm.frame = reduced.frame;
  warm.scale = reduced.scale;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& fit : fits) {
    lowest = fit ? std::min(lowest, fit->chi2) : lowest;
  }
  warm.polynomials.every_seed = !fits_well(lowest, residual_count(reduced));
  if (!warm.polynomials.every_seed) {  // where nothing fits, nothing is out for that
    warm.polynomials.lowest_chi2 = lowest;
  }
  const auto take = [&](CurveClass curve_class) -> std::optional<PolynomialFit> {
    const auto& fit = fits[curve_class];
    return fit && !fit->at_limit ? fit->polynomial : std::nullopt;
  };
  warm.polynomials.parabola = take(CurveClass::Parabola);
  warm.polynomials.cubical_parabola = take(CurveClass::CubicalParabola);
  warm.polynomials.semi_cubical_parabola = take(CurveClass::SemiCubicalParabola);
  warm.polynomials.cubic_spline = take(CurveClass::CubicSpline);
  if (const auto& spline = fits[CurveClass::CubicSpline]) {
    warm.polynomials.rival = spline->rival;
  }
  if (const auto& cusp = fits[CurveClass::SemiCubicalParabola]) {
    warm.polynomials.other_cusp = cusp->rival;
  }
  return warm;
}

PolynomialFits carried_to(const WarmStart& warm, const FitData& reduced) {
  PolynomialFits starts;
  starts.every_seed = warm.polynomials.every_seed;
  starts.lowest_chi2 = warm.polynomials.lowest_chi2;
  starts.parabola = carried(warm.polynomials.parabola, warm, reduced);
  starts.cubical_parabola = carried(warm.polynomials.cubical_parabola, warm, reduced);
  starts.semi_cubical_parabola = carried(warm.polynomials.semi_cubical_parabola, warm, reduced);
  starts.cubic_spline = carried(warm.polynomials.cubic_spline, warm, reduced);
  starts.rival = carried(warm.polynomials.rival, warm, reduced);
  starts.other_cusp = carried(warm.polynomials.other_cusp, warm, reduced);
  return starts;
}

}  // namespace palpate

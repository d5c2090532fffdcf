#include "core/recognition/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// See probabilities().
void divide_conic(const ClassFits& fits, const EvidenceScale& scale,
                  std::array<double, 9>* criterion) {
  const auto& ellipse = fits[static_cast<std::size_t>(CurveClass::Ellipse)];
  const auto& hyperbola = fits[static_cast<std::size_t>(CurveClass::Hyperbola)];
  if (!ellipse || !hyperbola || ellipse->at_limit == hyperbola->at_limit) {
    return;
  }
  const ClassFit& inside = ellipse->at_limit ? *hyperbola : *ellipse;
  const ClassFit& beyond = ellipse->at_limit ? *ellipse : *hyperbola;
  const double distance =
      std::sqrt(std::max(0.0, misfit(beyond.chi2, scale) - misfit(inside.chi2, scale)));
  // Phi(-z) without losing small tails, and its complement.
  const double share_beyond = 0.5 * std::erfc(distance / std::sqrt(2.0));
  double& conic = (*criterion)[static_cast<std::size_t>(inside.curve_class)];
  (*criterion)[static_cast<std::size_t>(beyond.curve_class)] =
      conic - 2.0 * std::log(std::max(share_beyond, std::numeric_limits<double>::min()));
  conic -= 2.0 * std::log1p(-share_beyond);
}

/// Whether the points lie on one arm of the curve, far from its vertex beside their extent along
/// the axis: t^2 is the distance from the vertex along it.
bool is_far_from_vertex(const PolynomialFit& semi_cubical) {
  constexpr double kFarthest = 25.0;  // extents of the points
  const auto [low, high] = std::minmax_element(semi_cubical.t.begin(), semi_cubical.t.end());
  if (low == semi_cubical.t.end() || *low * *high <= 0.0) {
    return false;
  }
  const double nearest = std::min(*low * *low, *high * *high);
  const double extent = std::abs(*high * *high - *low * *low);
  return nearest > kFarthest * extent;
}

/// See probabilities().
void count_once(const ClassFits& fits, const EvidenceScale& scale,
                std::array<double, 9>* criterion) {
  constexpr double kSame = 1.0;  // of chi-square: odds are right to a factor of 1.6
  const auto& cubical = fits[static_cast<std::size_t>(CurveClass::CubicalParabola)];
  const auto& semi_cubical = fits[static_cast<std::size_t>(CurveClass::SemiCubicalParabola)];
  if (cubical && semi_cubical && semi_cubical->polynomial &&
      misfit(cubical->chi2, scale) <= misfit(semi_cubical->chi2, scale) + kSame &&
      is_far_from_vertex(*semi_cubical->polynomial)) {
    (*criterion)[static_cast<std::size_t>(CurveClass::SemiCubicalParabola)] =
        std::numeric_limits<double>::infinity();
  }
}

}  // namespace

double without_form_error(double chi2, const EvidenceScale& scale) {
  return scale.coherent_variance > 0.0
             ? scale.noise_chi2 + (chi2 - scale.noise_chi2) / (1.0 + scale.coherent_variance)
             : chi2;
}

double misfit(double chi2, const EvidenceScale& scale) {
  chi2 = without_form_error(chi2, scale);
  if (scale.sigma_known) {
    return chi2 / scale.tempering;
  }
  return scale.samples *
         std::log(std::max(chi2 + scale.chi2_floor, std::numeric_limits<double>::min()));
}

double information_criterion(double chi2, double parameters, const EvidenceScale& scale) {
  return misfit(chi2, scale) +
         scale.parsimony * parameters * std::log(std::max(scale.samples, 1.0));
}

ClassProbabilities probabilities(const ClassFits& fits, double smooth_chi2, int smooth_parameters,
                                 const EvidenceScale& scale) {
  std::array<double, 9> criterion;
  criterion.fill(std::numeric_limits<double>::infinity());
  criterion[0] = information_criterion(smooth_chi2, smooth_parameters, scale);
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (fits[i]) {
      criterion[i] = information_criterion(fits[i]->chi2, degrees_of_freedom(curve_class), scale);
    }
  }
  divide_conic(fits, scale, &criterion);
  count_once(fits, scale, &criterion);
  const double best = *std::min_element(criterion.begin(), criterion.end());
  ClassProbabilities result{};
  double sum = 0.0;
  for (std::size_t i = 0; i < criterion.size(); ++i) {
    result[i] = std::exp(-0.5 * (criterion[i] - best));
    sum += result[i];
  }
  for (double& p : result) {
    p /= sum;
  }
  return result;
}

}  // namespace palpate

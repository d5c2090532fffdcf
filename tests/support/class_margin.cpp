#include "tests/support/class_margin.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::test {
namespace {

/// Without noise, a quarter of the samples contains the same information.
constexpr std::size_t kStep = 4;

std::vector<Vec2> thinned(const PriorScene& prior_scene) {
  std::vector<Vec2> points;
  for (const auto& patch : prior_scene.exact_patches) {
    for (std::size_t i = 0; i < patch.size(); i += kStep) {
      points.push_back(patch[i]);
    }
  }
  return points;
}

double samples_per_thinned(const PriorScene& prior_scene) {
  std::size_t all = 0;
  for (const auto& patch : prior_scene.exact_patches) {
    all += patch.size();
  }
  return static_cast<double>(all) / static_cast<double>(thinned(prior_scene).size());
}

double half_extent(const PriorScene& prior_scene) {
  Vec2 low = prior_scene.exact_patches.front().front();
  Vec2 high = low;
  for (const auto& patch : prior_scene.exact_patches) {
    for (const Vec2& point : patch) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  return 0.5 * (high - low).norm();
}

/// The square root of det(I + F). `departures`: normal displacements for one prior width of each
/// departure; the part that shape and pose of the truth (the columns of `taken`) can absorb is
/// removed.
double root_of_information(const Eigen::MatrixXd& taken, const Eigen::MatrixXd& departures,
                           double weight) {
  const Eigen::MatrixXd left = departures - taken * taken.colPivHouseholderQr().solve(departures);
  const Eigen::MatrixXd information = weight * left.transpose() * left;
  return std::sqrt((Eigen::MatrixXd::Identity(information.rows(), information.cols()) + information)
                       .determinant());
}

/// Against a spline with the same a and b and c = +-step; pose, a and b are free. Chi-square is (c
/// / r)^4 with r the c that the data resolve. Returns the mass of the prior over that of the
/// likelihood.
double against_spline(const PriorScene& prior_scene, double extent) {
  constexpr double kStepOfC = 0.1;   // sqrt(extent)
  constexpr double kWidthOfC = 1.5;  // sqrt(extent)
  const Scene& scene = prior_scene.scene;
  const std::vector<Vec2> points = thinned(prior_scene);
  const double weight = samples_per_thinned(prior_scene) / (scene.sigma_m * scene.sigma_m);
  double lowest = std::numeric_limits<double>::infinity();
  for (const double sign : {-1.0, 1.0}) {
    PlacedShape spline{CurveClass::CubicSpline,
                       {scene.values[0], scene.values[1], sign * kStepOfC * std::sqrt(extent)},
                       scene.world_T_curve};
    lowest = std::min(lowest, weight * refine_geometrically(points, &spline, 2));
  }
  const double resolved = kStepOfC / std::pow(lowest, 0.25);
  // The ratio of the integrals of exp(-(c / width)^2 / 2) and exp(-(c / resolved)^4 / 2).
  const double integral = 2.0 * std::pow(2.0, 0.25) * std::tgamma(1.25) * resolved;
  return std::max(1.0, kWidthOfC * std::sqrt(2.0 * kPi) / integral);
}

}  // namespace

double needed_chi2(int extra) {
  const double evidence =
      2.0 * std::log(kDeterminedOdds) + 2.0 * std::max(extra, 0) * std::log(kOccamFactor);
  const double root = std::sqrt(evidence) + kNoiseDeviations;
  return root * root;
}

double occam_against_richer(const PriorScene& prior_scene) {
  const Scene& scene = prior_scene.scene;
  const CurveClass truth = scene.curve_class;
  const auto curve = make_curve(truth, scene.values);
  if (!curve || truth == CurveClass::Ellipse || truth == CurveClass::Hyperbola ||
      truth == CurveClass::CubicSpline) {
    return std::numeric_limits<double>::infinity();
  }
  const double extent = half_extent(prior_scene);
  if (truth == CurveClass::SemiCubicalParabola) {
    return against_spline(prior_scene, extent);
  }
  std::vector<double> places;
  for (const auto& patch : scene.t) {
    for (std::size_t i = 0; i < patch.size(); i += kStep) {
      places.push_back(patch[i]);
    }
  }
  const auto [first, last] = std::minmax_element(places.begin(), places.end());
  const double middle = 0.5 * (*first + *last);
  const double reach = 0.5 * (*last - *first);
  const auto letters = static_cast<Eigen::Index>(parameter_letters(truth).size());
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd taken(n, letters + 3);
  Eigen::MatrixXd departures = Eigen::MatrixXd::Zero(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = places[static_cast<std::size_t>(i)];
    const double u = (t - middle) / reach;
    const CurveDerivatives d = derivatives(*curve, t);
    const Vec2 normal = left_of(d.first).normalized();
    taken.row(i).head(letters) =
        (normal.transpose() * position_by_parameters(*curve, t)).head(letters);
    taken(i, letters) = normal.x();
    taken(i, letters + 1) = normal.y();
    taken(i, letters + 2) = normal.dot(left_of(d.position));
    switch (truth) {
      case CurveClass::Line:
        departures(i, 0) = 0.5 * (t - middle) * (t - middle) / extent;
        break;
      case CurveClass::Circle:
        // b = a (1 - e): the radius is a (1 - e / 2 + e / 2 cos 2t); the prior width of e is 1/2.
        departures(i, 0) = 0.25 * scene.values[0] * std::cos(2.0 * t);
        departures(i, 1) = 0.25 * scene.values[0] * std::sin(2.0 * t);
        break;
      case CurveClass::Parabola:
        // y^2 = 4 a x + m x^2: m moves the curve by x^2 / |gradient|.
        departures(i, 0) = d.position.x() * d.position.x() /
                           std::hypot(4.0 * scene.values[0], 2.0 * d.position.y());
        departures(i, 1) = extent * u * u * u * normal.y();
        break;
      default:
        departures(i, 0) = extent * u * u * normal.x();
        break;
    }
  }
  // Scale the columns to similar size; otherwise the factorisation may drop one because of its
  // unit.
  for (Eigen::Index k = 0; k < taken.cols(); ++k) {
    const double size = taken.col(k).norm();
    taken.col(k) /= size > 0.0 ? size : 1.0;
  }
  const double weight = samples_per_thinned(prior_scene) / (scene.sigma_m * scene.sigma_m);
  if (truth == CurveClass::Circle) {
    return root_of_information(taken, departures, weight);
  }
  double least = root_of_information(taken, departures.col(0), weight);
  if (truth == CurveClass::Parabola) {
    least = std::min(least, root_of_information(taken, departures.col(1), weight));
  }
  return least;
}

double least_chi2(const PriorScene& prior_scene, std::span<const PlacedShape> starts) {
  const std::vector<Vec2> points = thinned(prior_scene);
  const double sigma = prior_scene.scene.sigma_m;
  const double weight = samples_per_thinned(prior_scene) / (sigma * sigma);
  double least = std::numeric_limits<double>::infinity();
  for (PlacedShape start : starts) {
    least = std::min(least, weight * refine_geometrically(points, &start));
  }
  return least;
}

bool has_as_limit(CurveClass rival, CurveClass truth) {
  switch (truth) {
    case CurveClass::Line:
      return rival != CurveClass::Line;
    case CurveClass::Circle:
      return rival == CurveClass::Ellipse;
    case CurveClass::Parabola:
      return rival != CurveClass::Parabola && rival != CurveClass::Line &&
             rival != CurveClass::Circle;
    case CurveClass::CubicalParabola:
    case CurveClass::SemiCubicalParabola:
      return rival == CurveClass::CubicSpline;
    default:
      return false;
  }
}

}  // namespace palpate::test

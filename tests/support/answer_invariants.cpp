#include "tests/support/answer_invariants.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace palpate::test {
namespace {

/// Relative to the square root of the product of two variances.
constexpr double kCovarianceRounding = 1e-9;
/// Doubles lose digits near variances below this.
constexpr double kLeastVariance = 1e-280;

std::string broken_covariance(const ShapePoseCovariance& covariance) {
  std::vector<Eigen::Index> finite;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double variance = covariance(i, i);
    if (std::isnan(variance) || variance < 0.0) {
      return "a variance is negative or NaN";
    }
    if (std::isfinite(variance) && variance > kLeastVariance) {
      finite.push_back(i);
    }
  }
  const auto n = static_cast<Eigen::Index>(finite.size());
  Eigen::MatrixXd correlation(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index row = finite[static_cast<std::size_t>(i)];
      const Eigen::Index column = finite[static_cast<std::size_t>(j)];
      correlation(i, j) = covariance(row, column) / std::sqrt(covariance(row, row)) /
                          std::sqrt(covariance(column, column));
    }
  }
  if (!correlation.allFinite()) {
    return "a covariance is not finite between finite variances";
  }
  if (n > 0 &&
      (correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kCovarianceRounding) {
    return "a covariance is not symmetric";
  }
  if (n > 0 &&
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues().minCoeff() <
          -kCovarianceRounding) {
    return "a covariance is not positive semidefinite";
  }
  return {};
}

bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
}

}  // namespace

std::size_t fewest_places(CurveClass curve_class) {
  constexpr int kOfSpline = 6;
  constexpr int kOfNone = 8;
  return static_cast<std::size_t>(curve_class == CurveClass::Unclassified
                                      ? kOfNone
                                      : std::max(kOfSpline, degrees_of_freedom(curve_class) + 2));
}

TouchedPlaces places_of(std::span<const Vec2> positions) {
  std::set<std::pair<double, double>> distinct;
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const Vec2& p : positions) {
    distinct.emplace(p.x() + 0.0, p.y() + 0.0);  // -0 becomes 0
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr double kUnits = 8.0;  // in units of the last place of the largest coordinate
  TouchedPlaces places;
  places.distinct = distinct.size();
  if (!positions.empty()) {
    const double extent = (0.5 * high - 0.5 * low).maxCoeff();
    const double largest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
    places.at_rounding = extent <= kUnits * std::numeric_limits<double>::epsilon() * largest;
  }
  return places;
}

std::string broken_invariant(const Recognition& answer, const TouchedPlaces& places) {
  constexpr double kSumRounding = 1e-9;
  double sum = 0.0;
  for (const Hypothesis& hypothesis : answer.hypotheses) {
    if (!(hypothesis.probability >= 0.0 && hypothesis.probability <= 1.0 + kSumRounding)) {
      return "a probability is not in [0, 1]";
    }
    sum += hypothesis.probability;
    if (!hypothesis.shape.values.allFinite() || !is_finite(hypothesis.world_T_curve)) {
      return "a shape or pose is not finite";
    }
    if (std::isnan(hypothesis.chi2)) {
      return "a chi-square is NaN";
    }
    const std::string broken = broken_covariance(hypothesis.covariance);
    if (!broken.empty()) {
      return broken;
    }
  }
  if (!answer.hypotheses.empty() && !(std::abs(sum - 1.0) <= kSumRounding)) {
    return "the probabilities do not sum to 1";
  }
  if (!std::isfinite(answer.sigma_m) || answer.sigma_m < 0.0 ||
      std::isnan(answer.noise_correlation_m)) {
    return "the noise is not finite";
  }
  for (const LocalizedContact& contact : answer.contacts) {
    if (!std::isfinite(contact.t) || !contact.estimate.position.allFinite() ||
        !std::isfinite(contact.estimate.tangent_angle) || std::isnan(contact.estimate.kappa) ||
        std::isnan(contact.estimate.kappa_s)) {
      return "a contact is not finite";
    }
  }
  const std::string broken = broken_covariance(answer.covariance);
  if (!broken.empty()) {
    return broken;
  }
  if (answer.work.spent() > answer.work.most()) {
    return "more work than an answer may take";
  }
  if (answer.work.was_cut() && answer.status != RecognitionStatus::Collecting &&
      (answer.status != RecognitionStatus::Ambiguous || answer.doubt != Doubt::WorkLimit)) {
    return "the work was cut, and the answer does not say so";
  }
  if (answer.status != RecognitionStatus::Recognized) {
    return {};
  }
  if (answer.hypotheses.empty() || !answer.shape.values.allFinite() ||
      !is_finite(answer.world_T_curve)) {
    return "RECOGNIZED without a finite shape";
  }
  if (places.distinct < fewest_places(answer.shape.curve_class)) {
    return "RECOGNIZED from fewer distinct places than its class asks for";
  }
  if (places.at_rounding) {
    return "RECOGNIZED where the extent is at rounding";
  }
  return {};
}

}  // namespace palpate::test

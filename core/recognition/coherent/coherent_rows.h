// The residuals of a class as a linear model with deviations that neighbours share.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/coherent/markov_drift.h"
#include "core/recognition/coherent/offset_harmonics.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/modes/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Up to this order lobes look like the difference of two classes, which bends twice around like a
/// conic's own lobes, or as a cubic does.
inline constexpr int kHighestOfClasses = 4;

/// A row holds: derivatives by shape and pose, the residual, derivatives by the offset's
/// coefficients. Lower orders are a prefix of the row.
inline constexpr int kUnknowns = 6;
inline constexpr int kResidualColumn = kUnknowns;
constexpr int columns_to(int highest) { return kUnknowns + 1 + offset_coefficients(highest); }
using CoherentRow = Eigen::Matrix<double, columns_to(kHighestOrder), 1>;

struct CoherentStep {
  DriftStep at;
  CoherentRow row = CoherentRow::Zero();
};

/// One step for each reduced point, in the order of drift_steps(), in units of the typical noise.
/// Derivatives are by [shape; x; y; theta] in metres and radians, world frame. `curve`: that of
/// `placed`.
std::vector<CoherentStep> coherent_steps(const CanonicalFit& placed, const FitData& reduced,
                                         const Curve& curve, double sigma);

/// The same with derivatives by the coordinates of `evidence`, in units of the prior's widths, and
/// with stated form error counted as noise. nullopt if `placed` is no curve.
std::optional<std::vector<CoherentStep>> steps_by_coordinates(const CanonicalFit& placed,
                                                              const ClassEvidence& evidence,
                                                              const FitData& reduced,
                                                              const Likelihood& likelihood,
                                                              double sigma);

/// Path length of the longest run, normalised.
double longest_run(const std::vector<CoherentStep>& steps);

/// Sums of products of the rows up to an order, after Kalman's recursion has made the drift white.
template <int Highest>
struct WhiteRows {
  using Sums = Eigen::Matrix<double, columns_to(Highest), columns_to(Highest)>;
  Sums sums = Sums::Zero();
  double log_determinant = 0.0;  ///< of their covariance, relative to noise alone
};

/// `Highest`: kHighestOrder or kHighestOfClasses.
template <int Highest>
WhiteRows<Highest> white_rows(const std::vector<CoherentStep>& steps, const Drift& drift);

}  // namespace palpate

// The residuals of a class as a linear model of deviations that neighbours share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/coherent/markov_drift.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Orders of the offset by direction are 0, the constant, and 2 to a highest one. (The first is a
/// shift.) The lobes of probes run to this order,
inline constexpr int kHighestOrder = 8;
/// and to this one they look like the difference of two classes: it bends as a conic's own lobes
/// do, twice around, or a cubic's.
inline constexpr int kHighestOfClasses = 4;

/// Coefficients up to an order.
constexpr int offsets_to(int highest) { return 2 * highest - 1; }

/// A row has derivatives by shape and pose, the residual, derivatives by the offset's coefficients:
/// lower orders are its head.
inline constexpr int kUnknowns = 6;
inline constexpr int kResidualColumn = kUnknowns;
constexpr int columns_to(int highest) { return kUnknowns + 1 + offsets_to(highest); }
using CoherentRow = Eigen::Matrix<double, columns_to(kHighestOrder), 1>;

/// Coefficients of one order have this index and, but for the constant, the next.
constexpr int first_offset_of(int order) { return order == 0 ? 0 : 2 * order - 3; }

struct CoherentStep {
  DriftStep at;
  CoherentRow row = CoherentRow::Zero();
};

/// Of each reduced point in the order of drift_steps(), in units of the typical noise; by [shape;
/// x; y; theta] in metres and radians, world frame. `curve`: that of `placed`.
std::vector<CoherentStep> coherent_steps(const CanonicalFit& placed, const FitData& reduced,
                                         const Curve& curve, double sigma);

/// The way along the longest run, normalised.
double longest_run(const std::vector<CoherentStep>& steps);

/// The rows' products, up to an order, once a drift is made white by Kalman's recursion.
template <int Highest>
struct WhiteRows {
  using Sums = Eigen::Matrix<double, columns_to(Highest), columns_to(Highest)>;
  Sums sums = Sums::Zero();
  double log_determinant = 0.0;  ///< of their covariance over that of the noise alone
};

/// `Highest`: kHighestOrder or kHighestOfClasses.
template <int Highest>
WhiteRows<Highest> white_rows(const std::vector<CoherentStep>& steps, const Drift& drift);

}  // namespace palpate

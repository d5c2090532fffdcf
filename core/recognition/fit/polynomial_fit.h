// Least orthogonal distances of a polynomial parametric curve: parabola, the cubics and the line.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/polynomial_problem.h"
#include "core/recognition/fit/refine_effort.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct PolynomialFit {
  /// In the normalised frame; columns of powers that the model lacks are 0.
  PolynomialCoefficients coefficients = PolynomialCoefficients::Zero();
  std::vector<double> t;  ///< curve parameter of every point's foot point
  double chi2 = 0.0;
  int iterations = 0;
  int side = 0;  ///< where tip centres lie: +1 left of increasing t, -1 right
};

/// Refines coefficients and foot points together: the foot points are eliminated (each evaluation
/// follows them from where they were), the Jacobian is that of the envelope theorem. Affine changes
/// of t leave the curve as it is; the damping takes care of them. `start.t` must hold a parameter
/// near each point's foot point. O(points) per iteration.
PolynomialFit refine_polynomial(PolynomialModel model, std::span<const FitPoint> points,
                                const PolynomialFit& start, int side, const RefineEffort& effort,
                                WorkBudget& work);

/// Whether two fits to the same points ended in the same optimum: chi-squares alike and directions
/// of the cubic axis alike, as far as the optimiser's tolerance goes.
bool is_same_curve(const PolynomialFit& a, const PolynomialFit& b);

/// A point against the fit, its foot point followed from `t` until a step is shorter than
/// `last_step`.
PlacedPoint place_on(const PolynomialFit& fit, double t, const Vec2& point,
                     double last_step = kExactFootStep);

/// The fit as it is, with the foot points and the chi-square of surface points: `fit.t` near them.
PolynomialFit placed_on(std::span<const FitPoint> points, PolynomialFit fit);

}  // namespace palpate

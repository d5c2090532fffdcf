// Fits of polynomial parametric curves (parabola and the cubics) by least orthogonal distances.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/orthogonal/polynomial_problem.h"
#include "core/recognition/fit/orthogonal/refine_effort.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct PolynomialFit {
  /// In the normalised frame; columns of powers that the model lacks are 0.
  PolynomialCoefficients coefficients = PolynomialCoefficients::Zero();
  std::vector<double> t;  ///< curve parameter of every point's foot point
  double chi2 = 0.0;
  int side = 0;  ///< where tip centres lie: +1 left of increasing t, -1 right
};

/// The side of points that bear no tip radius: reduced points lie on the surface.
inline constexpr int kSurfacePoints = 0;

/// Refines the coefficients, with the foot points eliminated: each evaluation follows them from
/// where they were, and the Jacobian is that of the envelope theorem. Affine changes of t do not
/// change the curve; the damping handles these free directions. `start.t` must hold a parameter
/// near each point's foot point. O(points) per iteration.
PolynomialFit refine_polynomial(PolynomialModel model, std::span<const FitPoint> points,
                                const PolynomialFit& start, int side, const RefineEffort& effort,
                                WorkBudget& work);

/// Takes a fit for the best of a class if it is.
void keep_better(std::optional<PolynomialFit>* best, PolynomialFit fit);

/// True if two fits to the same points ended in the same optimum: chi-square and the direction of
/// the cubic axis agree within the optimiser's tolerance.
bool is_same_curve(const PolynomialFit& a, const PolynomialFit& b);

/// The foot point and distance of a point, followed from `t` until a step is shorter than
/// `last_step`.
PlacedPoint place_on(const PolynomialFit& fit, double t, const FitPoint& point,
                     double last_step = kExactFootStep);

/// The unchanged fit with the foot points and chi-square of surface points. `fit.t` must be near
/// the feet.
PolynomialFit placed_on(std::span<const FitPoint> points, PolynomialFit fit);

}  // namespace palpate

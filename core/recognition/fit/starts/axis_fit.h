// The polynomial classes along a trial axis: linear in all but one or two unknowns.
#pragma once

#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Cosine of the angle between travel and axis: converts a residual across the axis into a
/// distance. It has a lower bound, so that no point loses all weight.
double verticality(const FitPoint& point, const Vec2& axis);

/// Graph models (parabola, cubical parabola): y is a polynomial in x, in the frame turned by theta;
/// `arms` is empty. Arm models (semi-cubical parabola, spline): y is a polynomial in t = arm *
/// sqrt(x - x0).
struct AxisFit {
  PolynomialModel model = PolynomialModel::Parabola;
  double theta = 0.0;        ///< direction of the x axis [rad]
  double x0 = 0.0;           ///< abscissa of the vertex (arm models)
  std::vector<double> arms;  ///< sign of t of every point (arm models)
  double chi2 = 0.0;
};

/// Minimises over theta (and x0). Linear least squares eliminates the coefficients of y at every
/// step (variable projection: G. Golub and V. Pereyra, 1973), so that the long valleys of short
/// arcs have one or two dimensions only. O(points) per iteration.
AxisFit refine_axis(std::span<const FitPoint> points, AxisFit start, int max_iterations,
                    WorkBudget& work);

/// Iterations of a walk in a valley. It need only tell which is the deepest: refine_polynomial goes
/// on from there.
inline constexpr int kMostWalked = 15;

/// Assigns to every point of each patch the arm that suits the fit. It tries one arm for the whole
/// patch and a change of arm at each point. Returns whether any arm changed. Arm models only.
bool reassign_arms(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                   AxisFit* fit);

/// The spline's other optimum. Near c = 0 a spline's shape depends on c^2. Because a (x + 2c /
/// 3a)^(3/2) = a x^(3/2) + c x^(1/2) + O(c^2), the splines with c at vertex x0 and -c at x0 - 4c /
/// 3a agree to first order, one with a loop and one without. The vertex of the result stays before
/// the points.
AxisFit twin_of(const AxisFit& spline, std::span<const FitPoint> points);

/// The semi-cubical parabola that agrees with a spline to first order in c: vertex at x0 - 2c / 3a.
AxisFit semi_cubical_near(const AxisFit& spline, std::span<const FitPoint> points);

/// The same curve as a parametric polynomial, with the parameters of the points.
PolynomialFit to_polynomial(const AxisFit& fit, std::span<const FitPoint> points);

/// Shifts (if the model allows it) and scales t so that the points lie in [-1, 1].
void normalise_parameter(PolynomialModel model, PolynomialFit* fit);

}  // namespace palpate

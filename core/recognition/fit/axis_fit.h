// The polynomial classes seen along a trial axis: linear in all but one or two numbers.
#pragma once

#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Cosine between travel and axis: turns a residual across the axis into a distance. Bounded below
/// so that no point drops out altogether.
double verticality(const FitPoint& point, const Vec2& axis);

/// Parabola and cubical parabola: y a polynomial in x in the frame turned by theta (`arms` empty).
/// Semi-cubical parabola and spline: y a polynomial in t = arm * sqrt(x - x0).
struct AxisFit {
  PolynomialModel model = PolynomialModel::Parabola;
  double theta = 0.0;        ///< direction of the x axis [rad]
  double x0 = 0.0;           ///< abscissa of the vertex (arm models)
  std::vector<double> arms;  ///< sign of t of every point (arm models)
  double chi2 = 0.0;
};

/// Minimises over theta (and x0), the coefficients of y eliminated by linear least squares at every
/// step (variable projection: G. Golub and V. Pereyra, 1973), so that the long valleys of short
/// arcs are walked in one or two dimensions. O(points) per iteration.
AxisFit refine_axis(std::span<const FitPoint> points, AxisFit start, int max_iterations,
                    WorkBudget& work);

/// Gives every point of each patch the arm that suits the fit: both all-one-arm and a change of arm
/// at some point are tried. Returns whether any arm changed. Arm models only.
bool reassign_arms(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                   AxisFit* fit);

/// The spline's other optimum. Near c = 0 a spline's shape depends on c^2: by
/// a (x + 2c / 3a)^(3/2) = a x^(3/2) + c x^(1/2) + O(c^2) the splines with c at vertex x0 and -c at
/// x0 - 4c / 3a agree to first order, one with a loop and one without. The
/// twin's vertex stays before the points.
AxisFit twin_of(const AxisFit& spline, std::span<const FitPoint> points);

/// The semi-cubical parabola that agrees with a spline to first order in c: vertex at x0 - 2c / 3a.
AxisFit semi_cubical_near(const AxisFit& spline, std::span<const FitPoint> points);

/// The same curve as a polynomial parametric curve, with the parameters of the points.
PolynomialFit to_polynomial(const AxisFit& fit, std::span<const FitPoint> points);

/// Shifts (where the model allows it) and scales t so that the points lie in [-1, 1].
void normalise_parameter(PolynomialModel model, PolynomialFit* fit);

}  // namespace palpate

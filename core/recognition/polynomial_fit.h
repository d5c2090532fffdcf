// Least orthogonal distances of a polynomial parametric curve: parabola, the cubics and the line.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/recognition/fit_data.h"
#include "core/recognition/refine_effort.h"

namespace palpate {

/// Which powers of t a model has. Up to SE(2) and an affine change of t these are exactly the
/// canonical classes (core/README.md, "Refinement and the bound"): no class has a singular limit
/// in these coefficients.
enum class PolynomialModel {
  Parabola,             ///< 1, t, t^2
  CubicalParabola,      ///< 1, t, t^3
  SemiCubicalParabola,  ///< 1, t^2, t^3
  CubicSpline,          ///< 1, t, t^2, t^3
};

/// Column k holds the coefficients of t^k; columns of powers that the model lacks are 0.
using PolynomialCoefficients = Eigen::Matrix<double, 2, 4>;

struct PolynomialFit {
  PolynomialCoefficients coefficients = PolynomialCoefficients::Zero();  ///< normalised frame
  std::vector<double> t;  ///< curve parameter of every point's foot point
  double chi2 = 0.0;
  int iterations = 0;
  int side = 0;  ///< where tip centres lie: +1 left of increasing t, -1 right
};

/// Refines coefficients and foot points together: the foot points are eliminated (each evaluation
/// follows them by Newton's method from where they were), the Jacobian is that of the envelope
/// theorem. Affine changes of t leave the curve as it is; the damping takes care of them.
/// `start.t` must hold a parameter near each point's foot point. O(points) per iteration.
PolynomialFit refine_polynomial(PolynomialModel model, std::span<const FitPoint> points,
                                PolynomialFit start, int side, const RefineEffort& effort = {});

/// Eigenvalues, ascending, of the Fisher information of the model's coefficients; those of affine
/// changes of t are 0.
Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> polynomial_information(
    PolynomialModel model, std::span<const FitPoint> points, const PolynomialFit& fit);

/// A point against the curve at its foot point parameter.
struct PlacedPoint {
  double t = 0.0;                ///< followed from the given one to the foot point
  double signed_distance = 0.0;  ///< positive to the left of increasing t
  Vec2 normal = Vec2::Zero();    ///< unit, along the distance: left of increasing t but at a cusp
};

/// Whether two fits to the same points ended in the same optimum: chi-squares alike and directions of
/// the cubic axis alike, as far as the optimiser's tolerance goes.
bool is_same_curve(const PolynomialFit& a, const PolynomialFit& b);

PlacedPoint place_on(const PolynomialFit& fit, double t, const Vec2& point);

}  // namespace palpate

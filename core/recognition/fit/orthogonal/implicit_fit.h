// Fits of implicit curves (conic, circle, line) by least orthogonal distances.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/fit/orthogonal/refine_effort.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct ImplicitFit {
  ConicCoefficients coefficients = ConicCoefficients::Zero();  ///< unit norm, normalised frame
  double chi2 = 0.0;
  int side = 0;  ///< where tip centres lie: +1 where the polynomial is positive, -1 negative
  std::vector<Vec2> feet;  ///< foot point of every point
};

/// Refines over all conics (5 degrees of freedom), all circles and lines (3), or all lines (2). The
/// coefficients move on the unit sphere of the model's subspace, so that the passage from ellipse
/// through parabola to hyperbola, or from circle to line, is smooth. `near`: places on the
/// branch that the tips have touched, one for each point; empty: the nearest branch. A tip that is
/// larger than a hyperbola's a may have its centre nearer to the other one.
ImplicitFit refine_conic(std::span<const FitPoint> points, const ConicCoefficients& start, int side,
                         const RefineEffort& effort, WorkBudget& work,
                         std::span<const Vec2> near = {});
ImplicitFit refine_circle(std::span<const FitPoint> points, const ConicCoefficients& start,
                          int side, const RefineEffort& effort, WorkBudget& work,
                          std::span<const Vec2> near = {});
ImplicitFit refine_line(std::span<const FitPoint> points, const ConicCoefficients& start, int side,
                        const RefineEffort& effort, WorkBudget& work,
                        std::span<const Vec2> near = {});

/// The unchanged fit with the foot points and chi-square of these surface points.
ImplicitFit placed_on(std::span<const FitPoint> points, ImplicitFit fit);

/// Signed distance of a point to a nearby conic, positive where the polynomial is. `foot` receives
/// the foot point, found by Newton's method from the point itself. It is the nearest one if the
/// distance is small compared with the radius of curvature.
double signed_distance(const ConicCoefficients& coefficients, const Vec2& point, Vec2* foot);

/// The same of a tip's centre, which may be far from the conic: with the foot that is reached from
/// `near`, that of a neighbour. It is on the same branch of a hyperbola. Where the tip is about as
/// large as the curve's radius, it takes several times the steps of a point near the curve: `work`
/// counts them.
double signed_distance_of_tip(const Vec2& near, const ConicCoefficients& coefficients,
                              const Vec2& point, Vec2* foot, WorkBudget& work);

/// The same for a known foot point.
double signed_distance_from(const Vec2& foot, const ConicCoefficients& coefficients,
                            const Vec2& point);

/// Weight of a point's measured normal for this conic; 0 if its foot cannot be followed.
double weight_of_normal(const ConicCoefficients& coefficients, const Vec2& foot,
                        const FitPoint& point);

/// What a point's measured normal, of that weight, leaves at its foot.
double normal_residual(const ConicCoefficients& coefficients, const Vec2& foot,
                       const FitPoint& point);

/// A conic's polynomial is the product of its coefficients and these: x^2, x y, y^2, x, y, 1.
using Monomials = Eigen::Matrix<double, 6, 1>;
inline Monomials monomials(const Vec2& p) {
  return {p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1.0};
}

/// The gradient of the conic's polynomial.
inline Vec2 conic_gradient(const ConicCoefficients& q, const Vec2& p) {
  return {2.0 * q[0] * p.x() + q[1] * p.y() + q[3], q[1] * p.x() + 2.0 * q[2] * p.y() + q[4]};
}

}  // namespace palpate

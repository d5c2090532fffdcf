#include "core/recognition/given/starts/given_starts.h"

#include <limits>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/curves/algebraic/canonical_cubic.h"
#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/matrices/small_ldlt.h"
#include "core/numerics/matrices/symmetric_eigen.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/orthogonal/implicit_fit.h"
#include "core/recognition/fit/orthogonal/refine_effort.h"
#include "core/recognition/fit/polynomial_search.h"
#include "core/recognition/fit/starts/algebraic_fit.h"
#include "core/recognition/fit/starts/few_points.h"
#include "core/recognition/given/starts/thinned.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {
namespace {

enum class Order {
  None,     ///< every point is a patch of its own
  AsGiven,  ///< all points are one patch
};

FitData seed_data(std::span<const Vec2> points, Order order) {
  std::vector<StoredPatch> patches;
  for (const Vec2& point : thinned(points, kMostSearchedPoints)) {
    if (order == Order::None || patches.empty()) {
      patches.emplace_back();
    }
    patches.back().samples.push_back({point, 0.0, 1.0});
  }
  return make_fit_data(patches, 0.0);
}

/// Converts a curve from the frame of `data` to the frame of the points.
GivenStart in_points_frame(const ShapeParameters& shape, const Pose2& pose, const FitData& data) {
  return {shape, data.frame * pose};
}

/// Conics of least algebraic distance among the ellipses, or among the hyperbolas: generalised
/// eigenvectors of the scatter matrix with the discriminant as the constraint. (Ellipses: A.
/// Fitzgibbon, M. Pilu and R. Fisher, 1999, in the reduced form of R. Halir and J. Flusser, 1998.
/// Hyperbolas: P. O'Leary and P. Zsombor-Murray, 2004.)
std::vector<ConicCoefficients> conics_of_class(CurveClass curve_class,
                                               std::span<const FitPoint> points) {
  Eigen::Matrix3d quadratic = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  for (const FitPoint& point : points) {
    const Vec2& p = point.position;
    const Eigen::Vector3d q(p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
    const Eigen::Vector3d l(p.x(), p.y(), 1.0);
    quadratic += q * q.transpose();
    mixed += q * l.transpose();
    linear += l * l.transpose();
  }
  const Eigen::Matrix3d to_linear = -SmallLdlt<3>(linear).inverse() * mixed.transpose();
  const Eigen::Matrix3d scatter = quadratic + mixed * to_linear;
  // Solves scatter v = lambda discriminant v with the scatter as the factored matrix: it is
  // positive definite unless the points lie exactly on a conic. The ridge covers that case.
  constexpr double kRidge = 1e-13;
  Eigen::Matrix3d discriminant;
  discriminant << 0.0, 0.0, 2.0, 0.0, -1.0, 0.0, 2.0, 0.0, 0.0;
  Eigen::Matrix3d factor;
  if (!cholesky(Eigen::Matrix3d(scatter + kRidge * quadratic.trace() * Eigen::Matrix3d::Identity()),
                &factor)) {
    return {};
  }
  const Eigen::Matrix3d whitening = inverse_lower(factor);
  const SymmetricEigen eigen = symmetric_eigen(whitening * discriminant * whitening.transpose());
  std::vector<ConicCoefficients> conics;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector3d v = whitening.transpose() * eigen.vectors.col(k);
    const double sign = 4.0 * v[0] * v[2] - v[1] * v[1];
    if (v.allFinite() && (sign > 0.0) == (curve_class == CurveClass::Ellipse)) {
      ConicCoefficients q;
      q << v, to_linear * v;
      conics.push_back(q);
    }
  }
  return conics;
}

void add_conic(CurveClass curve_class, const ConicCoefficients& q, const FitData& data,
               std::vector<GivenStart>* starts) {
  if (!q.allFinite()) {
    return;
  }
  const auto canonical = canonicalise_as(curve_class, q);
  if (!canonical) {
    return;
  }
  ShapeParameters shape{curve_class, data.scale * canonical->values};
  Pose2 pose = canonical->world_T_curve;
  if (curve_class == CurveClass::Hyperbola) {
    // Takes the branch on which most points lie.
    int votes = 0;
    for (const FitPoint& point : data.points) {
      votes += pose.to_local(point.position).x() > 0.0 ? 1 : -1;
    }
    pose.theta += votes < 0 ? kPi : 0.0;
  }
  pose.x *= data.scale;
  pose.y *= data.scale;
  starts->push_back(in_points_frame(shape, pose, data));
}

void add_polynomial(CurveClass curve_class, const PolynomialCoefficients& c, const FitData& data,
                    std::vector<GivenStart>* starts) {
  const auto canonical = canonicalise_as(curve_class, PolynomialCurve2{data.scale * c});
  if (canonical.curve) {
    starts->push_back(in_points_frame({curve_class, canonical.curve->values},
                                      canonical.curve->world_T_curve, data));
  }
}

const std::vector<AxisFit>& seeds_of(CurveClass curve_class, const PolynomialSeeds& seeds) {
  switch (curve_class) {
    case CurveClass::Parabola:
      return seeds.parabola;
    case CurveClass::CubicalParabola:
      return seeds.cubical_parabola;
    case CurveClass::SemiCubicalParabola:
      return seeds.semi_cubical_parabola;
    default:
      return seeds.cubic_spline;
  }
}

void add_polynomials(CurveClass curve_class, const FitData& data, std::vector<GivenStart>* starts) {
  constexpr double kNoneOutOfReach = std::numeric_limits<double>::infinity();
  constexpr bool kLineFits = false;  // whatever does
  WorkBudget unbounded;
  const PolynomialFits fits = curve_class == CurveClass::Parabola
                                  ? search_parabola(data, unbounded)
                                  : search_polynomials(data, kLineFits, kNoneOutOfReach, unbounded);
  const auto add = [&](const std::optional<PolynomialFit>& fit) {
    if (fit) {
      add_polynomial(curve_class, fit->coefficients, data, starts);
    }
  };
  switch (curve_class) {
    case CurveClass::Parabola:
      add(fits.parabola);
      break;
    case CurveClass::CubicalParabola:
      add(fits.cubical_parabola);
      break;
    case CurveClass::SemiCubicalParabola:
      add(fits.semi_cubical_parabola);
      break;
    default:
      add(fits.cubic_spline);
      add(fits.rival);
      break;
  }
  for (const AxisFit& seed : seeds_of(curve_class, fits.seeds)) {
    const PolynomialFit fit =
        refine_polynomial(seed.model, data.points, to_polynomial(seed, data.points), kSurfacePoints,
                          kCoarseEffort, unbounded);
    add_polynomial(curve_class, fit.coefficients, data, starts);
  }
}

}  // namespace

std::vector<GivenStart> given_starts(CurveClass curve_class, std::span<const Vec2> points) {
  const FitData data = seed_data(points, Order::None);
  WorkBudget unbounded;
  std::vector<GivenStart> starts;
  switch (curve_class) {
    case CurveClass::Unclassified:
      break;
    case CurveClass::Line:
      // Through the middle of the points, along their longer axis: that is the frame's x axis.
      starts.push_back({{CurveClass::Line, Eigen::Vector3d::Zero()}, data.frame});
      break;
    case CurveClass::Circle: {
      const ConicCoefficients algebraic = algebraic_circle(data.points);
      add_conic(curve_class, algebraic, data, &starts);
      add_conic(curve_class,
                refine_circle(data.points, algebraic, kSurfacePoints, {}, unbounded).coefficients,
                data, &starts);
      break;
    }
    case CurveClass::Ellipse:
    case CurveClass::Hyperbola: {
      const ConicCoefficients algebraic = algebraic_conic(data.points);
      const ImplicitFit refined =
          refine_conic(data.points, algebraic, kSurfacePoints, {}, unbounded);
      add_conic(curve_class, refined.coefficients, data, &starts);
      add_conic(curve_class, algebraic, data, &starts);
      for (const ConicCoefficients& q : conics_of_class(curve_class, data.points)) {
        add_conic(curve_class, q, data, &starts);
      }
      break;
    }
    case CurveClass::Parabola:
    case CurveClass::CubicalParabola:
      add_polynomials(curve_class, data, &starts);
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      // If the points come in their order along the curve, the two arms are separated more easily.
      // A second search uses the given order, but does not rely on it.
      add_polynomials(curve_class, data, &starts);
      add_polynomials(curve_class, seed_data(points, Order::AsGiven), &starts);
      break;
  }
  return starts;
}

}  // namespace palpate

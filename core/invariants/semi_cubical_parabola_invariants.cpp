#include "core/invariants/semi_cubical_parabola_invariants.h"

#include "core/curves/pose2.h"
#include "core/invariants/pair_solution_impl.h"

namespace palpate {
namespace {

struct SemiCubicalParabolaFamily {
  template <typename T>
  static AngleQuadratic<T> quadratic(const T& k1, const T& ks1, const T& k2, const T& ks2,
                                     const T& rotation) {
    return semi_cubical_parabola_quadratic(k1, ks1, k2, ks2, rotation);
  }

  /// (a, b). Turning the frame by pi changes the sign of Iscp1 and nothing else.
  template <typename T>
  static std::array<T, 2> parameters(const CanonicalPoint<T>& point) {
    using std::abs;
    using std::sqrt;
    return {sqrt(abs(semi_cubical_parabola_a_squared(point))), semi_cubical_parabola_b(point)};
  }

  template <typename T>
  static T signed_invariant(const CanonicalPoint<T>& point) {
    return semi_cubical_parabola_a_squared(point);
  }

  static bool accept(PairSolution& solution, double unit) {
    const Eigen::Vector2d factor(1.0 / std::sqrt(unit), 1.0);
    solution.parameters = factor.asDiagonal() * solution.parameters;
    solution.covariance.array() *= (factor * factor.transpose()).array();
    return solution.parameters[0] > 0.0 && solution.parameters.allFinite();
  }
};

}  // namespace

PairSolutions semi_cubical_parabola_pair(const MeasuredGeometry& point1,
                                         const MeasuredGeometry& point2) {
  PairSolutions result = detail::solve_pair<SemiCubicalParabolaFamily>(point1, point2);
  for (int i = 0; i < result.count; ++i) {
    PairSolution& solution = result.solutions[static_cast<std::size_t>(i)];
    if (semi_cubical_parabola_a_squared(
            canonical_point(solution.angle, point1.kappa, point1.kappa_s)) < 0.0) {
      solution.angle = wrap_angle(solution.angle + kPi);
    }
  }
  return result;
}

}  // namespace palpate

#include "core/invariants/cubical_parabola_invariants.h"

#include "core/invariants/pair_solution_impl.h"

namespace palpate {
namespace {

struct CubicalParabolaFamily {
  template <typename T>
  static AngleQuadratic<T> quadratic(const T& k1, const T& ks1, const T& k2, const T& ks2,
                                     const T& rotation) {
    return cubical_parabola_quadratic(k1, ks1, k2, ks2, rotation);
  }

  template <typename T>
  static std::array<T, 2> parameters(const CanonicalPoint<T>& point) {
    return {cubical_parabola_a(point), cubical_parabola_c(point)};
  }

  template <typename T>
  static T signed_invariant(const CanonicalPoint<T>& point) {
    return cubical_parabola_a(point);
  }

  static bool accept(PairSolution& solution, double unit) {
    const Eigen::Vector2d factor(1.0 / (unit * unit), 1.0);
    solution.parameters = factor.asDiagonal() * solution.parameters;
    solution.covariance.array() *= (factor * factor.transpose()).array();
    return solution.parameters[0] != 0.0 && solution.parameters.allFinite();
  }
};

}  // namespace

PairSolutions cubical_parabola_pair(const MeasuredGeometry& point1,
                                    const MeasuredGeometry& point2) {
  return detail::solve_pair<CubicalParabolaFamily>(point1, point2);
}

}  // namespace palpate

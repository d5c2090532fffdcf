#include "core/recognition/fit/orthogonal/told_ways.h"

#include <cmath>

#include "core/curves/curve_class.h"
#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

/// Of a few points one may: a quarter of them, where the chord of its neighbours goes round a bend
/// that is sharper than they are apart.
constexpr std::size_t kFewestWithOne = 4;

}  // namespace

bool turns(std::size_t against, std::size_t points) {
  return against * kMayTurnOneIn > points && !(against == 1 && points >= kFewestWithOne);
}

double farthest_noise(double chi2, const FitData& data) {
  constexpr double kDeviations = 6.0;
  const double dof = static_cast<double>(residual_count(data)) -
                     degrees_of_freedom(CurveClass::CubicSpline);  // the most
  const double least = dof > 0.0 ? dof * std::exp(-1.0 - 2.0 * kNegligibleLogOdds / dof) : 0.0;
  return chi2 < least ? kDeviations * std::sqrt(chi2 / least) : kDeviations;
}

bool is_told_apart(const Vec2& a, const FitPoint& from, const Vec2& b, const FitPoint& to,
                   double farthest) {
  const double v = 1.0 / (from.inverse_sigma * from.inverse_sigma);
  const double w = 1.0 / (to.inverse_sigma * to.inverse_sigma);
  return (b - a).squaredNorm() > farthest * farthest * (v + w);
}

bool tells_direction(const FitPoint& from, const FitPoint& to, double farthest) {
  return is_told_apart(from.position, from, to.position, to, farthest);
}

}  // namespace palpate

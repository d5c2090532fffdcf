#include "core/recognition/fit/parabola_beside_conic.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <optional>

#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/starts/axis_fit.h"

namespace palpate {
namespace {

/// Of m in y^2 = 2 p x + m x^2. Legs are missed whose slope t against the vertex tangent is above
/// 46, that of half a step of directions; there x is p t^2 / 2, and a conic is nearer to the
/// parabola than that is wide if abs(m) is below 4 / t^2.
constexpr double kNearParabola = 2e-3;
/// Three deviations of the conic's one coefficient more. By less than that a needle that runs to
/// and fro over a stroke is better than a parabola along it, and far less probable.
constexpr double kMissedBy = 9.0;

}  // namespace

void start_parabola_beside_conic(const ConicCoefficients& conic, double conic_chi2,
                                 const FitData& reduced, PolynomialFits* fits, WorkBudget& work) {
  std::optional<PolynomialFit>& parabola = fits->parabola;
  if (!parabola || parabola->chi2 <= conic_chi2 + kMissedBy ||
      !fits_well(conic_chi2, residual_count(reduced)) || !work.allows()) {
    return;
  }
  Eigen::Matrix2d squares;
  squares << conic[0], 0.5 * conic[1], 0.5 * conic[1], conic[2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(squares);
  const Eigen::Vector2d sizes = axes.eigenvalues().cwiseAbs();
  const Eigen::Index across = sizes[0] < sizes[1] ? 1 : 0;
  if (!(sizes[1 - across] < kNearParabola * sizes[across])) {
    return;
  }
  const Vec2 tangent = axes.eigenvectors().col(across);  // at the vertex
  const AxisFit walked =
      refine_axis(reduced.points,
                  {PolynomialModel::Parabola, std::atan2(tangent.y(), tangent.x()), 0.0, {}, 0.0},
                  kMostWalked, work);
  keep_better(&parabola, refine_polynomial(PolynomialModel::Parabola, reduced.points,
                                           to_polynomial(walked, reduced.points), kSurfacePoints,
                                           coarse(std::numeric_limits<double>::infinity()), work));
}

}  // namespace palpate

#include "core/recognition/fit/orthogonal/polynomial_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/numerics/levenberg_marquardt.h"
#include "core/recognition/fit/orthogonal/polynomial_problem.h"

namespace palpate {
namespace {

/// Takes `x` to the optimum that the problem's feet lead to. Chi-square there goes to `fit`.
template <PolynomialModel kModel>
void minimise_from(typename PolynomialProblem<kModel>::Vector* x,
                   PolynomialProblem<kModel>* problem, std::span<const FitPoint> points,
                   const RefineEffort& effort, PolynomialFit* fit, WorkBudget& work) {
  // The solver also stops where a step is refused for next to nothing, as happens along the
  // directions that affine changes of t leave free. Starting afresh, with the damping of the new
  // place, tells a stop from an optimum.
  constexpr double kSettled = 1e-5;  // of chi-square
  // Where the points scatter far less than their stated noise (exact data, noise estimated from a
  // smooth model that bends too little), what is left to gain is to be seen beside what is left at
  // all.
  constexpr double kExact = 1e-3;  // of the chi-square that noise would leave
  constexpr int kMoreStarts = 2;
  const std::size_t normals = count_normals(points);
  const double n = static_cast<double>(points.size() + normals);
  const auto is_exact = [&] { return fit->chi2 < kExact * n; };
  for (int start_number = 0;
       start_number < effort.starts || (is_exact() && start_number < effort.starts + kMoreStarts);
       ++start_number) {
    if (normals > 0) {
      problem->weigh_normals(*x);
    }
    const double left = start_number > 0 && is_exact() ? fit->chi2 / n : 1.0;
    const MinimiseSummary summary = minimise(problem, x,
                                             {.iterations = effort.iterations,
                                              .chi2_tolerance = left * effort.chi2_tolerance,
                                              .relative_tolerance = effort.relative_tolerance(n),
                                              .coarse_above = most_chi2_of_noise(points),
                                              .out_of_reach = effort.out_of_reach,
                                              .work = &work,
                                              .row = WorkKind::PolynomialRow,
                                              .rows = points.size()});
    if (start_number == 0) {
      fit->chi2 = summary.initial_chi2;
    }
    const bool nothing_left = summary.converged || !(summary.chi2 < fit->chi2 - left * kSettled);
    const bool settled = nothing_left && (start_number > 0 || !(summary.chi2 < kExact * n));
    fit->chi2 = std::min(fit->chi2, summary.chi2);
    // What has not arrived by then runs along a valley that is as good as flat.
    const bool too_far = summary.iterations >= effort.iterations;
    if (settled || too_far || !std::isfinite(summary.chi2)) {
      return;
    }
  }
}

template <PolynomialModel kModel>
PolynomialFit refine(std::span<const FitPoint> points, const PolynomialFit& start, int side,
                     const RefineEffort& effort, WorkBudget& work) {
  using Problem = PolynomialProblem<kModel>;
  constexpr double kWorthASearch = 1.0;  // of chi-square: odds change by 1.6
  Problem problem(points, start.t, side);
  typename Problem::Vector x = Problem::parameters(start.coefficients);
  PolynomialFit fit;
  fit.chi2 = std::numeric_limits<double>::infinity();
  minimise_from<kModel>(&x, &problem, points, effort, &fit, work);
  if (effort.seek_feet && std::isfinite(fit.chi2) && problem.seek_feet() > kWorthASearch) {
    minimise_from<kModel>(&x, &problem, points, effort, &fit, work);
  }
  fit.coefficients = Problem::coefficients(x);
  fit.side = side;
  fit.t = problem.t();
  return fit;
}

}  // namespace

PolynomialFit refine_polynomial(PolynomialModel model, std::span<const FitPoint> points,
                                const PolynomialFit& start, int side, const RefineEffort& effort,
                                WorkBudget& work) {
  switch (model) {
    case PolynomialModel::Parabola:
      return refine<PolynomialModel::Parabola>(points, start, side, effort, work);
    case PolynomialModel::CubicalParabola:
      return refine<PolynomialModel::CubicalParabola>(points, start, side, effort, work);
    case PolynomialModel::SemiCubicalParabola:
      return refine<PolynomialModel::SemiCubicalParabola>(points, start, side, effort, work);
    case PolynomialModel::CubicSpline:
      return refine<PolynomialModel::CubicSpline>(points, start, side, effort, work);
  }
  return start;
}

void keep_better(std::optional<PolynomialFit>* best, PolynomialFit fit) {
  if (std::isfinite(fit.chi2) && (!*best || fit.chi2 < (*best)->chi2)) {
    *best = std::move(fit);
  }
}

bool is_same_curve(const PolynomialFit& a, const PolynomialFit& b) {
  constexpr double kSameChi2 = 1e-3;   // far below what tells curves apart
  constexpr double kSameAngle = 1e-6;  // [rad]
  const Vec2 u = a.coefficients.col(3).normalized();
  const Vec2 v = b.coefficients.col(3).normalized();
  return std::abs(a.chi2 - b.chi2) <= kSameChi2 && std::abs(cross(u, v)) <= kSameAngle;
}

PlacedPoint place_on(const PolynomialFit& fit, double t, const FitPoint& point, double last_step) {
  return follow_foot_point(fit.coefficients, point.position, t, last_step, point_of(point));
}

PolynomialFit placed_on(std::span<const FitPoint> points, PolynomialFit fit) {
  fit.chi2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlacedPoint placed = place_on(fit, fit.t[i], points[i]);
    const double residual = placed.signed_distance * points[i].inverse_sigma;
    fit.t[i] = placed.t;
    fit.chi2 += residual * residual;
    if (has_normal(points[i])) {
      const double turned = normal_residual(fit.coefficients, placed, points[i]);
      fit.chi2 += turned * turned;
    }
  }
  return fit;
}

}  // namespace palpate

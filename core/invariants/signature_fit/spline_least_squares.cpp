#include "core/invariants/signature_fit/spline_least_squares.h"

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/curves/pose2.h"
#include "core/invariants/cubic_spline_equations.h"
#include "core/invariants/spline_pair.h"
#include "core/numerics/quantile.h"

namespace palpate {
namespace {

/// Twice as many points as determine orientation, a and b.
constexpr int kLargestPointCount = 6;

/// TinySolver compares the ABSOLUTE change of the cost with function_tolerance, contrary to its own
/// comment. The residuals are dimensionless and of size one, so the tolerances are relative.
constexpr double kCostTolerance = 1e-26;
constexpr double kGradientTolerance = 1e-15;
constexpr double kStepTolerance = 1e-13;
constexpr int kMaxIterations = 30;

/// If chi-square exceeds its mean by more than this many standard deviations, the minimum may be a
/// wrong one, and more starts are tried. This happens by chance for one fit in a hundred.
constexpr double kPlausibleSigmas = 3.0;
/// Starts from pairs of points, refined one after another until a fit explains the points. One more
/// than there are pairs of the points used. Bounds the time.
constexpr int kFallbackStarts = 16;

/// The points of (50), at most kLargestPointCount, in normalised lengths.
struct SplineData {
  int count = 0;
  std::array<double, kLargestPointCount> angle;
  std::array<double, kLargestPointCount> kappa;
  std::array<double, kLargestPointCount> kappa_s;
};

/// Residuals of (50) as a function of x = (orientation, ln a, arctan b); 0 for unused entries.
struct SplineResiduals {
  const SplineData* data;

  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    using std::exp;
    using std::tan;
    const T a = exp(x[1]);
    const T b = tan(x[2]);
    for (std::size_t i = 0; i < kLargestPointCount; ++i) {
      if (static_cast<int>(i) < data->count) {
        const T angle = data->angle[i] - x[0];
        residuals[i] = spline_residual(
            spline_point(canonical_point(angle, T(data->kappa[i]), T(data->kappa_s[i])), a, b));
      } else {
        residuals[i] = T(0.0);
      }
    }
    return true;
  }
};

using SplineFunction = ceres::TinySolverAutoDiffFunction<SplineResiduals, kLargestPointCount, 3>;

/// Sets c to the median of the closed forms of the points, and c_spread to their disagreement, each
/// form relative to the size of its two sides.
void solve_c(const SplineData& data, SplineSolution& solution) {
  std::vector<SplineC> forms;
  std::vector<double> own;
  forms.reserve(kLargestPointCount);
  own.reserve(kLargestPointCount);
  for (int i = 0; i < data.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto point = spline_point(
        canonical_point(data.angle[k] - solution.orientation, data.kappa[k], data.kappa_s[k]),
        solution.parameters[0], solution.parameters[1]);
    const SplineC form = spline_c(point, solution.parameters[0]);
    const double c = form.numerator / form.denominator;
    if (std::isfinite(c)) {
      forms.push_back(form);
      own.push_back(c);
    }
  }
  if (own.empty()) {
    solution.c_spread = 2.0;
    return;
  }
  solution.parameters[2] = median_of(own);
  double sum = 0.0;
  for (const SplineC& form : forms) {
    const double left = form.denominator * solution.parameters[2];
    const double size = std::abs(left) + std::abs(form.numerator);
    sum += size > 0.0 ? std::pow((left - form.numerator) / size, 2) : 0.0;
  }
  solution.c_spread = std::sqrt(sum / static_cast<double>(forms.size()));
}

/// At most kLargestPointCount points, spread evenly over those given.
std::vector<MeasuredGeometry> selected_points(std::span<const MeasuredGeometry> points,
                                              double unit) {
  const std::size_t count = std::min<std::size_t>(points.size(), kLargestPointCount);
  std::vector<MeasuredGeometry> selected;
  selected.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    selected.push_back(in_units_of(points[i * (points.size() - 1) / (count - 1)], unit));
  }
  return selected;
}

SplineData spline_data(std::span<const MeasuredGeometry> points) {
  SplineData data;
  for (const MeasuredGeometry& point : points) {
    const auto k = static_cast<std::size_t>(data.count++);
    data.angle[k] = point.tangent_angle;
    data.kappa[k] = point.kappa;
    data.kappa_s[k] = point.kappa_s;
  }
  return data;
}

}  // namespace

std::vector<SplineSolution> spline_least_squares(std::span<const MeasuredGeometry> points,
                                                 const SplineOptions& options) {
  std::vector<SplineSolution> solutions;
  const double scale = curvature_scale(points);
  if (points.size() < 3 || !(scale > 0.0) || !are_finite(points)) {
    return solutions;
  }
  const double unit = 1.0 / scale;
  const std::vector<MeasuredGeometry> selected = selected_points(points, unit);
  const SplineData data = spline_data(selected);
  const SplineResiduals residuals{&data};  // TinySolver's adaptor stores a reference
  const SplineFunction function(residuals);
  ceres::TinySolver<SplineFunction> solver;
  solver.options.function_tolerance = kCostTolerance;
  solver.options.gradient_tolerance = kGradientTolerance;
  solver.options.parameter_tolerance = kStepTolerance;
  solver.options.cost_threshold = kCostTolerance;
  solver.options.max_num_iterations = kMaxIterations;
  for (const SplineSeed& seed : spline_seeds(selected, options.starts)) {
    Eigen::Vector3d x(seed.orientation, std::log(seed.parameters[0]),
                      std::atan(seed.parameters[1]));
    solver.Solve(function, &x);
    if (!x.allFinite()) {
      continue;
    }
    SplineSolution solution;
    solution.parameters = {std::exp(x[1]), std::tan(x[2]), 0.0};
    solution.orientation = wrap_angle(x[0]);
    solution.cost = 2.0 * solver.summary.final_cost;
    solve_c(data, solution);
    solution.parameters[0] /= std::sqrt(unit);
    solution.parameters[2] *= std::sqrt(unit);
    if (solution.parameters.allFinite() && std::isfinite(solution.cost)) {
      solutions.push_back(solution);
    }
  }
  const auto badness = [](const SplineSolution& s) { return s.cost + s.c_spread * s.c_spread; };
  std::sort(
      solutions.begin(), solutions.end(),
      [&](const SplineSolution& p, const SplineSolution& q) { return badness(p) < badness(q); });
  // Starts that converged to the same minimum count once.
  const auto same = [](const SplineSolution& p, const SplineSolution& q) {
    return std::abs(wrap_angle(p.orientation - q.orientation)) < 1e-6 &&
           std::abs(p.parameters[0] - q.parameters[0]) < 1e-6 * p.parameters[0];
  };
  solutions.erase(std::unique(solutions.begin(), solutions.end(), same), solutions.end());
  return solutions;
}

SemiSignatureFit fit_cubic_spline(std::span<const MeasuredGeometry> points,
                                  const SplineOptions& options) {
  SemiSignatureFit best;
  best.curve_class = CurveClass::CubicSpline;
  if (points.size() < 3) {
    return best;
  }
  if (!are_finite(points)) {
    best.status = InvariantStatus::NotFinite;
    return best;
  }
  best.status = InvariantStatus::NoRealRoot;
  best.chi2 = std::numeric_limits<double>::infinity();
  const auto refine = [&](const Eigen::Vector3d& parameters, double orientation) {
    SemiSignatureFit fit = fit_semi_signature(CurveClass::CubicSpline, points, parameters,
                                              orientation, options.refinement);
    keep_better(std::move(fit), best);
  };
  const auto explained = [&] {
    return best.status == InvariantStatus::Ok &&
           best.chi2 <= best.dof + kPlausibleSigmas * std::sqrt(2.0 * best.dof);
  };
  const std::vector<SplineSolution> solutions = spline_least_squares(points, options);
  const auto refined = std::min(solutions.size(), static_cast<std::size_t>(options.refined));
  for (std::size_t i = 0; i < refined; ++i) {
    refine(solutions[i].parameters, solutions[i].orientation);
  }
  // (50) gives all residuals the same weight, so noise can lead it away from the curve. The cubics
  // through single pairs of points are then the better starts.
  const double scale = curvature_scale(points);
  if (!explained() && scale > 0.0) {
    const double unit = 1.0 / scale;
    for (const SplineSeed& seed : spline_seeds(selected_points(points, unit), kFallbackStarts)) {
      refine({seed.parameters[0] / std::sqrt(unit), seed.parameters[1],
              seed.parameters[2] * std::sqrt(unit)},
             seed.orientation);
      if (explained()) {
        break;
      }
    }
  }
  return best;
}

}  // namespace palpate

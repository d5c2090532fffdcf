#include "core/recognition/fit/orthogonal/feet_in_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/orthogonal/touchable.h"

namespace palpate {
namespace {

/// On which arms a stroke runs: the signs of t - vertex before and after it is nearest to the bend.
struct Arms {
  double before = 1.0;
  double after = 1.0;
};

struct Run {
  std::vector<double> t;
  double chi2 = 0.0;
};

/// A stroke's feet on these arms, followed there; nullopt where one leaves its arm.
std::optional<Run> run_on(const Arms& arms, const PolynomialFit& fit, double vertex,
                          std::span<const FitPoint> points, std::span<const double> t) {
  const auto nearest = std::min_element(t.begin(), t.end(), [&](double a, double b) {
    return std::abs(a - vertex) < std::abs(b - vertex);
  });
  const auto turn = static_cast<std::size_t>(nearest - t.begin());
  Run run;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double arm = i < turn ? arms.before : arms.after;
    const PlacedPoint foot = place_on(fit, vertex + arm * std::abs(t[i] - vertex), points[i]);
    if (arm * (foot.t - vertex) < 0.0) {
      return std::nullopt;
    }
    run.t.push_back(foot.t);
    const double residual = foot.signed_distance * points[i].inverse_sigma;
    run.chi2 += residual * residual;
  }
  return run;
}

/// The stroke alone, with these feet.
bool runs_one_way(const PolynomialFit& fit, std::span<const FitPoint> points, const Run& run) {
  FitData alone;
  alone.points.assign(points.begin(), points.end());
  alone.patches = {{0, points.size()}};
  PolynomialFit placed = fit;
  placed.t = run.t;
  return is_touchable(placed, alone);
}

}  // namespace

PolynomialFit with_feet_in_order(PolynomialFit fit, const FitData& data, WorkBudget& work) {
  const auto vertex = vertex_of(fit.coefficients);
  if (!vertex) {
    return fit;
  }
  constexpr Arms kWays[] = {{1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}, {-1.0, 1.0}};
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    const PatchSpan& patch = data.patches[p];
    const auto begin = fit.t.begin() + static_cast<std::ptrdiff_t>(patch.begin);
    const Run now{{begin, begin + static_cast<std::ptrdiff_t>(patch.size())}, 0.0};
    if (patch.size() < 2 || runs_one_way(fit, data.patch(p), now)) {
      continue;
    }
    std::optional<Run> best;
    for (const Arms& arms : kWays) {
      work.spend(WorkKind::PolynomialRow, patch.size());
      auto run = run_on(arms, fit, *vertex, data.patch(p), now.t);
      if (run && (!best || run->chi2 < best->chi2) && runs_one_way(fit, data.patch(p), *run)) {
        best = std::move(run);
      }
    }
    if (best) {
      std::copy(best->t.begin(), best->t.end(), begin);
    }
  }
  return fit;
}

}  // namespace palpate

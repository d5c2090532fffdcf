#include "core/recognition/fit/starts/polynomial_seeds.h"

#include <algorithm>
#include <cmath>

#include "core/curves/curve_class.h"
#include "core/recognition/fit/starts/algebraic_fit.h"
#include "core/recognition/fit/starts/arm_search.h"
#include "core/recognition/fit/starts/seed_moments.h"

namespace palpate {
namespace {

double square(double x) { return x * x; }

/// Appends the best local minima over a grid of directions (circular, outer index) and vertices
/// (inner index, `vertices` each), best first; without arms.
void take_minima(const std::vector<SeedCell>& grid, std::size_t vertices, std::size_t most,
                 PolynomialModel model, std::vector<AxisFit>* seeds) {
  std::vector<const SeedCell*> minima;
  const std::size_t directions = grid.size() / vertices;
  const auto is_minimum = [&](std::size_t d, std::size_t v) {
    const SeedCell& here = grid[d * vertices + v];
    for (std::size_t dd : {d + directions - 1, d, d + 1}) {
      for (std::size_t vv = v > 0 ? v - 1 : v; vv <= std::min(v + 1, vertices - 1); ++vv) {
        const SeedCell& there = grid[(dd % directions) * vertices + vv];
        if (&there != &here &&
            (there.cost < here.cost || (there.cost == here.cost && &there < &here))) {
          return false;
        }
      }
    }
    return std::isfinite(here.cost);
  };
  for (std::size_t d = 0; d < directions; ++d) {
    for (std::size_t v = 0; v < vertices; ++v) {
      if (is_minimum(d, v)) {
        minima.push_back(&grid[d * vertices + v]);
      }
    }
  }
  std::sort(minima.begin(), minima.end(),
            [](const SeedCell* a, const SeedCell* b) { return a->cost < b->cost; });
  minima.resize(std::min(most, minima.size()));
  for (const SeedCell* minimum : minima) {
    seeds->push_back({model, minimum->theta, minimum->x0, {}, minimum->cost});
  }
}

/// Whether the same points share an arm: which arm is called positive is a convention (t -> -t).
bool are_same_arms(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [same = a.front() * b.front()](double u, double v) { return u == same * v; });
}

/// Appends the best splines of the cells that are no minima because a cell beside them is lower
/// with other arms: each pattern of arms has valleys of its own, and a grid of the best pattern of
/// each cell shows only those that no other pattern covers.
void add_other_arms(const std::vector<SeedCell>& splines, ArmSearch* search,
                    std::vector<AxisFit>* seeds, WorkBudget& work) {
  // As many as leave the true valley out of one search in a hundred (lone_search_test). A valley
  // is several cells wide, so that most cells are like one taken already.
  constexpr std::size_t kMostAdded = 40;
  constexpr std::size_t kMostTried = 4 * kMostAdded;
  constexpr double kSameValley = 0.3;  // rad, about two directions of the grid
  std::vector<const SeedCell*> best(splines.size());
  for (std::size_t i = 0; i < splines.size(); ++i) {
    best[i] = &splines[i];
  }
  const std::size_t tried = std::min(kMostTried, best.size());
  std::partial_sort(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(tried), best.end(),
                    [](const SeedCell* a, const SeedCell* b) { return a->cost < b->cost; });
  std::size_t added = 0;
  for (std::size_t i = 0; i < tried && added < kMostAdded && std::isfinite(best[i]->cost); ++i) {
    AxisFit seed{PolynomialModel::CubicSpline, best[i]->theta, best[i]->x0, {}, best[i]->cost};
    seed.arms = search->best_arms(seed, work);
    const bool known = std::any_of(seeds->begin(), seeds->end(), [&](const AxisFit& other) {
      return std::abs(std::remainder(other.theta - seed.theta, 2.0 * kPi)) < kSameValley &&
             are_same_arms(other.arms, seed.arms);
    });
    if (!known) {
      seeds->push_back(std::move(seed));
      ++added;
    }
  }
}

}  // namespace

std::size_t most_few_touches() {
  return std::size_t{5} * degrees_of_freedom(CurveClass::CubicSpline);
}

bool are_few_touches(std::span<const FitPoint> points, std::span<const PatchSpan> patches) {
  return points.size() == patches.size() && points.size() <= most_few_touches();
}

void add_graph_seeds(std::span<const FitPoint> points, PolynomialSeeds* seeds, WorkBudget& work) {
  // 2.5 degrees: half a step puts the far end of a needle off by its width where that is a fiftieth
  // of its length.
  constexpr std::size_t kDirections = 72;
  work.spend(WorkKind::SeedRow, kDirections * points.size());
  std::vector<SeedCell> parabolas(kDirections);
  std::vector<SeedCell> cubics(kDirections);
  for (std::size_t d = 0; d < kDirections; ++d) {
    const double theta = kPi * static_cast<double>(d) / static_cast<double>(kDirections);
    const Vec2 axis(std::cos(theta), std::sin(theta));
    SeedMoments moments;
    for (const FitPoint& point : points) {
      const double along = point.position.dot(axis);
      moments.add(square(point.inverse_sigma * verticality(point, axis)), along, along * along,
                  cross(axis, point.position));
    }
    const ResidualSums sums = residual_sums(moments, {0, 1, 2, 3});
    parabolas[d] = {sums.of_three, theta, 0.0};
    cubics[d] = {sums.of_four, theta, 0.0};
  }
  take_minima(parabolas, 1, PolynomialSeeds::kGraphSeeds, PolynomialModel::Parabola,
              &seeds->parabola);
  take_minima(cubics, 1, PolynomialSeeds::kGraphSeeds, PolynomialModel::CubicalParabola,
              &seeds->cubical_parabola);
}

void add_arm_seeds(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                   PolynomialSeeds* seeds, WorkBudget& work) {
  // 7.5 degrees: half a step moves a point at the far end across the axis by a fifteenth of the
  // way, about as much as half a cell of vertices does.
  constexpr std::size_t kDirections = 48;
  constexpr std::size_t kVertices = ArmSearch::kVertexDistances.size();
  ArmSearch search(points, patches);
  work.spend(WorkKind::SeedRow, kDirections * kVertices * (points.size() + search.sums()));
  std::vector<SeedCell> semi_cubicals(kDirections * kVertices);
  std::vector<SeedCell> splines(kDirections * kVertices);
  for (std::size_t d = 0; d < kDirections; ++d) {
    const double theta = 2.0 * kPi * static_cast<double>(d) / static_cast<double>(kDirections);
    search.search(theta, &semi_cubicals[d * kVertices], &splines[d * kVertices]);
  }
  take_minima(semi_cubicals, kVertices, search.most_seeds(), PolynomialModel::SemiCubicalParabola,
              &seeds->semi_cubical_parabola);
  take_minima(splines, kVertices, search.most_seeds() + PolynomialSeeds::kMoreSplines,
              PolynomialModel::CubicSpline, &seeds->cubic_spline);
  const std::size_t first = std::min(search.most_seeds(), seeds->cubic_spline.size());
  const auto more = seeds->cubic_spline.begin() + static_cast<std::ptrdiff_t>(first);
  seeds->more_splines.assign(more, seeds->cubic_spline.end());
  seeds->cubic_spline.erase(more, seeds->cubic_spline.end());
  for (auto* found : {&seeds->semi_cubical_parabola, &seeds->cubic_spline, &seeds->more_splines}) {
    for (AxisFit& seed : *found) {
      seed.arms = search.best_arms(seed, work);
    }
  }
  // The semi-cubical parabolas start beside the splines too.
  if (are_few_touches(points, patches)) {
    add_other_arms(splines, &search, &seeds->cubic_spline, work);
  }
}

void add_straight_arm(std::span<const FitPoint> points, PolynomialSeeds* seeds) {
  const ConicCoefficients line = algebraic_line(points);
  const Vec2 axis = -left_of(Vec2(line[3], line[4]));
  const auto [first, last] =
      std::minmax_element(points.begin(), points.end(), [&](const FitPoint& a, const FitPoint& b) {
        return a.position.dot(axis) < b.position.dot(axis);
      });
  const double least = first->position.dot(axis);
  const double span = last->position.dot(axis) - least;
  seeds->cubic_spline.push_back({PolynomialModel::CubicSpline, std::atan2(axis.y(), axis.x()),
                                 least - span, std::vector<double>(points.size(), 1.0), 0.0});
}

}  // namespace palpate

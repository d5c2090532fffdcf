#include "core/recognition/samples/tips/sides_on_a_cubic.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/samples/tips/tip_sides.h"

namespace palpate {
namespace {

/// x^i y^j of all orders from the first to the third, and how they change by x and y.
constexpr int kMonomials = 9;
using Monomials = Eigen::Matrix<double, kMonomials, 1>;
using Moments = Eigen::Matrix<double, kMonomials, kMonomials>;

Monomials monomials_at(const Vec2& p) {
  const double x = p.x();
  const double y = p.y();
  return {x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
}
Monomials by_x_at(const Vec2& p) {
  const double x = p.x();
  const double y = p.y();
  return {1.0, 0.0, 2.0 * x, y, 0.0, 3.0 * x * x, 2.0 * x * y, y * y, 0.0};
}
Monomials by_y_at(const Vec2& p) {
  const double x = p.x();
  const double y = p.y();
  return {0.0, 1.0, 0.0, x, 2.0 * y, 0.0, x * x, 2.0 * x * y, 3.0 * y * y};
}

/// Sums over surface points, weighted by what they are known to.
struct CubicSums {
  double weight = 0.0;
  Monomials sum = Monomials::Zero();
  Moments squares = Moments::Zero();
  Moments slopes = Moments::Zero();

  CubicSums& operator+=(const CubicSums& other) {
    weight += other.weight;
    sum += other.sum;
    squares += other.squares;
    slopes += other.slopes;
    return *this;
  }
};

CubicSums sums_of(std::span<const FitPoint> points) {
  CubicSums sums;
  for (const FitPoint& point : points) {
    const double weight = point.inverse_sigma * point.inverse_sigma;
    const Monomials m = monomials_at(point.position);
    const Monomials by_x = by_x_at(point.position);
    const Monomials by_y = by_y_at(point.position);
    sums.weight += weight;
    sums.sum += weight * m;
    sums.squares += weight * m * m.transpose();
    sums.slopes += weight * (by_x * by_x.transpose() + by_y * by_y.transpose());
  }
  return sums;
}

/// Its work, measured in steps of a fit.
constexpr std::size_t kStepsOfMisfit = 10;

/// Squared distances from the nearest curve, in units of the noise, as Taubin estimates them: the
/// squares of its polynomial over those of its slope.
double misfit_of(const CubicSums& sums) {
  const Moments spread = sums.squares - sums.sum * sums.sum.transpose() / sums.weight;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Moments> solver(spread, sums.slopes,
                                                                 Eigen::EigenvaluesOnly);
  return sums.weight * solver.eigenvalues()[0];
}

/// Sides of the patches looked at so far.
struct Way {
  std::vector<int> sides;
  CubicSums sums;
  double misfit = 0.0;
};

/// Those ways by which all surface points so far lie on one curve, the nearest first.
std::vector<Way> on_one_curve(std::vector<Way> ways, std::size_t points, std::size_t most,
                              WorkBudget& work) {
  work.spend(WorkKind::FitStep, kStepsOfMisfit * ways.size());
  for (Way& way : ways) {
    way.misfit = misfit_of(way.sums);
  }
  std::erase_if(
      ways, [&](const Way& way) { return !can_be_noise(way.misfit, static_cast<double>(points)); });
  std::stable_sort(ways.begin(), ways.end(),
                   [](const Way& a, const Way& b) { return a.misfit < b.misfit; });
  ways.resize(std::min(most, ways.size()));
  return ways;
}

}  // namespace

std::vector<std::vector<int>> sides_on_a_cubic(const FitData& touches, std::span<const int> known,
                                               std::size_t most, WorkBudget& work) {
  // Kept from patch to patch: as many as five patches may lie in.
  constexpr std::size_t kKept = 32;
  const std::vector<int> all_left(known.size(), 1);
  const std::vector<int> all_right(known.size(), -1);
  const FitData left = on_surface(touches, all_left);
  const FitData right = on_surface(touches, all_right);
  std::vector<Way> ways(1);
  std::size_t points = 0;
  for (std::size_t p = 0; p < known.size(); ++p) {
    if (!work.allows()) {
      return {};
    }
    const bool has_tip = !touches.patch(p).empty() && touches.patch(p).front().offset > 0.0;
    const bool is_open = has_tip && known[p] == 0;
    const CubicSums of_left = sums_of(left.patch(p));
    const CubicSums of_right = sums_of(right.patch(p));
    std::vector<Way> longer;
    for (const Way& way : ways) {
      for (const int side : {-1, 1}) {
        if (is_open || side == (known[p] < 0 ? -1 : 1)) {
          Way& next = longer.emplace_back(way);
          next.sides.push_back(has_tip ? side : 0);
          next.sums += side < 0 ? of_right : of_left;
        }
      }
    }
    ways = std::move(longer);
    points += touches.patch(p).size();
    if (ways.size() > kKept) {
      ways = on_one_curve(std::move(ways), points, kKept, work);
    }
  }
  std::vector<std::vector<int>> nearest;
  for (Way& way : on_one_curve(std::move(ways), points, most, work)) {
    nearest.push_back(std::move(way.sides));
  }
  return nearest;
}

}  // namespace palpate

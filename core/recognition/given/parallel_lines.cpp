#include "core/recognition/given/parallel_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/numerics/matrices/symmetric_eigen.h"

namespace palpate {
namespace {

/// In local units, about half extents of the points: the walls of an ellipse so long leave lines by
/// 3e-14 of its width over these, by the rounding of coordinates that are some dozens of extents.
/// (Curves of more than 1e7 are taken for their limit: foot_parameter.h.)
constexpr double kFar = 0x1p22;

/// Numbers in two parts, low and high ones.
struct Split {
  double square = std::numeric_limits<double>::infinity();  ///< sum of squares about both means
  double low = 0.0;                                         ///< mean of either part
  double high = 0.0;
};

/// The best split of numbers in two, each about its mean.
Split best_split(std::vector<double> along) {
  std::sort(along.begin(), along.end());
  const auto n = static_cast<double>(along.size());
  const double sum = std::accumulate(along.begin(), along.end(), 0.0);
  const double squares = std::inner_product(along.begin(), along.end(), along.begin(), 0.0);
  Split best;
  double below = 0.0;
  for (std::size_t i = 0; i + 1 < along.size(); ++i) {
    below += along[i];
    const auto k = static_cast<double>(i + 1);
    const double low = below / k;
    const double high = (sum - below) / (n - k);
    const double square = squares - k * low * low - (n - k) * high * high;
    if (square < best.square) {
      best = {square, low, high};
    }
  }
  return best;
}

/// Pairs of parallel lines that no pair of a direction beside theirs fits better, as long ellipses.
/// Parallels stay parallel where the plane is stretched: where the points are as wide as long,
/// walls lie far apart in all directions but few.
std::vector<PlacedCurve<double>> parallels_of(const LocalPoints& local) {
  // So many directions are 2.8 degrees apart. The walls, over which the points are as long as wide,
  // are then off their direction by 0.025 of that at most.
  constexpr std::size_t kDirections = 64;
  const auto n = static_cast<double>(local.rough.size());
  const Vec2 mean = std::accumulate(local.rough.begin(), local.rough.end(), Vec2(0.0, 0.0)) / n;
  SmallSymmetric scatter = SmallSymmetric::Zero(2, 2);
  for (const Vec2& point : local.rough) {
    scatter += (point - mean) * (point - mean).transpose() / n;
  }
  const SymmetricEigen axes = symmetric_eigen(scatter);
  if (!(axes.values[0] > 0.0)) {
    return {};  // two lines fit no better than the one that all points lie on
  }
  std::array<Vec2, kDirections> normal;
  std::array<Split, kDirections> split;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double angle = kPi * static_cast<double>(k) / kDirections;
    normal[k] = std::cos(angle) / std::sqrt(axes.values[0]) * axes.vectors.col(0) +
                std::sin(angle) / std::sqrt(axes.values[1]) * axes.vectors.col(1);
    std::vector<double> along;
    for (const Vec2& point : local.rough) {
      along.push_back(normal[k].dot(point - mean));
    }
    split[k] = best_split(std::move(along));
  }
  std::vector<PlacedCurve<double>> parallels;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double square = split[k].square;
    if (square > split[(k + 1) % kDirections].square ||
        square > split[(k + kDirections - 1) % kDirections].square) {
      continue;
    }
    const double length = normal[k].norm();
    const Vec2 unit = normal[k] / length;
    const Vec2 origin = mean + 0.5 * (split[k].low + split[k].high) / length * unit;
    PlacedCurve<double>& pair = parallels.emplace_back();
    pair.curve_class = CurveClass::Ellipse;
    pair.shape[0] = kFar;
    pair.shape[1] = 0.5 * (split[k].high - split[k].low) / length;
    pair.origin = {origin.x(), origin.y()};
    pair.axis = {unit.y(), -unit.x()};
  }
  return parallels;
}

}  // namespace

double misfit_of_parallels(const LocalPoints& local, const GivenNoise& noise) {
  // The ellipse keeps its length, and stays where it is along the lines: there it slides freely.
  HeldUnknowns held;
  held.set(0);
  held.set(static_cast<std::size_t>(Unknowns(CurveClass::Ellipse).x));
  const std::vector<PlacedCurve<double>> starts = parallels_of(local);
  double least = std::numeric_limits<double>::infinity();
  for (const int side : sides_of(noise.points)) {
    for (const PlacedCurve<double>& start : starts) {
      GivenCandidate candidate;
      candidate.side = side;
      candidate.curve = start;
      settle(local, noise, &candidate, held);
      least = std::min(least, candidate.misfit);
    }
  }
  return least;
}

}  // namespace palpate

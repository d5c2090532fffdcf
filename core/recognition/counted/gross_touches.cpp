#include "core/recognition/counted/gross_touches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/recognition/counted/fewest_places.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"

namespace palpate {
namespace {

using Indices = std::vector<std::size_t>;

/// The most touches of one fit that are left out in turn, those that it misses most: what errs by
/// far more than noise is among them, and the work is linear in the touches.
constexpr std::size_t kMostInTurn = 16;

/// A class on the touches that are left.
struct Left {
  ClassFit fit;
  FitData points;
  Indices numbers;  ///< of the points among all
};

Left without(Left left, std::size_t k) {
  std::vector<bool> is_out(left.points.points.size(), false);
  is_out[k] = true;
  left.points = without_points(left.points, is_out);
  const auto at = static_cast<std::ptrdiff_t>(k);
  left.numbers.erase(left.numbers.begin() + at);
  if (left.fit.polynomial) {
    left.fit.polynomial->t.erase(left.fit.polynomial->t.begin() + at);
  }
  left.fit.rival.reset();
  return left;
}

/// The touches that a fit misses most, farthest first.
Indices most_missed(const Left& left) {
  const std::vector<FitPoint>& points = left.points.points;
  std::vector<double> miss;
  for (std::size_t i = 0; i < points.size(); ++i) {
    miss.push_back((points[i].position - foot_of(left.fit, i)).norm() * points[i].inverse_sigma);
  }
  Indices order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return miss[a] > miss[b]; });
  order.resize(std::min(order.size(), kMostInTurn));
  return order;
}

/// The class without the touch that leaves it the least.
std::optional<Left> best_without_one(const Left& from, WorkBudget& work) {
  std::optional<Left> best;
  for (const std::size_t k : most_missed(from)) {
    if (!work.allows()) {
      return std::nullopt;
    }
    Left left = without(from, k);
    left.fit = settled(left.fit, left.points, RivalOf::Other, work);
    if (std::isfinite(left.fit.chi2) && (!best || left.fit.chi2 < best->fit.chi2)) {
      best = std::move(left);
    }
  }
  return best;
}

bool is_told(const Left& left) {
  return fits_well(left.fit.chi2, residual_count(left.points)) &&
         is_what_it_says(left.fit, left.points);
}

}  // namespace

std::optional<FitData> without_gross_touches(const Weighing& weighing, const FitData& data,
                                             WorkBudget& work) {
  const std::size_t n = data.points.size();
  if (!all_lie_apart(data) || weighing.reduced.points.size() != n) {
    return std::nullopt;
  }
  Indices all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Left> classes;
  for (const auto& fit : weighing.coarse) {
    if (fit && !fit->at_limit && (fit->implicit || fit->polynomial->t.size() == n)) {
      classes.push_back({*fit, points_of(*fit, weighing.reduced), all});
      if (is_told(classes.back())) {
        return std::nullopt;
      }
    }
  }
  const Left* told = nullptr;
  for (std::size_t out = 1; told == nullptr && out <= most_set_aside(n); ++out) {
    for (Left& left : classes) {
      if (n < fewest_places(left.fit.curve_class) + 2 * out) {
        continue;  // as many touches must speak for the class as against it
      }
      auto fewer = best_without_one(left, work);
      if (!fewer) {
        continue;
      }
      left = *std::move(fewer);
      if (is_told(left) && (told == nullptr || left.fit.chi2 < told->fit.chi2)) {
        told = &left;
      }
    }
  }
  if (told == nullptr) {
    return std::nullopt;
  }
  std::vector<bool> is_out(n, true);
  for (const std::size_t i : told->numbers) {
    is_out[i] = false;
  }
  return without_points(data, is_out);
}

double log_odds_against_gross(const FitData& data, const FitData& kept) {
  std::size_t gross = 0;
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    gross += data.patches[p].size() == 1 && kept.patches[p].size() == 0 ? 1 : 0;
  }
  return static_cast<double>(gross) * log_odds(1.0 - kGross);
}

}  // namespace palpate

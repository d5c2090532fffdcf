// The arms of the points, for trial directions and vertices of the arm models: semi-cubical
// parabola and spline.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/starts/axis_fit.h"
#include "core/recognition/fit/starts/polynomial_seeds.h"
#include "core/recognition/fit/starts/seed_moments.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// One cell of the coarse search.
struct SeedCell {
  double cost = std::numeric_limits<double>::infinity();
  double theta = 0.0;
  double x0 = 0.0;
};

/// Where a patch comes nearest to the vertex along the axis, and by how much both its ends lie
/// beyond.
struct Turn {
  std::size_t leftmost = 0;
  double depth = 0.0;
};

/// Arms of one patch for one direction and vertex: moments on the positive arm, and where the
/// patch turns round its leftmost point, the index at which it changes arms.
struct PatchArms {
  SeedMoments moments;
  std::size_t change = 0;  ///< first index of the second arm; patch end if there is one arm only
};

/// Trial directions and vertices of semi-cubical parabolas and splines, with the best arms for
/// each.
class ArmSearch {
 public:
  /// Vertices from "at the leftmost point" to "so far away that the arms are graphs", in spans of
  /// the points along the axis. One d spans before the leftmost leaves parameters from r to 1 of
  /// the farthest point's, r^2 = d / (1 + d). A vertex of another r puts the parameter at the near
  /// end off by the difference, and those farther on by less: that is what a walk has to make good.
  /// Between neighbours r differs by 0.16 at most.
  static constexpr std::array kVertexDistances = {0.002, 0.02, 0.06, 0.15, 0.35, 0.8, 1.8, 4.0};

  ArmSearch(std::span<const FitPoint> points, std::span<const PatchSpan> patches)
      : points_(points),
        patches_(patches),
        order_(patches.size()),
        x_(points.size()),
        y_(points.size()),
        w_(points.size()),
        turns_(patches.size()),
        arms_(patches.size()) {
    for (std::size_t p = 0; p < order_.size(); ++p) {
      order_[p] = p;
    }
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return patches[a].size() != patches[b].size() ? patches[a].size() > patches[b].size() : a < b;
    });
    any_lone_ = std::any_of(patches.begin(), patches.end(),
                            [](const PatchSpan& patch) { return patch.size() == 1; });
    settles_arms_ = are_few_touches(points, patches);
    spread_first();
  }

  /// Costs with the best arms for one direction and each vertex of kVertexDistances.
  void search(double theta, SeedCell* semi_cubicals, SeedCell* splines) {
    look_along(theta);
    for (std::size_t v = 0; v < kVertexDistances.size(); ++v) {
      const double x0 = least_ - kVertexDistances[v] * span_;
      SeedCell& semi_cubical = semi_cubicals[v] = {kNone, theta, x0};
      SeedCell& spline = splines[v] = {kNone, theta, x0};
      for_each_pattern(x0, [&](const SeedMoments& sum) {
        const ResidualSums sums = residual_sums(sum, kPowersOfT);
        semi_cubical.cost = std::min(semi_cubical.cost, sums.of_three);
        spline.cost = std::min(spline.cost, sums.of_four);
      });
    }
  }

  /// Sums over patches of all patterns that one vertex is tried with, and for each the residuals'.
  std::size_t sums() const {
    constexpr std::size_t kOfResiduals = 8;  // patches, by its time
    const std::size_t enumerated = std::min(kMostEnumerated, patches_.size());
    const std::size_t once =
        enumerated > 0 ? (patches_.size() + kOfResiduals) << (enumerated - 1) : 0;
    return settles_arms_ ? 2 * once : once;
  }

  /// How many minima are worth a walk.
  std::size_t most_seeds() const {
    return settles_arms_ ? PolynomialSeeds::kFewTouchesSeeds
           : any_lone_   ? PolynomialSeeds::kLoneArmSeeds
                         : PolynomialSeeds::kArmSeeds;
  }

  /// The best arms, point by point, of what `search` has found.
  std::vector<double> best_arms(const AxisFit& seed, WorkBudget& work) {
    work.spend(WorkKind::SeedRow, points_.size() + sums());
    look_along(seed.theta);
    double best = kNone;
    std::vector<double> arms;
    for_each_pattern(seed.x0, [&](const SeedMoments& sum) {
      const ResidualSums sums = residual_sums(sum, kPowersOfT);
      const double cost = seed.model == PolynomialModel::CubicSpline ? sums.of_four : sums.of_three;
      if (cost < best) {
        best = cost;
        arms = point_arms();
      }
    });
    return arms;
  }

 private:
  /// Patches whose arms are tried in all ways; the others get those that suit them. A cubic model
  /// has four coefficients at most, so that four patches apart place it and show the others'; each
  /// more would double the time.
  static constexpr std::size_t kMostEnumerated = 4;
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  /// A spline is a semi-cubical parabola and a linear term.
  static constexpr std::array<std::size_t, 4> kPowersOfT = {0, 2, 3, 1};

  /// Of `order_`, longest first, the first kMostEnumerated: patches that differ by less than twice
  /// in length say most of the curve where they lie far apart, and from longer ones. (By their
  /// order and length, four strokes of one arm had come first, and the only one of the other last.)
  void spread_first() {
    if (order_.size() <= kMostEnumerated) {
      return;
    }
    const auto place_of = [&](std::size_t p) {
      const PatchSpan& patch = patches_[p];
      return points_[patch.begin + patch.size() / 2].position;
    };
    Vec2 middle = Vec2::Zero();
    for (const FitPoint& point : points_) {
      middle += point.position / static_cast<double>(points_.size());
    }
    for (std::size_t k = 0; k < kMostEnumerated; ++k) {
      const std::size_t size = patches_[order_[k]].size();
      if (size == 0) {
        return;
      }
      const auto alike = std::find_if(order_.begin() + static_cast<std::ptrdiff_t>(k), order_.end(),
                                      [&](std::size_t p) { return 2 * patches_[p].size() < size; });
      const auto distance = [&](std::size_t p) {
        double least =
            k == 0 ? (place_of(p) - middle).squaredNorm() : std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < k; ++j) {
          least = std::min(least, (place_of(p) - place_of(order_[j])).squaredNorm());
        }
        return least;
      };
      const auto next = order_.begin() + static_cast<std::ptrdiff_t>(k);
      const auto farthest = std::max_element(
          next, alike, [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
      std::rotate(next, farthest, farthest + 1);
    }
  }

  void look_along(double theta) {
    const Vec2 axis(std::cos(theta), std::sin(theta));
    least_ = std::numeric_limits<double>::infinity();
    double most = -least_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      x_[i] = points_[i].position.dot(axis);
      y_[i] = cross(axis, points_[i].position);
      const double weight = points_[i].inverse_sigma * verticality(points_[i], axis);
      w_[i] = weight * weight;
      least_ = std::min(least_, x_[i]);
      most = std::max(most, x_[i]);
    }
    span_ = most - least_;
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      const PatchSpan& patch = patches_[p];
      if (patch.size() == 0) {
        continue;  // every sample of it was set aside as a spike
      }
      std::size_t leftmost = patch.begin;
      for (std::size_t i = patch.begin; i < patch.end; ++i) {
        leftmost = x_[i] < x_[leftmost] ? i : leftmost;
      }
      turns_[p] = {leftmost, std::min(x_[patch.begin], x_[patch.end - 1]) - x_[leftmost]};
    }
  }

  /// Calls `function` with the moments of all points for each pattern of arms, signs_ being the
  /// patches'.
  template <typename Function>
  void for_each_pattern(double x0, const Function& function) {
    for (std::size_t p = 0; p < arms_.size(); ++p) {
      arms_[p] = patch_arms(p, x0);
    }
    const std::size_t enumerated = std::min(kMostEnumerated, arms_.size());
    if (enumerated == 0) {
      return;
    }
    signs_.assign(arms_.size(), 1.0);
    // The first patch's arm is a matter of convention (t -> -t).
    for (unsigned pattern = 0; pattern < (1U << (enumerated - 1)); ++pattern) {
      SeedMoments sum;
      for (std::size_t k = 0; k < enumerated; ++k) {
        const double sign = k > 0 && ((pattern >> (k - 1)) & 1U) != 0 ? -1.0 : 1.0;
        signs_[order_[k]] = sign;
        sum.add(arms_[order_[k]].moments, sign);
      }
      if (enumerated < order_.size()) {
        const std::array<double, 4> y = coefficients(sum);
        for (std::size_t k = enumerated; k < order_.size(); ++k) {
          add_on_better_arm(order_[k], y, &sum);
        }
      }
      function(sum);
      if (settles_arms_ && settle_arms(&sum)) {
        function(sum);
      }
    }
  }

  /// Gives every patch the arm that suits the curve through all of them. A curve through four
  /// touches leads past the others where these lie far from the four. Returns whether any changed.
  bool settle_arms(SeedMoments* sum) {
    const std::array<double, 4> y = coefficients(*sum);
    const std::vector<double> before = signs_;
    *sum = SeedMoments();
    for (std::size_t p = 0; p < arms_.size(); ++p) {
      add_on_better_arm(p, y, sum);
    }
    return signs_ != before;
  }

  /// `y`: the coefficients of y(t).
  void add_on_better_arm(std::size_t patch, const std::array<double, 4>& y, SeedMoments* sum) {
    const SeedMoments& moments = arms_[patch].moments;
    signs_[patch] = advantage_of_positive_arm(moments, y) >= 0.0 ? 1.0 : -1.0;
    sum->add(moments, signs_[patch]);
  }

  PatchArms patch_arms(std::size_t p, double x0) const {
    const PatchSpan& patch = patches_[p];
    if (patch.size() == 0) {
      return {SeedMoments(), patch.end};
    }
    // A patch that turns round its leftmost point near the vertex passes from arm to arm there.
    // Of the span of all points: between the second and the third of the vertices tried.
    constexpr double kNearVertex = 0.03;
    const auto [leftmost, depth] = turns_[p];
    const bool turns = x_[leftmost] - x0 < kNearVertex * span_ && depth > 0.0;
    const std::size_t change = turns ? leftmost + 1 : patch.end;
    SeedMoments moments;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      const double t2 = x_[i] - x0;
      const double t = std::sqrt(t2);
      moments.add(w_[i], i < change ? t : -t, t2, y_[i]);
    }
    return {moments, change};
  }

  std::vector<double> point_arms() const {
    std::vector<double> result(points_.size());
    for (std::size_t p = 0; p < arms_.size(); ++p) {
      for (std::size_t i = patches_[p].begin; i < patches_[p].end; ++i) {
        result[i] = i < arms_[p].change ? signs_[p] : -signs_[p];
      }
    }
    return result;
  }

  std::span<const FitPoint> points_;
  std::span<const PatchSpan> patches_;
  std::vector<std::size_t> order_;
  bool any_lone_ = false;      ///< patches of a single point
  bool settles_arms_ = false;  ///< once more, by the curve through all
  // Along the axis last looked along:
  std::vector<double> x_, y_, w_;
  double least_ = 0.0;  ///< of x_
  double span_ = 0.0;   ///< of x_
  std::vector<Turn> turns_;
  // For the vertex last tried:
  std::vector<PatchArms> arms_;
  std::vector<double> signs_;
};

}  // namespace palpate

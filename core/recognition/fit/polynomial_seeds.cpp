#include "core/recognition/fit/polynomial_seeds.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/numerics/small_cholesky.h"

namespace palpate {
namespace {

double square(double x) { return x * x; }

/// Weighted moments for a least-squares polynomial in u of degree 3: sums of w u^k, w v u^k. An
/// even and an odd power at a time: two doubles are one operation.
struct Moments {
  using Pair = Eigen::Array2d;
  std::array<Pair, 4> u = {Pair::Zero(), Pair::Zero(), Pair::Zero(), Pair::Zero()};
  std::array<Pair, 2> vu = {Pair::Zero(), Pair::Zero()};
  double vv = 0.0;

  /// `x2` is x^2.
  void add(double w, double x, double x2, double v) {
    Pair powers(w, w * x);
    vv += w * v * v;
    u[0] += powers;
    vu[0] += v * powers;
    powers *= x2;
    u[1] += powers;
    vu[1] += v * powers;
    powers *= x2;
    u[2] += powers;
    powers *= x2;
    u[3] += powers;
  }

  /// Adds another patch's moments, taken on the arm of the given sign: u -> sign u.
  void add(const Moments& other, double sign) {
    const Pair signs(1.0, sign);
    for (std::size_t k = 0; k < 4; ++k) {
      u[k] += signs * other.u[k];
    }
    for (std::size_t k = 0; k < 2; ++k) {
      vu[k] += signs * other.vu[k];
    }
    vv += other.vv;
  }

  double of_u(std::size_t k) const { return u[k / 2][static_cast<Eigen::Index>(k % 2)]; }
  double of_vu(std::size_t k) const { return vu[k / 2][static_cast<Eigen::Index>(k % 2)]; }
};

/// Near-empty directions (all points alike) must not blow up: a ridge at the level of rounding.
constexpr double kRidge = 1e-12;

/// Sums of squares that two models leave, one of which has a power more.
struct ResidualSums {
  double of_three = std::numeric_limits<double>::infinity();
  double of_four = std::numeric_limits<double>::infinity();
};

/// Least squares of v over the first three and over all four of the powers of u, in the order
/// given.
ResidualSums residual_sums(const Moments& m, const std::array<std::size_t, 4>& powers) {
  constexpr std::size_t kRight = 4;
  // Gaussian elimination of the normal equations: each pivot takes its part off the sum of squares.
  std::array<std::array<double, 5>, 4> rows;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i; j < 4; ++j) {
      rows[i][j] = m.of_u(powers[i] + powers[j]);
    }
    rows[i][i] += kRidge * m.of_u(2 * powers[i]);
    rows[i][kRight] = m.of_vu(powers[i]);
  }
  const auto at_least_zero = [](double cost) {
    return std::isfinite(cost) ? std::max(cost, 0.0) : std::numeric_limits<double>::infinity();
  };
  ResidualSums sums;
  double cost = m.vv;
  for (std::size_t k = 0; k < 4; ++k) {
    if (rows[k][k] > 0.0) {
      const double inverse = 1.0 / rows[k][k];
      for (std::size_t i = k + 1; i < 4; ++i) {
        const double factor = rows[k][i] * inverse;
        for (std::size_t j = i; j <= kRight; ++j) {
          rows[i][j] -= factor * rows[k][j];
        }
      }
      cost -= rows[k][kRight] * rows[k][kRight] * inverse;
    }
    if (k == 2) {
      sums.of_three = at_least_zero(cost);
    }
  }
  sums.of_four = at_least_zero(cost);
  return sums;
}

/// Least squares of v over all four powers of u, the coefficient of u^k at k.
std::array<double, 4> coefficients(const Moments& m) {
  Eigen::Matrix4d normal;
  Eigen::Vector4d right;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < 4; ++j) {
      normal(row, static_cast<Eigen::Index>(j)) = m.of_u(i + j);
    }
    normal(row, row) *= 1.0 + kRidge;
    right[row] = m.of_vu(i);
  }
  Eigen::Matrix4d factor;
  if (!cholesky(normal, &factor)) {
    return {};
  }
  const Eigen::Vector4d y = solve_cholesky(factor, right);
  return {y[0], y[1], y[2], y[3]};
}

/// By how much of the sum of squares a patch, its moments taken on the positive arm, fits there
/// better than on the negative one, over 4. With the even part e and the odd part o of y(u) the
/// residuals are v - e - o and v - e + o: the sum of w o (v - e).
double advantage_of_positive_arm(const Moments& m, const std::array<double, 4>& y) {
  return y[1] * (m.of_vu(1) - y[0] * m.of_u(1) - y[2] * m.of_u(3)) +
         y[3] * (m.of_vu(3) - y[0] * m.of_u(3) - y[2] * m.of_u(5));
}

/// One cell of the coarse search.
struct Candidate {
  double cost = std::numeric_limits<double>::infinity();
  double theta = 0.0;
  double x0 = 0.0;
};

/// Appends the best local minima over a grid of directions (circular, outer index) and vertices
/// (inner index, `vertices` each), best first; without arms.
void take_minima(const std::vector<Candidate>& grid, std::size_t vertices, std::size_t most,
                 PolynomialModel model, std::vector<AxisFit>* seeds) {
  std::vector<const Candidate*> minima;
  const std::size_t directions = grid.size() / vertices;
  const auto is_minimum = [&](std::size_t d, std::size_t v) {
    const Candidate& here = grid[d * vertices + v];
    for (std::size_t dd : {d + directions - 1, d, d + 1}) {
      for (std::size_t vv = v > 0 ? v - 1 : v; vv <= std::min(v + 1, vertices - 1); ++vv) {
        const Candidate& there = grid[(dd % directions) * vertices + vv];
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
            [](const Candidate* a, const Candidate* b) { return a->cost < b->cost; });
  minima.resize(std::min(most, minima.size()));
  for (const Candidate* minimum : minima) {
    seeds->push_back({model, minimum->theta, minimum->x0, {}, minimum->cost});
  }
}

/// Where a patch comes nearest to the vertex along the axis, and by how much both its ends lie
/// beyond.
struct Turn {
  std::size_t leftmost = 0;
  double depth = 0.0;
};

/// Arms of one patch for one direction and vertex: moments on the positive arm, and where the
/// patch turns round its leftmost point, the index at which it changes arms.
struct PatchArms {
  Moments moments;
  std::size_t change = 0;  ///< first index of the second arm; patch end if there is one arm only
};

class ArmSearch {
 public:
  /// Vertices from "at the leftmost point" to "so far away that the arms are graphs", in spans of
  /// the points along the axis.
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
  }

  /// Costs with the best arms for one direction and each vertex of kVertexDistances.
  void search(double theta, Candidate* semi_cubicals, Candidate* splines) {
    look_along(theta);
    for (std::size_t v = 0; v < kVertexDistances.size(); ++v) {
      const double x0 = least_ - kVertexDistances[v] * span_;
      Candidate& semi_cubical = semi_cubicals[v] = {kNone, theta, x0};
      Candidate& spline = splines[v] = {kNone, theta, x0};
      for_each_pattern(x0, [&](const Moments& sum) {
        const ResidualSums sums = residual_sums(sum, kPowersOfT);
        semi_cubical.cost = std::min(semi_cubical.cost, sums.of_three);
        spline.cost = std::min(spline.cost, sums.of_four);
      });
    }
  }

  /// The best arms, point by point, of what `search` has found.
  std::vector<double> best_arms(const AxisFit& seed) {
    look_along(seed.theta);
    double best = kNone;
    std::vector<double> arms;
    for_each_pattern(seed.x0, [&](const Moments& sum) {
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
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  /// A spline is a semi-cubical parabola and a linear term.
  static constexpr std::array<std::size_t, 4> kPowersOfT = {0, 2, 3, 1};

  void look_along(double theta) {
    const Vec2 axis(std::cos(theta), std::sin(theta));
    least_ = std::numeric_limits<double>::infinity();
    double most = -least_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      x_[i] = points_[i].position.dot(axis);
      y_[i] = cross(axis, points_[i].position);
      w_[i] = square(points_[i].inverse_sigma * verticality(points_[i], axis));
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
    constexpr std::size_t kMostEnumerated = 4;
    const std::size_t enumerated = std::min(kMostEnumerated, arms_.size());
    signs_.assign(arms_.size(), 1.0);
    // The first patch's arm is a matter of convention (t -> -t).
    for (unsigned pattern = 0; pattern < (1U << (enumerated - 1)); ++pattern) {
      Moments sum;
      for (std::size_t k = 0; k < enumerated; ++k) {
        const double sign = k > 0 && ((pattern >> (k - 1)) & 1U) != 0 ? -1.0 : 1.0;
        signs_[order_[k]] = sign;
        sum.add(arms_[order_[k]].moments, sign);
      }
      if (enumerated < order_.size()) {
        const std::array<double, 4> y = coefficients(sum);
        for (std::size_t k = enumerated; k < order_.size(); ++k) {
          const Moments& moments = arms_[order_[k]].moments;
          const double sign = advantage_of_positive_arm(moments, y) >= 0.0 ? 1.0 : -1.0;
          signs_[order_[k]] = sign;
          sum.add(moments, sign);
        }
      }
      function(sum);
    }
  }

  PatchArms patch_arms(std::size_t p, double x0) const {
    const PatchSpan& patch = patches_[p];
    if (patch.size() == 0) {
      return {Moments(), patch.end};
    }
    // A patch that turns round its leftmost point near the vertex passes from arm to arm there.
    // Of the span of all points: between the second and the third of the vertices tried.
    constexpr double kNearVertex = 0.03;
    const auto [leftmost, depth] = turns_[p];
    const bool turns = x_[leftmost] - x0 < kNearVertex * span_ && depth > 0.0;
    const std::size_t change = turns ? leftmost + 1 : patch.end;
    Moments moments;
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
  // Along the axis last looked along:
  std::vector<double> x_, y_, w_;
  double least_ = 0.0;  ///< of x_
  double span_ = 0.0;   ///< of x_
  std::vector<Turn> turns_;
  // For the vertex last tried:
  std::vector<PatchArms> arms_;
  std::vector<double> signs_;
};

}  // namespace

void add_graph_seeds(std::span<const FitPoint> points, PolynomialSeeds* seeds) {
  constexpr std::size_t kDirections =
      72;  // 2.5 degrees: minima are narrow where there is little noise
  std::vector<Candidate> parabolas(kDirections);
  std::vector<Candidate> cubics(kDirections);
  for (std::size_t d = 0; d < kDirections; ++d) {
    const double theta = kPi * static_cast<double>(d) / static_cast<double>(kDirections);
    const Vec2 axis(std::cos(theta), std::sin(theta));
    Moments moments;
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
                   PolynomialSeeds* seeds) {
  constexpr std::size_t kDirections = 48;  // 7.5 degrees
  constexpr std::size_t kVertices = ArmSearch::kVertexDistances.size();
  ArmSearch search(points, patches);
  std::vector<Candidate> semi_cubicals(kDirections * kVertices);
  std::vector<Candidate> splines(kDirections * kVertices);
  for (std::size_t d = 0; d < kDirections; ++d) {
    const double theta = 2.0 * kPi * static_cast<double>(d) / static_cast<double>(kDirections);
    search.search(theta, &semi_cubicals[d * kVertices], &splines[d * kVertices]);
  }
  take_minima(semi_cubicals, kVertices, PolynomialSeeds::kArmSeeds,
              PolynomialModel::SemiCubicalParabola, &seeds->semi_cubical_parabola);
  take_minima(splines, kVertices, PolynomialSeeds::kArmSeeds, PolynomialModel::CubicSpline,
              &seeds->cubic_spline);
  for (auto* found : {&seeds->semi_cubical_parabola, &seeds->cubic_spline}) {
    for (AxisFit& seed : *found) {
      seed.arms = search.best_arms(seed);
    }
  }
}

}  // namespace palpate

// Orthogonal distances from a polynomial curve, as a problem for levenberg_marquardt.h.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/fit/orthogonal/polynomial_foot.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The powers of t of a model. Up to SE(2) and an affine change of t these are exactly the
/// canonical classes (core/README.md, "Refinement and the bound"): no class has a singular limit in
/// these coefficients.
enum class PolynomialModel {
  Parabola,             ///< 1, t, t^2
  CubicalParabola,      ///< 1, t, t^3
  SemiCubicalParabola,  ///< 1, t^2, t^3
  CubicSpline,          ///< 1, t, t^2, t^3
};

template <PolynomialModel kModel>
constexpr auto exponents_of_model() {
  if constexpr (kModel == PolynomialModel::Parabola) {
    return std::array{0, 1, 2};
  } else if constexpr (kModel == PolynomialModel::CubicalParabola) {
    return std::array{0, 1, 3};
  } else if constexpr (kModel == PolynomialModel::SemiCubicalParabola) {
    return std::array{0, 2, 3};
  } else {
    return std::array{0, 1, 2, 3};
  }
}

inline PointOf point_of(const FitPoint& point) {
  return point.offset > 0.0 ? PointOf::Tip : PointOf::Surface;
}

/// The curve at a foot point.
inline NormalAtFoot normal_at(const PolynomialCoefficients& c, const PlacedPoint& foot) {
  NormalAtFoot at;
  at.first = first_derivative(c, foot.t);
  at.second = second_derivative(c, foot.t);
  const double speed = at.speed();
  at.normal = speed > 0.0 ? Vec2(left_of(at.first) / speed) : Vec2::Zero();
  at.distance = foot.signed_distance;
  return at;
}

/// Weight of a point's measured normal for this curve; 0 if its foot cannot be followed.
inline double weight_of_normal(const PolynomialCoefficients& c, const PlacedPoint& foot,
                               const FitPoint& point) {
  const NormalAtFoot at = normal_at(c, foot);
  return at.is_followed() ? normal_weight(point, at.turn_along()) : 0.0;
}

/// What a point's measured normal, of that weight, leaves at its foot.
inline double normal_residual(const PolynomialCoefficients& c, const PlacedPoint& foot,
                              const FitPoint& point) {
  return weight_of_normal(c, foot, point) * normal_miss(point.normal, normal_at(c, foot).normal);
}

/// Points farther from the curve than noise. Their feet may have been followed to the wrong arm of
/// a bend or cusp, where the steps end whatever the curve does. Empty if there are many: the curve
/// itself is wrong. `residual_of`: point `i`'s, in standard deviations.
template <typename ResidualOf>
std::vector<std::size_t> few_far_points(std::size_t count, const ResidualOf& residual_of) {
  constexpr double kFar = 3.0;  // good points exceed it once in 370
  constexpr std::size_t kOneFarIn = 10;
  std::vector<std::size_t> far;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(residual_of(i)) > kFar) {
      far.push_back(i);
      if (kOneFarIn * far.size() > count + kOneFarIn) {
        return {};
      }
    }
  }
  return far;
}

/// Orthogonal distances as functions of the model's coefficients, for `minimise`.
template <PolynomialModel kModel>
class PolynomialProblem {
 public:
  static constexpr auto kExponents = exponents_of_model<kModel>();
  static constexpr int kPowers = static_cast<int>(kExponents.size());
  static constexpr int kParameters = 2 * kPowers;
  using Vector = Eigen::Matrix<double, kParameters, 1>;
  using Matrix = Eigen::Matrix<double, kParameters, kParameters>;

  /// `t`: a parameter near each point's foot point.
  PolynomialProblem(std::span<const FitPoint> points, std::span<const double> t, int side)
      : points_(points),
        side_(side),
        feet_(points.size()),
        tried_feet_(points.size()),
        last_step_(last_foot_step(least_sigma(points))) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      feet_[i].t = t[i];
    }
  }

  static PolynomialCoefficients coefficients(const Vector& x) {
    PolynomialCoefficients c = PolynomialCoefficients::Zero();
    for (int k = 0; k < kPowers; ++k) {
      c.col(exponent(k)) = x.template segment<2>(2 * k);
    }
    return c;
  }

  static Vector parameters(const PolynomialCoefficients& c) {
    Vector x;
    for (int k = 0; k < kPowers; ++k) {
      x.template segment<2>(2 * k) = c.col(exponent(k));
    }
    return x;
  }

  /// Sets the weights of measured normals from this curve; they stay fixed for trial curves.
  /// Without this call normals do not count.
  void weigh_normals(const Vector& x) {
    normals_.clear();
    const PolynomialCoefficients c = coefficients(x);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (has_normal(points_[i])) {
        const PlacedPoint foot =
            follow_foot_point(c, points_[i].position, feet_[i].t, last_step_, point_of(points_[i]));
        normals_.push_back({i, weight_of_normal(c, foot, points_[i])});
      }
    }
  }

  double chi2_at(const Vector& x) {
    tried_ = coefficients(x);
    double chi2 = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      tried_feet_[i] = follow_foot_point(tried_, points_[i].position, feet_[i].t, last_step_,
                                         point_of(points_[i]));
      const double residual = residual_at(tried_feet_[i], i);
      chi2 += residual * residual;
    }
    for (const WeighedNormal& of : normals_) {
      const double residual =
          miss_at(normal_at(tried_, tried_feet_[of.point]), of.point) * of.weight;
      chi2 += residual * residual;
    }
    return chi2;
  }

  /// Makes the last trial the current state. A rejected trial must not move the foot points from
  /// which the next one starts.
  void accept() {
    coefficients_ = tried_;
    feet_.swap(tried_feet_);
  }

  std::vector<std::size_t> far_points() const {
    return few_far_points(points_.size(), [&](std::size_t i) { return residual_at(feet_[i], i); });
  }

  /// Follows the feet of far points, and of their neighbours, again from the feet of the points
  /// touched before and after: a stroke does not leap from arm to arm. Returns by how much that
  /// lowers chi-square.
  double seek_feet() {
    const std::vector<std::size_t> far = far_points();
    std::vector<bool> doubtful(far.empty() ? 0 : points_.size(), false);
    for (const std::size_t i : far) {
      doubtful[i] = true;
    }
    double lowered = 0.0;
    for (const std::size_t i : far) {
      double by = seek_foot(i, doubtful);
      doubtful[i] = !(by > 0.0);
      lowered += by;
      // Its neighbours may be on the wrong arm too, by less.
      for (std::size_t k = i; by > 0.0 && k > 0; lowered += by) {
        by = seek_foot(--k, doubtful);
      }
      by = doubtful[i] ? 0.0 : 1.0;
      for (std::size_t k = i + 1; by > 0.0 && k < points_.size(); ++k) {
        by = seek_foot(k, doubtful);
        lowered += by;
      }
    }
    return lowered;
  }

  /// By the envelope theorem a residual changes by -n . (1, t, t^2, t^3). So all of J^T J follows
  /// from the sums of n n^T t^k over the points.
  void linearise(Matrix* information, Vector* gradient) const {
    constexpr int kSums = 2 * kExponents.back() + 1;
    Eigen::Matrix<double, 3, kSums> squares = Eigen::Matrix<double, 3, kSums>::Zero();
    Eigen::Matrix<double, 2, kExponents.back() + 1> sums;
    sums.setZero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const PlacedPoint& foot = feet_[i];
      const double weight = points_[i].inverse_sigma;
      const Vec2 n = weight * foot.normal;
      Eigen::Vector3d square(n.x() * n.x(), n.x() * n.y(), n.y() * n.y());
      Vec2 pull = -residual_at(foot, i) * n;
      for (int k = 0; k < kSums; ++k) {
        squares.col(k) += square;
        square *= foot.t;
      }
      for (int k = 0; k <= kExponents.back(); ++k) {
        sums.col(k) += pull;
        pull *= foot.t;
      }
    }
    for (int j = 0; j < kPowers; ++j) {
      gradient->template segment<2>(2 * j) = sums.col(exponent(j));
      for (int k = 0; k < kPowers; ++k) {
        const auto s = squares.col(exponent(j) + exponent(k));
        information->template block<2, 2>(2 * j, 2 * k) << s[0], s[1], s[1], s[2];
      }
    }
    if (!normals_.empty()) {
      linearise_normals(information, gradient);
    }
  }

  /// J^T r'' for a step. The foot point moves with the curve and the normal turns: r'' of
  /// core/README.md, "Refinement and the bound", step 4.
  Vector bend(const Vector& step) const {
    const PolynomialCoefficients v = coefficients(step);
    Eigen::Matrix<double, 2, kExponents.back() + 1> sums;
    sums.setZero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const PlacedPoint& foot = feet_[i];
      const Vec2 first = first_derivative(coefficients_, foot.t);
      const Vec2 second = second_derivative(coefficients_, foot.t);
      const double speed2 = first.squaredNorm();
      const Vec2 away = foot.signed_distance * foot.normal;
      const double slope = speed2 - away.dot(second);
      if (!(slope >= kLeastFootSlope * speed2) || speed2 <= 0.0) {
        continue;  // no foot point to follow
      }
      const Vec2 shift = position_at(v, foot.t);
      const Vec2 shift_by_t = first_derivative(v, foot.t);
      const double t_rate = (away.dot(shift_by_t) - shift.dot(first)) / slope;
      const double turn = foot.normal.dot(second * t_rate + shift_by_t);  // times the speed
      const double weight = points_[i].inverse_sigma;
      const double second_residual =
          weight * (turn * shift.dot(first) / speed2 - t_rate * foot.normal.dot(shift_by_t));
      Vec2 pull = -second_residual * weight * foot.normal;
      for (int k = 0; k <= kExponents.back(); ++k) {
        sums.col(k) += pull;
        pull *= foot.t;
      }
    }
    Vector gradient;
    for (int j = 0; j < kPowers; ++j) {
      gradient.template segment<2>(2 * j) = sums.col(exponent(j));
    }
    return gradient;
  }

  /// Parameters of the foot points.
  std::vector<double> t() const {
    std::vector<double> t;
    t.reserve(feet_.size());
    for (const PlacedPoint& foot : feet_) {
      t.push_back(foot.t);
    }
    return t;
  }

 private:
  static constexpr int exponent(int k) { return kExponents[static_cast<std::size_t>(k)]; }

  /// Parameters of the nearest feet before and after that are not doubtful; of the other one where
  /// one side has none, and of point `i` if there are none.
  std::array<double, 2> parameters_beside(std::size_t i, const std::vector<bool>& doubtful) const {
    std::size_t before = i;
    while (before > 0 && (before == i || doubtful[before])) {
      --before;
    }
    std::size_t after = i;
    while (after + 1 < feet_.size() && (after == i || doubtful[after])) {
      ++after;
    }
    if (before == i || doubtful[before]) before = after;
    if (after == i || doubtful[after]) after = before;
    return {feet_[before].t, feet_[after].t};
  }

  /// seek_feet for one point. From half way, and from the feet on either side: half way between two
  /// arms may be the cusp, where every way ends, and the foot is on one of them.
  double seek_foot(std::size_t i, const std::vector<bool>& doubtful) {
    constexpr double kSame = 1e-2;  // of chi-square: a tenth of a standard deviation
    const auto [from, to] = parameters_beside(i, doubtful);
    const double before = residual_at(feet_[i], i);
    double least = before * before - kSame;
    for (const double t : {0.5 * (from + to), from, to}) {
      const PlacedPoint foot = follow_foot_point(coefficients_, points_[i].position, t, last_step_,
                                                 point_of(points_[i]));
      const double after = residual_at(foot, i);
      if (after * after < least) {
        least = after * after;
        feet_[i] = foot;
      }
    }
    const double lowered = before * before - least;
    return lowered > kSame ? lowered : 0.0;
  }

  double residual_at(const PlacedPoint& foot, std::size_t i) const {
    return (foot.signed_distance - side_ * points_[i].offset) * points_[i].inverse_sigma;
  }

  [[gnu::noinline]] void linearise_normals(Matrix* information, Vector* gradient) const {
    for (const WeighedNormal& of : normals_) {
      const NormalAtFoot at = normal_at(coefficients_, feet_[of.point]);
      if (!at.is_followed()) {
        continue;
      }
      const double t = feet_[of.point].t;
      const std::array<double, 4> powers{1.0, t, t * t, t * t * t};
      Vector row;
      for (int j = 0; j < kPowers; ++j) {
        const auto k = static_cast<std::size_t>(exponent(j));
        const double by_t = k > 0 ? static_cast<double>(k) * powers[k - 1] : 0.0;
        for (int d = 0; d < 2; ++d) {
          row[2 * j + d] = of.weight * at.turn_by(powers[k] * Vec2::Unit(d), by_t * Vec2::Unit(d));
        }
      }
      information->noalias() += row.lazyProduct(row.transpose());
      *gradient += of.weight * miss_at(at, of.point) * row;
    }
  }

  /// 0 at a cusp, where the curve has no normal.
  double miss_at(const NormalAtFoot& at, std::size_t i) const {
    return at.normal.isZero(0.0) ? 0.0 : normal_miss(points_[i].normal, at.normal);
  }

  std::span<const FitPoint> points_;
  std::vector<WeighedNormal> normals_;
  int side_;
  PolynomialCoefficients coefficients_;  ///< current state
  std::vector<PlacedPoint> feet_;
  PolynomialCoefficients tried_;  ///< last trial
  std::vector<PlacedPoint> tried_feet_;
  double last_step_;  ///< of foot points
};

}  // namespace palpate

#include "core/recognition/polynomial_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/recognition/least_squares.h"

namespace palpate {
namespace {

template <PolynomialModel kModel>
constexpr auto exponents() {
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

/// Follows the foot point of `p` by Newton's method on (C(t) - p) . C'(t) = 0 from `t`.
PlacedPoint follow_foot_point(const PolynomialCoefficients& c, const Vec2& p, double t) {
  constexpr int kMaxIterations = 5;
  constexpr double kLastStep = 1e-5;    // after it the error is its square
  constexpr double kLongestStep = 0.5;  // of the data's parameter range, about [-1, 1]
  Vec2 away;
  Vec2 first;
  bool last = false;
  for (int iteration = 0;; ++iteration) {
    away = p - (c.col(0) + t * (c.col(1) + t * (c.col(2) + t * c.col(3))));
    first = c.col(1) + t * (2.0 * c.col(2) + 3.0 * t * c.col(3));
    const double speed2 = first.squaredNorm();
    if (last || iteration == kMaxIterations || speed2 <= 0.0) {
      break;
    }
    const Vec2 second = 2.0 * c.col(2) + 6.0 * t * c.col(3);
    double slope = speed2 - away.dot(second);
    if (slope < 0.1 * speed2) {
      slope = speed2;  // beyond the centre of curvature: a Gauss-Newton step is safe
    }
    const double step = std::clamp(away.dot(first) / slope, -kLongestStep, kLongestStep);
    last = std::abs(step) < kLastStep;
    t += step;
  }
  PlacedPoint placed;
  placed.t = t;
  const double speed = first.norm();
  const double distance = away.norm();
  if (speed > 0.0) {
    placed.normal = left_of(first) / speed;
    placed.signed_distance = away.dot(placed.normal);
  }
  // At a cusp, or where the foot point is not stationary, the normal does not point along the
  // distance: take the distance itself.
  constexpr double kPerpendicular = 0.9;
  if (std::abs(placed.signed_distance) < kPerpendicular * distance) {
    placed.normal = away / distance;
    placed.signed_distance = distance;
  }
  return placed;
}

template <PolynomialModel kModel>
class PolynomialResiduals {
 public:
  static constexpr auto kExponents = exponents<kModel>();
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 2 * static_cast<int>(kExponents.size()) };
  using Parameters = Eigen::Matrix<double, NUM_PARAMETERS, 1>;

  PolynomialResiduals(std::span<const FitPoint> points, std::vector<double> t, int side)
      : points_(points), side_(side), t_accepted_(std::move(t)), feet_(points.size()) {
    trial_.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

  int NumResiduals() const { return static_cast<int>(points_.size()); }

  static PolynomialCoefficients coefficients(const Parameters& x) {
    PolynomialCoefficients c = PolynomialCoefficients::Zero();
    for (std::size_t k = 0; k < kExponents.size(); ++k) {
      c.col(kExponents[k]) = x.template segment<2>(2 * static_cast<Eigen::Index>(k));
    }
    return c;
  }

  static Parameters parameters(const PolynomialCoefficients& c) {
    Parameters x;
    for (std::size_t k = 0; k < kExponents.size(); ++k) {
      x.template segment<2>(2 * static_cast<Eigen::Index>(k)) = c.col(kExponents[k]);
    }
    return x;
  }

  // The solver asks for residuals alone at a trial step and for the Jacobian at accepted ones: a
  // rejected trial must not move the foot points that the next one starts from, and an accepted one
  // has found them already.
  bool operator()(const double* x_data, double* residuals, double* jacobian) const {
    const Parameters x = Eigen::Map<const Parameters>(x_data);
    const std::size_t n = points_.size();
    if (jacobian == nullptr || x != trial_) {
      const PolynomialCoefficients c = coefficients(x);
      for (std::size_t i = 0; i < n; ++i) {
        feet_[i] = follow_foot_point(c, points_[i].position, t_accepted_[i]);
      }
      trial_ = x;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const FitPoint& point = points_[i];
      residuals[i] = (feet_[i].signed_distance - side_ * point.offset) * point.inverse_sigma;
    }
    if (jacobian == nullptr) {
      return true;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double t = feet_[i].t;
      t_accepted_[i] = t;
      const double powers[4] = {1.0, t, t * t, t * t * t};
      const double nx = -feet_[i].normal.x() * points_[i].inverse_sigma;
      const double ny = -feet_[i].normal.y() * points_[i].inverse_sigma;
      for (std::size_t k = 0; k < kExponents.size(); ++k) {
        const double power = powers[kExponents[k]];
        jacobian[2 * k * n + i] = nx * power;
        jacobian[(2 * k + 1) * n + i] = ny * power;
      }
    }
    return true;
  }

  std::vector<double> take_t() { return std::move(t_accepted_); }

 private:
  std::span<const FitPoint> points_;
  int side_;
  mutable std::vector<double> t_accepted_;
  mutable std::vector<PlacedPoint> feet_;  ///< at trial_
  mutable Parameters trial_;
};

template <PolynomialModel kModel>
PolynomialFit refine(std::span<const FitPoint> points, PolynomialFit start, int side,
                     const RefineEffort& effort) {
  using Residuals = PolynomialResiduals<kModel>;
  Residuals residuals(points, std::move(start.t), side);
  ceres::TinySolver<Residuals> solver{};
  solver.options = least_squares_options<Residuals>(effort.iterations, effort.chi2_tolerance);
  typename Residuals::Parameters x = Residuals::parameters(start.coefficients);
  PolynomialFit fit;
  fit.chi2 = std::numeric_limits<double>::infinity();
  // The solver also stops where a step is refused for next to nothing, as happens along the
  // directions that affine changes of t leave free. Starting afresh, with the scaling and damping
  // of the new place, tells a stop from an optimum.
  constexpr double kSettled = 1e-5;  // of chi-square
  // Where the points scatter far less than their stated noise (exact data, noise estimated from a
  // smooth model that bends too little), what is left to gain is to be seen beside what is left at
  // all.
  constexpr double kExact = 1e-3;  // of the chi-square that noise would leave
  constexpr int kMoreStarts = 2;
  const double n = static_cast<double>(points.size());
  const auto is_exact = [&] { return fit.chi2 < kExact * n; };
  for (int start_number = 0;
       start_number < effort.starts || (is_exact() && start_number < effort.starts + kMoreStarts);
       ++start_number) {
    const double left = start_number > 0 && is_exact() ? fit.chi2 / n : 1.0;
    solver.options.function_tolerance = left * effort.chi2_tolerance;
    const auto& summary = solver.Solve(residuals, &x);
    const double chi2 = 2.0 * summary.final_cost;
    if (start_number == 0) {
      fit.chi2 = 2.0 * summary.initial_cost;
    }
    fit.iterations += summary.iterations;
    const bool settled =
        !(chi2 < fit.chi2 - left * kSettled) && (start_number > 0 || !(chi2 < kExact * n));
    fit.chi2 = std::min(fit.chi2, chi2);
    if (settled || !std::isfinite(chi2)) {
      break;
    }
  }
  fit.coefficients = Residuals::coefficients(x);
  fit.side = side;
  fit.t = residuals.take_t();
  return fit;
}

template <PolynomialModel kModel>
Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> spectrum(std::span<const FitPoint> points,
                                                           const PolynomialFit& fit) {
  using Residuals = PolynomialResiduals<kModel>;
  constexpr int kParameters = Residuals::NUM_PARAMETERS;
  const Residuals residuals(points, fit.t, fit.side);
  const typename Residuals::Parameters x = Residuals::parameters(fit.coefficients);
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd values(n);
  Eigen::Matrix<double, Eigen::Dynamic, kParameters> jacobian(n, kParameters);
  residuals(x.data(), values.data(), jacobian.data());
  const Eigen::Matrix<double, kParameters, kParameters> information =
      jacobian.transpose() * jacobian;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kParameters, kParameters>> solver(
      information, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

}  // namespace

Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> polynomial_information(
    PolynomialModel model, std::span<const FitPoint> points, const PolynomialFit& fit) {
  switch (model) {
    case PolynomialModel::Parabola:
      return spectrum<PolynomialModel::Parabola>(points, fit);
    case PolynomialModel::CubicalParabola:
      return spectrum<PolynomialModel::CubicalParabola>(points, fit);
    case PolynomialModel::SemiCubicalParabola:
      return spectrum<PolynomialModel::SemiCubicalParabola>(points, fit);
    case PolynomialModel::CubicSpline:
      break;
  }
  return spectrum<PolynomialModel::CubicSpline>(points, fit);
}

PolynomialFit refine_polynomial(PolynomialModel model, std::span<const FitPoint> points,
                                PolynomialFit start, int side, const RefineEffort& effort) {
  switch (model) {
    case PolynomialModel::Parabola:
      return refine<PolynomialModel::Parabola>(points, std::move(start), side, effort);
    case PolynomialModel::CubicalParabola:
      return refine<PolynomialModel::CubicalParabola>(points, std::move(start), side, effort);
    case PolynomialModel::SemiCubicalParabola:
      return refine<PolynomialModel::SemiCubicalParabola>(points, std::move(start), side, effort);
    case PolynomialModel::CubicSpline:
      return refine<PolynomialModel::CubicSpline>(points, std::move(start), side, effort);
  }
  return start;
}

bool is_same_curve(const PolynomialFit& a, const PolynomialFit& b) {
  constexpr double kSameChi2 = 1e-3;   // far below what tells curves apart
  constexpr double kSameAngle = 1e-6;  // [rad]
  const Vec2 u = a.coefficients.col(3).normalized();
  const Vec2 v = b.coefficients.col(3).normalized();
  return std::abs(a.chi2 - b.chi2) <= kSameChi2 && std::abs(cross(u, v)) <= kSameAngle;
}

PlacedPoint place_on(const PolynomialFit& fit, double t, const Vec2& point) {
  return follow_foot_point(fit.coefficients, point, t);
}

}  // namespace palpate

// The iteration of fit_semi_signature: Levenberg-Marquardt over shape and orientation, with the
// parameter t of each point eliminated. Included only by its source file.
//
// Ceres' TinySolver cannot eliminate unknowns: with one unknown per point its cost would be cubic
// in the points.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/curves/pose2.h"
#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/canonical_models.h"
#include "core/invariants/signature_fit/local_parameter.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"
#include "core/numerics/matrices/small_ldlt.h"

namespace palpate::detail {

/// Relative to the diagonal: nearly a full Gauss-Newton step.
inline constexpr double kInitialDamping = 1e-3;
inline constexpr double kLargestDamping = 1e12;  ///< stop if so short a step still does not help
/// Rounding of the difference between a measurement and the model, in total.
inline constexpr double kResidualRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// A point in normalised lengths, with its whitening matrix.
struct WhitePoint {
  MeasuredGeometry measured;
  Eigen::Matrix3d whitening;  ///< inverse Cholesky factor of the covariance
};

/// The lower triangular `whitening` times columns of (angle, kappa, kappa_s).
template <int N>
Eigen::Matrix<double, 3, N> whitened_columns(const Eigen::Matrix3d& whitening,
                                             const Eigen::Matrix<double, 3, N>& columns) {
  Eigen::Matrix<double, 3, N> white;
  for (int k = 0; k < N; ++k) {
    white(0, k) = whitening(0, 0) * columns(0, k);
    white(1, k) = whitening(1, 0) * columns(0, k) + whitening(1, 1) * columns(1, k);
    white(2, k) = whitening(2, 0) * columns(0, k) + whitening(2, 1) * columns(1, k) +
                  whitening(2, 2) * columns(2, k);
  }
  return white;
}

/// Derivatives of angle, kappa and kappa_s ((1), (2); one row each) by the variables of the jets.
template <int N>
Eigen::Matrix<double, 3, N> geometry_jacobian(const ModelDerivatives<ceres::Jet<double, N>>& d) {
  using Row = Eigen::Matrix<double, N, 1>;
  const double x1 = d.first.x.a, y1 = d.first.y.a;
  const double x2 = d.second.x.a, y2 = d.second.y.a;
  const double x3 = d.third.x.a, y3 = d.third.y.a;
  const double inverse = 1.0 / (x1 * x1 + y1 * y1);  // of the squared speed
  const double inverse2 = inverse * inverse;
  const double inverse_cubed_speed = inverse * std::sqrt(inverse);
  const double turn = x1 * y2 - x2 * y1;
  const double turn_by_t = x1 * y3 - x3 * y1;
  const double stretch = x1 * x2 + y1 * y2;
  const double kappa = turn * inverse_cubed_speed;
  const double kappa_s = (turn_by_t - 3.0 * turn * stretch * inverse) * inverse2;
  const Row half_speed2_by = x1 * d.first.x.v + y1 * d.first.y.v;
  const Row turn_by = y2 * d.first.x.v - x2 * d.first.y.v + x1 * d.second.y.v - y1 * d.second.x.v;
  const Row turn_by_t_by =
      y3 * d.first.x.v - x3 * d.first.y.v + x1 * d.third.y.v - y1 * d.third.x.v;
  const Row stretch_by =
      x2 * d.first.x.v + y2 * d.first.y.v + x1 * d.second.x.v + y1 * d.second.y.v;
  Eigen::Matrix<double, 3, N> jacobian;
  jacobian.row(0) = (inverse * (x1 * d.first.y.v - y1 * d.first.x.v)).transpose();
  jacobian.row(1) =
      (inverse_cubed_speed * turn_by - 3.0 * kappa * inverse * half_speed2_by).transpose();
  const double by_speed2 = 2.0 * inverse * (turn_by_t * inverse2 - 3.0 * kappa_s);
  jacobian.row(2) = (inverse2 * turn_by_t_by + by_speed2 * half_speed2_by -
                     3.0 * inverse * inverse2 * (stretch * turn_by + turn * stretch_by))
                        .transpose();
  return jacobian;
}

template <typename Model>
class SemiSignatureFitter {
 public:
  static constexpr int kShape = Model::kParameters;
  static constexpr int kGlobal = kShape + 1;  ///< the shape and the orientation
  using Global = Eigen::Matrix<double, kGlobal, 1>;
  using Hessian = Eigen::Matrix<double, kGlobal, kGlobal>;

  SemiSignatureFitter(const std::vector<WhitePoint>& points, const Global& start,
                      const SemiSignatureOptions& options, std::vector<LocalParameter>& places)
      : points_(points),
        options_(options),
        global_(start),
        places_(places),
        differences_(points.size()),
        trial_differences_(points.size()),
        steps_(points.size()),
        blocks_(points.size()),
        trial_(places) {
    tangents_.reserve(points.size());
    for (const WhitePoint& point : points) {
      tangents_.push_back(
          {std::cos(point.measured.tangent_angle), std::sin(point.measured.tangent_angle)});
      const Eigen::Vector3d size(kPi, std::abs(point.measured.kappa),
                                 std::abs(point.measured.kappa_s));
      rounding_ += (kResidualRounding * (point.whitening.cwiseAbs() * size)).squaredNorm();
    }
  }

  InvariantStatus solve() {
    double damping = kInitialDamping;
    double growth = 2.0;
    chi2_ = evaluate(global_, places_, &differences_);
    if (!std::isfinite(chi2_)) {
      return InvariantStatus::NotFinite;
    }
    for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
      linearise();
      for (;;) {
        const Global step = reduced_step(damping);
        const double predicted = step.allFinite() ? predicted_decrease(step) : 0.0;
        if (step.allFinite() &&
            (predicted <= negligible_decrease() || is_hopeless(predicted, iteration))) {
          return InvariantStatus::Ok;
        }
        const Global next = global_ + step;
        const std::vector<LocalParameter>& trial = trial_places();
        const double chi2 = evaluate(next, trial, &trial_differences_);
        if (step.allFinite() && chi2 < chi2_) {
          const double rho = (chi2_ - chi2) / predicted;
          const double excess = 2.0 * rho - 1.0;
          damping *= std::max(1.0 / 3.0, 1.0 - excess * excess * excess);
          growth = 2.0;
          global_ = next;
          places_.swap(trial_);
          differences_.swap(trial_differences_);
          chi2_ = chi2;
          is_linearised_ = false;
          break;
        }
        damping *= growth;
        growth *= 2.0;
        if (damping > kLargestDamping) {
          // No descent even along the gradient: chi-square cannot be resolved any further.
          return gradient_is_small() ? InvariantStatus::Ok : InvariantStatus::NotConverged;
        }
      }
    }
    return InvariantStatus::NotConverged;
  }

  /// Inverse of the undamped reduced Hessian; its diagonal is infinite if it is singular.
  Hessian covariance() {
    if (!is_linearised_) {
      linearise();
    }
    const Hessian reduced = reduced_hessian(0.0).first;
    const Global scale = reduced.diagonal().cwiseMax(0.0).cwiseSqrt();
    const Hessian unit_diagonal = reduced.cwiseQuotient(scale * scale.transpose());
    const SmallLdlt<kGlobal> factor(unit_diagonal);
    Hessian inverse = factor.inverse().cwiseQuotient(scale * scale.transpose());
    const bool regular = unit_diagonal.allFinite() &&
                         factor.pivots().minCoeff() > kGlobal * kEpsilon && inverse.allFinite();
    if (regular) {
      return inverse;
    }
    Hessian unknown = Hessian::Zero();
    unknown.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return unknown;
  }

  const Global& global() const { return global_; }
  double chi2() const { return chi2_; }

 private:
  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

  /// Linearisation of one point: the residual, its derivatives by the globals and by its own t, and
  /// the products needed to eliminate t. Of symmetric matrices only the lower triangle is stored.
  struct Block {
    Eigen::Vector3d residual;
    Eigen::Matrix<double, 3, kGlobal> by_global;
    Eigen::Vector3d by_t;
    Global coupling;    ///< by_global^T by_t
    double t_squared;   ///< by_t^T by_t
    double t_residual;  ///< by_t^T residual
  };

  /// The requested decrease, or what rounding can do to chi-square: errors r of the residuals
  /// change it by r^2 and by twice their product with the residuals.
  double negligible_decrease() const {
    return std::max(options_.absolute_decrease, options_.relative_decrease * chi2_) + rounding_ +
           std::sqrt(rounding_ * chi2_);
  }

  /// A damped step promises less than is possible. The full decrease of the linear model counts; it
  /// is expensive, and therefore computed only if the step itself promises too little.
  bool is_hopeless(double predicted, int iteration) const {
    const double left = options_.max_iterations - iteration;
    const auto remains = [&](double decrease) {
      return chi2_ - left * decrease > options_.hopeless_chi2;
    };
    if (!remains(predicted)) {
      return false;
    }
    const auto [hessian, gradient] = reduced_hessian(0.0);
    double linear = gradient.dot(SmallLdlt<kGlobal>(hessian).solve(gradient));
    for (const Block& block : blocks_) {
      linear += block.t_squared > 0.0 ? block.t_residual * block.t_residual / block.t_squared : 0.0;
    }
    return remains(linear);
  }

  /// Chi-square, and the differences between measurements and model.
  double evaluate(const Global& global, const std::vector<LocalParameter>& places,
                  std::vector<Eigen::Vector3d>* differences) const {
    const double axis_x = std::cos(global[kShape]);
    const double axis_y = std::sin(global[kShape]);
    double chi2 = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto& [measured, whitening] = points_[i];
      const int direction = places[i].direction;
      const ModelDerivatives<double> model = Model::derivatives(global.data(), places[i].t);
      const ModelCurvatures<double> curvatures = curvatures_of(model);
      // The angle from the model's tangent to the measured one, in the frame of the curve.
      const double x = direction * (tangents_[i].x * axis_x + tangents_[i].y * axis_y);
      const double y = direction * (tangents_[i].y * axis_x - tangents_[i].x * axis_y);
      const double sine = model.first.x * y - model.first.y * x;
      const double cosine = model.first.x * x + model.first.y * y;
      // Both up to a common factor. The arc tangent of a quotient costs half as much as atan2.
      const double angle = cosine > 0.0 ? std::atan(sine / cosine) : std::atan2(sine, cosine);
      Eigen::Vector3d& difference = (*differences)[i];
      difference = {angle, measured.kappa - direction * curvatures.kappa,
                    measured.kappa_s - curvatures.kappa_s};
      chi2 += whitened_columns<1>(whitening, difference).squaredNorm();
    }
    return std::isfinite(chi2) ? chi2 : std::numeric_limits<double>::infinity();
  }

  void linearise() {
    using Jet = ceres::Jet<double, kShape + 1>;  // by the shape and by t
    std::array<Jet, kShape> shape;
    for (int k = 0; k < kShape; ++k) {
      shape[static_cast<std::size_t>(k)] = Jet(global_[k], k);
    }
    is_linearised_ = true;
    hessian_.setZero();
    gradient_.setZero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Eigen::Matrix<double, 3, kShape + 1> model =
          geometry_jacobian(Model::derivatives(shape.data(), Jet(places_[i].t, kShape)));
      model.row(1) *= places_[i].direction;
      const Eigen::Matrix3d& whitening = points_[i].whitening;
      const Eigen::Matrix<double, 3, kShape + 1> by_own =
          -whitened_columns<kShape + 1>(whitening, model);
      Block& block = blocks_[i];
      block.residual = whitened_columns<1>(whitening, differences_[i]);
      block.by_global.template leftCols<kShape>() = by_own.template leftCols<kShape>();
      block.by_global.col(kShape) = -whitening.col(0);
      block.by_t = by_own.col(kShape);
      block.t_squared = block.by_t.squaredNorm();
      block.t_residual = block.by_t.dot(block.residual);
      for (int k = 0; k < kGlobal; ++k) {
        const auto by = block.by_global.col(k);
        block.coupling[k] = by.dot(block.by_t);
        gradient_[k] += by.dot(block.residual);
        for (int j = 0; j <= k; ++j) {
          hessian_(k, j) += by.dot(block.by_global.col(j));
        }
      }
    }
  }

  /// Hessian and gradient of the globals after elimination of each t, with Marquardt's damping.
  std::pair<Hessian, Global> reduced_hessian(double damping) const {
    Hessian hessian = hessian_;
    Global gradient = gradient_;
    hessian.diagonal() *= 1.0 + damping;
    for (const Block& block : blocks_) {
      const double own = block.t_squared * (1.0 + damping);
      if (own > 0.0) {
        const Global share = block.coupling / own;
        gradient -= block.t_residual * share;
        for (int k = 0; k < kGlobal; ++k) {
          for (int j = 0; j <= k; ++j) {
            hessian(k, j) -= share[k] * block.coupling[j];
          }
        }
      }
    }
    return {hessian, gradient};
  }

  Global reduced_step(double damping) {
    const auto [hessian, gradient] = reduced_hessian(damping);
    Global step = -SmallLdlt<kGlobal>(hessian).solve(gradient);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const Block& block = blocks_[i];
      const double own = block.t_squared * (1.0 + damping);
      steps_[i] = own > 0.0 ? -(block.t_residual + block.coupling.dot(step)) / own : 0.0;
    }
    return step;
  }

  double predicted_decrease(const Global& step) const {
    double decrease = 0.0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const Block& block = blocks_[i];
      Eigen::Vector3d change = block.by_t * steps_[i];
      for (int k = 0; k < kGlobal; ++k) {
        change += step[k] * block.by_global.col(k);
      }
      decrease -= change.dot(2.0 * block.residual + change);
    }
    return decrease;
  }

  bool gradient_is_small() const {
    const auto [hessian, gradient] = reduced_hessian(0.0);
    return gradient.cwiseAbs().dot(hessian.diagonal()
                                       .cwiseMax(std::numeric_limits<double>::min())
                                       .cwiseSqrt()
                                       .cwiseInverse()) <= 1e-6 * std::sqrt(chi2_);
  }

  const std::vector<LocalParameter>& trial_places() {
    for (std::size_t i = 0; i < trial_.size(); ++i) {
      trial_[i] = {places_[i].t + steps_[i], places_[i].direction};
    }
    return trial_;
  }

  const std::vector<WhitePoint>& points_;
  const SemiSignatureOptions& options_;
  std::vector<PlanePoint<double>> tangents_;  ///< measured, of length one
  Global global_;
  std::vector<LocalParameter>& places_;
  std::vector<Eigen::Vector3d> differences_;  ///< measurements minus model, at places_
  std::vector<Eigen::Vector3d> trial_differences_;
  std::vector<double> steps_;
  std::vector<Block> blocks_;
  Hessian hessian_ = Hessian::Zero();  ///< of the globals, before any t is eliminated
  Global gradient_ = Global::Zero();   ///< likewise
  std::vector<LocalParameter> trial_;
  double chi2_ = 0.0;
  bool is_linearised_ = false;  ///< at the current globals and places
  double rounding_ = 0.0;       ///< chi-square that the rounding of the residuals causes
};

}  // namespace palpate::detail

// The iteration behind fit_semi_signature: Levenberg-Marquardt over shape and orientation, with
// each point's t eliminated. Included by its source file only.
//
// Ceres' TinySolver has no elimination: with one unknown a point its cost would be cubic in the
// points.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/curves/pose2.h"
#include "core/invariants/canonical_models.h"
#include "core/invariants/invariant_status.h"
#include "core/invariants/local_parameter.h"
#include "core/invariants/measured_geometry.h"

namespace palpate::detail {

inline constexpr double kInitialDamping = 1e-3;
inline constexpr double kLargestDamping =
    1e12;  ///< a step this short that still does not help: stop
/// Converged where the predicted relative decrease of chi-square is below this, or the decrease is
/// below what rounding makes of chi-square.
inline constexpr double kRelativeDecrease = 1e-13;
/// Roundings in a difference between a measurement and the model.
inline constexpr double kResidualRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// A point in normalised lengths with its whitening matrix.
struct WhitePoint {
  MeasuredGeometry measured;
  Eigen::Matrix3d whitening;  ///< inverse Cholesky factor of the covariance
};

template <typename Model>
class SemiSignatureFitter {
 public:
  static constexpr int kShape = Model::kParameters;
  static constexpr int kGlobal = kShape + 1;  ///< the shape and the orientation
  using Global = Eigen::Matrix<double, kGlobal, 1>;
  using Hessian = Eigen::Matrix<double, kGlobal, kGlobal>;

  SemiSignatureFitter(const std::vector<WhitePoint>& points, const Global& start,
                      std::vector<LocalParameter>& places)
      : points_(points), global_(start), places_(places), steps_(points.size()) {
    for (const WhitePoint& point : points) {
      const Eigen::Vector3d size(kPi, std::abs(point.measured.kappa),
                                 std::abs(point.measured.kappa_s));
      rounding_ += (kResidualRounding * (point.whitening.cwiseAbs() * size)).squaredNorm();
    }
  }

  InvariantStatus solve(int max_iterations) {
    double damping = kInitialDamping;
    double growth = 2.0;
    chi2_ = evaluate(global_, places_);
    if (!std::isfinite(chi2_)) {
      return InvariantStatus::NotFinite;
    }
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      linearise();
      for (;;) {
        const Global step = reduced_step(damping);
        const double predicted = step.allFinite() ? predicted_decrease(step) : 0.0;
        if (step.allFinite() && predicted <= negligible_decrease()) {
          return InvariantStatus::Ok;
        }
        const Global next = global_ + step;
        const std::vector<LocalParameter>& trial = trial_places();
        const double chi2 = evaluate(next, trial);
        if (step.allFinite() && chi2 < chi2_) {
          const double rho = (chi2_ - chi2) / predicted;
          damping *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * rho - 1.0, 3));
          growth = 2.0;
          global_ = next;
          places_.swap(trial_);
          chi2_ = chi2;
          break;
        }
        damping *= growth;
        growth *= 2.0;
        if (damping > kLargestDamping) {
          // No descent along the gradient itself: the rounding of chi-square has been reached.
          return gradient_is_small() ? InvariantStatus::Ok : InvariantStatus::NotConverged;
        }
      }
    }
    return InvariantStatus::NotConverged;
  }

  /// Inverse of the undamped reduced Hessian; infinite on the diagonal where it is singular.
  Hessian covariance() {
    linearise();
    const Hessian reduced = reduced_hessian(0.0).first;
    const Global scale = reduced.diagonal().cwiseMax(0.0).cwiseSqrt();
    const Hessian unit_diagonal =
        scale.cwiseInverse().asDiagonal() * reduced * scale.cwiseInverse().asDiagonal();
    const Eigen::LDLT<Hessian> factor(unit_diagonal);
    const Hessian inverse = scale.cwiseInverse().asDiagonal() * factor.solve(Hessian::Identity()) *
                            scale.cwiseInverse().asDiagonal();
    const bool regular = unit_diagonal.allFinite() && factor.isPositive() &&
                         factor.vectorD().minCoeff() > kGlobal * kEpsilon && inverse.allFinite();
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

  /// Linearisation of one point: the residual and its derivatives by the globals and by its own t.
  struct Block {
    Eigen::Vector3d residual;
    Eigen::Matrix<double, 3, kGlobal> by_global;
    Eigen::Vector3d by_t;
  };

  /// Errors r of the residuals change chi-square by r^2 and by twice their product with it.
  double negligible_decrease() const {
    return kRelativeDecrease * chi2_ + rounding_ + std::sqrt(rounding_ * chi2_);
  }

  template <typename T>
  static Eigen::Matrix<T, 3, 1> difference(const MeasuredGeometry& measured, const T* shape,
                                           const T& orientation, const T& t, int direction) {
    const ModelGeometry<T> model = geometry_of(Model::derivatives(shape, t));
    const double half_turn = direction < 0 ? kPi : 0.0;
    T angle = measured.tangent_angle - half_turn - orientation - model.tangent_angle;
    if constexpr (std::is_same_v<T, double>) {
      angle = wrap_angle(angle);
    } else {
      angle.a = wrap_angle(angle.a);
    }
    return {angle, measured.kappa - static_cast<double>(direction) * model.kappa,
            measured.kappa_s - model.kappa_s};
  }

  double evaluate(const Global& global, const std::vector<LocalParameter>& places) const {
    double chi2 = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d r = difference<double>(
          points_[i].measured, global.data(), global[kShape], places[i].t, places[i].direction);
      chi2 += (points_[i].whitening * r).squaredNorm();
    }
    return std::isfinite(chi2) ? chi2 : std::numeric_limits<double>::infinity();
  }

  void linearise() {
    using Jet = ceres::Jet<double, kShape + 1>;  // by the shape and by t
    blocks_.resize(points_.size());
    std::array<Jet, kShape> shape;
    for (int k = 0; k < kShape; ++k) {
      shape[static_cast<std::size_t>(k)] = Jet(global_[k], k);
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Matrix<Jet, 3, 1> r =
          difference<Jet>(points_[i].measured, shape.data(), Jet(global_[kShape]),
                          Jet(places_[i].t, kShape), places_[i].direction);
      Eigen::Vector3d residual;
      Eigen::Matrix<double, 3, kShape> by_shape;
      Eigen::Vector3d by_t;
      for (int k = 0; k < 3; ++k) {
        residual[k] = r[k].a;
        by_shape.row(k) = r[k].v.template head<kShape>().transpose();
        by_t[k] = r[k].v[kShape];
      }
      const Eigen::Matrix3d& whitening = points_[i].whitening;
      blocks_[i].residual = whitening * residual;
      blocks_[i].by_global.template leftCols<kShape>() = whitening * by_shape;
      blocks_[i].by_global.col(kShape) = -whitening.col(0);
      blocks_[i].by_t = whitening * by_t;
    }
  }

  /// Hessian and gradient of the globals after each t is eliminated, with Marquardt's damping.
  std::pair<Hessian, Global> reduced_hessian(double damping) const {
    Hessian hessian = Hessian::Zero();
    Global gradient = Global::Zero();
    for (const Block& block : blocks_) {
      const double own = block.by_t.squaredNorm() * (1.0 + damping);
      const Global coupling = block.by_global.transpose() * block.by_t;
      hessian.noalias() += block.by_global.transpose() * block.by_global;
      gradient.noalias() += block.by_global.transpose() * block.residual;
      if (own > 0.0) {
        hessian.noalias() -= coupling * coupling.transpose() / own;
        gradient.noalias() -= coupling * (block.by_t.dot(block.residual) / own);
      }
    }
    if (damping > 0.0) {
      Global diagonal = Global::Zero();
      for (const Block& block : blocks_) {
        diagonal += block.by_global.colwise().squaredNorm().transpose();
      }
      hessian.diagonal() += damping * diagonal;
    }
    return {hessian, gradient};
  }

  Global reduced_step(double damping) {
    const auto [hessian, gradient] = reduced_hessian(damping);
    const Global step = -hessian.ldlt().solve(gradient);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const Block& block = blocks_[i];
      const double own = block.by_t.squaredNorm() * (1.0 + damping);
      steps_[i] = own > 0.0 ? -block.by_t.dot(block.residual + block.by_global * step) / own : 0.0;
    }
    return step;
  }

  double predicted_decrease(const Global& step) const {
    double decrease = 0.0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const Block& block = blocks_[i];
      const Eigen::Vector3d change = block.by_global * step + block.by_t * steps_[i];
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
    trial_ = places_;
    for (std::size_t i = 0; i < trial_.size(); ++i) {
      trial_[i].t += steps_[i];
    }
    return trial_;
  }

  const std::vector<WhitePoint>& points_;
  Global global_;
  std::vector<LocalParameter>& places_;
  std::vector<double> steps_;
  std::vector<Block> blocks_;
  std::vector<LocalParameter> trial_;
  double chi2_ = 0.0;
  double rounding_ = 0.0;  ///< chi-square of the residuals' rounding
};

}  // namespace palpate::detail

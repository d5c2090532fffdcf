#include "core/invariants/semi_signature_fit.h"

#include <ceres/jet.h>

#include <Eigen/Cholesky>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/curves/pose2.h"
#include "core/invariants/canonical_models.h"

namespace palpate {
namespace {

constexpr double kInitialDamping = 1e-3;
constexpr double kLargestDamping = 1e12;  ///< a step this short that still does not help: stop
/// Converged where the predicted relative decrease of chi-square is below this, or the decrease is
/// below what rounding makes of chi-square.
constexpr double kRelativeDecrease = 1e-13;
/// Roundings in a difference between a measurement and the model.
constexpr double kResidualRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// A point in normalised lengths with its whitening matrix.
struct WhitePoint {
  MeasuredGeometry measured;
  Eigen::Matrix3d whitening;  ///< inverse Cholesky factor of the covariance
};

/// Powers of the length unit by which each parameter of a class scales.
Eigen::Vector3d unit_powers(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return {-2.0, 0.0, 0.0};
    case CurveClass::SemiCubicalParabola:
      return {-0.5, 0.0, 0.0};
    case CurveClass::CubicSpline:
      return {-0.5, 0.0, 0.5};
    default:
      return {1.0, 1.0, 0.0};
  }
}

/// Power of the length unit by which the curve parameter scales.
double parameter_power(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return 1.0;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return 0.5;
    default:
      return 0.0;
  }
}

template <typename Model>
class Fitter {
 public:
  static constexpr int kShape = Model::kParameters;
  static constexpr int kGlobal = kShape + 1;  ///< the shape and the orientation
  using Global = Eigen::Matrix<double, kGlobal, 1>;
  using Hessian = Eigen::Matrix<double, kGlobal, kGlobal>;

  Fitter(const std::vector<WhitePoint>& points, const Global& start,
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

/// Brings a fit to the class's conventions: a >= b, a > 0; the t and the orientation follow.
void canonicalise(SemiSignatureFit& fit) {
  Eigen::Vector3d& p = fit.parameters;
  const auto flip = [&](int i) {
    p[i] = -p[i];
    fit.covariance.row(i) *= -1.0;
    fit.covariance.col(i) *= -1.0;
  };
  if (fit.curve_class == CurveClass::Ellipse) {
    if (p[1] > p[0]) {
      std::swap(p[0], p[1]);
      fit.covariance.row(0).swap(fit.covariance.row(1));
      fit.covariance.col(0).swap(fit.covariance.col(1));
      fit.orientation += kPi / 2.0;
      for (LocalParameter& place : fit.places) {
        place.t -= kPi / 2.0;
      }
    }
    for (LocalParameter& place : fit.places) {
      place.t = wrap_angle(place.t);
    }
  } else if (fit.curve_class == CurveClass::SemiCubicalParabola ||
             fit.curve_class == CurveClass::CubicSpline) {
    if (p[0] < 0.0) {  // t -> -t changes the signs of a and c and the direction
      flip(0);
      if (fit.curve_class == CurveClass::CubicSpline) {
        flip(2);
      }
      for (LocalParameter& place : fit.places) {
        place.t = -place.t;
        place.direction = -place.direction;
      }
    }
  }
  fit.orientation = wrap_angle(fit.orientation);
}

bool in_class(CurveClass curve_class, const Eigen::Vector3d& p) {
  switch (curve_class) {
    case CurveClass::Ellipse:
    case CurveClass::Hyperbola:
      return p[0] > 0.0 && p[1] > 0.0;
    case CurveClass::Parabola:
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return p[0] > 0.0;
    default:
      return p[0] != 0.0;
  }
}

template <typename Model>
void fit_model(const std::vector<WhitePoint>& points, double unit, int max_iterations,
               SemiSignatureFit& fit) {
  using ModelFitter = Fitter<Model>;
  constexpr int kShape = ModelFitter::kShape;
  const Eigen::Vector3d powers = unit_powers(fit.curve_class);
  const Eigen::Vector3d to_normal(std::pow(unit, -powers[0]), std::pow(unit, -powers[1]),
                                  std::pow(unit, -powers[2]));
  const double t_unit = std::pow(unit, parameter_power(fit.curve_class));
  const Eigen::Vector3d normal = to_normal.cwiseProduct(fit.parameters);
  typename ModelFitter::Global start;
  start << normal.head<kShape>(), fit.orientation;
  fit.places.clear();
  for (const WhitePoint& point : points) {
    fit.places.push_back(local_parameter(fit.curve_class, normal,
                                         point.measured.tangent_angle - fit.orientation,
                                         point.measured.kappa, point.measured.kappa_s));
  }
  ModelFitter fitter(points, start, fit.places);
  fit.status = fitter.solve(max_iterations);
  if (fit.status == InvariantStatus::NotFinite) {
    return;
  }
  fit.chi2 = fitter.chi2();
  const auto covariance = fitter.covariance();
  typename ModelFitter::Global back;
  back << to_normal.head<kShape>().cwiseInverse(), 1.0;
  for (int i = 0; i < kShape; ++i) {
    fit.parameters[i] = fitter.global()[i] * back[i];
  }
  fit.orientation = fitter.global()[kShape];
  for (int i = 0; i <= kShape; ++i) {
    for (int j = 0; j <= kShape; ++j) {
      fit.covariance(i, j) = covariance(i, j) * (back[i] * back[j]);
    }
  }
  if (fit.covariance.hasNaN()) {  // 0 times a power of the unit that has overflowed
    fit.covariance.setZero();
    fit.covariance.diagonal().head<kShape + 1>().setConstant(
        std::numeric_limits<double>::infinity());
  }
  for (LocalParameter& place : fit.places) {
    place.t *= t_unit;
  }
  canonicalise(fit);
  if (!fit.parameters.allFinite()) {
    fit.status = InvariantStatus::NotFinite;
  }
  if (fit.status == InvariantStatus::Ok && !in_class(fit.curve_class, fit.parameters)) {
    fit.status = InvariantStatus::NotThisClass;
  }
}

}  // namespace

SemiSignatureFit fit_semi_signature(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> measured,
                                    const Eigen::Vector3d& start_parameters,
                                    double start_orientation, const SemiSignatureOptions& options) {
  SemiSignatureFit fit;
  fit.curve_class = curve_class;
  fit.parameters = start_parameters;
  fit.orientation = start_orientation;
  const int shape_count = static_cast<int>(parameter_letters(curve_class).size());
  const int count = static_cast<int>(measured.size());
  fit.dof = 2 * count - shape_count - 1;
  if (fit.dof < 0) {
    return fit;
  }
  const double scale = curvature_scale(measured);
  bool finite = start_parameters.allFinite() && std::isfinite(start_orientation);
  for (const MeasuredGeometry& point : measured) {
    finite = finite && is_finite(point);
  }
  if (!finite || !(scale > 0.0)) {
    fit.status = finite ? InvariantStatus::ZeroCurvature : InvariantStatus::NotFinite;
    return fit;
  }
  const double unit = 1.0 / scale;
  std::vector<WhitePoint> points;
  points.reserve(measured.size());
  for (const MeasuredGeometry& point : measured) {
    WhitePoint white{in_units_of(point, unit), Eigen::Matrix3d::Zero()};
    const double size = curvature_scale({&white.measured, 1});
    const Eigen::Vector3d floor =
        options.relative_floor *
        Eigen::Vector3d(1.0, size > 0.0 ? size : 1.0, size > 0.0 ? size * size : 1.0);
    Eigen::Matrix3d covariance = white.measured.covariance;
    covariance.diagonal() += floor.cwiseAbs2();
    const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
    if (factor.info() != Eigen::Success) {
      fit.status = InvariantStatus::NotFinite;  // not a covariance
      return fit;
    }
    white.whitening = factor.matrixL().solve(Eigen::Matrix3d::Identity());
    points.push_back(white);
  }
  switch (curve_class) {
    case CurveClass::Ellipse:
      fit_model<EllipseModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::Parabola:
      fit_model<ParabolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::Hyperbola:
      fit_model<HyperbolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::CubicalParabola:
      fit_model<CubicalParabolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::SemiCubicalParabola:
      fit_model<SemiCubicalParabolaModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::CubicSpline:
      fit_model<CubicSplineModel>(points, unit, options.max_iterations, fit);
      break;
    case CurveClass::Line:
    case CurveClass::Circle:
    case CurveClass::Unclassified:
      assert(false);
      break;
  }
  return fit;
}

}  // namespace palpate

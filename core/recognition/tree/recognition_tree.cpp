#include "core/recognition/tree/recognition_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/invariants/conic_line.h"
#include "core/invariants/constant_curvature.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/conic_start.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/numerics/probability/chi_square.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/tree/conic_shapes.h"
#include "core/recognition/tree/recognition_tree_tolerance.h"
#include "core/recognition/tree/tree_pose.h"
#include "core/recognition/tree/tree_record.h"

namespace palpate {
namespace {

/// The path through the tree, with thresholds from the estimates' uncertainty.
class SignificanceTree {
 public:
  SignificanceTree(std::span<const TreePoint> points, const RecognitionTreeOptions& options,
                   const TreeEffort& effort)
      : points_(points), options_(options), effort_(effort), record_(options.significance) {
    for (const TreePoint& point : points) {
      MeasuredGeometry measured = measured_geometry(point.estimate, point.patch);
      const double size = curvature_scale({&measured, 1});
      const Eigen::Vector3d floor =
          options.relative_floor * Eigen::Vector3d(1.0, size, size * size);
      measured.covariance.diagonal() += floor.cwiseAbs2();
      measured_.push_back(measured);
      record_.result.pooled.push_back(record_.result.pooled.size());
    }
  }

  TreeResult run() {
    record_.result.status = InvariantStatus::Ok;
    if (!constant_curvature() && !conic() && !cubic(CurveClass::CubicalParabola) &&
        !cubic(CurveClass::SemiCubicalParabola) && !cubic(CurveClass::CubicSpline)) {
      record_.result.status = InvariantStatus::NotThisClass;
    }
    return std::move(record_.result);
  }

  TreeResult leaf_again(const TreeResult& answer) {
    record_.result.status = InvariantStatus::Ok;
    const CurveClass curve_class = answer.shape.curve_class;
    if (curve_class == CurveClass::Line || curve_class == CurveClass::Circle) {
      const ConstantCurvature fit = fit_constant_curvature(measured_);
      if (curve_class == CurveClass::Line) {
        reach_line(fit);
      } else if (fit.kappa > 0.0) {
        reach_circle(fit, tangent_circle(points_, 1.0 / fit.kappa, options_.relative_floor));
      }
      return std::move(record_.result);
    }
    const SemiSignatureFit fit = fit_semi_signature(curve_class, measured_, answer.shape.values,
                                                    answer.world_T_curve->theta);
    if (fit.status == InvariantStatus::Ok) {
      reach_fit(fit);
    }
    return std::move(record_.result);
  }

 private:
  bool constant_curvature() {
    const ConstantCurvature fit = fit_constant_curvature(measured_);
    if (fit.status != InvariantStatus::Ok) {
      return false;
    }
    record_.add_invariant(CurveClass::Circle, "kappa", fit.kappa, fit.variance);
    if (record_.passes("line", fit.line_chi2, fit.line_dof, {CurveClass::Line})) {
      reach_line(fit);
      return true;
    }
    if (fit.kappa > 0.0 &&
        record_.passes("circle", fit.circle_chi2, fit.circle_dof, {CurveClass::Circle})) {
      const double radius = 1.0 / fit.kappa;
      const TangentCircle circle = tangent_circle(points_, radius, options_.relative_floor);
      // The curvatures are equal within their errors; positions and tangents are a sharper test.
      if (!record_.passes("circle through tangents", circle.chi2, circle.dof,
                          {CurveClass::Circle})) {
        return false;
      }
      reach_circle(fit, circle);
      return true;
    }
    return false;
  }

  void reach_line(const ConstantCurvature& fit) {
    record_.reach(CurveClass::Line, Eigen::Vector3d::Zero(), fit.line_chi2, fit.line_dof);
    record_.result.world_T_curve = line_pose(points_);
  }

  void reach_circle(const ConstantCurvature& fit, const TangentCircle& circle) {
    const double radius = 1.0 / fit.kappa;
    record_.reach(CurveClass::Circle, {radius, 0.0, 0.0}, fit.circle_chi2, fit.circle_dof);
    record_.result.covariance(0, 0) = std::pow(radius, 4) * fit.variance;
    record_.result.world_T_curve = circle.pose;
  }

  /// The points whose errors enter the conic's invariants almost linearly in the range that a test
  /// uses. Ip goes as kappa^(-10/3): at 3.3 standard deviations (significance 1e-3) it is linear to
  /// a third if the relative error of kappa is below 3 %.
  std::vector<MeasuredGeometry> of_linear_invariants() const {
    constexpr double kMostRelativeError = 0.03;
    std::vector<MeasuredGeometry> linear;
    for (const MeasuredGeometry& point : measured_) {
      if (std::sqrt(point.covariance(1, 1)) <= kMostRelativeError * std::abs(point.kappa)) {
        linear.push_back(point);
      }
    }
    return linear;
  }

  bool conic() {
    if (measured_.size() < 3) {
      return false;
    }
    // All points give the invariants. Only points whose invariants follow a known law test them.
    const std::vector<MeasuredGeometry> linear = of_linear_invariants();
    const ConicLine all = fit_conic_line(measured_);
    const ConicLine tested = linear.size() == measured_.size() ? all : fit_conic_line(linear);
    const ConicLine& line = is_line(all) ? all : tested;
    if (tested.status == InvariantStatus::SignChange || !is_line(line)) {
      return record_.refused("conic line", static_cast<int>(measured_.size()) - 2);
    }
    if (line.status == InvariantStatus::Ok) {
      const CurveClass of_sign = line.ic1 < 0.0 ? CurveClass::Hyperbola : CurveClass::Ellipse;
      record_.add_invariant(of_sign, "Ic1", line.ic1, line.covariance(0, 0));
      record_.add_invariant(of_sign, "Ic2", line.ic2, line.covariance(1, 1));
    }
    record_.add_invariant(CurveClass::Parabola, "Ip", line.ip_mean, line.ip_variance);
    if (tested.status == InvariantStatus::Ok && tested.dof > 0 &&
        !record_.passes("conic line", tested.chi2, tested.dof,
                        {CurveClass::Ellipse, CurveClass::Parabola, CurveClass::Hyperbola})) {
      return false;
    }
    if (const int sign = sign_of_ic1(tested)) {
      return central_conic(sign > 0 ? CurveClass::Ellipse : CurveClass::Hyperbola, tested.ic1,
                           tested);
    }
    if (parabola(tested, line)) {
      return true;
    }
    if (line.status != InvariantStatus::Ok) {
      return alike_ellipse();
    }
    // The sign of Ic1 is not known. The tangents are measured much better and may decide.
    const double size = std::max(std::abs(line.ic1), std::sqrt(line.covariance(0, 0)));
    return central_conic(CurveClass::Ellipse, size, line) ||
           central_conic(CurveClass::Hyperbola, -size, line);
  }

  static bool is_line(const ConicLine& line) {
    return line.status == InvariantStatus::Ok || line.status == InvariantStatus::PointsTooAlike;
  }

  /// 0 if the sign is not significant.
  int sign_of_ic1(const ConicLine& tested) {
    if (tested.status != InvariantStatus::Ok) {
      return 0;
    }
    const double threshold = std::sqrt(record_.threshold_of(1));
    const double sign = tested.ic1 / std::sqrt(tested.covariance(0, 0));
    const double p_value = chi_square_survival(sign * sign, 1);
    const bool is_signed = std::abs(sign) > threshold;
    record_.result.decisions.push_back(
        {"Ic1 not zero", std::abs(sign), threshold, is_signed, p_value});
    record_.says(CurveClass::Parabola, p_value);
    record_.says(sign > 0.0 ? CurveClass::Hyperbola : CurveClass::Ellipse, p_value);
    return !is_signed ? 0 : sign > 0.0 ? 1 : -1;
  }

  bool central_conic(CurveClass curve_class, double ic1, const ConicLine& line) {
    return rotation(curve_class, central_shapes(curve_class, ic1, line),
                    curve_class == CurveClass::Ellipse ? "ellipse rotation" : "hyperbola rotation");
  }

  /// If the curvatures are equal within their errors, the line has no slope, so that Ic1 has
  /// neither sign nor size. But an ellipse has four points of the same curvature, a parabola or
  /// hyperbola two, and the tangents may decide.
  bool alike_ellipse() {
    const ConstantCurvature mean = fit_constant_curvature(measured_);
    if (mean.status != InvariantStatus::Ok || !(mean.kappa > 0.0)) {
      return false;
    }
    return rotation(CurveClass::Ellipse, ellipses_curved_by(mean.kappa), "ellipse rotation");
  }

  bool parabola(const ConicLine& tested, const ConicLine& line) {
    if (is_line(tested) && tested.ip_dof > 0 &&
        !record_.passes("parabola Ip", tested.ip_chi2, tested.ip_dof, {CurveClass::Parabola})) {
      return false;
    }
    return rotation(CurveClass::Parabola, parabola_shapes(line), "parabola rotation");
  }

  /// The conic's invariants do not use the tangent angles, which are measured best of all: the
  /// class must explain them too.
  bool rotation(CurveClass curve_class, std::span<const Eigen::Vector3d> shapes,
                std::string_view name) {
    return leaf(
        fit_of(curve_class,
               [&] {
                 SemiSignatureFit best;
                 best.curve_class = curve_class;
                 for (const CurveStart& start : conic_starts(curve_class, shapes, measured_)) {
                   SemiSignatureFit fit = fit_semi_signature(
                       curve_class, measured_, start.parameters, start.orientation, effort_.fit);
                   if (is_better(fit, best)) {
                     best = std::move(fit);
                   }
                   if (explains(best)) {
                     break;
                   }
                 }
                 return best;
               }),
        name);
  }

  /// True if the leaf's test passes.
  bool explains(const SemiSignatureFit& fit) {
    return fit.status == InvariantStatus::Ok && fit.chi2 <= record_.threshold_of(fit.dof);
  }

  static bool is_better(const SemiSignatureFit& fit, const SemiSignatureFit& best) {
    const bool best_ok = best.status == InvariantStatus::Ok;
    return fit.status == InvariantStatus::Ok ? !best_ok || fit.chi2 < best.chi2 : !best_ok;
  }

  /// Fits from the known curve if there is one, else calls `search`.
  template <typename Search>
  SemiSignatureFit fit_of(CurveClass curve_class, const Search& search) {
    if (!effort_.known) {
      return search();
    }
    const auto known = effort_.known(curve_class);
    return known ? fit_semi_signature(curve_class, measured_, known->parameters, known->orientation,
                                      options_of(curve_class))
                 : SemiSignatureFit{};
  }

  /// For a conic it only matters whether it explains the points, so that a hopeless fit may stop
  /// early. A cubic's parameters are its invariants: its optimum is needed in any case.
  SemiSignatureOptions options_of(CurveClass curve_class) const {
    SemiSignatureOptions options = effort_.fit;
    const bool is_conic = curve_class == CurveClass::Ellipse ||
                          curve_class == CurveClass::Parabola ||
                          curve_class == CurveClass::Hyperbola;
    if (is_conic) {
      // P(chi2 > k + 2 sqrt(k u) + 2 u) <= exp(-u) for k degrees of freedom (B. Laurent, P.
      // Massart, 2000). k is the largest of any conic, the parabola's.
      const double k = 2.0 * static_cast<double>(measured_.size()) - 2.0;
      const double u = std::max(kNegligibleLogOdds, -std::log(options_.significance));
      options.hopeless_chi2 = k + 2.0 * std::sqrt(k * u) + 2.0 * u;
    }
    return options;
  }

  bool cubic(CurveClass curve_class) {
    if (curve_class == CurveClass::CubicalParabola) {
      return measured_.size() >= 2 &&
             cubic_leaf(
                 fit_of(curve_class, [&] { return fit_cubical_parabola(measured_, effort_.fit); }),
                 "cubical parabola");
    }
    if (curve_class == CurveClass::SemiCubicalParabola) {
      return measured_.size() >= 2 &&
             cubic_leaf(fit_of(curve_class,
                               [&] { return fit_semi_cubical_parabola(measured_, effort_.fit); }),
                        "semi-cubical parabola");
    }
    return measured_.size() >= 4 && cubic_leaf(fit_of(curve_class,
                                                      [&] {
                                                        SplineOptions options;
                                                        options.refinement = effort_.fit;
                                                        return fit_cubic_spline(measured_, options);
                                                      }),
                                               "cubic spline");
  }

  bool cubic_leaf(const SemiSignatureFit& fit, std::string_view name) {
    if (fit.status == InvariantStatus::Ok) {
      add_cubic_invariants(fit);
    }
    return leaf(fit, name);
  }

  /// A cubic's invariants are its parameters; Iscp1 is a^2.
  void add_cubic_invariants(const SemiSignatureFit& fit) {
    const Eigen::Matrix3d covariance = shape_covariance(fit);
    const auto add = [&](std::string_view name, Eigen::Index i) {
      record_.add_invariant(fit.curve_class, name, fit.parameters[i], covariance(i, i));
    };
    if (fit.curve_class == CurveClass::CubicalParabola) {
      add("Icp1", 0);
      add("Icp2", 1);
    } else if (fit.curve_class == CurveClass::SemiCubicalParabola) {
      const double a = fit.parameters[0];
      record_.add_invariant(fit.curve_class, "Iscp1", a * a, 4.0 * a * a * covariance(0, 0));
      add("Iscp2", 1);
    } else {
      add("a", 0);
      add("b", 1);
      add("c", 2);
    }
  }

  bool leaf(const SemiSignatureFit& fit, std::string_view name) {
    if (fit.status == InvariantStatus::NotConverged && fit.chi2 <= record_.threshold_of(fit.dof)) {
      return runs_away(fit, name);
    }
    if (fit.status != InvariantStatus::Ok) {
      return record_.refused(name, std::max(fit.dof, 1));
    }
    if (!record_.passes(name, fit.chi2, fit.dof, {fit.curve_class})) {
      return false;
    }
    reach_fit(fit);
    return true;
  }

  /// Accepts a class that explains the points on its way to a neighbouring class, without an
  /// optimum.
  bool runs_away(const SemiSignatureFit& fit, std::string_view name) {
    record_.passes(name, fit.chi2, fit.dof, {fit.curve_class});
    record_.reach(fit.curve_class, fit.parameters, fit.chi2, fit.dof);
    record_.result.covariance.setZero();
    record_.result.covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return true;
  }

  void reach_fit(const SemiSignatureFit& fit) {
    record_.reach(fit.curve_class, fit.parameters, fit.chi2, fit.dof);
    record_.result.covariance = shape_covariance(fit);
    record_.result.world_T_curve = pose_of(points_, fit);
    record_.result.places = fit.places;
  }

  std::span<const TreePoint> points_;
  const RecognitionTreeOptions& options_;
  const TreeEffort& effort_;
  std::vector<MeasuredGeometry> measured_;
  TreeRecord record_;
};

}  // namespace

TreeResult recognise_by_tree(std::span<const TreePoint> points,
                             const RecognitionTreeOptions& options, const TreeEffort& effort) {
  TreeResult result;
  if (points.size() < 2) {
    return result;
  }
  for (const TreePoint& point : points) {
    if (!point.estimate.position.allFinite() ||
        !is_finite(measured_geometry(point.estimate, point.patch))) {
      result.status = InvariantStatus::NotFinite;
      return result;
    }
  }
  return options.relative_tolerance > 0.0 ? recognise_by_tolerance(points, options)
                                          : SignificanceTree(points, options, effort).run();
}

TreeResult solve_leaf(std::span<const TreePoint> points, const TreeResult& answer,
                      const RecognitionTreeOptions& options) {
  return SignificanceTree(points, options, {}).leaf_again(answer);
}

}  // namespace palpate

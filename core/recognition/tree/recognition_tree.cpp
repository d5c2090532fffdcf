#include "core/recognition/tree/recognition_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/invariants/conic_line.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/constant_curvature.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/conic_start.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/numerics/chi_square.h"
#include "core/recognition/tree/recognition_tree_tolerance.h"
#include "core/recognition/tree/tree_pose.h"

namespace palpate {
namespace {

/// The path through the tree with the estimates' uncertainties as thresholds.
class SignificanceTree {
 public:
  SignificanceTree(std::span<const TreePoint> points, const RecognitionTreeOptions& options,
                   const SplineOptions& spline)
      : points_(points), options_(options), spline_(spline) {
    for (const TreePoint& point : points) {
      MeasuredGeometry measured = measured_geometry(point.estimate, point.patch);
      const double size = curvature_scale({&measured, 1});
      const Eigen::Vector3d floor =
          options.relative_floor * Eigen::Vector3d(1.0, size, size * size);
      measured.covariance.diagonal() += floor.cwiseAbs2();
      measured_.push_back(measured);
    }
  }

  TreeResult run() {
    result_.status = InvariantStatus::Ok;
    if (!constant_curvature() && !conic() && !cubic(CurveClass::CubicalParabola) &&
        !cubic(CurveClass::SemiCubicalParabola) && !cubic(CurveClass::CubicSpline)) {
      result_.status = InvariantStatus::NotThisClass;
    }
    return std::move(result_);
  }

 private:
  /// Records one chi-square test.
  bool passes(std::string_view name, double chi2, int dof) {
    const double threshold = chi_square_threshold(options_.significance, dof);
    const bool passed = chi2 <= threshold;
    result_.decisions.push_back({name, chi2, threshold, passed});
    return passed;
  }

  /// Records a test that could not be made: its chi-square is infinite.
  bool refused(std::string_view name, int dof) {
    return passes(name, std::numeric_limits<double>::infinity(), dof);
  }

  void reach(CurveClass curve_class, const Eigen::Vector3d& parameters, double chi2, int dof) {
    result_.shape = {curve_class, parameters};
    result_.chi2 = chi2;
    result_.dof = dof;
  }

  bool constant_curvature() {
    const ConstantCurvature fit = fit_constant_curvature(measured_);
    if (fit.status != InvariantStatus::Ok) {
      return false;
    }
    if (passes("line", fit.line_chi2, fit.line_dof)) {
      reach(CurveClass::Line, Eigen::Vector3d::Zero(), fit.line_chi2, fit.line_dof);
      result_.world_T_curve = line_pose(points_);
      return true;
    }
    if (fit.kappa > 0.0 && passes("circle", fit.circle_chi2, fit.circle_dof)) {
      const double radius = 1.0 / fit.kappa;
      const TangentCircle circle = tangent_circle(points_, radius, options_.relative_floor);
      // Constant curvature within its errors: the places and tangents know better.
      if (!passes("circle through tangents", circle.chi2, circle.dof)) {
        return false;
      }
      reach(CurveClass::Circle, {radius, 0.0, 0.0}, fit.circle_chi2, fit.circle_dof);
      result_.covariance(0, 0) = std::pow(radius, 4) * fit.variance;
      result_.world_T_curve = circle.pose;
      return true;
    }
    return false;
  }

  bool conic() {
    const ConicLine line = fit_conic_line(measured_);
    const int dof = static_cast<int>(measured_.size()) - 2;
    if (dof < 1) {
      return false;
    }
    if (line.status == InvariantStatus::PointsTooAlike) {
      // Curvatures equal within their errors, kappa_s not zero: no slope, hence no sign. What is
      // left of the conic test is Ip, the parabola's.
      return parabola(line);
    }
    if (line.status != InvariantStatus::Ok) {
      return refused("conic line", dof);
    }
    if (!passes("conic line", line.chi2, line.dof)) {
      return false;
    }
    const double sd = std::sqrt(line.covariance(0, 0));
    const double threshold = std::sqrt(chi_square_threshold(options_.significance, 1));
    const double sign = line.ic1 / sd;
    const bool signed_conic = std::abs(sign) > threshold;
    result_.decisions.push_back({"Ic1 not zero", std::abs(sign), threshold, signed_conic});
    if (signed_conic) {
      return central_conic(sign > 0.0 ? CurveClass::Ellipse : CurveClass::Hyperbola, line.ic1,
                           line);
    }
    // The sign of Ic1 is not known: the tangents, which are measured far better, may decide.
    const double size = std::max(std::abs(line.ic1), sd);
    return parabola(line) || central_conic(CurveClass::Ellipse, size, line) ||
           central_conic(CurveClass::Hyperbola, -size, line);
  }

  bool central_conic(CurveClass curve_class, double ic1, const ConicLine& line) {
    const bool ellipse = curve_class == CurveClass::Ellipse;
    const ConicParameters parameters = ellipse
                                           ? ellipse_parameters(ic1, line.ic2, line.covariance)
                                           : hyperbola_parameters(ic1, line.ic2, line.covariance);
    if (parameters.status != InvariantStatus::Ok) {
      return refused(ellipse ? "ellipse" : "hyperbola", static_cast<int>(measured_.size()) - 2);
    }
    return rotation(curve_class, {parameters.a, parameters.b, 0.0},
                    ellipse ? "ellipse rotation" : "hyperbola rotation");
  }

  bool parabola(const ConicLine& line) {
    if (!passes("parabola Ip", line.ip_chi2, line.ip_dof)) {
      return false;
    }
    const ConicParameters parameters = parabola_parameters(line.ip_mean, line.ip_variance);
    return parameters.status == InvariantStatus::Ok
               ? rotation(CurveClass::Parabola, {parameters.a, 0.0, 0.0}, "parabola rotation")
               : refused("parabola rotation", line.ip_dof);
  }

  /// The conic's invariants do not see the tangent angles, which are the best-measured of all: the
  /// class must explain them too.
  bool rotation(CurveClass curve_class, const Eigen::Vector3d& parameters, std::string_view name) {
    const double orientation = conic_orientation(curve_class, parameters, measured_);
    return leaf(fit_semi_signature(curve_class, measured_, parameters, orientation), name);
  }

  bool cubic(CurveClass curve_class) {
    if (curve_class == CurveClass::CubicalParabola) {
      return measured_.size() >= 2 && leaf(fit_cubical_parabola(measured_), "cubical parabola");
    }
    if (curve_class == CurveClass::SemiCubicalParabola) {
      return measured_.size() >= 2 &&
             leaf(fit_semi_cubical_parabola(measured_), "semi-cubical parabola");
    }
    return measured_.size() >= 4 && leaf(fit_cubic_spline(measured_, spline_), "cubic spline");
  }

  bool leaf(const SemiSignatureFit& fit, std::string_view name) {
    if (fit.status != InvariantStatus::Ok) {
      return refused(name, std::max(fit.dof, 1));
    }
    if (!passes(name, fit.chi2, fit.dof)) {
      return false;
    }
    reach(fit.curve_class, fit.parameters, fit.chi2, fit.dof);
    result_.covariance = shape_covariance(fit);
    result_.world_T_curve = pose_of(points_, fit);
    result_.places = fit.places;
    return true;
  }

  std::span<const TreePoint> points_;
  const RecognitionTreeOptions& options_;
  const SplineOptions& spline_;
  std::vector<MeasuredGeometry> measured_;
  TreeResult result_;
};

}  // namespace

TreeResult recognise_by_tree(std::span<const TreePoint> points,
                             const RecognitionTreeOptions& options, const SplineOptions& spline) {
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
                                          : SignificanceTree(points, options, spline).run();
}

}  // namespace palpate

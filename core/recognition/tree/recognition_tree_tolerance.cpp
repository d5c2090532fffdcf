#include "core/recognition/tree/recognition_tree_tolerance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/parabola_invariant.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/recognition/tree/tree_pose.h"

namespace palpate {
namespace {

/// Most points used, spread evenly: they have 28 pairs, of which the paper's tests need one.
constexpr std::size_t kPoints = 8;

/// Smallest and largest of a set of numbers, and their mean.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  int count = 0;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    sum += value;
    ++count;
  }
  double mean() const { return count > 0 ? sum / count : 0.0; }
  double size() const { return std::max(std::abs(low), std::abs(high)); }
  /// (max - min) / max size; infinite if nothing finite was added.
  double spread(double least_size = 0.0) const {
    const double unit = std::max(size(), least_size);
    const double value = count == 0   ? std::numeric_limits<double>::infinity()
                         : unit > 0.0 ? (high - low) / unit
                                      : 0.0;
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  }
};

class ToleranceTree {
 public:
  ToleranceTree(std::span<const TreePoint> points, double tolerance) : tolerance_(tolerance) {
    const std::size_t count = std::min(points.size(), kPoints);
    for (std::size_t i = 0; i < count; ++i) {
      result_.pooled.push_back(i * (points.size() - 1) / (count - 1));
      points_.push_back(points[result_.pooled.back()]);
      measured_.push_back(measured_geometry(points_.back().estimate, points_.back().patch));
      measured_.back().covariance.setZero();
    }
  }

  TreeResult run() {
    result_.status = InvariantStatus::Ok;
    if (!constant_curvature() && !conic() &&
        !parabola_of_third_degree(CurveClass::CubicalParabola) &&
        !parabola_of_third_degree(CurveClass::SemiCubicalParabola) && !spline()) {
      result_.status = InvariantStatus::NotThisClass;
    }
    return std::move(result_);
  }

 private:
  bool passes(std::string_view name, double value) {
    const bool passed = value <= tolerance_;
    result_.decisions.push_back({name, value, tolerance_, passed});
    return passed;
  }

  /// An invariant tested by a tolerance has no standard deviation.
  void add_invariant(CurveClass curve_class, std::string_view name, double value) {
    result_.invariants.push_back({curve_class, name, value});
  }

  /// `frame`: orientation of the curve, for classes that need it to localise points.
  void reach(CurveClass curve_class, const Eigen::Vector3d& parameters, double frame) {
    result_.shape = {curve_class, parameters};
    result_.world_T_curve = pose_by_places(result_.shape, points_, frame);
  }

  bool constant_curvature() {
    const double scale = curvature_scale(measured_);
    if (scale == 0.0) {
      result_.shape.curve_class = CurveClass::Line;
      result_.world_T_curve = line_pose(points_);
      return passes("line", 0.0);
    }
    Range size;
    Range change;
    for (const MeasuredGeometry& point : measured_) {
      size.add(std::abs(point.kappa) / scale);
      change.add(point.kappa_s / (scale * scale));
    }
    add_invariant(CurveClass::Circle, "kappa", size.mean() * scale);
    if (passes("circle", std::max(size.spread(), change.size()))) {
      const double radius = 1.0 / (size.mean() * scale);
      result_.shape = {CurveClass::Circle, {radius, 0.0, 0.0}};
      result_.world_T_curve =
          tangent_circle(points_, radius, RecognitionTreeOptions{}.relative_floor).pose;
      return true;
    }
    return false;
  }

  bool conic() {
    if (measured_.size() < 3) {
      return false;
    }
    Range ic1;
    Range ic2;
    Range unit;
    Range ip;
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      if (measured_[i].kappa == 0.0) {
        return passes("conic Ic1", std::numeric_limits<double>::infinity());
      }
      const double two_thirds = curvature_two_thirds(measured_[i].kappa);
      ip.add(parabola_invariant(measured_[i].kappa, measured_[i].kappa_s));
      unit.add(parabola_invariant(measured_[i].kappa, measured_[i].kappa_s) * two_thirds);
      for (std::size_t j = 0; j < i; ++j) {
        const double other = curvature_two_thirds(measured_[j].kappa);
        const ConicInvariants pair = conic_invariants(measured_[i], measured_[j]);
        if (pair.status == InvariantStatus::SignChange) {
          return passes("conic Ic1", std::numeric_limits<double>::infinity());
        }
        // Curvatures that are equal within the tolerance do not determine the slope between them,
        // Ic1.
        if (pair.status == InvariantStatus::Ok &&
            std::abs(two_thirds - other) > tolerance_ * std::max(two_thirds, other)) {
          ic1.add(pair.ic1);
          ic2.add(pair.ic2);
        }
      }
    }
    if (ic1.count > 0) {
      const CurveClass of_sign = ic1.mean() < 0.0 ? CurveClass::Hyperbola : CurveClass::Ellipse;
      add_invariant(of_sign, "Ic1", ic1.mean());
      add_invariant(of_sign, "Ic2", ic2.mean());
    }
    add_invariant(CurveClass::Parabola, "Ip", ip.mean());
    const double natural = unit.low;
    const bool flat = ic1.size() <= tolerance_ * natural;
    if (!flat && !passes("conic Ic1", ic1.spread())) {
      return false;
    }
    result_.decisions.push_back({"Ic1 not zero", ic1.size() / natural, tolerance_, !flat});
    const Eigen::Matrix2d none = Eigen::Matrix2d::Zero();
    ConicParameters parameters;
    CurveClass curve_class = CurveClass::Parabola;
    if (flat) {
      if (!passes("parabola Ip", ip.spread())) {
        return false;
      }
      parameters = parabola_parameters(ip.mean(), 0.0);
    } else if (ic1.mean() > 0.0) {
      curve_class = CurveClass::Ellipse;
      parameters = ellipse_parameters(ic1.mean(), ic2.mean(), none);
    } else {
      curve_class = CurveClass::Hyperbola;
      parameters = hyperbola_parameters(ic1.mean(), ic2.mean(), none);
    }
    if (parameters.status != InvariantStatus::Ok) {
      return false;
    }
    reach(curve_class, {parameters.a, parameters.b, 0.0}, 0.0);
    return true;
  }

  /// The pair for which the invariants agree best over all points fixes the frame. The mean over
  /// all points gives the invariants.
  bool parabola_of_third_degree(CurveClass curve_class) {
    const bool cubical = curve_class == CurveClass::CubicalParabola;
    double best = std::numeric_limits<double>::infinity();
    Eigen::Vector2d best_invariants = Eigen::Vector2d::Zero();
    double best_frame = 0.0;
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      for (std::size_t j = 0; j < measured_.size(); ++j) {
        const PairSolutions pair = i == j ? PairSolutions{}
                                   : cubical
                                       ? cubical_parabola_pair(measured_[i], measured_[j])
                                       : semi_cubical_parabola_pair(measured_[i], measured_[j]);
        for (int k = 0; k < pair.count; ++k) {
          const double frame =
              measured_[i].tangent_angle - pair.solutions[static_cast<std::size_t>(k)].angle;
          Range first;
          Range second;
          for (const MeasuredGeometry& point : measured_) {
            const auto p = canonical_point(point.tangent_angle - frame, point.kappa, point.kappa_s);
            first.add(cubical ? cubical_parabola_a(p) : semi_cubical_parabola_a_squared(p));
            second.add(cubical ? cubical_parabola_c(p) : semi_cubical_parabola_b(p));
          }
          const double value = std::max(first.spread(), second.spread());
          if (value < best) {
            best = value;
            best_invariants = {first.mean(), second.mean()};
            best_frame = frame;
          }
        }
      }
    }
    if (std::isfinite(best)) {
      add_invariant(curve_class, cubical ? "Icp1" : "Iscp1", best_invariants[0]);
      add_invariant(curve_class, cubical ? "Icp2" : "Iscp2", best_invariants[1]);
    }
    if (!passes(cubical ? "cubical parabola" : "semi-cubical parabola", best)) {
      return false;
    }
    const double a = cubical ? best_invariants[0] : std::sqrt(std::abs(best_invariants[0]));
    reach(curve_class, {a, best_invariants[1], 0.0}, best_frame);
    return true;
  }

  /// Three points give (a, b, c). Every other point in place of the third must give them again.
  bool spline() {
    if (measured_.size() < 4) {
      return false;
    }
    // In units of 1 / scale, (a, b, c) are pure numbers and can be compared by one norm.
    const double scale = curvature_scale(measured_);
    const Eigen::Vector3d to_numbers(1.0 / std::sqrt(scale), 1.0, std::sqrt(scale));
    double frame = 0.0;
    const auto parameters_of = [&](std::size_t third) -> Eigen::Vector3d {
      const std::array three{measured_[0], measured_[1], measured_[third]};
      const SemiSignatureFit fit = fit_cubic_spline(three);
      if (third == 2) {
        frame = fit.orientation;
      }
      return fit.status == InvariantStatus::Ok
                 ? Eigen::Vector3d(to_numbers.cwiseProduct(fit.parameters))
                 : Eigen::Vector3d::Zero();
    };
    const Eigen::Vector3d first = parameters_of(2);
    double worst = first.norm() > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 3; i < measured_.size(); ++i) {
      const Eigen::Vector3d other = parameters_of(i);
      worst = std::max(worst, (other - first).norm() / std::max(first.norm(), other.norm()));
    }
    if (first.norm() > 0.0) {
      const Eigen::Vector3d parameters = first.cwiseQuotient(to_numbers);
      add_invariant(CurveClass::CubicSpline, "a", parameters[0]);
      add_invariant(CurveClass::CubicSpline, "b", parameters[1]);
      add_invariant(CurveClass::CubicSpline, "c", parameters[2]);
    }
    if (!passes("cubic spline",
                std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity())) {
      return false;
    }
    reach(CurveClass::CubicSpline, first.cwiseQuotient(to_numbers), frame);
    return true;
  }

  double tolerance_;
  std::vector<TreePoint> points_;
  std::vector<MeasuredGeometry> measured_;
  TreeResult result_;
};

}  // namespace

TreeResult recognise_by_tolerance(std::span<const TreePoint> points,
                                  const RecognitionTreeOptions& options) {
  return ToleranceTree(points, options.relative_tolerance).run();
}

}  // namespace palpate

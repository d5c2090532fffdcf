#include "core/recognition/posterior/straight_paths.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/prior/arc_coordinates.h"
#include "core/recognition/prior/prior_lattice.h"

namespace palpate {
namespace {

/// Gauss and Legendre's rule of ten points over [0, 1].
constexpr int kRule = 10;
using Rule = Eigen::Array<double, kRule, 1>;
Rule rule_places() {
  Rule places;
  places << 0.013046735741414, 0.067468316655507, 0.160295215850488, 0.283302302935376,
      0.425562830509184, 0.574437169490816, 0.716697697064624, 0.839704784149512, 0.932531683344493,
      0.986953264258586;
  return places;
}
Rule rule_weights() {
  Rule weights;
  weights << 0.033335672154344, 0.074725674575290, 0.109543181257991, 0.134633359654998,
      0.147762112357376, 0.147762112357376, 0.134633359654998, 0.109543181257991, 0.074725674575290,
      0.033335672154344;
  return weights;
}

/// log of the likelihood where chi-square, as it counts, is lower by `rise` at its least: a normal
/// law where the noise is stated, otherwise what is left of it without its scale
/// (Likelihood::log_evidence).
Rule log_fall(const Rule& rise, const BendOfLine& bend) {
  return std::isfinite(bend.freedom) ? Rule(-0.5 * bend.freedom * (rise / bend.chi2).log1p())
                                     : Rule(-0.5 * rise);
}

/// log of the highest likelihood over that of the line.
double log_highest(const BendOfLine& bend) {
  return std::isfinite(bend.freedom) ? 0.5 * bend.freedom * std::log1p(bend.fall() / bend.chi2)
                                     : 0.5 * bend.fall();
}

/// How far from where it is highest 4e-5 of the likelihood is left: 4.5 deviations of a normal law.
double reach(const BendOfLine& bend) {
  constexpr double kFall = 4.5 * 4.5;
  return std::sqrt(std::isfinite(bend.freedom) ? bend.chi2 * std::expm1(kFall / bend.freedom)
                                               : kFall);
}

/// The likelihood of what is `curvature` and `rate` deviations from straight over the highest,
/// either side of the line alike probable.
Rule over_highest(const Rule& curvature, const Rule& rate, const BendOfLine& bend) {
  Rule sum = Rule::Zero();
  for (const double side : {-1.0, 1.0}) {
    for (const double rate_side : {-1.0, 1.0}) {
      sum += log_fall((curvature - side * bend.curvature).square() +
                          (rate - rate_side * bend.rate).square(),
                      bend)
                 .exp();
    }
  }
  return 0.25 * sum;
}

/// A shape of the prior by what is seen of it where it is large.
struct StraightShape {
  double curvature = 0.0;
  double rate = 0.0;
  double weight = 0.0;
};

/// Those that lie straight over most of their sizes first.
const std::vector<StraightShape>& straight_shapes(CurveClass curve_class) {
  static const auto all = [] {
    ByClass<std::vector<StraightShape>> result;
    for (const CurveClass each : kCurveClasses) {
      auto& shapes = result[each];
      for (const PriorShape& shape : prior_shapes(each)) {
        shapes.push_back({std::abs(shape.curvature), std::abs(shape.rate), shape.weight});
      }
      std::stable_sort(shapes.begin(), shapes.end(), [](const auto& a, const auto& b) {
        return a.weight * b.curvature * b.curvature > b.weight * a.curvature * a.curvature;
      });
    }
    return result;
  }();
  return all[curve_class];
}

/// The mean over a spline that is an arc (arc_coordinates.h), over the highest likelihood. Nearly
/// straight, the rate of curvature is the third derivative across. Shares of the prior up to so
/// much are uniform: those of |x| < s tan(p) are sin(p) and 2 p / pi by laws of 2 and of 1 degrees
/// of freedom.
double mean_over_arcs(const Rule& places, const Rule& weights, double farthest_curvature,
                      double farthest_rate, const BendOfLine& bend) {
  const double of_curvature = law_of_arc(1).scale / bend.curvature_sigma;
  const double of_rate = law_of_arc(3).scale / bend.rate_sigma;
  const double curvature_share = std::sin(std::atan(farthest_curvature / of_curvature));
  const double rate_share = 2.0 / kPi * std::atan(farthest_rate / of_rate);
  const Rule rate = of_rate * (0.5 * kPi * rate_share * places).tan();
  double sum = 0.0;
  for (int i = 0; i < kRule; ++i) {
    const double share = curvature_share * places[i];
    const double curvature = of_curvature * share / std::sqrt(1.0 - share * share);
    sum += weights[i] * (weights * over_highest(Rule::Constant(curvature), rate, bend)).sum();
  }
  return curvature_share * rate_share * sum;
}

}  // namespace

std::optional<BendOfLine> bend_of_line(const ClassEvidence& line, double chi2, const FitData& data,
                                       const Likelihood& likelihood) {
  if (residual_count(data) > data.points.size()) {
    return std::nullopt;
  }
  const TouchedCurve& curve = line.nodes[line.mode].curve;
  const double middle = curve.t[curve.t.size() / 2];
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d pull = Eigen::Vector4d::Zero();
  for (const FitPoint& point : data.points) {
    const Vec2 local = curve.frame_T_curve.to_local(point.position);
    const double x = local.x() - middle;
    const double weight = line.touch.weight * point.inverse_sigma;
    const Eigen::Vector4d row = weight * Eigen::Vector4d(1.0, x, x * x / 2.0, x * x * x / 6.0);
    information += row * row.transpose();
    pull += weight * local.y() * row;
  }
  constexpr double kRounding = 1e-14;  // of a difference of chi-squares, of either
  const Eigen::Matrix2d of_touch = information.topLeftCorner<2, 2>();
  const double determinant = of_touch.determinant();
  if (!(determinant > 0.0)) {
    return std::nullopt;
  }
  const Eigen::Matrix2d solved = of_touch.inverse() * information.topRightCorner<2, 2>();
  Eigen::Matrix2d bend =
      information.bottomRightCorner<2, 2>() - information.bottomLeftCorner<2, 2>() * solved;
  Eigen::Vector2d bend_pull = pull.tail<2>() - solved.transpose() * pull.head<2>();
  // To the place where both are told independently.
  const double moved = bend(0, 1) / bend(0, 0);
  const double of_rate = bend(1, 1) - moved * bend(0, 1);
  bend_pull[1] -= moved * bend_pull[0];
  if (!(bend(0, 0) > 0.0 && of_rate > 0.0)) {
    return std::nullopt;
  }
  BendOfLine result;
  result.curvature_sigma = 1.0 / std::sqrt(bend(0, 0));
  result.rate_sigma = 1.0 / std::sqrt(of_rate);
  result.curvature = bend_pull[0] * result.curvature_sigma;
  result.rate = bend_pull[1] * result.rate_sigma;
  if (!likelihood.sigma_known) {
    result.freedom = likelihood.freedom(line.determined);
    const double left = likelihood.left(chi2);
    result.chi2 = std::max(left - result.fall(), kRounding * left);
  }
  // Twice as far as the likelihood reaches: even of a normal law e^-40 is left of the line.
  constexpr double kFar = 2.0;
  if (!(std::sqrt(result.fall()) <= kFar * reach(result))) {
    return std::nullopt;
  }
  return result;
}

// With the size s over its centre's, curvature is k / s and its rate q / s^2. The prior of s is
// such that v = 1 / (1 + s^2) is uniform in [0, 1], and the likelihood is one of sqrt(v / (1 - v)).
double log_evidence_over_line(CurveClass curve_class, const BendOfLine& bend) {
  // Of the sizes at which shapes are as straight as the points allow: a few of the shapes have
  // nearly all. The rest is as likely as these were, on average.
  constexpr double kMostLeft = 0.05;
  static const Rule places = rule_places();
  static const Rule weights = rule_weights();
  const double beyond = reach(bend);
  const double farthest_curvature = beyond + std::abs(bend.curvature);
  const double farthest_rate = beyond + std::abs(bend.rate);
  const std::vector<StraightShape>& shapes = straight_shapes(curve_class);
  const auto end_of = [&](const StraightShape& shape) {
    const double by_curvature = farthest_curvature * bend.curvature_sigma / shape.curvature;
    const double by_rate = farthest_rate * bend.rate_sigma / shape.rate;
    const double most = std::min(by_curvature * by_curvature, by_rate);
    return std::isfinite(most) ? most / (1.0 + most) : 1.0;
  };
  double all = 0.0;
  for (const StraightShape& shape : shapes) {
    all += shape.weight * end_of(shape);
  }
  double taken = 0.0;
  double sum = 0.0;
  for (const StraightShape& shape : shapes) {
    const double end = end_of(shape);
    const Rule v = end * places;
    const Rule inverse_square = v / (1.0 - v);
    const double k = shape.curvature / bend.curvature_sigma;
    const double q = shape.rate / bend.rate_sigma;
    sum += shape.weight * end *
           (weights * over_highest(k * inverse_square.sqrt(), q * inverse_square, bend)).sum();
    taken += shape.weight * end;
    if (taken > (1.0 - kMostLeft) * all) {
      break;
    }
  }
  sum *= all / taken;
  if (curve_class == CurveClass::CubicSpline) {
    sum = 0.5 * (sum + mean_over_arcs(places, weights, farthest_curvature, farthest_rate, bend));
  }
  return log_highest(bend) + std::log(sum);
}

}  // namespace palpate

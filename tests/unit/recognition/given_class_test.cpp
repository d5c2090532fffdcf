// A class that is given: against 50-digit least squares, and what it says where there is none.
#include "core/recognition/given/given_class.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct ReferenceFit {
  std::string name;
  CurveClass curve_class = CurveClass::Unclassified;
  std::vector<double> values;    ///< [shape; x; y; theta]
  std::vector<double> rounding;  ///< of each: what the rounding of the coordinates makes of it
  double squares = 0.0;
  std::vector<GivenPoint> points;
};

/// tests/data/reference/make_given.py says what the lines are.
std::vector<ReferenceFit> reference_fits() {
  std::ifstream file(PALPATE_TEST_DATA "/reference/given.txt");
  std::vector<ReferenceFit> fits;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    const auto numbers = [&] {
      std::vector<double> values;
      for (double value; words >> value;) {
        values.push_back(value);
      }
      return values;
    };
    if (word == "case") {
      ReferenceFit& fit = fits.emplace_back();
      std::string class_name;
      words >> fit.name >> class_name;
      fit.curve_class = curve_class_from_name(class_name).value_or(CurveClass::Unclassified);
    } else if (word == "value") {
      fits.back().values = numbers();
    } else if (word == "rounding") {
      fits.back().rounding = numbers();
    } else if (word == "squares") {
      fits.back().squares = numbers().at(0);
    } else if (word != "#") {
      GivenPoint point;
      point.position_m.x() = std::stod(word);
      words >> point.position_m.y();
      fits.back().points.push_back(point);
    }
  }
  return fits;
}

std::vector<double> values_of(const GivenFit& fit) {
  std::vector<double> values;
  for (std::size_t i = 0; i < parameter_letters(fit.shape.curve_class).size(); ++i) {
    values.push_back(fit.shape.values[static_cast<Eigen::Index>(i)]);
  }
  values.insert(values.end(), {fit.world_T_curve.x, fit.world_T_curve.y, fit.world_T_curve.theta});
  return values;
}

/// Difference of two angles, modulo the pose's symmetry; a line runs either way.
double angle_error(CurveClass curve_class, double u, double v) {
  const bool half = curve_class == CurveClass::Line || pose_symmetry(curve_class) == 2;
  return std::abs(std::remainder(u - v, half ? kPi : 2.0 * kPi));
}

TEST(GivenClass, IsTheLeastSquaresOfFiftyDigits) {
  const std::vector<ReferenceFit> references = reference_fits();
  ASSERT_GT(references.size(), 50U);
  int compared = 0;
  for (const ReferenceFit& reference : references) {
    SCOPED_TRACE(reference.name);
    const GivenFit fit = fit_given_class(reference.curve_class, reference.points);
    ASSERT_EQ(fit.status, GivenStatus::Fitted) << name_of(fit.status);
    EXPECT_LE(fit.stationarity, 1e-12);
    const double n = static_cast<double>(reference.points.size());
    const double reference_rms = std::sqrt(reference.squares / n);
    // As low as rounding goes: of what is exact, an attometre.
    EXPECT_LE(fit.rms_m, reference_rms * (1.0 + 1e-12) + 1e-18);
    const bool interpolates =
        static_cast<int>(reference.points.size()) == degrees_of_freedom(reference.curve_class);
    if (!interpolates && fit.rms_m < reference_rms * (1.0 - 1e-9)) {
      // The reference follows each foot along its arm: beside a cusp a nearer one may be on the
      // other arm or the cusp itself.
      EXPECT_EQ(reference.curve_class, CurveClass::SemiCubicalParabola);
      continue;
    }
    const std::vector<double> values = values_of(fit);
    if (interpolates && values.size() > 3 &&
        std::abs(values[0] - reference.values[0]) > 1e-6 * std::abs(reference.values[0])) {
      continue;  // several curves of the class go through so few points
    }
    ASSERT_EQ(values.size(), reference.values.size());
    ++compared;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool angle = i + 1 == values.size();
      const double error = angle
                               ? angle_error(reference.curve_class, values[i], reference.values[i])
                               : std::abs(values[i] - reference.values[i]);
      EXPECT_LE(error, 10.0 * reference.rounding[i]) << "value " << i;
      EXPECT_LE(error, 1e-9 * std::abs(reference.values[i])) << "value " << i;
    }
  }
  EXPECT_GT(compared, 50);
}

// A part of centimetres has a parameter of roots of centimetres, where the class has such a one.
TEST(GivenClass, AFootIsWhereTheCurveHasItsParameter) {
  for (const ReferenceFit& reference : reference_fits()) {
    SCOPED_TRACE(reference.name);
    const GivenFit fit = fit_given_class(reference.curve_class, reference.points);
    const auto curve = make_curve(reference.curve_class, fit.shape.values);
    ASSERT_TRUE(curve.has_value());
    const double size =
        fit.residuals.front().foot_m.norm() + fit.world_T_curve.translation().norm();
    for (const GivenResidual& residual : fit.residuals) {
      const Vec2 there = fit.world_T_curve * position(*curve, residual.t);
      EXPECT_LE((there - residual.foot_m).norm(), 1e-6 * size);
    }
  }
}

std::vector<GivenPoint> on_curve(const Curve& curve, const Pose2& pose, double t0, double t1,
                                 int count, double noise_m, std::uint64_t stream) {
  std::mt19937_64 rng = test::test_rng(stream);
  std::normal_distribution<double> normal;
  std::vector<GivenPoint> points;
  for (int i = 0; i < count; ++i) {
    const double t = t0 + (t1 - t0) * (i + 0.5) / count;
    const CurveDerivatives d = derivatives(curve, t);
    GivenPoint point;
    point.position_m = pose * (d.position + noise_m * normal(rng) * left_of(d.first).normalized());
    points.push_back(point);
  }
  return points;
}

TEST(GivenClass, SaysWhyThereIsNone) {
  const std::vector<GivenPoint> straight = {{{0.0, 0.0}}, {{1.0, 2.0}},  {{2.0, 4.0}},
                                            {{3.0, 6.0}}, {{5.0, 10.0}}, {{7.0, 14.0}}};
  for (const CurveClass curve_class : kCurveClasses) {
    SCOPED_TRACE(name_of(curve_class));
    EXPECT_EQ(fit_given_class(curve_class, straight).status,
              curve_class == CurveClass::Line ? GivenStatus::Fitted : GivenStatus::Collinear);
    EXPECT_EQ(fit_given_class(curve_class, {}).status, GivenStatus::TooFewPoints);
    // The same few places again and again determine no more.
    std::vector<GivenPoint> repeated;
    for (int i = 0; i < 40; ++i) {
      const int place = i % (degrees_of_freedom(curve_class) - 1);
      repeated.push_back({{std::cos(1.0 * place), std::sin(1.0 * place)}});
    }
    EXPECT_EQ(fit_given_class(curve_class, repeated).status, GivenStatus::TooFewPoints);
    std::vector<GivenPoint> broken = straight;
    broken[2].position_m.y() = std::nan("");
    EXPECT_EQ(fit_given_class(curve_class, broken).status, GivenStatus::NotFinite);
  }
}

TEST(GivenClass, ConicsBeyondTheirClassEndAtItsLimit) {
  const auto hyperbola = on_curve(Hyperbola{0.02, 0.015}, {0.1, 0.2, 0.3}, -1.5, 1.5, 40, 1e-6, 1);
  EXPECT_EQ(fit_given_class(CurveClass::Ellipse, hyperbola).status, GivenStatus::AtLimit);
  EXPECT_EQ(fit_given_class(CurveClass::Hyperbola, hyperbola).status, GivenStatus::Fitted);
}

TEST(GivenClass, PointsSetAsideOnlyHaveResiduals) {
  auto points = on_curve(Circle{0.03}, {0.1, 0.2, 0.0}, 0.0, 2.0, 20, 1e-5, 2);
  const GivenFit without = fit_given_class(CurveClass::Circle, points);
  GivenPoint outlier;
  outlier.position_m = without.world_T_curve.translation() + Vec2(0.04, 0.0);
  outlier.set_aside = true;
  points.insert(points.begin() + 7, outlier);
  const GivenFit fit = fit_given_class(CurveClass::Circle, points);
  EXPECT_EQ(fit.used, 20U);
  EXPECT_NEAR(fit.shape.values[0], without.shape.values[0], 1e-17);
  EXPECT_NEAR(fit.residuals[7].distance_m, -(0.04 - fit.shape.values[0]), 1e-16);
  EXPECT_NEAR(fit.peak_to_valley_m, without.peak_to_valley_m, 1e-17);
}

TEST(GivenClass, OrderDoesNotMatterAndRoundTipsAreTakenOff) {
  // A tip of 3 mm radius outside an ellipse: its centres run counter-clockwise right of travel.
  const Ellipse ellipse{0.03, 0.02};
  const Pose2 pose{0.5, -0.2, 0.4};
  std::vector<GivenPoint> points;
  for (int i = 0; i < 12; ++i) {
    const double t = 5.0 * i;  // any order
    const CurveDerivatives d = derivatives(ellipse, t);
    GivenPoint point;
    point.position_m = pose * (d.position - 0.003 * left_of(d.first).normalized());
    point.tip_radius_m = 0.003;
    points.push_back(point);
  }
  const GivenFit fit = fit_given_class(CurveClass::Ellipse, points);
  ASSERT_EQ(fit.status, GivenStatus::Fitted);
  EXPECT_EQ(fit.side, -1);
  EXPECT_NEAR(fit.shape.values[0], 0.03, 1e-15);
  EXPECT_NEAR(fit.shape.values[1], 0.02, 1e-15);
  EXPECT_NEAR(fit.world_T_curve.theta, 0.4, 1e-13);
  // A circle's centres fit either side: the material decides.
  for (const double sign : {1.0, -1.0}) {
    std::vector<GivenPoint> ring;
    for (int i = 0; i < 8; ++i) {
      const Vec2 radial(std::cos(1.0 * i), std::sin(1.0 * i));
      GivenPoint point{0.02 * radial};
      point.tip_radius_m = 0.001;
      point.into_material = sign * radial;
      ring.push_back(point);
    }
    EXPECT_NEAR(fit_given_class(CurveClass::Circle, ring).shape.values[0], 0.02 + sign * 0.001,
                1e-16);
  }
}

/// Mean squared distance from a circle, in extended precision about the first point.
long double mean_square(const std::vector<GivenPoint>& points, const Vec2& origin, long double x,
                        long double y, long double radius) {
  long double sum = 0.0L;
  for (const GivenPoint& point : points) {
    const Vec2 p = point.position_m - origin;
    const long double d = std::hypot(p.x() - x, p.y() - y) - radius;
    sum += d * d;
  }
  return sum / static_cast<long double>(points.size());
}

TEST(GivenClass, EveryOneOfThirtyHardCirclesIsAnswered) {
  // Few points, short arcs, much form error, far offsets, repeated points; any order.
  int answered = 0;
  for (int scene = 0; scene < 30; ++scene) {
    SCOPED_TRACE(scene);
    std::mt19937_64 rng = test::test_rng(static_cast<std::uint64_t>(scene));
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const int count = std::array{4, 5, 7, 12, 40, 200}[static_cast<std::size_t>(scene % 6)];
    const double arc =
        std::array{2.0 * kPi, 1.5, 0.35, 0.09, 4.0}[static_cast<std::size_t>(scene % 5)];
    const double radius = std::pow(10.0, uniform(rng) * 5.0 - 3.0);
    const double offset = std::array{0.0, 1e3, 1e6}[static_cast<std::size_t>(scene % 3)] * radius;
    // Of the sagitta, so that the arc still bends; a full turn bears 30 %.
    const double form =
        (scene % 2 == 0 ? 0.01 : 0.1) * radius * (1.0 - std::cos(0.5 * std::min(arc, 3.0)));
    const Vec2 centre(offset + radius * normal(rng), -offset + radius * normal(rng));
    std::vector<GivenPoint> points;
    for (int i = 0; i < count; ++i) {
      const double angle = arc * uniform(rng) + 0.01 * scene;
      const double r = radius + form * normal(rng);
      points.push_back({centre + r * Vec2(std::cos(angle), std::sin(angle))});
    }
    for (int i = 0; i < scene % 4; ++i) {
      points.push_back(points[static_cast<std::size_t>(i)]);
    }
    const GivenFit fit = fit_given_class(CurveClass::Circle, points);
    ASSERT_EQ(fit.status, GivenStatus::Fitted) << name_of(fit.status);
    ++answered;
    EXPECT_LE(fit.stationarity, 1e-12);
    // No circle beside it is better: steps of a millionth of what moves the points by the rms.
    const Vec2 origin = points.front().position_m;
    const Vec2 local = fit.world_T_curve.translation() - origin;
    const auto square = [&](double dx, double dy, double da) {
      return mean_square(points, origin, static_cast<long double>(local.x()) + dx,
                         static_cast<long double>(local.y()) + dy,
                         static_cast<long double>(fit.shape.values[0]) + da);
    };
    const long double least = square(0.0, 0.0, 0.0);
    EXPECT_NEAR(static_cast<double>(std::sqrt(least)), fit.rms_m, 1e-9 * fit.rms_m);
    const double step = 1e-3 * fit.rms_m + 1e-9 * offset;
    for (const double sign : {1.0, -1.0}) {
      EXPECT_GE(square(sign * step, 0.0, 0.0), least);
      EXPECT_GE(square(0.0, sign * step, 0.0), least);
      EXPECT_GE(square(0.0, 0.0, sign * step), least);
    }
  }
  EXPECT_EQ(answered, 30);
}

TEST(GivenClass, CovarianceIsThatOfTheErrors) {
  // 100 trials a class: the mean of the normalised squared errors of n unknowns is n, its
  // standard deviation sqrt(2 n / 100); 4.5 of these.
  const int trials = test::stress_count(100);
  // So little that no valley bends within its own width: the covariance is to first order.
  constexpr double kNoise_m = 1e-7;
  const std::vector<std::pair<Curve, Vec2>> curves = {
      {Line{}, {-0.02, 0.03}},
      {Circle{0.03}, {0.0, 2.5}},
      {Ellipse{0.03, 0.02}, {0.0, 4.0}},
      {Parabola{0.01}, {-1.5, 1.5}},
      {Hyperbola{0.02, 0.015}, {-1.5, 1.5}},
      {CubicalParabola{300.0, 0.2}, {-0.05, 0.05}},
      {SemiCubicalParabola{6.0, 0.8}, {0.05, 0.25}},
      {CubicSpline{4.0, 0.5, -0.1}, {-0.15, 0.2}},
  };
  for (const auto& [curve, range] : curves) {
    SCOPED_TRACE(name_of(class_of(curve)));
    const Pose2 pose{0.2, -0.1, 0.3};
    const double unknowns = degrees_of_freedom(class_of(curve));
    double sum = 0.0;
    for (int trial = 0; trial < trials; ++trial) {
      auto points = on_curve(curve, pose, range[0], range[1], 40, kNoise_m,
                             static_cast<std::uint64_t>(100 + trial));
      for (GivenPoint& point : points) {
        point.sigma_m = kNoise_m;
      }
      const GivenFit fit = fit_given_class(class_of(curve), points);
      ASSERT_EQ(fit.status, GivenStatus::Fitted);
      const auto n = fit.covariance.rows();
      Eigen::VectorXd error(n);
      error.head(n - 3) = fit.shape.values.head(n - 3) - parameters(curve).head(n - 3);
      error[n - 3] = fit.world_T_curve.x - pose.x;
      error[n - 2] = fit.world_T_curve.y - pose.y;
      error[n - 1] = class_of(curve) == CurveClass::Circle
                         ? 0.0
                         : std::remainder(fit.world_T_curve.theta - pose.theta, kPi);
      if (class_of(curve) == CurveClass::Line) {
        // Along itself it slides.
        const Vec2 normal(-std::sin(fit.world_T_curve.theta), std::cos(fit.world_T_curve.theta));
        const Vec2 mean = Vec2(fit.world_T_curve.x, fit.world_T_curve.y);
        const Vec2 true_normal(-std::sin(pose.theta), std::cos(pose.theta));
        const double across = true_normal.dot(mean - pose.translation());
        const double variance = normal.dot(fit.covariance.topLeftCorner<2, 2>() * normal);
        sum += across * across / variance + error[2] * error[2] / fit.covariance(2, 2);
        continue;
      }
      const auto free = class_of(curve) == CurveClass::Circle ? n - 1 : n;
      const Eigen::MatrixXd covariance = fit.covariance.topLeftCorner(free, free);
      const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd unit = scale.asDiagonal() * covariance * scale.asDiagonal();
      const Eigen::VectorXd scaled = scale.asDiagonal() * error.head(free);
      sum += scaled.dot(unit.ldlt().solve(scaled));
    }
    EXPECT_NEAR(sum / trials, unknowns, 4.5 * std::sqrt(2.0 * unknowns / trials));
  }
}

}  // namespace
}  // namespace palpate

#include "core/recognition/posterior/straight_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/curves/curve.h"
#include "core/recognition/prior/touched_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Of Student's law whose density falls with the power freedom + 1, its core as wide as `scale`.
double student(int freedom, double scale, std::mt19937_64& rng) {
  return scale / std::sqrt(freedom) * std::student_t_distribution<double>(freedom)(rng);
}

/// log of a size of sqrt(20) half extents over the size of a shape of length 1.
double log_of_length(double size) { return 0.5 * std::log(20.0) - std::log(size); }

/// A shape touched far out on an arm, drawn as core/README.md states it, its size the expected one,
/// half the diagonal of its box.
TouchedVector drawn_on_arms(CurveClass curve_class, std::mt19937_64& rng) {
  TouchedVector z = TouchedVector::Zero();
  switch (curve_class) {
    case CurveClass::Hyperbola: {  // a wedge, its place that of y / b
      const double square = std::uniform_real_distribution<double>(0.0, 1.0)(rng);
      z[1] = square / (1.0 - square);
      z[2] = student(6, 2.0, rng) / std::sqrt(square);
      z[0] = log_of_length(std::sqrt(1.0 + z[1]) / z[1]);
      break;
    }
    case CurveClass::Ellipse:
    case CurveClass::Parabola: {
      const double slope = student(2, 3.0 * std::numbers::sqrt3, rng);
      if (curve_class == CurveClass::Parabola) {
        z[1] = slope;
      } else {
        z[1] = 1.0 - std::sqrt(std::uniform_real_distribution<double>(0.0, 1.0)(rng));
        z[2] = std::atan2(1.0, slope);
      }
      const double end = std::hypot(3.0, slope);
      z[0] = log_of_length(0.5 * std::hypot(0.5 * end * end, 2.0 * end));
      break;
    }
    default: {  // cubical parabola
      z[1] = student(4, 2.7001, rng);
      z[2] = student(4, 2.7001, rng);
      const double end = std::hypot(1.0, z[2]);
      z[0] = log_of_length(end * std::sqrt(1.0 + std::pow(end, 4) + z[1] * z[1]));
      break;
    }
  }
  return z;
}

/// A shape drawn from the prior, its size the expected one.
TouchedVector drawn(CurveClass curve_class, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const bool has_arms = curve_class == CurveClass::Ellipse || curve_class == CurveClass::Parabola ||
                        curve_class == CurveClass::Hyperbola ||
                        curve_class == CurveClass::CubicalParabola;
  if (has_arms && uniform(rng) < 0.1) {
    return drawn_on_arms(curve_class, rng);
  }
  TouchedVector z = prior_centre({curve_class});
  switch (curve_class) {
    case CurveClass::Ellipse: {
      z[1] = uniform(rng);
      z[0] += std::log(z[1] * std::sqrt(2.0 / (1.0 + z[1])));  // half the diagonal is the size
      double angle = 0.0;
      do {  // evenly by arc length
        angle = kPi * uniform(rng);
      } while (uniform(rng) > std::hypot(std::sin(angle), std::sqrt(z[1]) * std::cos(angle)));
      z[2] = std::atan2(std::sqrt(z[1]) * std::cos(angle), -std::sin(angle));
      break;
    }
    case CurveClass::Hyperbola:
      do {
        z[1] = 1.0 + std::tan(kPi * (uniform(rng) - 0.5));
      } while (!(z[1] > 0.0));
      z[2] = student(6, 2.0, rng);
      break;
    case CurveClass::Parabola:
      z[1] = student(6, 2.0, rng);
      break;
    case CurveClass::CubicalParabola:
      z[1] = student(6, 2.0, rng);
      z[2] = student(10, 1.4, rng);
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      z[1] = student(6, 2.0, rng);
      z[2] = student(8, 2.45, rng);
      if (curve_class == CurveClass::CubicSpline) {
        z[3] = student(4, 3.0, rng);
      }
      break;
    default:
      break;
  }
  return z;
}

/// The likelihood over that of the line, so many deviations from where it is highest.
double over_line(const BendOfLine& bend, double curvature_off, double rate_off) {
  const double off = curvature_off * curvature_off + rate_off * rate_off;
  const double of_line = bend.curvature * bend.curvature + bend.rate * bend.rate;
  return std::isfinite(bend.freedom)
             ? std::pow((bend.chi2 + off) / (bend.chi2 + of_line), -0.5 * bend.freedom)
             : std::exp(0.5 * (of_line - off));
}

/// The same, the mean over either side of the line and either sense of the rate.
double over_line_on_all_sides(const BendOfLine& bend, double curvature, double rate) {
  double sum = 0.0;
  for (const double side : {-1.0, 1.0}) {
    for (const double rate_side : {-1.0, 1.0}) {
      sum +=
          0.25 * over_line(bend, curvature - side * bend.curvature, rate - rate_side * bend.rate);
    }
  }
  return sum;
}

struct Mean {
  double value = 0.0;
  double error = 0.0;  ///< its standard error
};

/// The mean over the prior, the sizes of each shape by a fine trapezoid. As many shapes under a
/// sanitizer too: with fewer the mean is not known well enough to compare with.
Mean mean_over_prior(CurveClass curve_class, const BendOfLine& bend, std::mt19937_64& rng) {
  const int shapes = curve_class == CurveClass::Circle ? 1 : 20000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < shapes; ++i) {
    const auto shape =
        shape_at({curve_class}, drawn(curve_class, rng), {Eigen::Vector3d::Ones(), 0.0});
    const auto curve = shape ? make_curve(curve_class, shape->values) : std::nullopt;
    if (!curve) {
      continue;
    }
    const LocalGeometry local = geometry(*curve, shape->t);
    double over_sizes = 0.0;
    constexpr double kStep = 0.25;
    for (double log_size = -6.0; log_size < 20.0; log_size += kStep) {
      const double secant = 1.0 / std::cosh(log_size);
      const double size = std::exp(log_size);
      const double k = local.kappa / size / bend.curvature_sigma;
      const double q = local.kappa_s / (size * size) / bend.rate_sigma;
      over_sizes += 0.5 * secant * secant * kStep * over_line_on_all_sides(bend, k, q);
    }
    if (curve_class == CurveClass::CubicSpline) {  // half are arcs
      const double k = student(2, 2.0 / std::sqrt(20.0), rng) / bend.curvature_sigma;
      const double q = student(1, 0.3, rng) / bend.rate_sigma;
      over_sizes = 0.5 * (over_sizes + over_line_on_all_sides(bend, k, q));
    }
    sum += over_sizes;
    squares += over_sizes * over_sizes;
  }
  const double mean = sum / shapes;
  return {mean, std::sqrt(std::max(0.0, squares / shapes - mean * mean) / shapes)};
}

/// What the lattice may leave of the logarithm: a twelfth of what tells odds of 19 to 1 from even.
constexpr double kLatticeError = 0.25;

TEST(StraightPaths, AreThoseOfThePrior) {
  std::mt19937_64 rng = test::test_rng();
  for (const BendOfLine& bend :
       {BendOfLine{1e-2, 5e-2, 0.0, 0.0}, BendOfLine{3e-2, 0.15, 1.0, -2.0},
        BendOfLine{0.3, 1.5, 3.0, 1.0},
        // Noise that five residuals are to tell, and a hundred.
        BendOfLine{1e-2, 5e-2, 1.0, 1.0, 4.0, 5.0}, BendOfLine{0.3, 1.5, 3.0, 1.0, 90.0, 100.0}}) {
    for (const CurveClass curve_class : kCurveClasses) {
      if (curve_class == CurveClass::Line) {
        continue;
      }
      const Mean mean = mean_over_prior(curve_class, bend, rng);
      EXPECT_NEAR(log_evidence_over_line(curve_class, bend), std::log(mean.value),
                  kLatticeError + 5.0 * mean.error / mean.value)
          << name_of(curve_class) << ", " << bend.curvature_sigma << ", " << bend.freedom;
    }
  }
}

TEST(StraightPaths, AreNumbersAsFarAsTheyAreAskedFor) {
  for (const double freedom : {1.0, 3.0, 1000.0, std::numeric_limits<double>::infinity()}) {
    for (const double away : {9.0, 1e3, 1e6}) {
      const BendOfLine bend{1e-3, 5e-3, away, 0.0, 1e-6, freedom};
      for (const CurveClass curve_class : kCurveClasses) {
        if (curve_class == CurveClass::Line) {
          continue;
        }
        // What is told to bend so has at most the likelihood where it is highest.
        const double most = std::isfinite(freedom) ? 0.5 * freedom * std::log1p(away * away / 1e-6)
                                                   : 0.5 * away * away;
        EXPECT_LE(log_evidence_over_line(curve_class, bend), most)
            << name_of(curve_class) << ", " << away << ", " << freedom;
      }
    }
  }
}

}  // namespace
}  // namespace palpate

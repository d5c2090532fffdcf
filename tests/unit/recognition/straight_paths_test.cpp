#include "core/recognition/posterior/straight_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/curves/curve.h"
#include "core/recognition/posterior/touched_coordinates.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Of Student's law whose density falls with the power freedom + 1, its core as wide as `scale`.
double student(int freedom, double scale, std::mt19937_64& rng) {
  return scale / std::sqrt(freedom) * std::student_t_distribution<double>(freedom)(rng);
}

/// A shape drawn from the prior as core/README.md states it, its size the expected one.
TouchedVector drawn(CurveClass curve_class, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  TouchedVector z = prior_centre(curve_class);
  switch (curve_class) {
    case CurveClass::Ellipse:
      z[1] = uniform(rng);
      do {  // density sin^2 + m cos^2
        z[2] = kPi * uniform(rng);
      } while (uniform(rng) > 1.0 - (1.0 - z[1]) * std::cos(z[2]) * std::cos(z[2]));
      break;
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
        shape_at(curve_class, drawn(curve_class, rng), {Eigen::Vector3d::Ones(), 0.0});
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
      const auto over_line = [](double x, double best) {
        return 0.5 * (std::exp(-0.5 * x * x + best * x) + std::exp(-0.5 * x * x - best * x));
      };
      over_sizes +=
          0.5 * secant * secant * kStep * over_line(k, bend.curvature) * over_line(q, bend.rate);
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
        BendOfLine{0.3, 1.5, 3.0, 1.0}}) {
    for (const CurveClass curve_class : kCurveClasses) {
      if (curve_class == CurveClass::Line) {
        continue;
      }
      const Mean mean = mean_over_prior(curve_class, bend, rng);
      EXPECT_NEAR(log_evidence_over_line(curve_class, bend), std::log(mean.value),
                  kLatticeError + 5.0 * mean.error / mean.value)
          << name_of(curve_class) << ", " << bend.curvature_sigma;
    }
  }
}

}  // namespace
}  // namespace palpate

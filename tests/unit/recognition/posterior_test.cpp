// The evidence against integrals by brute force, and what follows from it.
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/modes/mode_search.h"
#include "core/recognition/modes/slices.h"
#include "core/recognition/posterior/laplace_evidences.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "core/numerics/probability/log_add.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/smooth/smooth_model.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

/// A scene's reduced points and a class fitted to them.
struct Fitted {
  SmoothModel smooth;
  ClassFits fits;

  explicit Fitted(const test::Scene& scene) {
    FitData data = test::fit_data(scene, scene.sigma_m);
    smooth = fit_smooth_model(&data, true);
    fits = fit_classes(smooth.reduced, test::unbounded_work());
  }
  std::optional<CanonicalFit> canonical(CurveClass curve_class) const {
    const auto& fit = fits[static_cast<std::size_t>(curve_class)];
    return fit && !fit->at_limit ? to_canonical(*fit, smooth.reduced) : std::nullopt;
  }
};

test::Scene scene_of(CurveClass curve_class, double arc, double sigma, int patches,
                     std::mt19937_64& rng) {
  test::SceneOptions options;
  options.patches = patches;
  options.sigma_over_size = sigma;
  options.least_fraction = options.most_fraction = arc;
  return test::random_scene(curve_class, options, rng);
}

std::optional<ClassEvidence> sliced(const CanonicalFit& fit, const FitData& data) {
  auto laplace = evidence_of(fit, data, 1.0, test::unbounded_work());
  return laplace
             ? by_slices(*std::move(laplace), data, 1.0, Slices::ForMass, test::unbounded_work())
             : std::nullopt;
}

/// log of the mean of exp(-(chi2 - fitted) / 2) over the prior, on a grid over shape, offset and
/// turn: no gradient, no Gauss-Newton step.
double log_occam_by_grid(const ClassEvidence& evidence, const TouchedCurve& centre,
                         const FitData& data, const TouchedVector& low, const TouchedVector& high,
                         std::span<const int> steps, double fitted_chi2) {
  const Touch& touch = evidence.touch;
  const auto n = static_cast<int>(steps.size());
  std::vector<int> index(steps.size(), 0);
  TouchedVector step = TouchedVector::Zero();
  double cell = 1.0;
  for (int k = 0; k < n; ++k) {
    step[k] = (high[k] - low[k]) / steps[static_cast<std::size_t>(k)];
    cell *= step[k] / std::sqrt(2.0 * kPi);
  }
  double sum = 0.0;
  while (true) {
    TouchedVector z = TouchedVector::Zero();
    for (int k = 0; k < n; ++k) {
      z[k] = low[k] + (index[static_cast<std::size_t>(k)] + 0.5) * step[k];
    }
    if (const auto curve = curve_at(touch, z, centre, data)) {
      sum += std::exp(-0.5 * (curve->chi2 - fitted_chi2) + curve->log_prior) /
             curve->widths.head(n).prod();
    }
    int k = 0;
    while (k < n && ++index[static_cast<std::size_t>(k)] == steps[static_cast<std::size_t>(k)]) {
      index[static_cast<std::size_t>(k++)] = 0;
    }
    if (k == n) {
      return std::log(sum * cell);
    }
  }
}

TEST(ClassEvidence, OfACircleIsTheIntegralOverItsPrior) {
  // From well determined to as good as a line, where the radius runs over decades.
  std::mt19937_64 rng = test::test_rng();
  for (const double arc : {0.3, 0.05, 0.01, 0.003}) {
    const Fitted fitted(scene_of(CurveClass::Circle, arc, 1e-3, 1, rng));
    const auto canonical = fitted.canonical(CurveClass::Circle);
    ASSERT_TRUE(canonical.has_value());
    const FitData& data = fitted.smooth.reduced;
    const auto evidence = sliced(*canonical, data);
    ASSERT_TRUE(evidence.has_value());
    const TouchedCurve& centre = evidence->nodes[evidence->nodes.size() / 2].curve;
    TouchedVector low = TouchedVector::Zero();
    TouchedVector high = TouchedVector::Zero();
    low[0] = evidence->nodes.front().curve.z[0];
    high[0] = evidence->nodes.back().curve.z[0];
    if (evidence->nodes.size() == 1) {
      const double deviation = centre.widths[0] / centre.root.row(0).norm();
      low[0] -= 40.0 * deviation;
      high[0] += 40.0 * deviation;
    }
    for (int k = 1; k < 3; ++k) {
      // The offset bends with the radius: four times its own deviations.
      const double deviation = centre.widths[k] / centre.root.row(k).norm();
      low[k] = -12.0 * deviation;
      high[k] = 12.0 * deviation;
    }
    double fitted_chi2 = 0.0;
    for (const FittedPoint& point : canonical->points) {
      fitted_chi2 += point.residual * point.residual;
    }
    // Cells of at most h = 1.4 deviations: the sum over a normal law is right to
    // 2 exp(-2 pi^2 / h^2), 1e-4.
    constexpr std::array kSteps = {60, 30, 30};
    const double by_grid =
        log_occam_by_grid(*evidence, centre, data, low, high, kSteps, fitted_chi2);
    // The grid reaches as far as the slices. Their densities are right to a fiftieth each
    // (kSettledPotential), sums of a normal law's that are 1.25 times as far apart as asked to a
    // hundredth, and where steps change from one to the next that may be lost again.
    EXPECT_NEAR(evidence->log_occam, by_grid, 0.1) << "arc " << arc;
  }
}

/// A line's points are linear in its coordinates but for turn^2 / 2.
TEST(ModeSearch, CountsWhatADescentLeavesToGain) {
  std::mt19937_64 rng = test::test_rng();
  const Fitted fitted(scene_of(CurveClass::Line, 0.3, 1e-4, 1, rng));
  const FitData& data = fitted.smooth.reduced;
  const auto evidence =
      evidence_of(*fitted.canonical(CurveClass::Line), data, 1.0, test::unbounded_work());
  ASSERT_TRUE(evidence.has_value());
  const TouchedCurve mode = descend(evidence->touch, data, evidence->nodes.front().curve, -1,
                                    test::unbounded_work(), kStepsFromFit, 1e-12);
  for (const int k : {0, 1}) {
    // A quarter of a deviation: a potential of 1 / 32 is left to gain, less than ends a descent.
    TouchedVector z = mode.z;
    z[k] += 0.25 * mode.widths[k] / mode.root.row(k).norm();
    const auto beside = curve_at(evidence->touch, z, mode, data);
    ASSERT_TRUE(beside.has_value());
    const TouchedCurve left =
        descend(evidence->touch, data, *beside, -1, test::unbounded_work(), kStepsFromFit);
    EXPECT_EQ(left.z, z) << k;
    EXPECT_NEAR(left.left_to_gain, 1.0 / 32.0, 1e-4) << k;
    EXPECT_NEAR(log_mass(left), log_mass(mode), 1e-4) << k;
    EXPECT_NEAR(potential(left) - potential(mode), 1.0 / 32.0, 1e-4) << k;
  }
}

/// A spline of these coordinates, touched for half of the stroke to either side of its place.
std::optional<ClassEvidence> evidence_of_spline(const TouchedVector& z, double sigma_m) {
  const auto shape = shape_at({CurveClass::CubicSpline}, z, {});
  const auto curve = make_curve(CurveClass::CubicSpline, shape->values);
  test::Scene scene;
  scene.curve_class = CurveClass::CubicSpline;
  CanonicalFit fit;
  fit.shape = {CurveClass::CubicSpline, shape->values};
  scene.patches.emplace_back();
  constexpr int kToEitherSide = 30;
  for (int i = -kToEitherSide; i <= kToEitherSide; ++i) {
    const double t = parameter_at_arc_length(*curve, shape->t, 1.0 * i / kToEitherSide);
    scene.patches.front().push_back(position(*curve, t));
    fit.points.push_back({t, 0.0, Vec2::Zero()});
  }
  return evidence_of(fit, test::fit_data(scene, sigma_m), 1.0, test::unbounded_work());
}

TEST(ClassEvidence, OfASharpBendInTheMiddleOfAStrokeIsMostlyThatOfAnArc) {
  TouchedVector sharp = TouchedVector::Zero();
  sharp.head<4>() << 4.08, 1.73, -0.0252, -0.053;
  const auto of_arc = evidence_of_spline(sharp, 1e-4);
  ASSERT_TRUE(of_arc.has_value());
  EXPECT_FALSE(of_arc->touch.as_arc);
  // The density of the arcs is e^10 times that of the other half at the mode, e^6 at the least
  // beside it.
  EXPECT_GT(of_arc->log_all_modes, 3.0);
  // As sharp a bend that the stroke ends at is seldom one.
  TouchedVector beside = sharp;
  beside[2] = -0.3;
  const auto of_cusp = evidence_of_spline(beside, 1e-4);
  ASSERT_TRUE(of_cusp.has_value());
  EXPECT_LT(of_cusp->log_all_modes, 0.1);
}

/// log of the mean of likelihood over likelihood at the fit, over the half of the spline's prior
/// that is one of arcs, about its mode: by draws from a law of normal height and wider tails.
/// Beyond a cubical parabola the arc is a spline travelled the other way.
struct DrawnIntegral {
  double log_occam = 0.0;
  double deviation = 0.0;
};

DrawnIntegral log_occam_by_draws(const ClassEvidence& evidence, const FitData& data,
                                 std::mt19937_64& rng) {
  constexpr int kDraws = 4000;
  constexpr double kWider = 1.2;  // of deviations
  const TouchedCurve& mode = evidence.nodes[evidence.mode].curve;
  TouchedCurve turned = mode;
  for (double& s : turned.t) {
    s = -s;
  }
  Touch back = evidence.touch;
  back.tangent = -back.tangent;
  const double log_determinant_of_root = mode.root.diagonal().array().log().sum();
  std::normal_distribution<double> normal;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    TouchedVector u;
    for (int k = 0; k < kMostCoordinates; ++k) {
      u[k] = kWider * normal(rng);
    }
    const TouchedVector away = mode.root.transpose().triangularView<Eigen::Upper>().solve(u);
    const TouchedVector z = mode.z + away.cwiseProduct(mode.widths);
    TouchedVector z_back = z;
    z_back.head<2>() *= -1.0;  // the second derivatives, in the other tangent's frame
    z_back[4] *= -1.0;         // the offset
    auto curve = curve_at(evidence.touch, z, mode, data);
    if (!curve) {
      curve = curve_at(back, z_back, turned, data);
    }
    if (!curve) {
      continue;
    }
    const double log_of_law = -0.5 * u.squaredNorm() / (kWider * kWider) -
                              kMostCoordinates * std::log(kWider) + log_determinant_of_root;
    const double ratio = std::exp(-potential(*curve) + 0.5 * evidence.fitted_chi2 - log_of_law);
    sum += ratio;
    squares += ratio * ratio;
  }
  const double mean = sum / kDraws;
  return {std::log(mean), std::sqrt(squares / kDraws - mean * mean) / std::sqrt(kDraws) / mean};
}

TEST(ClassEvidence, OfASplineBesideACubicalParabolaIsTheIntegralOverItsArcs) {
  // Where the true curve is the limit, the splines that fit have their vertex at some hundreds of
  // half extents to where no double holds it.
  std::mt19937_64 rng = test::test_rng();
  for (const double sigma : {1e-4, 1e-5, 1e-6}) {
    for (int i = 0; i < 5; ++i) {
      const Fitted fitted(scene_of(CurveClass::CubicalParabola, 0.5, sigma, 1, rng));
      const auto canonical = fitted.canonical(CurveClass::CubicSpline);
      ASSERT_TRUE(canonical.has_value()) << sigma;
      const FitData& data = fitted.smooth.reduced;
      const auto evidence = evidence_of(*canonical, data, 1.0, test::unbounded_work());
      ASSERT_TRUE(evidence.has_value()) << sigma;
      EXPECT_TRUE(evidence->touch.as_arc) << sigma;
      const DrawnIntegral by_draws = log_occam_by_draws(*evidence, data, rng);
      // A descent ends within a fiftieth of the mode (kSettledPotential), and a normal law leaves
      // out what the arcs' residuals have of second order: as much again, with so little noise.
      EXPECT_NEAR(evidence->log_occam, by_draws.log_occam, 0.05 + 4.0 * by_draws.deviation)
          << sigma;
    }
  }
}

TEST(ClassEvidence, DoesNotChangeWithTheUnitOrThePlace) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    const test::Scene scene = scene_of(curve_class, 0.2, 1e-4, 2, rng);
    test::Scene moved = scene;
    const Pose2 motion{-0.7, 0.4, 2.0};
    for (auto& patch : moved.patches) {
      for (Vec2& p : patch) {
        p = 1000.0 * (motion * p);
      }
    }
    moved.sigma_m *= 1000.0;
    const auto a = Fitted(scene).canonical(curve_class);
    const auto b = Fitted(moved).canonical(curve_class);
    if (!a || !b) {
      continue;
    }
    const auto ea = sliced(*a, Fitted(scene).smooth.reduced);
    const auto eb = sliced(*b, Fitted(moved).smooth.reduced);
    ASSERT_EQ(ea.has_value(), eb.has_value()) << name_of(curve_class);
    if (ea) {
      EXPECT_NEAR(ea->log_occam, eb->log_occam, 0.02) << name_of(curve_class);
    }
  }
}

TEST(ClassEvidence, ByLaplacesFormulaHasNoSlicedCoordinate) {
  auto rng = test::test_rng();
  int sliced_ones = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Fitted fitted(scene_of(CurveClass::Ellipse, 0.2, 1e-3, 1, rng));
    const auto fit = fitted.canonical(CurveClass::Ellipse);
    const auto evidence = fit ? sliced(*fit, fitted.smooth.reduced) : std::nullopt;
    if (evidence && evidence->widest >= 0) {
      ++sliced_ones;
      const ClassEvidence again = counted_from(evidence->fitted_chi2, *evidence);
      EXPECT_EQ(again.nodes.size(), 1U);
      EXPECT_EQ(again.widest, -1);
    }
  }
  EXPECT_GT(sliced_ones, 0);
}

TEST(ClassEvidence, ABetterProbeLeavesLessOfThePrior) {
  // Each determined coordinate is worth a factor of ten for noise of a tenth.
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : {CurveClass::Line, CurveClass::Circle, CurveClass::Parabola,
                                       CurveClass::Ellipse, CurveClass::CubicSpline}) {
    const test::Scene scene = scene_of(curve_class, 0.2, 1e-5, 3, rng);
    const auto fit = Fitted(scene).canonical(curve_class);
    ASSERT_TRUE(fit.has_value());
    const FitData reduced = Fitted(scene).smooth.reduced;
    const auto evidence = evidence_of(*fit, reduced, 1.0, test::unbounded_work());
    const auto coarser = evidence_of(*fit, reduced, 100.0, test::unbounded_work());
    ASSERT_TRUE(evidence && coarser);
    const double per_decade = (coarser->log_occam - evidence->log_occam) / std::log(10.0);
    EXPECT_NEAR(per_decade, degrees_of_freedom(curve_class), 0.1) << name_of(curve_class);
    EXPECT_NEAR(evidence->determined, degrees_of_freedom(curve_class), 0.1);
  }
}

/// log of the integral of sigma^-exponent exp(-chi2 / (2 sigma^2)) over log sigma, by the
/// trapezoidal rule.
double log_integral(double chi2, double exponent) {
  double sum = 0.0;
  constexpr double kStep = 1e-3;
  const double middle = 0.5 * std::log(chi2 / exponent);
  for (double x = middle - 6.0; x < middle + 6.0; x += kStep) {
    sum += kStep * std::exp(-exponent * (x - middle) - 0.5 * chi2 * std::exp(-2.0 * x));
  }
  return std::log(sum) - exponent * middle;
}

Likelihood of_unknown_noise(double samples) {
  Likelihood likelihood;
  likelihood.sigma_known = false;
  likelihood.samples = samples;
  return likelihood;
}

TEST(Likelihood, UnknownNoiseIsIntegratedOut) {
  const Likelihood likelihood = of_unknown_noise(40.0);
  constexpr double kOccam = -12.0;
  const double ratio =
      likelihood.log_evidence(35.0, kOccam, 3.0) - likelihood.log_evidence(44.0, kOccam, 3.0);
  EXPECT_NEAR(ratio, log_integral(35.0, 37.0) - log_integral(44.0, 37.0), 1e-6);
}

// Five coordinates of a fit so bad that the noise it tells leaves them to the prior: a normal law
// of the width 1 where the likelihood's is a thousandth of the noise.
TEST(Likelihood, NoPriorLeavesMoreThanAllOfABadFit) {
  const Likelihood likelihood = of_unknown_noise(8.0);
  constexpr double kCoordinates = 5.0;
  const double occam = -kCoordinates * std::log(1e3);
  constexpr double kGood = 4.0;
  constexpr double kBad = 1e12;
  const double good = likelihood.log_evidence(kGood, occam, kCoordinates);
  const double bad = likelihood.log_evidence(kBad, occam, kCoordinates);
  EXPECT_NEAR(bad - good,
              log_integral(kBad, 8.0) - (log_integral(kGood, 8.0 - kCoordinates) + occam), 1e-6);
  EXPECT_LE(bad, likelihood.log_evidence(kBad, 0.0, 0.0));
}

TEST(Likelihood, NoStatedFormErrorChangesNothing) {
  Likelihood likelihood;
  likelihood.noise_chi2 = 90.0;
  EXPECT_EQ(likelihood.counted(123.0), 123.0);
  EXPECT_EQ(likelihood.inflation(), 1.0);
  likelihood.coherent_variance = 9.0;
  EXPECT_DOUBLE_EQ(likelihood.counted(100.0), 91.0);  // only what exceeds the noise
}

TEST(Posterior, SumsToOneAndFollowsTheEvidence) {
  std::mt19937_64 rng = test::test_rng();
  const Fitted fitted(scene_of(CurveClass::Ellipse, 0.2, 1e-4, 3, rng));
  ClassFits fits = fitted.fits;
  for (auto& fit : fits) {
    if (fit) {
      fit->chi2 += fitted.smooth.chi2;
    }
  }
  Likelihood likelihood;
  const Evidences evidences = evidences_of(fits, fitted.fits, fitted.smooth, fitted.smooth.reduced,
                                           likelihood, {}, test::unbounded_work());
  const ClassProbabilities p = probabilities_of(fits, fitted.smooth.chi2, likelihood, evidences);
  EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
  EXPECT_GT(p[static_cast<std::size_t>(CurveClass::Ellipse)], 0.95);
  // Ten units of chi-square are odds of exp(5), whatever else is probable.
  const auto e = static_cast<std::size_t>(CurveClass::Ellipse);
  fits[e]->chi2 += 10.0;
  const ClassProbabilities after =
      probabilities_of(fits, fitted.smooth.chi2, likelihood, evidences);
  EXPECT_NEAR(std::log(p[e] / p[0]) - std::log(after[e] / after[0]), 5.0, 1e-6);
}

TEST(FreeForm, PathsOfNoClassAreTakenAndRoughOnesCost) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.patches = 2;
  options.sigma_over_size = 1e-4;
  options.least_fraction = options.most_fraction = 0.3;
  const test::Scene scene = test::random_outside_scene(test::OutsideShape::LogSpiral, options, rng);
  const Fitted fitted(scene);
  const FreeForm paths = free_form(fitted.smooth, 1.0, test::unbounded_work());
  EXPECT_LT(paths.log_occam, 0.0);
  ClassFits fits = fitted.fits;
  for (auto& fit : fits) {
    if (fit) {
      fit->chi2 += fitted.smooth.chi2;
    }
  }
  Likelihood likelihood;
  const Evidences evidences = evidences_of(fits, fitted.fits, fitted.smooth, fitted.smooth.reduced,
                                           likelihood, {}, test::unbounded_work());
  EXPECT_GT(probabilities_of(fits, fitted.smooth.chi2, likelihood, evidences)[0], 0.95);
  // Noise a tenth as large determines more of the path, at a price.
  EXPECT_LT(free_form(fitted.smooth, 0.01, test::unbounded_work()).log_occam, paths.log_occam);
}

/// The marginal likelihood of one section as one normal law: the noise, and the prior's powers.
TEST(FreeForm, IsTheMarginalLikelihoodOfItsPrior) {
  constexpr int kNodes = 8;
  constexpr int kPowers = 12;
  constexpr double kSigma = 1e-2;
  SmoothModel smooth;
  Eigen::Matrix<double, kNodes, 1> y;
  Eigen::Matrix<double, kNodes, kPowers> powers;
  for (int i = 0; i < kNodes; ++i) {
    const double x = 0.2 * i - 0.7;
    y[i] = 0.1 * std::sin(4.0 * x);
    for (int k = 0; k < kPowers; ++k) powers(i, k) = std::pow(x, k);
    smooth.reduced.points.push_back({{x, y[i]}, {0.0, 0.0}, 1.0 / kSigma, 0.0});
  }
  smooth.sections.push_back({.end = kNodes, .half_length = 0.7});
  constexpr std::array kSizes = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
  double mean = 0.0;
  for (const double size : kSizes) {
    Eigen::Matrix<double, kPowers, 1> variances;
    variances.head<2>().setConstant(0.5 * std::numbers::pi);
    for (int k = 2; k < kPowers; ++k) {
      variances[k] = std::pow(std::pow(size, 1 - k) / (k * (k - 1)), 2);
    }
    Eigen::Matrix<double, kNodes, kNodes> covariance =
        powers * variances.asDiagonal() * powers.transpose() / (kSigma * kSigma);
    covariance.diagonal().array() += 1.0;
    const double chi2 = y.dot(covariance.llt().solve(y)) / (kSigma * kSigma);
    mean += std::exp(-0.5 * (chi2 + std::log(covariance.determinant()))) / kSizes.size();
  }
  const FreeForm paths = free_form(smooth, 1.0, test::unbounded_work());
  // What falls off the end of the sum, of all sizes.
  EXPECT_NEAR(paths.log_occam - 0.5 * paths.chi2, std::log(mean),
              kSizes.size() * std::exp(-kTailOfDensity));
}

/// A probe at rest: sections follow one another through a cloud, from each end predicted for the
/// next one's beginning. Covariances that rounding made indefinite left no evidence.
/// Strokes of so few samples that no section shows their noise.
TEST(FreeForm, OverAnUnseenNoiseIsTheIntegralOverIt) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : {CurveClass::Line, CurveClass::Circle}) {
    test::SceneOptions options;
    options.patches = 6;
    options.points_per_patch = 5;
    options.sigma_over_size = 0.01;
    options.least_fraction = options.most_fraction = 0.05;
    const test::Scene scene = test::random_scene(curve_class, options, rng);
    FitData data = test::fit_data(scene, scene.sigma_m);
    const SmoothModel smooth = fit_smooth_model(&data, true);
    ASSERT_EQ(smooth.dof(), 0);
    Likelihood likelihood;
    likelihood.sigma_known = false;
    likelihood.samples = static_cast<double>(data.points.size());
    likelihood.chi2_floor = 1e-8 * likelihood.samples;
    const FreeForm paths = free_form_over_noise(smooth, likelihood, test::unbounded_work());
    // By the trapezoidal rule, from the paths of every noise.
    constexpr double kStep = 0.02;
    double sum = kNoEvidence;
    double top = kNoEvidence;
    double at_noise = kNoEvidence;
    for (double u = std::log(1e-4) - 3.0; u < std::log(100.0); u += kStep) {
      const FreeForm there = free_form(smooth, std::exp(2.0 * u), test::unbounded_work());
      const double value = there.log_occam - 0.5 * there.chi2 -
                           0.5 * likelihood.chi2_floor * std::exp(-2.0 * u) -
                           likelihood.samples * u;
      sum = log_add(sum, value + std::log(kStep));
      at_noise = u < std::log(paths.noise) ? value : at_noise;
      top = std::max(top, value);
    }
    // As accurate as Laplace's formula for a chi-square law of some ten degrees of freedom.
    ASSERT_TRUE(paths.log_over_noise);
    EXPECT_NEAR(*paths.log_over_noise, std::log(2.0) + sum, 0.1) << name_of(curve_class);
    // The likeliest of one size of features, which others may outdo a little elsewhere.
    EXPECT_GE(at_noise, top - 1.0) << name_of(curve_class);
  }
}

TEST(FreeForm, OfACloudHasEvidence) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> scatter(0.0, 0.25);
  for (const double sigma : {1e-2, 1e-3, 1e-5, 1e-8}) {
    for (int run = 0; run < 4; ++run) {
      FitData data;
      for (int i = 0; i < 1500; ++i) {
        data.points.push_back({{scatter(rng), scatter(rng)}, {0.0, 0.0}, 1.0 / sigma, 0.0});
      }
      data.patches.push_back({0, data.points.size()});
      const SmoothModel smooth = fit_smooth_model(&data, true);
      const FreeForm paths = free_form(smooth, 1.0, test::unbounded_work());
      EXPECT_TRUE(std::isfinite(paths.log_occam)) << sigma;
      EXPECT_TRUE(std::isfinite(paths.chi2) && paths.chi2 > 0.0) << sigma;
    }
  }
}

TEST(FreeForm, IsTheSameAlongAndAgainstTravel) {
  std::mt19937_64 rng = test::test_rng();
  int single = 0;
  for (int i = 0; i < 20; ++i) {
    test::Scene scene = scene_of(CurveClass::Parabola, 0.1, 1e-4, 1, rng);
    const SmoothModel smooth = Fitted(scene).smooth;
    std::reverse(scene.patches[0].begin(), scene.patches[0].end());
    const SmoothModel reversed = Fitted(scene).smooth;
    if (smooth.sections.size() > 1 || reversed.sections.size() > 1) {
      continue;
    }
    ++single;
    const FreeForm along = free_form(smooth, 1.0, test::unbounded_work());
    const FreeForm against = free_form(reversed, 1.0, test::unbounded_work());
    // The chord's frame is turned by half a turn: the same powers, up to their signs.
    EXPECT_NEAR(along.log_occam - 0.5 * along.chi2, against.log_occam - 0.5 * against.chi2, 1e-6);
  }
  EXPECT_GT(single, 5);
}

}  // namespace
}  // namespace palpate

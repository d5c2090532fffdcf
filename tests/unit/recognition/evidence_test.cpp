#include "core/recognition/evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace palpate {
namespace {

ClassFit fit_of(CurveClass curve_class, double chi2, bool at_limit = false) {
  ClassFit fit;
  fit.curve_class = curve_class;
  fit.chi2 = chi2;
  fit.at_limit = at_limit;
  return fit;
}

void set(ClassFits* fits, const ClassFit& fit) {
  (*fits)[static_cast<std::size_t>(fit.curve_class)] = fit;
}

double of(const ClassProbabilities& p, CurveClass curve_class) {
  return p[static_cast<std::size_t>(curve_class)];
}

EvidenceScale scale_of(double samples) {
  EvidenceScale scale;
  scale.samples = samples;
  return scale;
}

TEST(Evidence, ProbabilitiesSumToOneAndFollowTheCriterion) {
  ClassFits fits;
  set(&fits, fit_of(CurveClass::Line, 300.0));
  set(&fits, fit_of(CurveClass::Circle, 100.0));
  const ClassProbabilities p = probabilities(fits, 90.0, 12, scale_of(100.0));
  EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-15);
  EXPECT_EQ(of(p, CurveClass::Ellipse), 0.0);
  // Circle against unclassified: (100 + 3 log 100) against (90 + 12 log 100).
  const double log_odds =
      -0.5 * ((100.0 + 3.0 * std::log(100.0)) - (90.0 + 12.0 * std::log(100.0)));
  EXPECT_NEAR(of(p, CurveClass::Circle) / of(p, CurveClass::Unclassified), std::exp(log_odds),
              1e-12 * std::exp(log_odds));
}

TEST(Evidence, SmallerModelWinsUnlessTheDataPay) {
  ClassFits fits;
  set(&fits, fit_of(CurveClass::Parabola, 100.0));
  set(&fits, fit_of(CurveClass::CubicSpline, 99.0));
  EXPECT_GT(of(probabilities(fits, 95.0, 14, scale_of(111.0)), CurveClass::Parabola), 0.9);
  set(&fits, fit_of(CurveClass::CubicSpline, 60.0));
  EXPECT_GT(of(probabilities(fits, 55.0, 14, scale_of(111.0)), CurveClass::CubicSpline), 0.9);
}

/// A semi-cubical parabola whose points lie from `nearest` to 1 along the axis from its vertex.
ClassFit semi_cubical_from(double nearest, double chi2) {
  ClassFit fit = fit_of(CurveClass::SemiCubicalParabola, chi2);
  fit.polynomial.emplace();
  fit.polynomial->t = {std::sqrt(nearest), 1.0};
  return fit;
}

TEST(Evidence, ASemiCubicalParabolaFarFromItsVertexIsACubicalOne) {
  ClassFits fits;
  set(&fits, fit_of(CurveClass::Parabola, 100.0));
  set(&fits, fit_of(CurveClass::CubicalParabola, 100.0));
  const EvidenceScale scale = scale_of(222.0);
  const double alone = of(probabilities(fits, 1e6, 14, scale), CurveClass::Parabola);
  set(&fits, semi_cubical_from(0.98, 100.0));
  const ClassProbabilities far = probabilities(fits, 1e6, 14, scale);
  EXPECT_EQ(of(far, CurveClass::SemiCubicalParabola), 0.0);
  EXPECT_EQ(of(far, CurveClass::Parabola), alone);
  // Nearer, or where it fits better, it is a hypothesis of its own.
  set(&fits, semi_cubical_from(0.9, 100.0));
  EXPECT_LT(of(probabilities(fits, 1e6, 14, scale), CurveClass::Parabola), alone);
  set(&fits, semi_cubical_from(0.98, 90.0));
  EXPECT_LT(of(probabilities(fits, 1e6, 14, scale), CurveClass::Parabola), alone);
}

TEST(Evidence, AConicIsDividedAtTheParabola) {
  // An ellipse whose optimum is one standard deviation inside: Phi(1) of the conic's evidence.
  ClassFits fits;
  set(&fits, fit_of(CurveClass::Ellipse, 100.0));
  set(&fits, fit_of(CurveClass::Hyperbola, 101.0, true));
  const ClassProbabilities p = probabilities(fits, 1e6, 14, scale_of(111.0));
  EXPECT_NEAR(of(p, CurveClass::Ellipse), 0.5 * std::erfc(-1.0 / std::sqrt(2.0)), 1e-12);
  EXPECT_NEAR(of(p, CurveClass::Hyperbola), 0.5 * std::erfc(1.0 / std::sqrt(2.0)), 1e-12);
}

TEST(Evidence, StatedFormErrorTempersWhatTheSmoothModelLeavesOut) {
  EvidenceScale scale = scale_of(100.0);
  scale.noise_chi2 = 1e16;
  const double chi2 = 0.3;
  EXPECT_EQ(without_form_error(chi2, scale), chi2);  // to the last bit, where none is stated
  scale.noise_chi2 = 90.0;
  scale.coherent_variance = 3.0;
  ClassFits fits;
  set(&fits, fit_of(CurveClass::Ellipse, 100.0));
  set(&fits, fit_of(CurveClass::Hyperbola, 108.0));
  const auto odds = [&](const EvidenceScale& of_scale) {
    const ClassProbabilities p = probabilities(fits, 90.0, 12, of_scale);
    return of(p, CurveClass::Ellipse) / of(p, CurveClass::Hyperbola);
  };
  EXPECT_NEAR(odds(scale), std::exp(0.5 * 8.0 / 4.0), 1e-12);
  // With the noise profiled out as well, where it is what the smooth model leaves.
  scale.sigma_known = false;
  EXPECT_NEAR(odds(scale), std::pow((90.0 + 18.0 / 4.0) / (90.0 + 10.0 / 4.0), 50.0), 1e-12);
}

TEST(Evidence, ProfiledNoiseIsScaleFree) {
  EvidenceScale scale = scale_of(200.0);
  scale.sigma_known = false;
  ClassFits fits;
  set(&fits, fit_of(CurveClass::Circle, 210.0));
  set(&fits, fit_of(CurveClass::Ellipse, 200.0));
  const ClassProbabilities p = probabilities(fits, 190.0, 12, scale);
  for (auto& fit : fits) {
    if (fit) {
      fit->chi2 *= 1e-12;
    }
  }
  const ClassProbabilities q = probabilities(fits, 190.0e-12, 12, scale);
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(p[i], q[i], 1e-12);
  }
}

}  // namespace
}  // namespace palpate

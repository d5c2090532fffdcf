// The jet estimator against polynomials it must reproduce, and against the classes.
#include "core/local/jet_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/local/graph_geometry.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

TEST(GraphGeometry, JacobianAgainstCentralDifferences) {
  Eigen::Matrix<double, 5, 1> d;
  d << 0.3, 0.7, -1.1, 2.3, 0.9;
  const GraphGeometry at = graph_geometry(d);
  constexpr double kStep = 1e-6;
  for (int i = 1; i < 5; ++i) {  // the column of v itself has a test of its own below
    Eigen::Matrix<double, 5, 1> plus = d;
    Eigen::Matrix<double, 5, 1> minus = d;
    plus[i] += kStep;
    minus[i] -= kStep;
    const GraphGeometry hi = graph_geometry(plus);
    const GraphGeometry lo = graph_geometry(minus);
    // Error of a central difference: rounding 1e-16 / 1e-6, truncation 1e-12 times third
    // derivatives of size 100.
    EXPECT_NEAR(at.jacobian(1, i), (hi.angle - lo.angle) / (2.0 * kStep), 1e-9);
    EXPECT_NEAR(at.jacobian(2, i), (hi.kappa - lo.kappa) / (2.0 * kStep), 1e-9);
    EXPECT_NEAR(at.jacobian(3, i), (hi.kappa_s - lo.kappa_s) / (2.0 * kStep), 1e-9);
  }
}

TEST(GraphGeometry, AnOffsetIsComparedWithTheFootOnTheTrueCurve) {
  // Raising the graph by dv and taking its geometry at the same abscissa, against the unraised
  // graph at the foot of the raised point, which lies dv sin(angle) farther along the curve.
  Eigen::Matrix<double, 5, 1> d;
  d << 0.0, 0.7, -1.1, 2.3, 0.9;
  const GraphGeometry at = graph_geometry(d);
  constexpr double kRise = 1e-6;
  const double du = kRise * std::sin(at.angle) * std::cos(at.angle);
  Eigen::Matrix<double, 5, 1> foot;
  foot << 0.0, d[1] + du * (d[2] + du * (d[3] / 2 + du * d[4] / 6)),
      d[2] + du * (d[3] + du * d[4] / 2), d[3] + du * d[4], d[4];
  const GraphGeometry true_foot = graph_geometry(foot);
  // The foot is right to second order in the rise: relative 1e-5 is ten times that.
  EXPECT_NEAR(at.jacobian(0, 0), std::cos(at.angle), 1e-15);
  EXPECT_NEAR(at.jacobian(1, 0), (at.angle - true_foot.angle) / kRise, 1e-5);
  EXPECT_NEAR(at.jacobian(2, 0), (at.kappa - true_foot.kappa) / kRise, 1e-5);
  EXPECT_NEAR(at.jacobian(3, 0), (at.kappa_s - true_foot.kappa_s) / kRise, 1e-5);
}

TEST(JetEstimator, BiasFallsWithTheDegreeAndTheWindow) {
  // Halving the window divides the bias of kappa by 2^2 (degree 3: the quartic term) or 2^4
  // (degree 4, 5), that of kappa_s by 2^2 (degree 3, 4) or 2^4 (degree 5), to leading order.
  test::TouchedArc arc = test::touched_arcs()[2];
  const auto error_at = [&](int degree, double length_m) {
    arc.length_m = length_m;
    const LocalResult result = jet_estimate(test::samples_of(arc, 101), {.degree = degree});
    EXPECT_EQ(result.status, LocalStatus::Ok);
    return test::error_of(result.estimate, arc);
  };
  const std::array<int, 3> kappa_order = {2, 4, 4};
  const std::array<int, 3> kappa_s_order = {2, 2, 4};
  for (int degree = 3; degree <= kMaxJetDegree; ++degree) {
    const Eigen::Vector4d wide = error_at(degree, 0.008);
    const Eigen::Vector4d narrow = error_at(degree, 0.004);
    const auto i = static_cast<std::size_t>(degree - 3);
    // Within half an order: the next term of the series is (4 mm / 17.5 mm)^2 = 5 % of the leading.
    EXPECT_NEAR(std::log2(wide[2] / narrow[2]), kappa_order[i], 0.5) << degree;
    EXPECT_NEAR(std::log2(wide[3] / narrow[3]), kappa_s_order[i], 0.5) << degree;
  }
}

TEST(JetEstimator, StraightEdge) {
  const test::TouchedArc& line = test::touched_arcs()[0];
  const LocalResult result = jet_estimate(test::samples_of(line, 20), {.sigma_m = 1e-5});
  ASSERT_EQ(result.status, LocalStatus::Ok);
  // Coordinates of 0.3 m are rounded to 6e-17 m; kappa amplifies by about 200 / length^2.
  EXPECT_NEAR(result.estimate.kappa, 0.0, 6e-17 * 200.0 / (0.022 * 0.022));
  EXPECT_NEAR(wrap_angle(result.estimate.tangent_angle - 0.8), 0.0, 1e-13);
  EXPECT_NEAR(result.estimate.window_arc_m, 0.022, 1e-15);
  EXPECT_EQ(result.estimate.window_samples, 20);
}

TEST(JetEstimator, WindowArcOfACircle) {
  const test::TouchedArc& circle = test::touched_arcs()[1];
  const LocalResult result = jet_estimate(test::samples_of(circle, 111), {.degree = 5});
  ASSERT_EQ(result.status, LocalStatus::Ok);
  // A circle's sixth-degree term, kappa^5 / 16, has 16/231 of P_6 in it, which the quintic leaves
  // out: off by 0.0043 * 0.55^5 half extents at both ends, times the slope 0.61 of the ends.
  const double half_extent = 0.020 * std::sin(0.55);
  EXPECT_NEAR(result.estimate.window_arc_m, 0.022,
              1.2 * 2.0 * 0.61 * 0.0043 * std::pow(0.55, 5) * half_extent);
}

}  // namespace
}  // namespace palpate

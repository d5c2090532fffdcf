#include "node/tool/drawing/curve_band.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "node/tool/drawing/drawing.h"
#include "node/tool/drawing/pose_ellipse.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/unit/node/tool/answered_scene.h"

namespace palpate {
namespace {

/// A scene whose covariance is small enough to be the whole truth about the curve.
CurveModel known_model(CurveClass curve_class, std::mt19937_64& rng, v1::Recognition& message) {
  test::SceneOptions options;
  // A long arc: no valley of chi-square that bends within its own deviations. Beside a cusp there
  // is no longer one than an arm, whose valley is straight only under less noise.
  const bool has_cusp = curve_class == CurveClass::SemiCubicalParabola;
  options.sigma_over_size = has_cusp ? 1e-9 : 1e-7;
  options.patches = 1;
  options.least_fraction = has_cusp ? 0.3 : 0.6;
  options.most_fraction = has_cusp ? 0.4 : 0.75;
  const test::Scene scene = test::random_scene(curve_class, options, rng);
  message = message_of(test::recognise(scene, scene.sigma_m));
  const auto model = model_of(message);
  EXPECT_TRUE(model) << name_of(curve_class);
  return *model;
}

TEST(CurveBand, HoldsTheCurvesThatTheCovarianceAllowsIn95Of100AtEveryPlace) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  constexpr int kDraws = 2000;
  // Five standard deviations of the share of so many draws.
  const double tolerance = 5.0 * std::sqrt(0.95 * 0.05 / kDraws);
  for (const CurveClass curve_class : kCurveClasses) {
    v1::Recognition message;
    const CurveModel model = known_model(curve_class, rng, message);
    ASSERT_GT(model.covariance.size(), 0) << name_of(curve_class);
    const Eigen::MatrixXd covariance = model.covariance;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
    const Eigen::MatrixXd root =
        axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    for (const v1::LocalizedContact& contact : message.contacts()) {
      const double t = contact.t();
      const auto band = band_at(model, t);
      ASSERT_TRUE(band);
      int inside = 0;
      double kappa_squares = 0.0;
      for (int draw = 0; draw < kDraws; ++draw) {
        Eigen::VectorXd units(covariance.rows());
        for (double& unit : units) unit = normal(rng);
        const auto drawn = moved(model, root * units);
        ASSERT_TRUE(drawn);
        const FootPoint foot =
            foot_point(drawn->curve, drawn->world_T_curve.to_local(model.world_position(t)));
        const double offset =
            model.world_left(t).dot(drawn->world_T_curve * foot.position - model.world_position(t));
        inside += offset <= band->left_m && offset >= band->right_m ? 1 : 0;
        const double kappa = geometry(drawn->curve, foot.t).kappa - geometry(model.curve, t).kappa;
        kappa_squares += kappa * kappa;
      }
      EXPECT_NEAR(inside / double{kDraws}, 0.95, tolerance) << name_of(curve_class) << " at " << t;
      if (curve_class == CurveClass::Line) continue;
      // Five standard deviations of a standard deviation from so many draws.
      EXPECT_NEAR(std::sqrt(kappa_squares / kDraws) / *CurvatureDeviation(model).at(t), 1.0,
                  5.0 / std::sqrt(2.0 * kDraws))
          << name_of(curve_class) << " at " << t;
    }
  }
}

TEST(CurveBand, IsAbsentWhereTheCovarianceSaysNothing) {
  std::mt19937_64 rng = test::test_rng();
  v1::Recognition message;
  (void)known_model(CurveClass::Ellipse, rng, message);
  message.set_covariance(0, std::numeric_limits<double>::infinity());
  const auto model = model_of(message);
  ASSERT_TRUE(model);
  EXPECT_FALSE(band_at(*model, 0.0));
  EXPECT_FALSE(CurvatureDeviation(*model).at(0.0));
  message.clear_covariance();
  EXPECT_FALSE(band_at(*model_of(message), 0.0));
}

TEST(CurveBand, IsDrawnToATwentiethOfItsWidth) {
  // A band of 20 pixels, which is a wide one, so is right to a pixel.
  constexpr double kTolerance = 0.05;
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    v1::Recognition message;
    const CurveModel model = known_model(curve_class, rng, message);
    const Drawing drawing = make_drawing({}, message, Curvature::None);
    ASSERT_TRUE(drawing.curve) << name_of(curve_class);
    for (const CurvePlace& place : drawing.curve->places) {
      const auto band = band_at(model, place.t);
      ASSERT_TRUE(band && place.band) << name_of(curve_class);
      const double width = band->left_m - band->right_m;
      EXPECT_NEAR(place.band->left_m, band->left_m, kTolerance * width)
          << name_of(curve_class) << " at " << place.t;
      EXPECT_NEAR(place.band->right_m, band->right_m, kTolerance * width)
          << name_of(curve_class) << " at " << place.t;
    }
  }
}

TEST(PoseEllipse, HoldsTheOriginIn95Of100) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  for (const CurveClass curve_class : {CurveClass::Circle, CurveClass::Ellipse}) {
    v1::Recognition message;
    const CurveModel model = known_model(curve_class, rng, message);
    const auto ellipse = pose_ellipse(model);
    ASSERT_TRUE(ellipse);
    EXPECT_GE(ellipse->long_m, ellipse->short_m);
    const Eigen::Index letters = model.covariance.rows() - 3;
    const Eigen::Matrix2d root =
        Eigen::LLT<Eigen::Matrix2d>(model.covariance.block(letters, letters, 2, 2)).matrixL();
    int inside = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Vec2 offset = root * Vec2(normal(rng), normal(rng));
      const Vec2 along(std::cos(ellipse->angle_rad), std::sin(ellipse->angle_rad));
      const double u = offset.dot(along) / ellipse->long_m;
      const double v = offset.dot(left_of(along)) / ellipse->short_m;
      inside += u * u + v * v <= 1.0 ? 1 : 0;
    }
    // Five standard deviations of the share of so many draws.
    EXPECT_NEAR(inside / double{kDraws}, 0.95, 5.0 * std::sqrt(0.95 * 0.05 / kDraws))
        << name_of(curve_class);
  }
}

TEST(CurveModel, IsAbsentForMessagesThatNameNoCurve) {
  v1::Recognition message;
  EXPECT_FALSE(model_of(message));
  message.set_curve_class(v1::CURVE_CLASS_ELLIPSE);
  message.mutable_pose();
  message.mutable_parameters()->set_a(1.0);
  message.mutable_parameters()->set_b(2.0);  // b > a is no canonical ellipse
  EXPECT_FALSE(model_of(message));
  message.mutable_parameters()->set_b(0.5);
  EXPECT_TRUE(model_of(message));
  message.mutable_pose()->set_x_m(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(model_of(message));
}

TEST(Drawing, ShowsTheCurveBesideEveryTouchedPlace) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    test::SceneOptions options;
    options.sigma_over_size = 1e-5;
    const test::Scene scene = test::random_scene(curve_class, options, rng);
    const v1::Recognition message = message_of(test::recognise(scene, scene.sigma_m));
    const ContactGroup group = group_of(scene);
    const Drawing drawing = make_drawing(group, message, Curvature::Along);
    ASSERT_TRUE(drawing.curve) << name_of(curve_class);
    EXPECT_EQ(drawing.contacts.size(), static_cast<std::size_t>(message.contacts_size()));
    // Every sample has the drawn polyline beside it: within its noise and a chord's height.
    const auto& places = drawing.curve->places;
    const double tolerance = 6.0 * scene.sigma_m + 1e-3 * options.size_m;
    for (const ContactRun& run : group.runs) {
      for (const ContactSample& sample : run.samples) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 1; i < places.size(); ++i) {
          const Vec2 along = places[i].position - places[i - 1].position;
          const Vec2 to = sample.position_m - places[i - 1].position;
          const double part = std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0);
          nearest = std::min(nearest, (to - part * along).norm());
        }
        EXPECT_LT(nearest, tolerance) << name_of(curve_class);
      }
    }
  }
}

TEST(Residuals, AreTrueToAThousandthOfTheNoiseHoweverFarApartSamplesAre) {
  constexpr double kSigma = 1e-6;
  const Curve curves[] = {Ellipse{0.05, 0.01}, Parabola{0.01}, CubicalParabola{400.0, 1.0}};
  for (const Curve& curve : curves) {
    const CurveModel model{curve, {0.3, 0.1, 0.4}, {}};
    for (const double step : {1e-4, 1e-2, 0.3}) {
      ContactRun run;
      for (int i = 0; i < 100; ++i) {
        const double t = step * (i - 50) * (domain(curve).period > 0.0 ? 1.0 : 0.01);
        const double beside = (i % 7 - 3) * kSigma;
        run.samples.push_back({model.world_position(t) + beside * model.world_left(t), 0.0, 0});
      }
      const auto residuals = residuals_of(model, run, kSigma);
      for (std::size_t i = 0; i < residuals.size(); ++i) {
        const double expected = (static_cast<int>(i) % 7 - 3) * kSigma;
        EXPECT_NEAR(residuals[i].residual_m, expected, 1e-3 * kSigma) << i;
      }
    }
  }
}

TEST(Residuals, AreTheDistancesBeyondTheTipAndTellSpikes) {
  const CurveModel model{Circle{0.02}, {0.3, 0.1, 0.0}, {}};
  ContactRun run;
  run.context.tip_radius_m = 0.004;
  constexpr double kSigma = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const double angle = 0.01 * i;
    const double beyond = i == 50 ? 1e-3 : 2e-5 * (i % 2 == 0 ? 1.0 : -1.0);
    const double radius = 0.024 + beyond;
    run.samples.push_back(
        {{0.3 + radius * std::cos(angle), 0.1 + radius * std::sin(angle)}, 0.0, 0});
  }
  const auto residuals = residuals_of(model, run, kSigma);
  ASSERT_EQ(residuals.size(), 100U);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    // Outside of a circle travelled leftwards is its right.
    const double expected = i == 50 ? -1e-3 : i % 2 == 0 ? -2e-5 : 2e-5;
    EXPECT_NEAR(residuals[i].residual_m, expected, 1e-12);
    EXPECT_EQ(residuals[i].is_far, i == 50);
    EXPECT_NEAR((model.world_position(residuals[i].t) - Vec2(0.3, 0.1)).norm(), 0.02, 1e-12);
  }
}

}  // namespace
}  // namespace palpate

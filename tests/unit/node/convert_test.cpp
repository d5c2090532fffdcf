#include "node/wire/convert.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace palpate {
namespace {

ContactSource no_source(std::uint32_t, std::uint32_t) { return {}; }

Recognition spline_recognition() {
  Recognition recognition;
  recognition.status = RecognitionStatus::Recognized;
  recognition.shape.curve_class = CurveClass::CubicalParabola;
  recognition.shape.values = {3.0, 0.5, 0.0};
  recognition.world_T_curve = {1.0, 2.0, 0.25};
  recognition.covariance = ShapePoseCovariance::Zero(5, 5);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) recognition.covariance(row, column) = row * column;
  }
  recognition.sample_count = 120;
  recognition.outlier_count = 3;
  recognition.dwelling_count = 4;
  recognition.sigma_m = 1e-5;
  recognition.noise_correlation_m = 2e-3;
  return recognition;
}

TEST(Convert, EveryClassHasItsOwnValueAndComesBack) {
  std::set<int> values;
  for (const CurveClass curve_class : kCurveClasses) {
    EXPECT_EQ(from_wire(to_wire(curve_class)), curve_class);
    values.insert(to_wire(curve_class));
  }
  EXPECT_EQ(values.size(), kCurveClasses.size());
  EXPECT_EQ(to_wire(CurveClass::Unclassified), v1::CURVE_CLASS_UNCLASSIFIED);
  EXPECT_EQ(from_wire(v1::CURVE_CLASS_UNSPECIFIED), CurveClass::Unclassified);
}

TEST(Convert, LettersTellWhichParametersArePresent) {
  for (const CurveClass curve_class : kCurveClasses) {
    v1::Parameters out;
    to_wire(ShapeParameters{curve_class, {1.0, 2.0, 3.0}}, out);
    const std::string_view letters = parameter_letters(curve_class);
    EXPECT_EQ(out.has_a(), letters.find('a') != letters.npos) << name_of(curve_class);
    EXPECT_EQ(out.has_b(), letters.find('b') != letters.npos) << name_of(curve_class);
    EXPECT_EQ(out.has_c(), letters.find('c') != letters.npos) << name_of(curve_class);
  }
  v1::Parameters cubical;
  to_wire(ShapeParameters{CurveClass::CubicalParabola, {3.0, 0.5, 0.0}}, cubical);
  EXPECT_EQ(cubical.a(), 3.0);
  EXPECT_EQ(cubical.c(), 0.5);  // second value, letter c
}

TEST(Convert, WhatNoiseAloneWouldLeaveGoesWithAnUnqualifiedProbe) {
  Recognition recognition = spline_recognition();
  recognition.unqualified_probe = true;
  recognition.white_covariance = ShapePoseCovariance::Identity(5, 5);
  recognition.covariance_inflation = 3.0;
  v1::Recognition out;
  to_wire(recognition, no_source, out);
  EXPECT_TRUE(out.unqualified_probe());
  ASSERT_EQ(out.noise_covariance_size(), 25);
  EXPECT_EQ(out.noise_covariance(2 * 5 + 2), 3.0);
  EXPECT_EQ(out.noise_covariance(2 * 5 + 1), 0.0);
}

TEST(Convert, ARecognitionArrivesWhole) {
  Recognition recognition = spline_recognition();
  Hypothesis winner;
  winner.shape = recognition.shape;
  winner.world_T_curve = recognition.world_T_curve;
  winner.covariance = recognition.covariance;
  winner.probability = 0.9;
  winner.chi2 = 100.0;
  winner.dof = 115;
  Hypothesis limit;
  limit.shape.curve_class = CurveClass::Ellipse;
  limit.at_limit = true;
  recognition.hypotheses = {winner, limit};
  recognition.decisions = {{"conic line", 7.0, 3.0, false, 0.125}, {"conic Ic1", 0.1, 0.2, true}};
  recognition.invariants = {{CurveClass::Ellipse, "Ic1", 40.0, 0.5}};
  recognition.pooled_contacts = {0};
  LocalizedContact contact;
  contact.probe = 1;
  contact.patch = 8;
  contact.t = 0.125;
  contact.estimate.position = {0.5, 0.75};
  contact.estimate.tangent_angle = -1.0;
  contact.estimate.kappa = 20.0;
  contact.estimate.kappa_s = -300.0;
  contact.estimate.covariance = Eigen::Vector4d(4.0, 9.0, 16.0, 25.0).asDiagonal();
  recognition.contacts = {contact};

  v1::Recognition out;
  out.set_group("left from before");
  to_wire(
      recognition,
      [](std::uint32_t probe, std::uint32_t run) {
        EXPECT_EQ(probe, 1U);
        return ContactSource{"finger", run + 100};
      },
      out);
  EXPECT_EQ(out.group(), "");
  EXPECT_EQ(out.status(), v1::RECOGNITION_STATUS_RECOGNIZED);
  EXPECT_EQ(out.curve_class(), v1::CURVE_CLASS_CUBICAL_PARABOLA);
  EXPECT_EQ(out.parameters().a(), 3.0);
  EXPECT_EQ(out.pose().x_m(), 1.0);
  EXPECT_EQ(out.pose().y_m(), 2.0);
  EXPECT_EQ(out.pose().theta_rad(), 0.25);
  EXPECT_EQ(out.pose_symmetry(), 2U);
  ASSERT_EQ(out.covariance_size(), 25);
  EXPECT_EQ(out.covariance(2 * 5 + 4), 8.0);
  EXPECT_FALSE(out.unqualified_probe());
  EXPECT_EQ(out.noise_covariance_size(), 0);
  ASSERT_EQ(out.hypotheses_size(), 2);
  EXPECT_EQ(out.hypotheses(0).probability(), 0.9);
  EXPECT_EQ(out.hypotheses(0).dof(), 115U);
  EXPECT_TRUE(out.hypotheses(0).has_pose());
  EXPECT_TRUE(out.hypotheses(1).at_limit());
  EXPECT_FALSE(out.hypotheses(1).has_parameters());
  ASSERT_EQ(out.contacts_size(), 1);
  EXPECT_EQ(out.contacts(0).probe(), "finger");
  EXPECT_EQ(out.contacts(0).patch(), 108U);
  EXPECT_EQ(out.contacts(0).t(), 0.125);
  EXPECT_EQ(out.contacts(0).normal_sigma_m(), 2.0);
  EXPECT_EQ(out.contacts(0).tangent_sigma_rad(), 3.0);
  EXPECT_EQ(out.contacts(0).kappa_sigma_per_m(), 4.0);
  EXPECT_EQ(out.contacts(0).kappa_s_sigma_per_m2(), 5.0);
  ASSERT_EQ(out.decisions_size(), 2);
  EXPECT_EQ(out.decisions(0).test(), "conic line");
  EXPECT_FALSE(out.decisions(0).passed());
  EXPECT_EQ(out.decisions(0).p_value(), 0.125);
  EXPECT_FALSE(out.decisions(1).has_p_value());
  ASSERT_EQ(out.invariants_size(), 1);
  EXPECT_EQ(out.invariants(0).curve_class(), v1::CURVE_CLASS_ELLIPSE);
  EXPECT_EQ(out.invariants(0).name(), "Ic1");
  EXPECT_EQ(out.invariants(0).value(), 40.0);
  EXPECT_EQ(out.invariants(0).sigma(), 0.5);
  ASSERT_EQ(out.invariants(0).contacts_size(), 1);
  EXPECT_EQ(out.invariants(0).contacts(0), 0U);
  EXPECT_EQ(out.sample_count(), 120U);
  EXPECT_EQ(out.outlier_count(), 3U);
  EXPECT_EQ(out.dwelling_count(), 4U);
  EXPECT_EQ(out.sigma_m(), 1e-5);
  EXPECT_EQ(out.noise_correlation_m(), 2e-3);
}

TEST(Convert, WhatIsNotKnownIsAbsent) {
  v1::Recognition out;
  Recognition recognition = spline_recognition();
  recognition.status = RecognitionStatus::Collecting;
  to_wire(recognition, no_source, out);
  EXPECT_EQ(out.status(), v1::RECOGNITION_STATUS_COLLECTING);
  EXPECT_EQ(out.curve_class(), v1::CURVE_CLASS_UNSPECIFIED);
  EXPECT_FALSE(out.has_parameters());
  EXPECT_FALSE(out.has_pose());

  recognition.status = RecognitionStatus::Recognized;
  recognition.shape = {};
  to_wire(recognition, no_source, out);
  EXPECT_EQ(out.curve_class(), v1::CURVE_CLASS_UNCLASSIFIED);
  EXPECT_FALSE(out.has_pose());
  EXPECT_EQ(out.covariance_size(), 0);
}

}  // namespace
}  // namespace palpate

// Real mirrors: no answer may be certain of another class than the design's, and form error that
// noise cannot explain must be reported.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "core/numerics/probability/chi_square.h"
#include "core/recognition/recognizer.h"

namespace palpate {
namespace {

std::vector<ContactSample> read_profile(const std::string& name) {
  std::ifstream in(std::string(PALPATE_TEST_DATA) + "/real/dabam/" + name + ".csv");
  EXPECT_TRUE(in.good()) << name;
  std::vector<ContactSample> samples;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#' || line.starts_with("probe,")) {
      continue;
    }
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    std::getline(fields, field, ',');
    Vec2 position;
    for (int axis = 0; axis < 2; ++axis) {
      std::getline(fields, field, ',');
      position[axis] = std::stod(field);
    }
    samples.push_back({position, 0.0, 0});
  }
  return samples;
}

Recognition recognise_recording(const std::string& name) {
  Recognizer recognizer;
  recognizer.add({}, read_profile(name));
  return recognizer.recognize();
}

TEST(RealRecordings, AMirrorOfLittleFormErrorIsTheEllipseOfItsDesign) {
  // Of foci at p and q under the grazing angle theta: a = (p + q) / 2, b = sqrt(p q) sin(theta).
  constexpr double kP_m = 4.5;
  constexpr double kQ_m = 0.49914;
  constexpr double kTheta = 0.03499;
  const Recognition answer = recognise_recording("dabam-006");
  EXPECT_EQ(answer.status, RecognitionStatus::Recognized);
  ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
  const Eigen::Vector2d design(0.5 * (kP_m + kQ_m), std::sqrt(kP_m * kQ_m) * std::sin(kTheta));
  const Eigen::Vector2d error = answer.shape.values.head<2>() - design;
  const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
  EXPECT_LT(error.dot(covariance.inverse() * error), chi_square_threshold(0.01, 2));
  EXPECT_GT(answer.noise_correlation_m, 0.0);
}

TEST(RealRecordings, FormErrorIsSeenAndNoMirrorIsCertainlyAnotherClass) {
  for (const char* name : {"dabam-004", "dabam-020", "dabam-022", "dabam-065"}) {
    const Recognition answer = recognise_recording(name);
    std::cout << name << ": " << name_of(answer.shape.curve_class) << " p "
              << answer.hypotheses.front().probability << " correlation "
              << answer.noise_correlation_m << " m\n";
    EXPECT_EQ(answer.status, RecognitionStatus::Ambiguous) << name;
    EXPECT_GT(answer.noise_correlation_m, 0.0) << name;
  }
}

TEST(RealRecordings, PoleCurvatureOfTheDesignIsMeasured) {
  // The curvature at the pole is sin(theta) (1/p + 1/q) / 2. The profiles are nearly circular
  // around it, and kappa of their middle window agrees to a few per cent (the position of the pole
  // is not given).
  struct Design {
    const char* name;
    double p, q, theta;
  };
  for (const Design& design : {Design{"dabam-006", 4.5, 0.49914, 0.03499},
                               Design{"dabam-020", 9.0, 0.35, 0.04363323129985824}}) {
    const Recognition answer = recognise_recording(design.name);
    const double expected = 0.5 * std::sin(design.theta) * (1.0 / design.p + 1.0 / design.q);
    ASSERT_FALSE(answer.contacts.empty());
    double least = 1e9;
    double most = 0.0;
    for (const LocalizedContact& contact : answer.contacts) {
      least = std::min(least, std::abs(contact.estimate.kappa));
      most = std::max(most, std::abs(contact.estimate.kappa));
    }
    EXPECT_LT(least, expected) << design.name;
    EXPECT_GT(most, expected) << design.name;
  }
}

}  // namespace
}  // namespace palpate

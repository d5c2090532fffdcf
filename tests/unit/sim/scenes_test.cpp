// Every scene that ships: what the recogniser makes of the simulator's contacts against their
// truth.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "node/tool/contact_groups.h"
#include "node/tool/part_match.h"
#include "node/wire/convert.h"
#include "sim/contact_export.h"
#include "sim/contacts.h"
#include "sim/scene_file.h"
#include "sim/truth.h"

namespace palpate {
namespace {

std::vector<std::string> scene_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_SCENES)) {
    if (entry.path().extension() == ".textproto") {
      files.push_back(entry.path().string());
    }
  }
  return files;
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, IsRecognisedWithinFourStandardDeviations) {
  const Result<sim::Scene> scene = sim::read_scene(GetParam());
  ASSERT_TRUE(scene.value.has_value()) << scene.error;
  EXPECT_FALSE(scene.value->description.description().empty());
  const auto probes = sim::simulate_contacts(*scene.value, 0);
  ContactTable table;
  sim::append_rows(*scene.value, probes, 1, table);
  const auto groups = contact_groups(GetParam(), table);
  const auto truths = sim::scene_truths(*scene.value, probes, 1);
  ASSERT_EQ(groups.size(), truths.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const v1::SceneTruth& truth = truths[g];
    ASSERT_EQ(groups[g].name, truth.group());
    Recognizer recognizer;
    add_group(groups[g], recognizer);
    const Recognition answer = recognizer.recognize();
    EXPECT_EQ(answer.status, RecognitionStatus::Recognized) << name_of(answer.doubt);
    ASSERT_EQ(to_wire(answer.shape.curve_class), truth.curve_class());
    std::vector<double> error;
    const v1::Parameters& parameters = truth.parameters();
    Eigen::Index letter = 0;
    for (const char name : parameter_letters(answer.shape.curve_class)) {
      const double value = name == 'a'   ? parameters.a()
                           : name == 'b' ? parameters.b()
                                         : parameters.c();
      error.push_back(answer.shape.values[letter++] - value);
    }
    if (answer.shape.curve_class == CurveClass::Unclassified) {
      continue;
    }
    const Pose2 true_pose{truth.pose().x_m(), truth.pose().y_m(), truth.pose().theta_rad()};
    if (answer.shape.curve_class == CurveClass::Line) {
      // Free to slide: what counts is the true line's distance and direction.
      const Vec2 across =
          true_pose.rotate_back(answer.world_T_curve.translation() - true_pose.translation());
      const double turn = std::remainder(answer.world_T_curve.theta - true_pose.theta, kPi);
      const double sigma = answer.sigma_m / std::sqrt(static_cast<double>(answer.sample_count));
      EXPECT_LE(std::abs(across.y()), 4.0 * sigma);
      EXPECT_LE(std::abs(turn), 4.0 * std::sqrt(answer.covariance(2, 2)));
      continue;
    }
    error.push_back(answer.world_T_curve.x - true_pose.x);
    error.push_back(answer.world_T_curve.y - true_pose.y);
    if (pose_symmetry(answer.shape.curve_class) != 0) {
      const double period = pose_symmetry(answer.shape.curve_class) == 2 ? kPi : 2.0 * kPi;
      error.push_back(std::remainder(answer.world_T_curve.theta - true_pose.theta, period));
    }
    for (std::size_t i = 0; i < error.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      EXPECT_LE(std::abs(error[i]), 4.0 * std::sqrt(answer.covariance(k, k)))
          << truth.group() << ", component " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(scene_files()),
                         [](const auto& scene) {
                           return std::filesystem::path(scene.param).stem().string();
                         });

TEST(ShippedScenes, ClosedPartsAreFoundWhereTheyLie) {
  int parts = 0;
  for (const std::string& file : scene_files()) {
    const Result<sim::Scene> scene = sim::read_scene(file);
    ASSERT_TRUE(scene.value.has_value()) << scene.error;
    if (!scene.value->description.has_closed_spline()) {
      continue;
    }
    ++parts;
    const Result<ClosedSpline> part = read_part(file);
    ASSERT_TRUE(part.value.has_value()) << part.error;
    const auto probes = sim::simulate_contacts(*scene.value, 0);
    ContactTable table;
    sim::append_rows(*scene.value, probes, 1, table);
    const auto truths = sim::scene_truths(*scene.value, probes, 1);
    const auto groups = contact_groups(file, table);
    ASSERT_EQ(groups.size(), truths.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const v1::PartMatch match = match_part(groups[g], *part.value, {});
      ASSERT_EQ(match.status(), v1::PART_MATCH_STATUS_DETERMINED);
      const v1::PartPlacement& best = match.placements(0);
      const Pose2& truth = scene.value->world_T_shape;
      const std::array errors = {best.pose().x_m() - truth.x, best.pose().y_m() - truth.y,
                                 wrap_angle(best.pose().theta_rad() - truth.theta)};
      for (int i = 0; i < 3; ++i) {
        EXPECT_LE(std::abs(errors[static_cast<std::size_t>(i)]),
                  4.0 * std::sqrt(best.covariance(4 * i)));
      }
      ASSERT_EQ(best.patches_size(), truths[g].patches_size());
      for (int p = 0; p < best.patches_size(); ++p) {
        const auto& t = best.patches(p).t();
        constexpr double kClose = 1e-3;  // some micrometres
        EXPECT_NEAR(t[0], truths[g].patches(p).start_t(), kClose);
        EXPECT_NEAR(t[t.size() - 1], truths[g].patches(p).end_t(), kClose);
      }
    }
  }
  EXPECT_GE(parts, 1);
}

TEST(ShippedScenes, ShowEveryClass) {
  std::vector<bool> shown(9, false);
  for (const std::string& file : scene_files()) {
    const Result<sim::Scene> scene = sim::read_scene(file);
    ASSERT_TRUE(scene.value.has_value()) << scene.error;
    if (scene.value->description.has_curve()) {
      shown[static_cast<std::size_t>(from_wire(scene.value->description.curve().curve_class()))] =
          true;
    }
  }
  for (const CurveClass curve_class : kCurveClasses) {
    EXPECT_TRUE(shown[static_cast<std::size_t>(curve_class)]) << name_of(curve_class);
  }
}

}  // namespace
}  // namespace palpate

// A tip radius that nobody stated is one only where nothing else explains the distance.
#include "core/qualification/estimated_tip.h"

#include <gtest/gtest.h>

#include "core/qualification/probe_correction.h"
#include "core/qualification/qualify.h"
#include "tests/support/probe_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

ProbeCharacter with_constant(double constant_m) {
  ProbeCharacter probe;
  probe.offset.order = 2;
  probe.offset.coefficients_m = Eigen::Vector3d(constant_m, 3e-5, 4e-5);  // lobes of 50 um
  probe.offset.covariance_m2 = 1e-12 * Eigen::Matrix3d::Identity();
  return probe;
}

TEST(EstimatedTip, IsWhatNothingElseExplains) {
  const ProbeCharacter tip = with_estimated_tip(with_constant(2e-3));
  EXPECT_EQ(tip.tip_radius_m, 2e-3);
  EXPECT_EQ(tip.offset.coefficients_m[0], 0.0);
  EXPECT_EQ(tip.offset.coefficients_m[1], 3e-5);
  // Within the material, thinner than any tip, as large as the lobes, as uncertain as itself.
  for (const double constant_m : {-2e-3, 0.0, 4e-5, 5.2e-5}) {
    const ProbeCharacter none = with_estimated_tip(with_constant(constant_m));
    EXPECT_EQ(none.tip_radius_m, 0.0) << constant_m;
    EXPECT_EQ(none.offset.coefficients_m[0], constant_m);
  }
  ProbeCharacter unsure = with_constant(2e-3);
  unsure.setup_m = {4e-4, 2e-4};
  EXPECT_EQ(with_estimated_tip(unsure).tip_radius_m, 0.0);
  ProbeCharacter stated = with_constant(3e-4);
  stated.tip_radius_m = 2e-3;
  EXPECT_EQ(with_estimated_tip(stated).tip_radius_m, 2e-3);
  EXPECT_EQ(with_estimated_tip(stated).offset.coefficients_m[0], 3e-4);
}

TEST(EstimatedTip, OfQualificationMakesDistancesThoseBeyondIt) {
  auto rng = test::test_rng();
  test::ProbeScene ring;
  ring.probe = test::lobed_probe();
  std::vector<ArtefactRecording> recordings = {simulate(ring, rng)};
  const Qualification stated = qualify(ring.curve, recordings);
  for (ArtefactStroke& stroke : recordings[0].strokes) stroke.tip_radius_m = 0.0;
  const Qualification silent = qualify(ring.curve, recordings);
  EXPECT_FALSE(stated.tip_is_estimated);
  EXPECT_TRUE(silent.tip_is_estimated);
  // A tenth of a micrometre: where both fits end.
  EXPECT_NEAR(silent.probe.tip_radius_m,
              stated.probe.tip_radius_m + stated.probe.offset.coefficients_m[0], 1e-7);
  double sum = 0.0;
  for (const QualifiedSample& sample : silent.samples) {
    if (!sample.spike) sum += sample.distance_m;
  }
  EXPECT_NEAR(sum / static_cast<double>(silent.samples.size()), 0.0, 1e-5);
}

TEST(EstimatedTip, WithoutOneAnOffsetIsOnTheSideThatIsTouched) {
  auto rng = test::test_rng();
  test::ProbeScene pin;
  const ArtefactRecording touched = simulate(pin, rng);
  ProbedPatch patch{{}, touched.strokes[0].samples, nullptr};
  EXPECT_EQ(material_sign(pin.curve, pin.world_T_curve, patch), 1);
  EXPECT_EQ(material_sign(pin.curve, pin.world_T_curve, patch, TouchedFrom::Outside), 1);
  EXPECT_EQ(material_sign(pin.curve, pin.world_T_curve, patch, TouchedFrom::Inside), -1);
  patch.context.material_side = MaterialSide::Left;  // what the probe states goes before
  EXPECT_EQ(material_sign(pin.curve, pin.world_T_curve, patch, TouchedFrom::Inside), 1);
}

}  // namespace
}  // namespace palpate

// The contacts of an answer and the tree over them, on strokes of any length: true deviations, a
// path that is never stale, round tips respected, no variance of zero for what is not known.
#include "core/recognition/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/curves/curve.h"
#include "core/recognition/estimate_stream.h"
#include "core/recognition/patch_contacts.h"
#include "core/recognition/recognizer.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigma_m = 2e-5;
constexpr double kSpacing_m = 2e-4;
const Ellipse kEllipse{0.030, 0.020};

std::vector<ContactSample> stroke(const Curve& curve, double length_m, double tip_offset_m = 0.0) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  std::vector<ContactSample> samples;
  for (double s = 0.0; s <= length_m; s += kSpacing_m) {
    const double t = parameter_at_arc_length(curve, 0.4, s);
    const double angle = geometry(curve, t).tangent_angle;
    const Vec2 normal_m = left_of(Vec2(std::cos(angle), std::sin(angle)));
    const double x = normal(rng);
    const double y = normal(rng);
    samples.push_back(
        {position(curve, t) + tip_offset_m * normal_m + kSigma_m * Vec2(x, y), kSigma_m, 0});
  }
  return samples;
}

Recognition answer_to(const std::vector<ContactSample>& samples,
                      const RecognizerOptions& options = {}, const PatchContext& context = {}) {
  Recognizer recognizer(options);
  recognizer.add(context, samples);
  return recognizer.recognize();
}

TEST(Contacts, HoldTheirErrorsOnALongStroke) {
  for (const double length : {0.02, 0.05, 0.1, 0.15, 0.3}) {
    const Recognition answer = answer_to(stroke(kEllipse, length));
    ASSERT_GE(answer.contacts.size(), 2U) << length;
    for (const LocalizedContact& contact : answer.contacts) {
      const LocalEstimate& e = contact.estimate;
      const LocalGeometry truth = kEllipse.geometry(kEllipse.foot_point(e.position).t);
      // Of some forty values of a normal law none is beyond four once in four hundred runs.
      EXPECT_LT(std::abs(e.kappa - truth.kappa), 4.0 * std::sqrt(e.covariance(2, 2))) << length;
      EXPECT_LT(std::abs(e.kappa_s - truth.kappa_s), 4.0 * std::sqrt(e.covariance(3, 3))) << length;
    }
  }
}

TEST(Contacts, AreNoMoreThanAPatchMayHave) {
  EXPECT_LE(answer_to(stroke(Circle{0.004}, 0.5)).contacts.size(), kMostContactsOfAPatch);
}

TEST(TreePath, IsThatOfTheSamplesInMemory) {
  const std::vector<ContactSample> samples = stroke(kEllipse, 0.1);
  const std::span<const ContactSample> all(samples);
  Recognizer growing;
  // By less than asks for a new search: what was found of the first samples must not be told again.
  growing.add({}, all.first(450));
  growing.recognize();
  growing.add({}, all.subspan(450));
  const Recognition grown = growing.recognize();
  const Recognition fresh = answer_to(samples);
  ASSERT_EQ(grown.decisions.size(), fresh.decisions.size());
  for (std::size_t i = 0; i < fresh.decisions.size(); ++i) {
    EXPECT_EQ(grown.decisions[i].test, fresh.decisions[i].test);
    EXPECT_EQ(grown.decisions[i].value, fresh.decisions[i].value);
  }
}

TEST(TreeMethod, RespectsTheTip) {
  constexpr double kRadius_m = 0.02;
  constexpr double kTip_m = 0.005;
  RecognizerOptions options;
  options.method = RecognitionMethod::Tree;
  PatchContext context;
  context.tip_radius_m = kTip_m;
  context.material_side = MaterialSide::Left;  // inside the circle, travelled counterclockwise
  const Recognition answer = answer_to(stroke(Circle{kRadius_m}, 0.06, -kTip_m), options, context);
  ASSERT_EQ(answer.shape.curve_class, CurveClass::Circle);
  EXPECT_NEAR(answer.shape.values[0], kRadius_m, 5.0 * std::sqrt(answer.covariance(0, 0)));
}

TEST(TreeMethod, HasNoVarianceOfZeroForItsPose) {
  RecognizerOptions options;
  options.method = RecognitionMethod::Tree;
  const Recognition answer = answer_to(stroke(kEllipse, 0.1), options);
  ASSERT_GE(answer.covariance.rows(), 3);
  for (const double variance : answer.covariance.diagonal().tail<3>()) {
    EXPECT_GT(variance, 0.0);
  }
}

TEST(TreeMethod, IsNotSureOfAClassWithoutAPose) {
  RecognizerOptions options;
  options.method = RecognitionMethod::Tree;
  options.tree.relative_tolerance = 0.5;
  const Recognition answer = answer_to(stroke(kEllipse, 0.1), options);
  const bool has_pose = answer.world_T_curve.x != 0.0 || answer.world_T_curve.y != 0.0;
  EXPECT_TRUE(has_pose || answer.status != RecognitionStatus::Recognized);
}

TEST(TakeEstimates, GivesEachOnceInOrder) {
  const std::vector<ContactSample> samples = stroke(kEllipse, 0.05);
  Recognizer recognizer;
  recognizer.stream_estimates(true);
  std::vector<LocalizedContact> taken;
  for (std::size_t first = 0; first < samples.size(); first += 10) {
    recognizer.add(
        {}, std::span(samples).subspan(first, std::min<std::size_t>(10, samples.size() - first)));
    const std::vector<LocalizedContact> some = recognizer.take_estimates();
    taken.insert(taken.end(), some.begin(), some.end());
  }
  // The first window has 16 samples, every fourth sample more brings another.
  EXPECT_EQ(taken.size(), (samples.size() - 16) / 4 + 1);
  EXPECT_TRUE(recognizer.take_estimates().empty());
  recognizer.stream_estimates(false);
  recognizer.add({}, samples);
  EXPECT_TRUE(recognizer.take_estimates().empty());
}

TEST(TakeEstimates, HaveNothingOfSamplesThatTheMemoryRefuses) {
  const std::vector<ContactSample> samples = stroke(kEllipse, 0.05);
  std::vector<SampleDetail> details(samples.size());
  for (SampleDetail& detail : details) {
    detail.normal = Vec2(2.0, 0.0);  // no unit vector
    detail.normal_sigma_rad = 0.1;
  }
  Recognizer recognizer;
  recognizer.stream_estimates(true);
  EXPECT_EQ(recognizer.add({.tip_radius_m = -1e-3}, samples).accepted, 0U);
  EXPECT_EQ(recognizer.add({}, samples, details).accepted, 0U);
  EXPECT_EQ(recognizer.add({}, samples, std::span(details).first(1)).accepted, 0U);
  EXPECT_TRUE(recognizer.take_estimates().empty());
}

TEST(TakeEstimates, OfARoundTipWaitForTheSide) {
  const std::vector<ContactSample> samples = stroke(kEllipse, 0.05, -0.005);
  PatchContext context;
  context.tip_radius_m = 0.005;
  Recognizer recognizer;
  recognizer.stream_estimates(true);
  recognizer.add(context, samples);
  EXPECT_TRUE(recognizer.take_estimates().empty());
  recognizer.recognize();
  const std::vector<LocalizedContact> taken = recognizer.take_estimates();
  ASSERT_FALSE(taken.empty());
  const LocalEstimate& last = taken.back().estimate;
  EXPECT_LT((kEllipse.foot_point(last.position).position - last.position).norm(),
            5.0 * std::sqrt(last.covariance(0, 0)));
}

TEST(TakeEstimates, BeginAnewWhereAnotherTipOrSideHasTheSameNumber) {
  const std::vector<ContactSample> samples = stroke(kEllipse, 0.05);
  const std::span<const ContactSample> all(samples);
  const PatchContext unspecified{.tip_radius_m = 1e-3};
  PatchContext left = unspecified;
  left.material_side = MaterialSide::Left;
  PatchContext right = unspecified;
  right.material_side = MaterialSide::Right;
  PatchContext larger = right;
  larger.tip_radius_m = 2e-3;
  EstimateStream stream({});
  const auto taken_after = [&](const PatchContext& context, std::size_t first, std::size_t count) {
    stream.add(context, all.subspan(first, count), {});
    return stream.take([](std::uint32_t, std::uint32_t) { return 1; }).size();
  };
  EXPECT_EQ(taken_after(left, 0, 40), 7U);
  EXPECT_EQ(taken_after(unspecified, 40, 12), 3U);
  // A window has no fewer samples than 16.
  EXPECT_EQ(taken_after(right, 52, 15), 0U);
  EXPECT_EQ(taken_after(right, 67, 1), 1U);
  EXPECT_EQ(taken_after(larger, 68, 15), 0U);
  EXPECT_EQ(taken_after(larger, 83, 1), 1U);
}

TEST(TakeEstimates, GoOnAfterSamplesThatAreNone) {
  const std::vector<ContactSample> samples = stroke(kEllipse, 0.05);
  const std::span<const ContactSample> all(samples);
  const ContactSample none{Vec2::Constant(std::numeric_limits<double>::quiet_NaN())};
  EstimateStream stream({});
  stream.add({}, all.first(20), {});
  stream.add({.patch = 1}, std::span(&none, 1), {});
  stream.add({}, all.subspan(20, 4), {});
  EXPECT_EQ(stream.take([](std::uint32_t, std::uint32_t) { return 0; }).size(), 3U);
}

TEST(Contacts, AreOfTheSamplesThatAreUsed) {
  StoredPatch patch;
  for (const ContactSample& sample : stroke(kEllipse, 0.05)) {
    patch.samples.push_back({sample.position_m, sample.sigma_m});
  }
  patch.newest_m = patch.samples.back().position_m;
  const auto without = [&](std::size_t k) {
    StoredPatch rest = patch;
    rest.samples.erase(rest.samples.begin() + static_cast<std::ptrdiff_t>(k));
    return rest;
  };
  const auto kappa_of = [](PatchContacts& contacts, const StoredPatch& used) {
    return contacts.of(std::span(&used, 1), {}, {}, {}).front().estimate.kappa;
  };
  PatchContacts kept;
  kappa_of(kept, without(20));
  // As many samples, and the same newest one.
  const StoredPatch other = without(60);
  PatchContacts fresh;
  EXPECT_EQ(kappa_of(kept, other), kappa_of(fresh, other));
}

}  // namespace
}  // namespace palpate

#include "core/recognition/fit/warm_start.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/recognition/modes/mode_search.h"
#include "core/recognition/posterior/kept_modes.h"
#include "core/recognition/weigh/weigh.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

/// Points of y = x^3 / 4 about the inflection, on the curve.
FitData on_cubic() {
  FitData data;
  for (int i = 0; i <= 24; ++i) {
    FitPoint point;
    const double x = -1.0 + i / 12.0;
    point.position = {x, 0.25 * x * x * x};
    point.inverse_sigma = 1e3;
    data.points.push_back(point);
  }
  data.patches = {{0, data.points.size()}};
  return data;
}

/// The same cubic with parameter `first + width (x + 1) / 2`: those of fits that were settled may
/// lie anywhere.
PolynomialFit cubic_fit(const FitData& data, double first, double width) {
  // x = (t - middle) / half
  const double half = 0.5 * width;
  const double middle = first + half;
  PolynomialFit fit;
  auto& c = fit.coefficients;
  c.row(0) << -middle / half, 1.0 / half, 0.0, 0.0;
  const double cube = 0.25 / (half * half * half);
  c.row(1) << -cube * middle * middle * middle, 3.0 * cube * middle * middle, -3.0 * cube * middle,
      cube;
  for (const FitPoint& point : data.points) {
    fit.t.push_back(middle + half * point.position.x());
  }
  return fit;
}

/// Whatever the parameters of its feet are, a fit is found again on the points.
TEST(WarmStart, FindsFeetWhereverTheirParametersLie) {
  const FitData data = on_cubic();
  for (const auto& [first, width] : {std::pair(-1.0, 2.0), std::pair(2.4, 2.0),
                                     std::pair(-1.0, 0.03), std::pair(-900.0, 50.0)}) {
    ClassFits fits;
    auto& spline = fits[static_cast<std::size_t>(CurveClass::CubicSpline)].emplace();
    spline.curve_class = CurveClass::CubicSpline;
    spline.polynomial = cubic_fit(data, first, width);
    const PolynomialFits starts = carried_to(warm_start_from(fits, data), data);
    ASSERT_TRUE(starts.cubic_spline);
    const double step = 1.6 * width / 128;  // between the places that are compared
    for (std::size_t i = 0; i < data.points.size(); ++i) {
      EXPECT_NEAR(starts.cubic_spline->t[i], spline.polynomial->t[i], step) << first << ' ' << i;
    }
    // In units of a noise of 1e-3: rounding of the parameter's offset, cubed, included.
    EXPECT_LT(placed_on(data.points, *starts.cubic_spline).chi2, 1e-6) << first;
  }
}

/// The frame in which points are given has no meaning.
FitData in_frame(const FitData& data, const Pose2& old_T_new) {
  FitData moved = data;
  moved.frame =
      data.frame * Pose2{data.scale * old_T_new.x, data.scale * old_T_new.y, old_T_new.theta};
  for (FitPoint& point : moved.points) {
    point.position = old_T_new.to_local(point.position);
    point.tangent = old_T_new.rotate_back(point.tangent);
  }
  return moved;
}

/// The modes are where they were, on the same points in another frame.
TEST(KeptModes, AreFoundAgain) {
  constexpr double kFiftieth = 2e-2;  // what odds are told to
  auto rng = test::test_rng();
  int kept = 0;
  for (int i = 0; i < 40; ++i) {
    const CurveClass truth = kCurveClasses[static_cast<std::size_t>(i) % kCurveClasses.size()];
    const test::Scene scene =
        test::random_scene(truth, {.patches = 2, .points_per_patch = 60}, rng);
    const auto patches = test::stored_patches(scene, scene.sigma_m);
    const FitData data = make_fit_data(patches, 0.0);
    const Weighing w = weigh(data, patches, test::unbounded_work());
    const KeptModes& modes = w.starts.front().modes;
    const FitData moved =
        in_frame(w.reduced, {test::uniform(rng, -1.0, 1.0), test::uniform(rng, -1.0, 1.0),
                             test::uniform(rng, -kPi, kPi)});
    const auto carried = carried_modes(modes, w.coarse, moved, 1.0, test::unbounded_work());
    const auto unmoved = carried_modes(modes, w.coarse, w.reduced, 1.0, test::unbounded_work());
    ASSERT_EQ(carried.size(), modes.modes.size()) << test::test_seed() << ' ' << i;
    ASSERT_EQ(unmoved.size(), modes.modes.size()) << test::test_seed() << ' ' << i;
    for (std::size_t k = 0; k < carried.size(); ++k) {
      const KeptMode& mode = modes.modes[k];
      const double mass = log_mass(carried[k].nodes[carried[k].mode].curve);
      EXPECT_EQ(carried[k].touch.curve_class, mode.place.shape.curve_class);
      EXPECT_TRUE(carried[k].prior_mode_sought);
      // A descent that was ended by its number of steps goes on.
      EXPECT_GT(mass, mode.log_mass - 2.0 * kFiftieth) << test::test_seed() << ' ' << i;
      EXPECT_NEAR(mass, log_mass(unmoved[k].nodes[unmoved[k].mode].curve), kSettledPotential)
          << test::test_seed() << ' ' << i;
      ++kept;
    }
  }
  EXPECT_GT(kept, 0);
}

}  // namespace
}  // namespace palpate

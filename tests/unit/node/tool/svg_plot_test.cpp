#include "node/tool/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++n;
  }
  return n;
}

ContactGroup group_of(const test::Scene& scene) {
  ContactGroup group{"a<b>.csv", "part", 1, {"probe"}, {}};
  for (const auto& patch : scene.patches) {
    ContactRun run;
    run.context.patch = static_cast<std::uint32_t>(group.runs.size());
    for (const Vec2& position : patch) {
      run.samples.push_back({position, scene.sigma_m, 0});
    }
    group.runs.push_back(run);
  }
  return group;
}

TEST(SvgPlot, ShowsEverySampleTheCurveTheFrameAndTheContactsOfEveryClass) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    test::SceneOptions options;
    options.sigma_over_size = 1e-5;
    const test::Scene scene = test::random_scene(curve_class, options, rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    const ContactGroup group = group_of(scene);
    const std::string svg = svg_plot(group, answer, group.file + ": title");
    EXPECT_THAT(svg, HasSubstr("a&lt;b&gt;.csv: title"));
    EXPECT_EQ(count(svg, "r=\"1.8\""), 222U) << name_of(curve_class);
    EXPECT_EQ(count(svg, "r=\"4\""), answer.contacts.size());
    EXPECT_EQ(count(svg, "<polyline"), 1U) << name_of(curve_class);
    EXPECT_EQ(count(svg, "<g"), count(svg, "</g"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(SvgPlot, WithoutAnAnswerShowsTheSamplesAlone) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = test::random_scene(CurveClass::Circle, {}, rng);
  const std::string svg = svg_plot(group_of(scene), {}, "nothing yet");
  EXPECT_EQ(count(svg, "r=\"1.8\""), 222U);
  EXPECT_EQ(count(svg, "<polyline"), 0U);
}

}  // namespace
}  // namespace palpate

#include "node/tool/drawing/svg/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "node/tool/drawing/svg/svg_text.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/unit/node/tool/answered_scene.h"

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

/// Samples drawn, and those that the picture says it leaves out.
std::size_t dots_and_left_out(const std::string& svg) {
  const std::size_t drawn = count(svg, "h0");
  const std::string said = std::to_string(drawn) + " samples drawn; ";
  const std::size_t at = svg.find(said);
  return at == std::string::npos ? drawn : drawn + std::stoul(svg.substr(at + said.size()));
}

TEST(SvgPlot, ShowsEverySampleTheCurveTheFrameAndTheContactsOfEveryClass) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    test::SceneOptions options;
    options.sigma_over_size = 1e-5;
    const test::Scene scene = test::random_scene(curve_class, options, rng);
    const Recognition answer = test::recognise(scene, scene.sigma_m);
    const ContactGroup group = group_of(scene, "a<b>.csv");
    const std::string svg = svg_plot(group, message_of(answer));
    EXPECT_THAT(svg, HasSubstr("a&lt;b&gt;.csv"));
    EXPECT_EQ(dots_and_left_out(svg), 222U) << name_of(curve_class);
    EXPECT_EQ(count(svg, "r=\"4\""), answer.contacts.size());
    EXPECT_EQ(count(svg, "class=\"curve\""), 1U) << name_of(curve_class);
    EXPECT_EQ(count(svg, "class=\"band\""), 1U) << name_of(curve_class);
    EXPECT_THAT(svg, HasSubstr("times enlarged"));
    // A line's lies anywhere along it. An element's own transform would move its clip path too.
    const std::size_t origins = curve_class == CurveClass::Line ? 0 : 1;
    EXPECT_EQ(count(svg, "<g clip-path=\"url(#picture)\"><ellipse class=\"origin\" rx="), origins);
    EXPECT_EQ(count(svg, "where its origin is"), origins);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(SvgPlot, LabelsTellTheTicksOfAnAxisApartHoweverFarFromTheOrigin) {
  const std::regex label("text-anchor=\"(middle|end)\">(-?[0-9][^<]*)<");
  for (const double size : {1e-9, 1e-6, 0.03, 1e4}) {
    for (const double far : {0.0, 1.0, -1.0, 1e4, 9.9e6, -9.9e6}) {
      ContactGroup group{"far.csv", "probe", 0, {"probe"}, {{}}};
      for (int i = 0; i <= 20; ++i) {
        const double t = 0.3 * i;
        group.runs[0].samples.push_back(
            {Vec2(far + size * std::cos(t), 2.0 * far + size * std::sin(t))});
      }
      const std::string svg = svg_plot(group, v1::Recognition());
      std::map<std::string, std::vector<std::string>> labels;  // by axis
      for (std::sregex_iterator at(svg.begin(), svg.end(), label), end; at != end; ++at) {
        labels[(*at)[1]].push_back((*at)[2]);
      }
      // Of doubles: what lies a few of their steps apart has no ticks between that could differ.
      if (size < 1e-13 * std::abs(far)) continue;
      for (auto& [axis, texts] : labels) {
        EXPECT_GE(texts.size(), 2U) << axis << " " << size << " " << far;
        std::sort(texts.begin(), texts.end());
        EXPECT_EQ(std::adjacent_find(texts.begin(), texts.end()), texts.end())
            << texts.front() << " comes twice: " << size << " " << far;
        for (const std::string& text : texts) EXPECT_LE(text.size(), 8U) << text;
      }
    }
  }
}

TEST(SvgPlot, WithoutAnAnswerShowsTheSamplesAlone) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = test::random_scene(CurveClass::Circle, {}, rng);
  const std::string svg = svg_plot(group_of(scene, "a<b>.csv"), {});
  EXPECT_EQ(dots_and_left_out(svg), 222U);
  EXPECT_EQ(count(svg, "<polyline"), 0U);
  EXPECT_THAT(svg, HasSubstr("not known yet"));  // the noise
}

TEST(SvgPlot, OnePlaceAloneIsShownAtTheScaleOfASmallPart) {
  for (const std::size_t samples : {1U, 20U}) {
    ContactGroup group{"one.csv", "probe", 0, {"probe"}, {{}}};
    group.runs[0].samples.assign(samples, {Vec2(0.3, 0.1)});
    const std::string svg = svg_plot(group, v1::Recognition());
    EXPECT_THAT(svg, HasSubstr(">x [mm]<"));
    EXPECT_THAT(svg, HasSubstr(">300<"));
    EXPECT_THAT(svg, HasSubstr(">100<"));
  }
}

TEST(SvgPlot, ShowsTheCurveOfTouchesThatAreTooFarApartForAContact) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, 1e-5);
  test::Scene scene;
  scene.sigma_m = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const double t = 2.0 * kPi * i / 20;
    scene.patches.push_back({{0.03 * std::cos(t) + noise(rng), 0.02 * std::sin(t) + noise(rng)}});
  }
  const Recognition answer = test::recognise(scene, scene.sigma_m);
  ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
  ASSERT_TRUE(answer.contacts.empty());
  const std::string svg = svg_plot(group_of(scene, "a<b>.csv"), message_of(answer));
  EXPECT_EQ(count(svg, "class=\"curve\""), 1U);
  EXPECT_THAT(svg, HasSubstr("probe, touches: 20"));
}

TEST(SvgPlot, NamesOfAnyLengthAndBytesLeaveItWellFormed) {
  ContactGroup group{"file", std::string(2000, '<') + "\x01", 1, {std::string(3000, '&')}, {{}}};
  group.runs[0].samples.push_back({{0.3, 0.1}, 0.0, 0});
  const std::string svg = svg_plot(group, {});
  EXPECT_EQ(count(svg, "<text"), count(svg, "</text>"));
  EXPECT_EQ(count(svg, "&lt;"), 2000U);
  EXPECT_EQ(count(svg, "&amp;"), 3000U);
  EXPECT_EQ(svg.find('\x01'), std::string::npos);
}

/// The texts of the table, from this x on: their right ends at most, and the last one's y.
struct TableOfPicture {
  double right = 0.0;
  double bottom = 0.0;
};

TableOfPicture table_of(const std::string& svg) {
  const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"( fill=\"#5b6470\")?>([^<]*)</text>");
  TableOfPicture table;
  for (std::sregex_iterator at(svg.begin(), svg.end(), text), end; at != end; ++at) {
    const double x = std::stod((*at)[1]);
    if (x < 710.0) continue;
    table.right = std::max(table.right, x + text_width_px((*at)[4].str(), 12.0));
    table.bottom = std::max(table.bottom, std::stod((*at)[2]));
  }
  return table;
}

TEST(SvgPlot, WordsOfAnyLengthStayOnThePage) {
  const std::string wide(64, 'W');  // as long as a name may be
  ContactGroup group{"/a/path/" + std::string(500, 'm') + ".csv", wide, 1, {wide, "b"}, {}};
  for (std::uint32_t patch = 0; patch < 40; ++patch) {
    ContactRun run;
    run.context.probe = patch % 2;
    run.context.patch = 4000000000U + patch;
    for (int i = 0; i < 5; ++i) run.samples.push_back({{0.01 * patch, 0.01 * i}, 0.0, 0});
    group.runs.push_back(run);
  }
  v1::Recognition answer;
  answer.set_status(v1::RECOGNITION_STATUS_AMBIGUOUS);
  answer.set_curve_class(v1::CURVE_CLASS_SEMI_CUBICAL_PARABOLA);
  for (const v1::RecognitionDoubt doubt :
       {v1::RECOGNITION_DOUBT_TWO_SHAPES, v1::RECOGNITION_DOUBT_FORM_ERROR,
        v1::RECOGNITION_DOUBT_WORK_LIMIT}) {
    answer.set_doubt(doubt);
    const std::string svg = svg_plot(group, answer);
    std::smatch size;
    ASSERT_TRUE(std::regex_search(svg, size, std::regex("viewBox=\"0 0 ([0-9]+) ([0-9]+)\"")));
    const TableOfPicture table = table_of(svg);
    EXPECT_LE(table.right, std::stod(size[1]));
    EXPECT_LT(table.bottom, std::stod(size[2]));
    EXPECT_THAT(svg, HasSubstr("patch 4000000007"));  // which tells the strokes of a probe apart
    EXPECT_THAT(svg, HasSubstr(".csv"));
  }
}

TEST(SvgPlot, DrawsSpikesUnlikeSamples) {
  std::mt19937_64 rng = test::test_rng();
  test::SceneOptions options;
  options.sigma_over_size = 1e-4;
  test::Scene scene = test::random_scene(CurveClass::Ellipse, options, rng);
  for (const std::size_t i : {20U, 50U, 90U}) {
    // Off the curve: along it a sample may lie where it likes.
    const Vec2 along = scene.patches[0][i + 1] - scene.patches[0][i - 1];
    scene.patches[0][i] += 60.0 * scene.sigma_m * left_of(along.normalized());
  }
  const Recognition answer = test::recognise(scene, scene.sigma_m);
  ASSERT_GE(answer.outlier_count, 3U);  // a clean sample is lost with a probability of 1 %
  ASSERT_EQ(answer.outliers_m.size(), answer.outlier_count);
  for (const std::size_t i : {20U, 50U, 90U}) {
    EXPECT_EQ(std::count(answer.outliers_m.begin(), answer.outliers_m.end(), scene.patches[0][i]),
              1);
  }
  // Crossed out is what the words call set aside.
  const ContactGroup group = group_of(scene, "a<b>.csv");
  const std::string svg = svg_plot(group, message_of(answer), answer.outliers_m);
  const std::string spikes = std::to_string(answer.outlier_count) + " set aside as spikes";
  EXPECT_THAT(svg, HasSubstr(", " + spikes));
  EXPECT_THAT(svg, HasSubstr("x: " + spikes));
  EXPECT_THAT(svg, Not(HasSubstr("beyond 5 sigma")));
  EXPECT_EQ(count(svg, "l8,8m0,-8l-8,8"), answer.outlier_count);
  // What is far off and counts has another sign.
  const std::string all_count = svg_plot(group, message_of(answer));
  EXPECT_THAT(all_count, HasSubstr("+: 3 beyond 5 sigma"));
  EXPECT_EQ(count(all_count, "m0,4h8m-4,-4v8"), 3U);
  EXPECT_EQ(count(all_count, "l8,8m0,-8l-8,8"), 0U);
}

TEST(SvgPlot, OfTwoMillionSamplesDrawsThoseThatCanBeSeenAndSaysSo) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, 1e-5);
  constexpr int kSamples = 2000000;
  ContactGroup group{"big.csv", "part", 1, {"probe"}, {{}}};
  for (int i = 0; i < kSamples; ++i) {
    const double t = 2.0 * kPi * i / kSamples;
    group.runs[0].samples.push_back(
        {{0.03 * std::cos(t) + noise(rng), 0.02 * std::sin(t) + noise(rng)}, 1e-5, 0});
  }
  v1::Recognition answer;
  answer.set_status(v1::RECOGNITION_STATUS_RECOGNIZED);
  answer.set_curve_class(v1::CURVE_CLASS_ELLIPSE);
  answer.mutable_parameters()->set_a(0.03);
  answer.mutable_parameters()->set_b(0.02);
  answer.mutable_pose();
  const std::string svg = svg_plot(group, answer);
  EXPECT_LT(svg.size(), 2U << 20);
  EXPECT_EQ(dots_and_left_out(svg), static_cast<std::size_t>(kSamples));
}

}  // namespace
}  // namespace palpate

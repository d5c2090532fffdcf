// The scenes of the paper's tables 3 to 5 as points in a file, for the whole pipeline:
//     paper_scenes table3|table3-differences|table4|table5 [NOISE_MM [SPACING_MM]] > scenes.csv
// Before each object a comment says what it is: "# OBJECT CLASS a b c", in metres.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string_view>
#include <vector>

#include "core/curves/curve.h"
#include "core/invariants/measured_geometry.h"
#include "tests/paper/paper_experiments.h"
#include "tests/paper/random_curves.h"
#include "tests/paper/sensor_experiments.h"
#include "tests/support/touched_curve.h"

namespace palpate::paper {
namespace {

/// Samples of a stroke for the two-round fit: n + (m - 1) l.
constexpr int kSamples = 111;
/// Samples of a stroke for finite differences: the five that they use.
constexpr int kDifferenceSamples = 5;
/// What samples without noise are stated to have, of a curve of about 1 m. [m]
constexpr double kRounding_m = 1e-12;

void print_object(int number, const test::Scene& scene) {
  std::printf("# %d %s %.17g %.17g %.17g\n", number, name_of(scene.curve_class).data(),
              scene.values[0], scene.values[1], scene.values[2]);
  for (std::size_t patch = 0; patch < scene.patches.size(); ++patch) {
    for (const Vec2& p : scene.patches[patch]) {
      std::printf("probe,%zu,%.17g,%.17g,%g,%d\n", patch, p.x(), p.y(), scene.sigma_m, number);
    }
  }
}

Pose2 random_pose(Random& random) {
  const double x = random.uniform(-1.0, 1.0);
  const double y = random.uniform(-1.0, 1.0);
  return {x, y, random.uniform(-kPi, kPi)};
}

/// As few places as the tree takes, no two of them alike: three, of the spline one that verifies.
/// Empty where the curve's own range seems to have none.
std::vector<double> apart_places(const test::PlacedCurve& curve, Random& random) {
  const std::size_t count = curve.curve_class == CurveClass::CubicSpline ? 4 : 3;
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    std::vector<double> places;
    std::vector<MeasuredGeometry> points;
    bool apart = true;
    while (apart && places.size() < count) {
      places.push_back(random_place(curve, random));
      points.push_back(measured_geometry(test::exact_estimate(curve, places.back())));
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        apart = apart && are_told_apart(curve.curve_class, points[k], points.back());
      }
    }
    if (apart) {
      return places;
    }
  }
  return {};
}

/// As many curves as the paper's, without noise.
void print_table3(bool differences) {
  std::mt19937_64 unused;
  std::uint64_t stream = 60;
  int number = 0;
  for (const Table3Class& row : table3_classes()) {
    Random random(stream++);
    for (int i = 0; i < row.curves;) {
      const test::PlacedCurve curve = random_curve(row.curve_class, random);
      const std::vector<double> places = apart_places(curve, random);
      if (places.empty()) {
        continue;
      }
      ++i;
      std::vector<test::Stroke> strokes;
      for (const double t : places) {
        const MeasuredGeometry point = measured_geometry(test::exact_estimate(curve, t));
        const double size = 1.0 / curvature_scale({&point, 1});
        const int direction = random.sign() > 0.0 ? 1 : -1;
        // Two rounds are over as much of the curve as table3's differences. Neighbours of
        // differences are as far apart as there; tangents are chords here, over two points more.
        strokes.push_back(differences ? test::Stroke{t, 4.0 * step_of(row.curve_class) * size,
                                                     kDifferenceSamples, direction}
                                      : test::Stroke{t, 2.0 * step_of(row.curve_class) * size,
                                                     kSamples, direction});
      }
      test::Scene scene = test::touched_curve(*make_curve(row.curve_class, curve.parameters),
                                              random_pose(random), strokes, 0.0, unused);
      scene.sigma_m = kRounding_m;
      print_object(++number, scene);
    }
  }
}

/// As many objects as the paper took pairs or more, with the sensor's noise.
void print_sensor_table(const SensorPart& part, int objects, std::uint64_t stream) {
  Random random(stream);
  std::mt19937_64 noise(stream);
  std::vector<test::Stroke> strokes;
  for (const double centre : part.centres) {
    strokes.push_back({centre, part.stroke_m, kSamples, 1});
  }
  for (int number = 1; number <= objects; ++number) {
    print_object(number, test::touched_curve(*make_curve(part.curve_class, part.shape),
                                             random_pose(random), strokes, part.sigma_m, noise));
  }
}

/// The part touched with another noise, at another spacing.
SensorPart with(SensorPart part, int argc, char** argv) {
  constexpr double kMillimetre = 1e-3;
  if (argc > 2) {
    part.sigma_m = kMillimetre * std::atof(argv[2]);
  }
  if (argc > 3) {
    part.stroke_m = kMillimetre * std::atof(argv[3]) * (kSamples - 1);
  }
  return part;
}

}  // namespace
}  // namespace palpate::paper

int main(int argc, char** argv) {
  using namespace palpate::paper;
  const std::string_view table = argc > 1 ? argv[1] : "";
  const bool differences = table == "table3-differences";
  if (!differences && table != "table3" && table != "table4" && table != "table5") {
    std::fprintf(stderr, "usage: paper_scenes table3|table3-differences|table4|table5\n");
    return 2;
  }
  std::printf("probe,patch,x_m,y_m,sigma_m,object\n");
  if (table == "table4") {
    print_sensor_table(with(table4_part(), argc, argv), 80, 64);  // the paper's eighty pairs
  } else if (table == "table5") {
    print_sensor_table(with(table5_part(), argc, argv), 80, 65);
  } else {
    print_table3(differences);
  }
  return 0;
}

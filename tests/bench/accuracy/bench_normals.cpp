// Measures how many touches of an ellipse a measured normal saves: the fewest touches after which
// both axes are known to a given relative accuracy in 95 % of scenes. Touches lie anywhere on the
// ellipse, in no order. The class is given; with --sought the ellipse has to be recognised. For
// each number of touches it also prints the mean square of the axes' errors in units of their
// published deviations (expected: 1) and how many scenes were recognised as another class. Prints a
// table.
//   bench_normals [--sought] [--scenes N] [--accuracy PART] [--most N] [--seed S]
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/recognizer.h"
#include "tests/bench/options/bench_options.h"

namespace {

using namespace palpate;

constexpr double kDegree = kPi / 180.0;
const Ellipse kPart{0.03, 0.022};
constexpr double kNoNormals = 0.0;

std::vector<GivenPoint> touch(int count, double sigma_m, double normal_sigma_rad,
                              std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> anywhere(0.0, 2.0 * kPi);
  const Pose2 pose{0.1, -0.2, anywhere(rng)};
  std::vector<GivenPoint> points;
  for (int i = 0; i < count; ++i) {
    const double t = anywhere(rng);
    const double outward = geometry(Curve(kPart), t).tangent_angle + pose.theta - 0.5 * kPi;
    GivenPoint& point = points.emplace_back();
    point.position_m = pose * position(Curve(kPart), t) + sigma_m * Vec2(normal(rng), normal(rng));
    point.sigma_m = sigma_m;
    const double measured = outward + normal_sigma_rad * normal(rng);
    point.normal = {std::cos(measured), std::sin(measured)};
    point.normal_sigma_rad = normal_sigma_rad;
  }
  return points;
}

struct Outcome {
  int known = 0;         ///< scenes in which both axes are known to the accuracy
  double squares = 0.0;  ///< of errors over deviations, in these scenes
  int wrong = 0;         ///< recognised as something else
};

/// What the answer says about the curve; covariance of [shape; x; y; theta].
struct Told {
  bool is_ellipse = false;
  bool is_other = false;
  ShapeParameters shape;
  ShapePoseCovariance covariance;
};

Told told_of_given(const std::vector<GivenPoint>& points) {
  const GivenFit fit = fit_given_class(CurveClass::Ellipse, points);
  return {fit.status == GivenStatus::Fitted, false, fit.shape, fit.covariance};
}

Told told_of_sought(const std::vector<GivenPoint>& points) {
  Recognizer recognizer;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const ContactSample sample{points[i].position_m, points[i].sigma_m, 0};
    SampleDetail detail;
    if (points[i].normal_sigma_rad > 0.0) {
      detail = {points[i].normal, points[i].normal_sigma_rad, Eigen::Vector3d::Zero()};
    }
    recognizer.add({0, i}, {&sample, 1}, {&detail, 1});
  }
  const Recognition answer = recognizer.recognize();
  const bool recognized = answer.status == RecognitionStatus::Recognized;
  const bool ellipse = answer.shape.curve_class == CurveClass::Ellipse;
  return {recognized && ellipse, recognized && !ellipse, answer.shape, answer.covariance};
}

Outcome outcome_of(int count, double sigma_m, double normal_sigma_rad, double accuracy, int scenes,
                   std::uint64_t seed, bool sought) {
  Outcome outcome;
  for (int scene = 0; scene < scenes; ++scene) {
    std::seed_seq seeds{seed, static_cast<std::uint64_t>(count), static_cast<std::uint64_t>(scene)};
    std::mt19937_64 rng(seeds);
    const std::vector<GivenPoint> points = touch(count, sigma_m, normal_sigma_rad, rng);
    const Told fit = sought ? told_of_sought(points) : told_of_given(points);
    outcome.wrong += fit.is_other ? 1 : 0;
    if (!fit.is_ellipse) continue;
    const double a_sd = std::sqrt(fit.covariance(0, 0));
    const double b_sd = std::sqrt(fit.covariance(1, 1));
    if (a_sd > accuracy * kPart.a || b_sd > accuracy * kPart.b) continue;
    ++outcome.known;
    outcome.squares += 0.5 * (std::pow((fit.shape.values[0] - kPart.a) / a_sd, 2) +
                              std::pow((fit.shape.values[1] - kPart.b) / b_sd, 2));
  }
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 400;
  int most = 200;
  double accuracy = 0.01;
  std::uint64_t seed = 2026;
  bool sought = false;
  if (const auto end = bench::BenchOptions("Touches that a measured normal saves on an ellipse")
                           .flag("--sought", sought, "The class is not given")
                           .number("--scenes", scenes, "Scenes of each number of touches")
                           .number("--accuracy", accuracy, "Deviation of each axis over the axis")
                           .number("--most", most, "Touches after which it is given up")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  constexpr double kOften = 0.95;
  std::printf("ellipse %g x %g m, %s, both axes to %g %% in %g %% of %d scenes\n", kPart.a, kPart.b,
              sought ? "recognised" : "given", 100.0 * accuracy, 100.0 * kOften, scenes);
  std::printf("%12s %12s | %8s %8s %6s\n", "noise/a [%]", "normals", "touches", "err^2", "wrong");
  for (const double noise : {0.001, 0.003, 0.01, 0.02}) {
    for (const double normals : {kNoNormals, 3.0 * kDegree, kDegree, kDegree / 3.0}) {
      char name[32] = "none";
      if (normals > 0.0) std::snprintf(name, sizeof name, "%.2f deg", normals / kDegree);
      int count = 3;
      Outcome outcome;
      for (; count <= most; count += 1 + count / 20) {
        outcome = outcome_of(count, noise * kPart.a, normals, accuracy, scenes, seed, sought);
        if (outcome.known >= kOften * scenes) break;
      }
      if (count > most) {
        std::printf("%12.1f %12s | %8s\n", 100.0 * noise, name, "more");
      } else {
        std::printf("%12.1f %12s | %8d %8.2f %6d\n", 100.0 * noise, name, count,
                    outcome.squares / outcome.known, outcome.wrong);
      }
    }
  }
  return 0;
}

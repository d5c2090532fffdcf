// Signature curves (curvature, its derivative by arc length) of a shape of each class, with local
// estimates from noisy strokes beside them: by circles through three samples (figure 9 of the
// paper), by its two-round fit (figure 10) and by adaptive jets. Shapes are the paper's where it
// gives them. Prints CSV, in units of the part's size.
#include <cmath>
#include <cstdio>
#include <random>
#include <span>
#include <string>
#include <string_view>

#include "core/curves/signature.h"
#include "core/local/adaptive_jet.h"
#include "core/local/estimator.h"
#include "tests/support/touched_curve.h"

namespace {

using namespace palpate;

constexpr std::uint64_t kSeed = 2026;
constexpr double kNoise = 1e-4;  // of the part's size, which is 1
constexpr int kCurvePoints = 400;
constexpr int kSamples = 600;
constexpr std::size_t kSamplesPerEstimate = 87;
constexpr std::size_t kShift = 4;

struct Shape {
  CurveClass curve_class;
  Eigen::Vector3d values;
  double t0, t1;
};

const Shape kShapes[] = {
    {CurveClass::Ellipse, {1.0, 0.7, 0.0}, 0.0, 2.0 * kPi},
    {CurveClass::Parabola, {0.4, 0.0, 0.0}, -1.2, 1.2},
    {CurveClass::Hyperbola, {0.8, 0.7, 0.0}, -1.0, 1.0},
    {CurveClass::CubicalParabola, {0.6, 0.4, 0.0}, -1.5, 1.5},
    {CurveClass::SemiCubicalParabola, {1.5, 0.5, 0.0}, 0.35, 1.1},
    {CurveClass::CubicSpline, {1.10734, 1.67996, -0.401898}, 0.25, 1.1},
};

void print(const std::string& name, const char* kind, double kappa, double kappa_s) {
  std::printf("%s,%s,%.8g,%.8g\n", name.c_str(), kind, kappa, kappa_s);
}

void estimates(const Shape& shape, const Curve& curve, const std::string& name) {
  std::mt19937_64 rng(kSeed);
  const double length = std::abs(arc_length(curve, shape.t0, shape.t1));
  const double middle = parameter_at_arc_length(curve, shape.t0, 0.5 * length);
  const test::Stroke stroke{middle, length, kSamples, 1};
  const test::Scene scene = test::touched_curve(curve, {}, {&stroke, 1}, kNoise, rng);
  const auto print_estimate = [&](std::string_view kind, const LocalResult& result) {
    if (result)
      print(name, std::string(kind).c_str(), result.estimate.kappa, result.estimate.kappa_s);
  };
  for (const EstimatorKind kind : {EstimatorKind::Circle, EstimatorKind::TwoRound}) {
    EstimatorOptions options;
    options.kind = kind;
    options.shift = static_cast<int>(kShift);
    options.sigma_m = kNoise;
    options.window = 0;  // the two-round fit takes more than a window
    options.window = static_cast<int>(kSamplesPerEstimate - samples_per_estimate(options));
    for (const WindowResult& window : estimate_all(scene.patches[0], options)) {
      print_estimate(name_of(kind), window.result);
    }
  }
  const std::span<const Vec2> samples(scene.patches[0]);
  for (std::size_t first = 0; first + kSamplesPerEstimate <= samples.size(); first += kShift) {
    print_estimate("adaptive jet", adaptive_jet(samples.subspan(first, kSamplesPerEstimate),
                                                PatchPlace::Centre, kNoise)
                                       .result);
  }
}

}  // namespace

int main() {
  std::printf("class,kind,kappa,kappa_s\n");
  for (const Shape& shape : kShapes) {
    const Curve curve = make_curve(shape.curve_class, shape.values).value();
    const std::string name(name_of(shape.curve_class));
    for (const SignaturePoint& point : signature_curve(curve, shape.t0, shape.t1, kCurvePoints)) {
      print(name, "curve", point.kappa, point.kappa_s);
    }
    estimates(shape, curve, name);
  }
  return 0;
}

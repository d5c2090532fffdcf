// Data of the paper's figures 2 to 5, 9 and 10: signature curves (curvature and its derivative by
// arc length), semi-signature curves (with the slope lambda as well), and for comparison local
// estimates from noisy strokes: by circles through three samples (figure 9), by the two-round fit
// (figure 10) and by the sliding window. Shapes are the paper's where it gives them. Prints CSV in
// units of the part's size; the labels of figures 4 and 5 hold the values of the invariants.
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "core/local/estimator.h"
#include "core/local/stream/sliding_window.h"
#include "tests/paper/figure_invariants.h"
#include "tests/support/signature.h"
#include "tests/support/touched_curve.h"

namespace {

using namespace palpate;

constexpr std::uint64_t kSeed = 2026;
constexpr double kNoise = 1e-4;  // relative to the part's size, which is 1
constexpr int kCurvePoints = 400;
constexpr int kSamples = 600;
/// The paper's n and l, and enough fits for the second round: 75 + 3 * 4 = 87 samples per estimate.
constexpr int kWindow = 75;
constexpr int kShift = 4;
constexpr int kFits = 4;

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

void print_curve(const std::string& figure, const std::string& label, const Curve& curve, double t0,
                 double t1) {
  for (const test::SignaturePoint& point : test::signature_curve(curve, t0, t1, kCurvePoints)) {
    const Vec2 place = position(curve, point.t);
    std::printf("%s,%s,curve,%.8g,%.8g,%.8g,%.8g,%.8g\n", figure.c_str(), label.c_str(), place.x(),
                place.y(), point.slope(), point.kappa, point.kappa_s);
  }
}

/// The slope of an estimate is in the world frame and not part of these figures.
void print_estimate(const std::string& label, const std::string& kind, const LocalResult& result) {
  if (result) {
    const LocalEstimate& e = result.estimate;
    std::printf("10,%s,%s,%.8g,%.8g,,%.8g,%.8g\n", label.c_str(), kind.c_str(), e.position.x(),
                e.position.y(), e.kappa, e.kappa_s);
  }
}

void print_estimates(const Shape& shape, const Curve& curve, const std::string& label) {
  std::mt19937_64 rng(kSeed);
  const double length = std::abs(arc_length(curve, shape.t0, shape.t1));
  const double middle = parameter_at_arc_length(curve, shape.t0, 0.5 * length);
  const test::Stroke stroke{middle, length, kSamples, 1};
  const test::Scene scene = test::touched_curve(curve, {}, {&stroke, 1}, kNoise, rng);
  EstimatorOptions two_round;
  two_round.kind = EstimatorKind::TwoRound;
  two_round.window = kWindow;
  two_round.shift = kShift;
  two_round.two_round_fits = kFits;
  two_round.sigma_m = kNoise;
  EstimatorOptions circle = two_round;
  circle.kind = EstimatorKind::Circle;
  circle.window = static_cast<int>(samples_per_estimate(two_round));
  for (const EstimatorOptions& options : {circle, two_round}) {
    for (const WindowResult& window : estimate_all(scene.patches[0], options)) {
      print_estimate(label, std::string(name_of(options.kind)), window.result);
    }
  }
  SlidingWindow sliding({.shift = kShift, .sigma_m = kNoise});
  for (const Vec2& sample : scene.patches[0]) {
    if (const auto window = sliding.add(sample)) {
      print_estimate(label, "sliding window", window->result);
    }
  }
}

std::string values_of(const paper::FigureCurve& figure) {
  char text[128];
  if (class_of(figure.curve) == CurveClass::Parabola) {
    std::snprintf(text, sizeof text, "a = %g: Ip = %.6g", figure.parameters[0], figure.measured[0]);
  } else {
    std::snprintf(text, sizeof text, "a = %g; b = %g: Ic1 = %.6g; Ic2 = %.6g", figure.parameters[0],
                  figure.parameters[1], figure.measured[0], figure.measured[1]);
  }
  return text;
}

}  // namespace

int main() {
  std::printf("figure,label,kind,x,y,lambda,kappa,kappa_s\n");
  constexpr double kWide = 2.0;  // of x, as in the paper's picture
  print_curve("3", "y = 0.6 x^3 + 0.4 x", CubicalParabola{0.6, 0.4}, -kWide, kWide);
  for (const paper::FigureCurve& figure : paper::figure4()) {
    print_curve("4", values_of(figure), figure.curve, -kWide, kWide);
  }
  for (const paper::FigureCurve& figure : paper::figure5()) {
    print_curve("5", values_of(figure), figure.curve, 0.0, 2.0 * kPi);
  }
  for (const Shape& shape : kShapes) {
    const Curve curve = make_curve(shape.curve_class, shape.values).value();
    const std::string name(name_of(shape.curve_class));
    print_curve("10", name, curve, shape.t0, shape.t1);
    print_estimates(shape, curve, name);
  }
  return 0;
}

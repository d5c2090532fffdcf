// One-parameter sweeps towards each degeneracy. Prints CSV: how often the class is right,
// recognised and recognised wrongly, errors compared with the Kanatani-Cramer-Rao bound, the
// condition number, and the time.
//   bench_sweeps [--scenes N]
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/bench/options/bench_options.h"
#include "tests/support/scene_data.h"
#include "tests/support/touched_curve.h"

namespace {

using namespace palpate;
using test::Scene;
using test::Stroke;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kSeed = 2026;
constexpr double kSize_m = 0.025;  // half extent of the parts below, about
constexpr double kNoise = 1e-3;    // relative to it, unless swept
constexpr double kSigma_m = kNoise * kSize_m;
constexpr double kStroke_m = 0.022;  // the paper's patches: 111 samples 0.2 mm apart
const Pose2 kPose{0.11, -0.07, 0.6};

using Make = std::function<Scene(double value, std::mt19937_64& rng)>;

struct Sweep {
  std::string name;
  std::vector<double> values;
  Make make;
  /// The class at the limit, which is the right answer when the difference is below the noise.
  CurveClass limit = CurveClass::Unclassified;
};

Curve curve_of(CurveClass curve_class, double a, double b = 0.0, double c = 0.0) {
  return make_curve(curve_class, Eigen::Vector3d(a, b, c)).value();
}

/// Two strokes of the paper's length around these parameters.
Scene two_strokes(const Curve& curve, double t1, double t2, std::mt19937_64& rng,
                  double length_m = kStroke_m) {
  const Stroke strokes[] = {{t1, length_m, 111, 1}, {t2, length_m, 111, -1}};
  return test::touched_curve(curve, kPose, strokes, kSigma_m, rng);
}

Scene paper_ellipse(std::mt19937_64& rng) {
  return two_strokes(curve_of(CurveClass::Ellipse, 0.025, 0.0175), 0.9, 3.0, rng);
}

/// The conic of that eccentricity with a focal parameter of 20 mm, in a fixed neighbourhood of its
/// vertex.
Scene conic(double eccentricity, std::mt19937_64& rng) {
  constexpr double kFocalParameter_m = 0.02;
  const double e2 = 1.0 - eccentricity * eccentricity;
  if (eccentricity == 1.0) {
    const double a =
        0.5 * kFocalParameter_m;  // (a t^2, 2 a t): radius of curvature 2 a at the vertex
    return two_strokes(curve_of(CurveClass::Parabola, a), -1.5, 1.2, rng);
  }
  const double a = kFocalParameter_m / std::abs(e2);
  const double b = kFocalParameter_m / std::sqrt(std::abs(e2));
  // At the same arc lengths from the vertex as on the parabola.
  const Curve parabola = curve_of(CurveClass::Parabola, 0.5 * kFocalParameter_m);
  const double s1 = arc_length(parabola, 0.0, -1.5);
  const double s2 = arc_length(parabola, 0.0, 1.2);
  const Curve curve = curve_of(e2 > 0.0 ? CurveClass::Ellipse : CurveClass::Hyperbola, a, b);
  return two_strokes(curve, parameter_at_arc_length(curve, 0.0, s1),
                     parameter_at_arc_length(curve, 0.0, s2), rng);
}

Scene scaled(Scene scene, double factor) {
  for (auto& patch : scene.patches) {
    for (Vec2& p : patch) p *= factor;
  }
  scene.values *= factor;  // an ellipse's t has no unit
  scene.world_T_curve.x *= factor;
  scene.world_T_curve.y *= factor;
  scene.sigma_m *= factor;
  return scene;
}

Scene moved(Scene scene, double offset_m) {
  for (auto& patch : scene.patches) {
    for (Vec2& p : patch) p.x() += offset_m;
  }
  scene.world_T_curve.x += offset_m;
  return scene;
}

Scene with_spikes(Scene scene, double fraction, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  constexpr double kSpike_m = 0.01;
  for (auto& patch : scene.patches) {
    for (Vec2& p : patch) {
      if (uniform(rng) >= fraction) continue;
      const double x = uniform(rng) - 0.5;
      const double y = uniform(rng) - 0.5;
      p += kSpike_m * Vec2(x, y);
    }
  }
  return scene;
}

Scene strokes_around(int patches, int samples, std::mt19937_64& rng) {
  const Curve ellipse = curve_of(CurveClass::Ellipse, 0.025, 0.0175);
  std::vector<Stroke> strokes;
  for (int i = 0; i < patches; ++i) {
    strokes.push_back({0.9 + 2.0 * kPi * i / patches, kStroke_m, samples, 1});
  }
  return test::touched_curve(ellipse, kPose, strokes, kSigma_m, rng);
}

/// Two strokes whose tangents are at right angles plus `off`: at 0 their relative slope is
/// infinite.
Scene right_angle(double off, std::mt19937_64& rng) {
  const Curve cubical = curve_of(CurveClass::CubicalParabola, 900.0, -0.5);
  const double t1 = 0.002;
  const double wanted = geometry(cubical, t1).tangent_angle + 0.5 * kPi + off;
  double low = t1;
  double high = 0.2;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (geometry(cubical, middle).tangent_angle < wanted ? low : high) = middle;
  }
  return two_strokes(cubical, t1, low, rng, 0.015);
}

std::vector<double> decades(double from, double to) {
  std::vector<double> values;
  for (double v = from; from < to ? v <= 1.0001 * to : v >= 0.9999 * to;
       v *= from < to ? 10.0 : 0.1) {
    values.push_back(v);
  }
  return values;
}

std::vector<Sweep> sweeps() {
  const double scale = 1.0 / std::sqrt(kSize_m);  // the cubics' a is a length to the power -1/2
  return {
      {"1 - b/a of an ellipse",
       {0.5, 0.3, 0.1, 0.05, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7},
       [](double v, auto& rng) {
         return two_strokes(curve_of(CurveClass::Ellipse, 0.025, 0.025 * (1.0 - v)), 0.9, 3.0, rng);
       },
       CurveClass::Circle},
      {"b/a of an ellipse",
       {1.0 / 2, 1.0 / 5, 1.0 / 10, 1.0 / 20, 1.0 / 50, 1.0 / 100},
       [](double v, auto& rng) {
         return two_strokes(curve_of(CurveClass::Ellipse, 0.05, 0.05 * v), 0.2, 2.9, rng);
       }},
      {"eccentricity less 1",
       {-0.5, -0.3, -0.2, -0.1, -0.05, -0.02, -0.01, 0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5},
       [](double v, auto& rng) { return conic(1.0 + v, rng); },
       CurveClass::Parabola},
      {"tangents from a right angle [rad]",
       {0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6, 0.0},
       [](double v, auto& rng) { return right_angle(v, rng); }},
      {"arc from the cusp [m]",
       {0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002},
       [=](double v, auto& rng) {
         const Curve curve = curve_of(CurveClass::SemiCubicalParabola, 1.2 * scale, 0.4);
         // Starting at distance v from the cusp, on both arms.
         const double t1 = parameter_at_arc_length(curve, 0.0, v + 0.5 * kStroke_m);
         const double t2 = parameter_at_arc_length(curve, 0.0, -v - 0.5 * kStroke_m);
         return two_strokes(curve, t1, t2, rng);
       }},
      {"arc from the inflection [m]",
       {0.03, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0},
       [](double v, auto& rng) {
         const Curve curve = curve_of(CurveClass::CubicalParabola, 900.0, -0.5);
         return two_strokes(curve, parameter_at_arc_length(curve, 0.0, v),
                            parameter_at_arc_length(curve, 0.0, v + 1.2 * kStroke_m), rng);
       }},
      {"c of a spline [sqrt(size)]",
       {1.5, 1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02, 0.01},
       [=](double v, auto& rng) {
         const Curve curve = curve_of(CurveClass::CubicSpline, 1.2 * scale, 0.4, v / scale);
         return two_strokes(curve, -0.6 / scale, 0.8 / scale, rng, 0.03);
       },
       CurveClass::SemiCubicalParabola},
      {"a of a spline [1/sqrt(size)]",
       {3.0, 1.5, 1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05},
       [=](double v, auto& rng) {
         const Curve curve = curve_of(CurveClass::CubicSpline, v * scale, 0.4, 0.5 / scale);
         return two_strokes(curve, -0.6 / scale, 0.8 / scale, rng, 0.03);
       },
       CurveClass::Parabola},
      {"scale", decades(1e-6, 1e6),
       [](double v, auto& rng) { return scaled(paper_ellipse(rng), v); }},
      {"offset [m]",
       {0.0, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6},
       [](double v, auto& rng) { return moved(paper_ellipse(rng), v); }},
      {"fraction of spikes",
       {0.0, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3},
       [](double v, auto& rng) {
         const Scene clean = paper_ellipse(rng);
         return with_spikes(clean, v, rng);
       }},
      {"patches",
       {1, 2, 3, 4},
       [](double v, auto& rng) { return strokes_around(static_cast<int>(v), 111, rng); }},
      {"samples a patch",
       {5, 8, 12, 20, 40, 80, 111, 200},
       [](double v, auto& rng) { return strokes_around(3, static_cast<int>(v), rng); }},
  };
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void run(const Sweep& sweep, int count) {
  for (const double value : sweep.values) {
    std::mt19937_64 rng(kSeed);
    int right = 0;
    int recognized = 0;
    int wrong = 0;
    int at_limit = 0;
    double squares = 0.0;
    std::vector<double> errors, bounds, conditions, times;
    std::string name;
    for (int i = 0; i < count; ++i) {
      const Scene scene = sweep.make(value, rng);
      name = name_of(scene.curve_class);
      const auto start = Clock::now();
      const Recognition answer = test::recognise(scene, scene.sigma_m);
      times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
      const bool is_recognized = answer.status == RecognitionStatus::Recognized;
      recognized += is_recognized ? 1 : 0;
      const Eigen::MatrixXd bound = test::bound_of(scene);
      const Eigen::ArrayXd sizes = test::natural_sizes(scene).array();
      const Eigen::ArrayXd relative_bound = bound.diagonal().cwiseSqrt().array() / sizes;
      const auto letters = static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size());
      bounds.push_back(relative_bound.head(letters).maxCoeff());
      const Eigen::MatrixXd scaled_bound =
          sizes.inverse().matrix().asDiagonal() * bound * sizes.inverse().matrix().asDiagonal();
      const Eigen::VectorXd spectrum =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled_bound).eigenvalues();
      conditions.push_back(std::sqrt(spectrum[spectrum.size() - 1] / spectrum[0]));
      if (answer.shape.curve_class != scene.curve_class) {
        if (sweep.limit != CurveClass::Unclassified && answer.shape.curve_class == sweep.limit) {
          ++at_limit;
        } else if (is_recognized) {
          ++wrong;
        }
        continue;
      }
      ++right;
      const Eigen::ArrayXd error = test::error_of(answer.hypotheses.front(), scene).array().abs();
      errors.push_back((error / sizes).head(letters).maxCoeff());
      squares += (error.square() / bound.diagonal().array()).mean();
    }
    std::printf("\"%s\",%.10g,%s,%d,%d,%d,%d,%d,%.4g,%.4g,%.3f,%.4g,%.0f\n", sweep.name.c_str(),
                value, name.c_str(), count, right, at_limit, recognized, wrong, median(errors),
                median(bounds), right > 0 ? std::sqrt(squares / right) : std::nan(""),
                median(conditions), median(times));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int count = 40;
  if (const auto end = bench::BenchOptions("Sweeps towards the degeneracies")
                           .number("--scenes", count, "Scenes a value")
                           .parse(argc, argv)) {
    return *end;
  }
  std::printf(
      "sweep,value,class,scenes,right_class,limit_class,recognized,recognized_wrongly,shape_error_"
      "median,shape_bound,"
      "rmse_over_bound,condition,us\n");
  for (const Sweep& sweep : sweeps()) run(sweep, count);
  return 0;
}

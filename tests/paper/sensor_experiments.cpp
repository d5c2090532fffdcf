#include "tests/paper/sensor_experiments.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "core/curves/curve.h"
#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/local/estimator.h"
#include "tests/support/scene_data.h"
#include "tests/support/touched_curve.h"

namespace palpate::paper {
namespace {

constexpr int kTrials = 200;
constexpr double kSigma_mm = 0.05;
constexpr double kSpacing_mm = 0.2;
constexpr int kSamples = 111;  // n + (m - 1) l

/// The paper's method: one two-round estimate a stroke, (26) and (28) of two or (50) of three.
std::optional<Eigen::Vector3d> by_paper(const test::Scene& scene) {
  EstimatorOptions options;
  options.kind = EstimatorKind::TwoRound;
  options.sigma_m = scene.sigma_m;
  std::vector<MeasuredGeometry> points;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    const LocalResult result = estimate_window(scene.patches[p], options);
    if (!result) {
      return std::nullopt;
    }
    points.push_back(measured_geometry(result.estimate, static_cast<int>(p)));
  }
  if (scene.curve_class == CurveClass::CubicSpline) {
    const SemiSignatureFit fit = fit_cubic_spline(points);
    return fit.status == InvariantStatus::Ok ? std::optional(fit.parameters) : std::nullopt;
  }
  const ConicInvariants pair = conic_invariants(points[0], points[1]);
  if (pair.status != InvariantStatus::Ok) {
    return std::nullopt;
  }
  const ConicParameters shape = ellipse_parameters(pair.ic1, pair.ic2, pair.covariance);
  return shape.status == InvariantStatus::Ok ? std::optional(Eigen::Vector3d(shape.a, shape.b, 0.0))
                                             : std::nullopt;
}

Recovered statistics(const std::vector<Eigen::Vector3d>& values) {
  Recovered result;
  result.answers = static_cast<int>(values.size());
  if (values.empty()) {
    return result;
  }
  for (int k = 0; k < 3; ++k) {
    std::vector<double> sorted;
    for (const Eigen::Vector3d& value : values) {
      sorted.push_back(value[k]);
    }
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&](double q) {
      return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
    };
    constexpr double kOneSigma = 0.1587;  // of a normal law below minus one standard deviation
    result.min[k] = sorted.front();
    result.max[k] = sorted.back();
    result.median[k] = quantile(0.5);
    result.spread[k] = 0.5 * (quantile(1.0 - kOneSigma) - quantile(kOneSigma));
  }
  return result;
}

/// Strokes at `centres` (curve parameters); lengths in `unit_mm` millimetres.
SensorExperiment run(CurveClass curve_class, const Eigen::Vector3d& truth,
                     const std::vector<double>& centres, double unit_mm, std::uint64_t seed) {
  const Curve curve = *make_curve(curve_class, truth);
  std::vector<test::Stroke> strokes;
  for (const double centre : centres) {
    strokes.push_back({centre, (kSamples - 1) * kSpacing_mm / unit_mm, kSamples, 1});
  }
  SensorExperiment experiment;
  experiment.trials = kTrials;
  experiment.curve_class = curve_class;
  std::copy(truth.begin(), truth.end(), experiment.truth);
  std::mt19937_64 rng(seed);
  std::vector<Eigen::Vector3d> paper;
  std::vector<Eigen::Vector3d> defaults;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double sigma = kSigma_mm / unit_mm;
    const test::Scene scene = test::touched_curve(curve, {}, strokes, sigma, rng);
    if (trial == 0) {
      const Eigen::MatrixXd bound = test::bound_of(scene);
      for (std::size_t k = 0; k < parameter_letters(curve_class).size(); ++k) {
        experiment.bound[k] =
            std::sqrt(bound(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
      }
    }
    if (const auto shape = by_paper(scene)) {
      paper.push_back(*shape);
    }
    const Recognition answer = test::recognise(scene, sigma);
    experiment.recognised +=
        answer.status == RecognitionStatus::Recognized && answer.shape.curve_class == curve_class
            ? 1
            : 0;
    const Hypothesis* hypothesis = test::hypothesis_of(answer, curve_class);
    if (hypothesis != nullptr && hypothesis->covariance.size() > 0) {
      defaults.push_back(hypothesis->shape.values);
    }
  }
  experiment.by_paper = statistics(paper);
  experiment.by_defaults = statistics(defaults);
  return experiment;
}

}  // namespace

SensorExperiment table4() {
  constexpr double kUnit_mm = 1.0;
  return run(CurveClass::Ellipse, {25.0, 17.5, 0.0}, {0.8, 2.8}, kUnit_mm, 4);
}

SensorExperiment table5() {
  constexpr double kUnit_mm = 10.0;
  return run(CurveClass::CubicSpline, {1.10734, 1.67996, -0.401898}, {-1.4, 0.75, 1.1}, kUnit_mm,
             5);
}

}  // namespace palpate::paper

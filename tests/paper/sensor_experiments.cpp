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
constexpr int kSamples = 111;  // n + (m - 1) l
constexpr double kSigma_m = 5e-5;
constexpr double kStroke_m = 2e-4 * (kSamples - 1);

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

/// The part with `unit_m` metres for a unit of length: canonical t goes as its root where x = t^2.
SensorPart in_unit(SensorPart part, double unit_m) {
  part.stroke_m /= unit_m;
  part.sigma_m /= unit_m;
  if (part.curve_class == CurveClass::Ellipse) {
    part.shape /= unit_m;
    return part;
  }
  const double root = std::sqrt(unit_m);
  part.shape = part.shape.cwiseProduct(Eigen::Vector3d(root, 1.0, 1.0 / root));
  for (double& centre : part.centres) {
    centre /= root;
  }
  return part;
}

/// On all strokes but the last.
SensorExperiment run(const SensorPart& part, std::uint64_t seed) {
  const Curve curve = *make_curve(part.curve_class, part.shape);
  std::vector<test::Stroke> strokes;
  for (std::size_t i = 0; i + 1 < part.centres.size(); ++i) {
    strokes.push_back({part.centres[i], part.stroke_m, kSamples, 1});
  }
  SensorExperiment experiment;
  experiment.trials = kTrials;
  experiment.curve_class = part.curve_class;
  std::copy(part.shape.begin(), part.shape.end(), experiment.truth);
  std::mt19937_64 rng(seed);
  std::vector<Eigen::Vector3d> paper;
  std::vector<Eigen::Vector3d> defaults;
  for (int trial = 0; trial < kTrials; ++trial) {
    const test::Scene scene = test::touched_curve(curve, {}, strokes, part.sigma_m, rng);
    if (trial == 0) {
      const Eigen::MatrixXd bound = test::bound_of(scene);
      for (std::size_t k = 0; k < parameter_letters(part.curve_class).size(); ++k) {
        experiment.bound[k] =
            std::sqrt(bound(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
      }
    }
    if (const auto shape = by_paper(scene)) {
      paper.push_back(*shape);
    }
    const Recognition answer = test::recognise(scene, part.sigma_m);
    experiment.recognised += answer.status == RecognitionStatus::Recognized &&
                                     answer.shape.curve_class == part.curve_class
                                 ? 1
                                 : 0;
    const Hypothesis* hypothesis = test::hypothesis_of(answer, part.curve_class);
    if (hypothesis != nullptr && hypothesis->covariance.size() > 0) {
      defaults.push_back(hypothesis->shape.values);
    }
  }
  experiment.by_paper = statistics(paper);
  experiment.by_defaults = statistics(defaults);
  return experiment;
}

}  // namespace

SensorPart table4_part() {
  return {CurveClass::Ellipse, {0.025, 0.0175, 0.0}, {0.8, 2.8, 4.6}, kStroke_m, kSigma_m};
}

SensorPart table5_part() {
  // Printed in cm.
  const double root = std::sqrt(0.01);
  return {CurveClass::CubicSpline,
          {1.10734 / root, 1.67996, -0.401898 * root},
          {-1.4 * root, 0.75 * root, 1.1 * root, 1.45 * root},
          kStroke_m,
          kSigma_m};
}

SensorExperiment table4() { return run(in_unit(table4_part(), 1e-3), 4); }

SensorExperiment table5() { return run(in_unit(table5_part(), 1e-2), 5); }

}  // namespace palpate::paper

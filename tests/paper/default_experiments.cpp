#include "tests/paper/default_experiments.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/curves/curve.h"
#include "tests/support/scene_data.h"

namespace palpate::paper {

std::vector<DefaultRecovery> default_table3() {
  struct Class {
    CurveClass curve_class;
    int curves;  // as many as the paper's
  };
  constexpr Class kClasses[] = {
      {CurveClass::Ellipse, 100},         {CurveClass::Hyperbola, 100},
      {CurveClass::Parabola, 100},        {CurveClass::CubicalParabola, 100},
      {CurveClass::SemiCubicalParabola, 100}, {CurveClass::CubicSpline, 25}};
  std::mt19937_64 rng(3);
  std::vector<DefaultRecovery> table;
  for (const Class& row : kClasses) {
    DefaultRecovery recovery{name_of(row.curve_class), row.curves};
    int values = 0;
    for (int i = 0; i < row.curves; ++i) {
      test::SceneOptions options;
      options.sigma_over_size = 0.0;
      const test::Scene scene = test::random_scene(row.curve_class, options, rng);
      const Recognition answer = test::recognise(scene, 0.0);
      const Hypothesis* hypothesis = test::hypothesis_of(answer, row.curve_class);
      recovery.recognised += answer.status == RecognitionStatus::Recognized &&
                             answer.shape.curve_class == row.curve_class;
      const std::string_view letters = parameter_letters(row.curve_class);
      for (std::size_t k = 0; k < letters.size(); ++k) {
        const auto index = static_cast<Eigen::Index>(k);
        const double error =
            100.0 * std::abs(hypothesis->shape.values[index] / scene.values[index] - 1.0);
        recovery.mean_percent += error;
        recovery.worst_percent = std::max(recovery.worst_percent, error);
        ++values;
      }
    }
    recovery.mean_percent /= values;
    table.push_back(recovery);
  }
  return table;
}

DefaultEllipse default_table4() {
  constexpr int kTrials = 200;
  constexpr double kSigma = 5e-5;
  const Curve curve = *make_curve(CurveClass::Ellipse, {0.025, 0.0175, 0.0});
  std::mt19937_64 rng(4);
  std::normal_distribution<double> noise(0.0, kSigma);
  DefaultEllipse result;
  result.trials = kTrials;
  double squares[2] = {};
  std::fill(result.min_mm, result.min_mm + 2, 1e9);
  for (int trial = 0; trial < kTrials; ++trial) {
    test::Scene scene;
    for (const double start : {0.3, 2.3}) {
      auto& patch = scene.patches.emplace_back();
      for (int i = 0; i < 111; ++i) {
        const double t = parameter_at_arc_length(curve, start, 2e-4 * i);
        patch.push_back(position(curve, t) + Vec2(noise(rng), noise(rng)));
      }
    }
    const Recognition answer = test::recognise(scene, kSigma);
    result.recognised += answer.status == RecognitionStatus::Recognized &&
                         answer.shape.curve_class == CurveClass::Ellipse;
    const Hypothesis& ellipse = *test::hypothesis_of(answer, CurveClass::Ellipse);
    for (int k = 0; k < 2; ++k) {
      const double value = 1e3 * ellipse.shape.values[k];
      result.mean_mm[k] += value / kTrials;
      squares[k] += value * value / kTrials;
      result.min_mm[k] = std::min(result.min_mm[k], value);
      result.max_mm[k] = std::max(result.max_mm[k], value);
      result.bound_mm[k] += 1e3 * std::sqrt(ellipse.covariance(k, k)) / kTrials;
    }
  }
  for (int k = 0; k < 2; ++k) {
    result.sd_mm[k] = std::sqrt(std::max(0.0, squares[k] - result.mean_mm[k] * result.mean_mm[k]));
  }
  return result;
}

}  // namespace palpate::paper

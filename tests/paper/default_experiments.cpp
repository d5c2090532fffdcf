#include "tests/paper/default_experiments.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/scene_data.h"

namespace palpate::paper {

std::vector<DefaultRecovery> default_table3(double share) {
  struct Class {
    CurveClass curve_class;
    int curves;  // as many as the paper's
  };
  constexpr Class kClasses[] = {{CurveClass::Ellipse, 100},
                                {CurveClass::Hyperbola, 100},
                                {CurveClass::Parabola, 100},
                                {CurveClass::CubicalParabola, 100},
                                {CurveClass::SemiCubicalParabola, 100},
                                {CurveClass::CubicSpline, 25}};
  std::mt19937_64 rng(3);
  std::vector<DefaultRecovery> table;
  for (const Class& row : kClasses) {
    const int curves = static_cast<int>(std::ceil(share * row.curves));
    DefaultRecovery recovery{name_of(row.curve_class), curves};
    int values = 0;
    for (int i = 0; i < curves; ++i) {
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

}  // namespace palpate::paper

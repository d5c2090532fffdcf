// Speed against error of three pipelines: the recognition tree on every local estimator, window and
// shift (as in the paper), the tree on the default contacts (palpate fit --method tree), and the
// refinement on all points. Prints CSV, one row per class, noise and pipeline. Errors are medians
// over all scenes.
//   bench_pareto [--scenes N]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/local/estimator.h"
#include "core/recognition/tree/recognition_tree.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/scene_data.h"
#include "tests/support/touched_curve.h"

namespace {

using namespace palpate;
using Clock = std::chrono::steady_clock;

constexpr CurveClass kClasses[] = {CurveClass::Ellipse,
                                   CurveClass::Parabola,
                                   CurveClass::Hyperbola,
                                   CurveClass::CubicalParabola,
                                   CurveClass::SemiCubicalParabola,
                                   CurveClass::CubicSpline};
constexpr double kNoise[] = {0.0, 1e-5, 1e-4, 5e-4, 1e-3, 2e-3};
constexpr int kWindows[] = {15, 31, 51, 75, 111, 151};
constexpr int kShifts[] = {4, 16};
constexpr int kRepetitions = 3;  // of each timing; the median counts
constexpr std::uint64_t kSeed = 2026;

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <typename Work>
double median_us(const Work& work) {
  std::vector<double> times;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto start = Clock::now();
    work();
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  return median(times);
}

/// Results of one pipeline on the scenes of a cell.
struct Cell {
  std::vector<double> update_us, recognition_us, kappa, kappa_s, shape, pose;
  int scenes = 0;
  int right = 0;
  int recognized = 0;
  int wrong = 0;  ///< recognised as another class
};

/// Largest relative error of the shape, and the error of the pose relative to the touched half
/// extent.
void add_errors(const Hypothesis& found, const test::Scene& scene, Cell* cell) {
  const Eigen::VectorXd error =
      (test::error_of(found, scene).array() / test::natural_sizes(scene).array()).abs();
  const auto letters = static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size());
  cell->shape.push_back(error.head(letters).maxCoeff());
  cell->pose.push_back(std::hypot(error[letters], error[letters + 1]));
}

/// A scene without a shape of its own class counts as an infinite error: errors of only those named
/// right would be errors of the easier scenes, and lie below a bound over all.
void add_miss(Cell* cell) {
  cell->shape.push_back(std::numeric_limits<double>::infinity());
  cell->pose.push_back(std::numeric_limits<double>::infinity());
}

/// Errors of curvature and its derivative against the truth in the middle of the window, relative
/// to kappa and to kappa^2 + |kappa_s|.
void add_local_errors(const test::Scene& scene, std::size_t patch, std::size_t middle,
                      const LocalEstimate& found, Cell* cell) {
  const std::vector<double>& t = scene.t[patch];
  const LocalGeometry truth = geometry(*make_curve(scene.curve_class, scene.values), t[middle]);
  const double direction = t.back() > t.front() ? 1.0 : -1.0;
  cell->kappa.push_back(std::abs(found.kappa - direction * truth.kappa) / std::abs(truth.kappa));
  cell->kappa_s.push_back(std::abs(found.kappa_s - truth.kappa_s) /
                          (truth.kappa * truth.kappa + std::abs(truth.kappa_s)));
}

void tree_on(const test::Scene& scene, const EstimatorOptions& estimator, Cell* cell) {
  ++cell->scenes;
  // Chained finite differences and circles have no covariance that a test could use, so the tree
  // uses the paper's tolerance.
  RecognitionTreeOptions options;
  constexpr double kPaperTolerance = 0.05;
  if (estimator.kind == EstimatorKind::FiniteDifference ||
      estimator.kind == EstimatorKind::Circle) {
    options.relative_tolerance = kPaperTolerance;
  }
  std::vector<std::vector<WindowResult>> windows;
  double samples = 0.0;
  const double local_us = median_us([&] {
    windows.clear();
    for (const auto& patch : scene.patches) windows.push_back(estimate_all(patch, estimator));
  });
  std::vector<TreePoint> points;
  for (std::size_t p = 0; p < windows.size(); ++p) {
    samples += static_cast<double>(scene.patches[p].size());
    // The tree assumes independent points: take both ends and the middle of the windows.
    const std::size_t n = windows[p].size();
    for (const std::size_t i : {std::size_t{0}, n / 2, n - 1}) {
      if (n == 0 || !windows[p][i].result) continue;
      if (n > 1 || i == 0) points.push_back({windows[p][i].result.estimate, static_cast<int>(p)});
    }
    if (n > 0 && windows[p][n / 2].result) {
      add_local_errors(scene, p,
                       windows[p][n / 2].first_sample + samples_per_estimate(estimator) / 2,
                       windows[p][n / 2].result.estimate, cell);
    }
  }
  TreeResult tree;
  const double tree_us = median_us([&] { tree = recognise_by_tree(points, options); });
  cell->update_us.push_back(local_us / samples);
  cell->recognition_us.push_back(local_us + tree_us);
  const bool named =
      tree.status == InvariantStatus::Ok && tree.shape.curve_class != CurveClass::Unclassified;
  cell->recognized += named ? 1 : 0;
  if (tree.shape.curve_class != scene.curve_class) {
    cell->wrong += named ? 1 : 0;
    return add_miss(cell);
  }
  ++cell->right;
  if (!tree.world_T_curve) {
    return add_miss(cell);
  }
  Hypothesis found;
  found.shape = tree.shape;
  found.world_T_curve = *tree.world_T_curve;
  add_errors(found, scene, cell);
}

void recognizer_on(const test::Scene& scene, const RecognizerOptions& options, Cell* cell) {
  ++cell->scenes;
  const double sigma = scene.sigma_m;
  Recognition answer;
  const double us = median_us([&] { answer = test::recognise(scene, sigma, options); });
  cell->recognition_us.push_back(us);
  cell->recognized += answer.status == RecognitionStatus::Recognized ? 1 : 0;
  if (answer.shape.curve_class != scene.curve_class) {
    cell->wrong += answer.status == RecognitionStatus::Recognized ? 1 : 0;
    return add_miss(cell);
  }
  ++cell->right;
  add_errors(answer.hypotheses.front(), scene, cell);
}

void print(CurveClass curve_class, double noise, const std::string& pipeline, int window, int shift,
           const Cell& cell, double shape_bound, double pose_bound) {
  const double n = cell.scenes;
  std::printf("%s,%g,%s,%d,%d,%d,%.4f,%.3f,%.4g,%.4g,%.4g,%.4g,%.4f,%.4f,%.4f,%.4g,%.4g\n",
              std::string(name_of(curve_class)).c_str(), noise, pipeline.c_str(), window, shift,
              cell.scenes, median(cell.update_us), median(cell.recognition_us), median(cell.kappa),
              median(cell.kappa_s), median(cell.shape), median(cell.pose), cell.right / n,
              cell.recognized / n, cell.wrong / n, shape_bound, pose_bound);
}

}  // namespace

int main(int argc, char** argv) {
  int count = 30;
  if (const auto end =
          bench::BenchOptions(
              "Speed against error of every local estimator, without and with refinement")
              .number("--scenes", count, "Scenes a class and noise")
              .parse(argc, argv)) {
    return *end;
  }
  std::printf(
      "class,noise_over_size,pipeline,window,shift,scenes,us_per_sample,us_per_recognition,kappa_"
      "error,"
      "kappa_s_error,shape_error,pose_error,right_class,recognized,wrong,shape_bound,pose_bound\n");
  for (const CurveClass curve_class : kClasses) {
    for (const double noise : kNoise) {
      std::mt19937_64 rng(kSeed);
      test::SceneOptions options;
      options.sigma_over_size = noise;
      options.points_per_patch = 200;
      std::vector<test::Scene> scenes;
      std::vector<double> shape_bounds;
      std::vector<double> pose_bounds;
      for (int i = 0; i < count; ++i) {
        scenes.push_back(test::random_scene(curve_class, options, rng));
        const Eigen::VectorXd bound = test::bound_of(scenes.back()).diagonal().cwiseSqrt().array() /
                                      test::natural_sizes(scenes.back()).array();
        const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
        // The median of |error| of a normal distribution is 0.6745 standard deviations.
        constexpr double kMedian = 0.6745;
        shape_bounds.push_back(kMedian * bound.head(letters).maxCoeff());
        pose_bounds.push_back(kMedian * std::hypot(bound[letters], bound[letters + 1]));
      }
      const double shape_bound = median(shape_bounds);
      const double pose_bound = median(pose_bounds);
      for (const EstimatorKind kind : {EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                                       EstimatorKind::TwoRound, EstimatorKind::Jet}) {
        for (const int window : kWindows) {
          for (const int shift : kShifts) {
            EstimatorOptions estimator;
            estimator.kind = kind;
            estimator.window = window;
            estimator.shift = shift;
            estimator.sigma_m = options.sigma_over_size * options.size_m;
            if (samples_per_estimate(estimator) >
                static_cast<std::size_t>(options.points_per_patch))
              continue;
            Cell cell;
            for (const test::Scene& scene : scenes) tree_on(scene, estimator, &cell);
            print(curve_class, noise, std::string(name_of(kind)), window, shift, cell, shape_bound,
                  pose_bound);
          }
        }
      }
      const auto recognizer = [&](const char* pipeline,
                                  const RecognizerOptions& recognizer_options) {
        Cell cell;
        for (const test::Scene& scene : scenes) recognizer_on(scene, recognizer_options, &cell);
        print(curve_class, noise, pipeline, 0, 0, cell, shape_bound, pose_bound);
      };
      RecognizerOptions tree;
      tree.method = RecognitionMethod::Tree;
      recognizer("tree on default contacts", tree);
      recognizer("refined", {});
      RecognizerOptions class_known;
      class_known.classes = 1U << static_cast<unsigned>(curve_class);
      recognizer("refined (class known)", class_known);
      std::fflush(stdout);
    }
  }
  return 0;
}

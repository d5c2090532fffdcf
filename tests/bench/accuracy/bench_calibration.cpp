// Checks the published uncertainties: the probability of the best class against how often it is
// right, and squared errors in units of the published covariance against their chi-square law.
// Prints CSV.
//   bench_calibration [--scenes N]
#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "tests/bench/options/bench_options.h"
#include "tests/support/scene_data.h"

namespace {

using namespace palpate;

constexpr std::uint64_t kSeed = 2026;
constexpr double kNoise[] = {1e-5, 1e-4, 5e-4, 1e-3, 2e-3};
// Upper ends of the bins of published probability.
constexpr std::array kBins = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0};
constexpr int kDeciles = 10;

/// Distribution function of chi-square with n degrees of freedom, by the series of the regularised
/// incomplete gamma function.
double chi2_cdf(double x, double n) {
  if (x <= 0.0) return 0.0;
  const double a = 0.5 * n;
  const double half = 0.5 * x;
  double term = 1.0 / a;
  double sum = term;
  constexpr int kMostTerms = 10000;
  for (int k = 1; k < kMostTerms && term > 1e-16 * sum; ++k) {
    term *= half / (a + k);
    sum += term;
  }
  return std::min(1.0, sum * std::exp(-half + a * std::log(half) - std::lgamma(a)));
}

struct Bin {
  int count = 0;
  int right = 0;
  double probability = 0.0;
};

struct Calibration {
  std::array<Bin, kBins.size()> bins;
  std::array<int, kDeciles> deciles{};
  int compared = 0;
};

void add(const test::Scene& scene, const Recognition& answer, Calibration* calibration) {
  if (answer.hypotheses.empty()) return;
  const Hypothesis& best = answer.hypotheses.front();
  std::size_t b = 0;
  while (b + 1 < kBins.size() && best.probability > kBins[b]) ++b;
  Bin& bin = calibration->bins[b];
  const bool right = best.shape.curve_class == scene.curve_class;
  ++bin.count;
  bin.right += right ? 1 : 0;
  bin.probability += best.probability;
  if (!right || answer.status != RecognitionStatus::Recognized) return;
  // Only if the problem is linear enough for a chi-square law: every shape parameter known to 3 %.
  constexpr double kDetermined = 0.03;
  const auto letters = static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size());
  for (Eigen::Index k = 0; k < letters; ++k) {
    if (std::sqrt(best.covariance(k, k)) > kDetermined * std::abs(scene.values[k])) return;
  }
  // Without the free parameters: a circle's theta; of a line all but its offset, so lines are left
  // out.
  if (scene.curve_class == CurveClass::Line) return;
  const Eigen::Index n = pose_symmetry(scene.curve_class) == 0 ? letters + 2 : letters + 3;
  const Eigen::VectorXd error = test::error_of(best, scene).head(n);
  const Eigen::MatrixXd covariance = best.covariance.topLeftCorner(n, n);
  const Eigen::ArrayXd sizes = covariance.diagonal().cwiseSqrt().array();
  const Eigen::MatrixXd correlation =
      sizes.inverse().matrix().asDiagonal() * covariance * sizes.inverse().matrix().asDiagonal();
  const Eigen::VectorXd normalised = (error.array() / sizes).matrix();
  const double squared = normalised.dot(correlation.ldlt().solve(normalised));
  const int decile = std::min(
      kDeciles - 1, static_cast<int>(kDeciles * chi2_cdf(squared, static_cast<double>(n))));
  ++calibration->deciles[static_cast<std::size_t>(decile)];
  ++calibration->compared;
}

}  // namespace

int main(int argc, char** argv) {
  int count = 20;
  if (const auto end = bench::BenchOptions("Published uncertainties against observed errors")
                           .number("--scenes", count, "Scenes a class, noise and number of patches")
                           .parse(argc, argv)) {
    return *end;
  }
  std::printf("kind,noise_stated,upper,expected,observed,count\n");
  for (const bool stated : {true, false}) {
    std::mt19937_64 rng(kSeed);
    Calibration calibration;
    for (const CurveClass curve_class : kCurveClasses) {
      for (const double noise : kNoise) {
        for (int patches = 1; patches <= 4; ++patches) {
          for (int i = 0; i < count; ++i) {
            test::SceneOptions options;
            options.patches = patches;
            options.sigma_over_size = noise;
            const test::Scene scene = test::random_scene(curve_class, options, rng);
            add(scene, test::recognise(scene, stated ? scene.sigma_m : 0.0), &calibration);
          }
        }
      }
    }
    for (std::size_t b = 0; b < kBins.size(); ++b) {
      const Bin& bin = calibration.bins[b];
      if (bin.count == 0) continue;
      std::printf("probability,%d,%g,%.4f,%.4f,%d\n", stated ? 1 : 0, kBins[b],
                  bin.probability / bin.count, static_cast<double>(bin.right) / bin.count,
                  bin.count);
    }
    for (int d = 0; d < kDeciles; ++d) {
      std::printf("squared_error,%d,%.1f,%.4f,%.4f,%d\n", stated ? 1 : 0, (d + 1.0) / kDeciles,
                  1.0 / kDeciles,
                  static_cast<double>(calibration.deciles[static_cast<std::size_t>(d)]) /
                      calibration.compared,
                  calibration.compared);
    }
    std::fflush(stdout);
  }
  return 0;
}

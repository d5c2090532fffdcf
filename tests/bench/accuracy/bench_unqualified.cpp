// Whether the covariance of an answer is true if nobody has measured the probe: parts of a given
// class, touched by probes that err by noise alone, by a drift along each stroke as well, and by an
// offset of the normal's direction as well, of sizes drawn as core/README.md, "Deviations that
// neighbours share", expects them. Prints, by class, how often the truth lies within the stated 50,
// 95 and 99 % of each parameter and within the 95 % region of all, by what factor deviations are
// wider than noise alone would leave them, and by what factor they change if the strokes are
// travelled the other way.
//   bench_unqualified [--scenes N] [--seed S] [--strokes N]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/curves/curve.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/joint_error.h"
#include "tests/support/test_rng.h"

namespace {

using namespace palpate;

enum class Errs { NoiseAlone, Drift, DriftAndOffset };

/// The two-sided quantiles of a normal law that contain 50, 95 and 99 %.
constexpr std::array kQuantiles = {0.674490, 1.959964, 2.575829};

/// A probe's deviations by the law that the answers assume.
class Deviations {
 public:
  Deviations(Errs errs, double sigma_m, int samples, double longest_m, double half_extent_m,
             std::mt19937_64& rng) {
    std::normal_distribution<double> normal;
    const double most = std::sqrt(static_cast<double>(samples));
    drift_m_ = sigma_m * test::log_uniform(rng, 1.0 / most, most);
    length_m_ = std::ldexp(longest_m, -1 - 2 * std::uniform_int_distribution<int>(0, 2)(rng));
    const double order = std::round(std::clamp(half_extent_m / length_m_, 2.0, kHighest));
    const double size = errs == Errs::DriftAndOffset
                            ? drift_m_ * order * order / 4.0 *
                                  std::abs(std::student_t_distribution<double>(3.0)(rng))
                            : 0.0;
    constant_m_ = size * normal(rng);
    const int highest = std::uniform_int_distribution<int>(1, 8)(rng);  // 1: the constant alone
    for (int k = 2; k <= highest; ++k) {
      const double cosine = size * 4.0 / (k * k) * normal(rng);
      lobes_m_.emplace_back(cosine, size * 4.0 / (k * k) * normal(rng));
    }
  }

  /// Of the next touch of a stroke; `step_m`: infinite at its beginning.
  double next(double step_m, const Vec2& unit_normal, std::mt19937_64& rng) {
    const double kept = std::exp(-step_m / length_m_);
    last_m_ = kept * last_m_ +
              std::sqrt(1.0 - kept * kept) * drift_m_ * std::normal_distribution<double>()(rng);
    const double phi = std::atan2(unit_normal.y(), unit_normal.x());
    double sum = last_m_ + constant_m_;
    for (std::size_t i = 0; i < lobes_m_.size(); ++i) {
      const double angle = static_cast<double>(i + 2) * phi;
      sum += lobes_m_[i].dot(Vec2(std::cos(angle), std::sin(angle)));
    }
    return sum;
  }

 private:
  static constexpr double kHighest = 8.0;  // order
  double drift_m_ = 0.0;
  double length_m_ = 0.0;
  double constant_m_ = 0.0;
  double last_m_ = 0.0;
  std::vector<Vec2> lobes_m_;  ///< from order 2 on: of cosine and sine
};

/// The touches displaced along the normals; nullopt if by more than a hundredth of the part: such a
/// probe is not suitable for it.
std::optional<test::Scene> displaced(test::Scene scene, Errs errs, double size_m,
                                     std::mt19937_64& rng) {
  constexpr double kMostOff = 0.01;
  const Curve curve = *make_curve(scene.curve_class, scene.values);
  const auto place = [&](double t) { return scene.world_T_curve * position(curve, t); };
  Eigen::AlignedBox2d box;
  double longest_m = 0.0;
  int samples = 0;
  for (const auto& stroke : scene.t) {
    double length_m = 0.0;
    for (std::size_t i = 0; i < stroke.size(); ++i) {
      box.extend(place(stroke[i]));
      length_m += i > 0 ? (place(stroke[i]) - place(stroke[i - 1])).norm() : 0.0;
    }
    longest_m = std::max(longest_m, length_m);
    samples += static_cast<int>(stroke.size());
  }
  Deviations deviations(errs, scene.sigma_m, samples, longest_m, 0.5 * box.sizes().maxCoeff(), rng);
  for (std::size_t p = 0; p < scene.t.size(); ++p) {
    const auto& t = scene.t[p];
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double step_m =
          i > 0 ? (place(t[i]) - place(t[i - 1])).norm() : std::numeric_limits<double>::infinity();
      const Vec2 normal =
          scene.world_T_curve.rotate(Vec2(left_of(derivatives(curve, t[i]).first.normalized())));
      const double off_m = deviations.next(step_m, normal, rng);
      if (std::abs(off_m) > kMostOff * size_m) {
        return std::nullopt;
      }
      scene.patches[p][i] += off_m * normal;
    }
  }
  return scene;
}

struct Row {
  int answers = 0;
  int parameters = 0;
  std::array<int, kQuantiles.size()> within{};
  int within_joint = 0;
  std::vector<double> widths;
  std::vector<double> reversed;

  void add(const Row& other) {
    answers += other.answers;
    parameters += other.parameters;
    for (std::size_t q = 0; q < within.size(); ++q) within[q] += other.within[q];
    within_joint += other.within_joint;
    widths.insert(widths.end(), other.widths.begin(), other.widths.end());
    reversed.insert(reversed.end(), other.reversed.begin(), other.reversed.end());
  }
};

/// The answer if no other class is asked for; nullopt if it is none of the class.
std::optional<Recognition> answer_to(const test::Scene& scene) {
  RecognizerOptions options;
  options.classes = 1U << static_cast<unsigned>(scene.curve_class);
  const Recognition answer = test::recognise(scene, 0.0, options);
  const bool has_covariance = answer.covariance.size() > 0 && answer.covariance.allFinite();
  return answer.shape.curve_class == scene.curve_class && has_covariance ? std::optional(answer)
                                                                         : std::nullopt;
}

void add(test::Scene scene, Row* row) {
  const auto answer = answer_to(scene);
  if (!answer) {
    return;
  }
  Hypothesis found = answer->hypotheses.front();
  const test::JointError joint = test::joint_error(found, scene);
  found.covariance = noise_covariance(*answer);
  const test::JointError by_noise = test::joint_error(found, scene);
  ++row->answers;
  row->within_joint +=
      test::squared_distance(joint) <= test::chi_square_95(joint.error.size()) ? 1 : 0;
  for (Eigen::Index k = 0; k < joint.error.size(); ++k) {
    const double deviation = std::sqrt(joint.covariance(k, k));
    ++row->parameters;
    for (std::size_t q = 0; q < kQuantiles.size(); ++q) {
      row->within[q] += std::abs(joint.error[k]) <= kQuantiles[q] * deviation ? 1 : 0;
    }
    row->widths.push_back(deviation / std::sqrt(by_noise.covariance(k, k)));
  }
  for (auto& patch : scene.patches) std::reverse(patch.begin(), patch.end());
  if (const auto back = answer_to(scene)) {
    const test::JointError other = test::joint_error(back->hypotheses.front(), scene);
    for (Eigen::Index k = 0; k < joint.error.size(); ++k) {
      row->reversed.push_back(
          std::exp(0.5 * std::abs(std::log(other.covariance(k, k) / joint.covariance(k, k)))));
    }
  }
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty()
             ? 0.0
             : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const std::string& title, const Row& row) {
  const auto percent = [](int count, int of) { return 100.0 * count / std::max(of, 1); };
  std::printf("%-22s %7d | %5.1f %5.1f %5.1f | %6.1f | %6.2f %6.2f | %5.2f %5.2f\n", title.c_str(),
              row.answers, percent(row.within[0], row.parameters),
              percent(row.within[1], row.parameters), percent(row.within[2], row.parameters),
              percent(row.within_joint, row.answers), quantile(row.widths, 0.5),
              quantile(row.widths, 0.9), quantile(row.reversed, 0.9), quantile(row.reversed, 0.99));
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 300;
  int strokes = 2;
  std::uint64_t seed = 2026;
  if (const auto end = bench::BenchOptions("Coverage for a probe that nobody has measured")
                           .number("--scenes", scenes, "Number of scenes of each class")
                           .number("--strokes", strokes, "Number of strokes")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  for (const auto& [errs, title] :
       {std::pair(Errs::NoiseAlone, "the probe errs by noise alone"),
        std::pair(Errs::Drift, "by drift as well"),
        std::pair(Errs::DriftAndOffset, "by drift and an offset of the normal's direction")}) {
    std::printf("%s\n%-22s %7s | within %% of each  | of all | wider by      | reversed by\n",
                title, "", "");
    std::printf("%-22s %7s | %5s %5s %5s | %6s | %6s %6s | %5s %5s\n", "class", "answers", "50",
                "95", "99", "95", "median", "90 %", "90 %", "99 %");
    Row all;
    for (const CurveClass curve_class : kCurveClasses) {
      std::mt19937_64 rng(seed + static_cast<std::uint64_t>(curve_class));
      Row row;
      for (int i = 0; i < scenes; ++i) {
        test::SceneOptions options;
        options.patches = strokes;
        options.least_fraction = 0.15;
        options.most_fraction = 0.5;
        options.sigma_over_size = test::log_uniform(rng, 1e-5, 1e-3);
        const test::Scene scene = test::random_scene(curve_class, options, rng);
        std::optional<test::Scene> touched;
        while (!touched) {
          touched = errs == Errs::NoiseAlone ? scene : displaced(scene, errs, options.size_m, rng);
        }
        add(*std::move(touched), &row);
      }
      print(std::string(name_of(curve_class)), row);
      all.add(row);
    }
    print("all", all);
  }
  return 0;
}

// Checks the stated probabilities on parts that are drawn from the very prior that the recognizer
// assumes (core/README.md, "The prior"); remaining errors are those of the integrals. Each scene
// has one stroke of 111 samples with stated noise, and shape and place from the prior; half of the
// stroke's extent is the prior's unit of length. A draw that cannot be touched that far (a circle
// that is too small, a cusp within the stroke) is left out together with its class's share, so that
// the odds of the others do not change. Prints, by bin of the stated probability, how often the
// answer is right, and for every class its stated mass and how often it is the truth.
//   bench_prior [--scenes N] [--seed S]
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
#include "core/recognition/posterior/touched_coordinates.h"
#include "core/recognition/recognizer.h"
#include "tests/bench/accuracy/calibration_table.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/calibration.h"
#include "tests/support/test_rng.h"

namespace {

using namespace palpate;
using test::log_uniform;
using test::uniform;

constexpr int kSamples = 111;

/// Draws one coordinate by the inverse of its distribution function, with the others at the centre.
/// The factors of the prior are independent, except for an ellipse's direction.
class CoordinateLaw {
 public:
  CoordinateLaw(CurveClass curve_class, int k) {
    constexpr int kSteps = 200000;
    // (At the centre, the parabola's limit, an ellipse's direction and shape have no effect.)
    const TouchedVector centre = curve_class == CurveClass::Ellipse
                                     ? expected_coordinates(curve_class, 1.0, 1.0)
                                     : prior_centre(curve_class);
    double sum = 0.0;
    double last = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      // The tails of the size are exponential, those of the others are powers.
      const double part = (i + 0.5) / kSteps;
      TouchedVector z = centre;
      z[k] += k == 0 ? 40.0 * (part - 0.5) : 2.0 * std::tan(kPi * (part - 0.5));
      if (curve_class == CurveClass::Hyperbola && k == 1 && z[k] <= 0.0) {
        continue;
      }
      const double density = std::exp(log_prior(curve_class, z) - log_prior(curve_class, centre));
      if (!places_.empty()) {
        sum += 0.5 * (density + last) * (z[k] - places_.back());
      }
      places_.push_back(z[k]);
      sums_.push_back(sum);
      last = density;
    }
  }

  double operator()(std::mt19937_64& rng) const {
    const double target = uniform(rng, 0.0, sums_.back());
    const auto after = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, target);
    const auto i = static_cast<std::size_t>(after - sums_.begin());
    const double part = (target - sums_[i - 1]) / (sums_[i] - sums_[i - 1]);
    return places_[i - 1] + part * (places_[i] - places_[i - 1]);
  }

 private:
  std::vector<double> places_;
  std::vector<double> sums_;
};

/// The prior of a class; lengths are in half extents of what is touched.
class ClassLaw {
 public:
  explicit ClassLaw(CurveClass curve_class) : class_(curve_class) {
    for (int k = 0; k < shape_coordinates(curve_class); ++k) {
      if (curve_class != CurveClass::Ellipse || k == 0) {
        coordinates_.emplace_back(curve_class, k);
      }
    }
  }

  std::optional<TouchedShape> draw(std::mt19937_64& rng) const {
    TouchedVector z = prior_centre(class_);
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      z[static_cast<Eigen::Index>(k)] = coordinates_[k](rng);
    }
    if (class_ == CurveClass::Ellipse) {
      z[1] = uniform(rng, 0.0, 1.0);
      const auto density = [&] {
        return std::pow(std::sin(z[2]), 2) + z[1] * std::pow(std::cos(z[2]), 2);
      };
      do {
        z[2] = uniform(rng, 0.0, kPi);
      } while (uniform(rng, 0.0, 1.0) > density());
    }
    TouchedShape like;
    like.values[0] = uniform(rng, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    return shape_at(class_, z, like);
  }

 private:
  CurveClass class_;
  std::vector<CoordinateLaw> coordinates_;
};

/// Half of the longer side of the points' bounding box along their principal axes.
double half_extent(const std::vector<Vec2>& points) {
  Vec2 middle = Vec2::Zero();
  for (const Vec2& point : points) middle += point / static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Vec2& point : points) scatter += (point - middle) * (point - middle).transpose();
  const double angle = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const Vec2& point : points) {
    const Vec2 along = Pose2{0.0, 0.0, angle}.rotate_back(point);
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  return 0.5 * (high - low).maxCoeff();
}

/// Points evenly along an arc with its middle at t; nullopt if it goes all around or over a cusp.
std::optional<std::vector<Vec2>> places_on(const Curve& curve, double t, double length) {
  const double begin = parameter_at_arc_length(curve, t, -0.5 * length);
  const double end = parameter_at_arc_length(curve, t, 0.5 * length);
  const CurveClass curve_class = class_of(curve);
  const bool closed = curve_class == CurveClass::Circle || curve_class == CurveClass::Ellipse;
  if (!std::isfinite(begin) || !std::isfinite(end) || (closed && end - begin > 2.0 * kPi) ||
      (curve_class == CurveClass::SemiCubicalParabola && begin * end <= 0.0)) {
    return std::nullopt;
  }
  std::vector<Vec2> places;
  for (int i = 0; i < kSamples; ++i) {
    const double s = length * (static_cast<double>(i) / (kSamples - 1) - 0.5);
    places.push_back(position(curve, parameter_at_arc_length(curve, t, s)));
    if (!places.back().allFinite()) {
      return std::nullopt;
    }
  }
  return places;
}

/// The stroke around t with a half extent of 1.
std::optional<std::vector<Vec2>> stroke_on(const Curve& curve, double t) {
  constexpr double kExact = 1e-6;
  double low = 1.9;
  double high = 8.0;  // a circle's whole turn is 2 pi
  std::optional<std::vector<Vec2>> stroke;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    auto places = places_on(curve, t, middle);
    if (places && half_extent(*places) < 1.0) {
      low = middle;
      stroke = std::move(places);
    } else {
      high = middle;
    }
  }
  return stroke && std::abs(half_extent(*stroke) - 1.0) <= kExact ? stroke : std::nullopt;
}

std::optional<std::vector<Vec2>> draw_stroke(CurveClass curve_class, const ClassLaw& law,
                                             std::mt19937_64& rng) {
  const auto shape = law.draw(rng);
  const auto curve = shape ? make_curve(curve_class, shape->values) : std::nullopt;
  return curve ? stroke_on(*curve, shape->t) : std::nullopt;
}

Recognition touch(const std::vector<Vec2>& stroke, std::mt19937_64& rng) {
  const double sigma = log_uniform(rng, 1e-5, 2e-3);
  const double half_extent_m = log_uniform(rng, 5e-3, 0.5);
  const Pose2 pose{uniform(rng, -1.0, 1.0), uniform(rng, -1.0, 1.0), uniform(rng, -kPi, kPi)};
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<ContactSample> samples;
  for (const Vec2& place : stroke) {
    const Vec2 touched = half_extent_m * (place + Vec2(noise(rng), noise(rng)));
    samples.push_back({pose * touched, sigma * half_extent_m, 0});
  }
  Recognizer recognizer;
  recognizer.add({}, samples);
  return recognizer.recognize();
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 2000;
  std::uint64_t seed = 2026;
  if (const auto end =
          bench::BenchOptions("Probabilities beside the truth, of parts from the assumed prior")
              .number("--scenes", scenes, "Number of scenes")
              .seed(seed)
              .parse(argc, argv)) {
    return *end;
  }
  std::vector<ClassLaw> laws;
  for (const CurveClass curve_class : kCurveClasses) {
    laws.emplace_back(curve_class);
  }
  std::mt19937_64 rng(seed);
  test::Calibration pooled;
  std::array<test::Calibration, 9> by_class;
  std::array<double, 9> stated{};
  std::array<int, 9> true_count{};
  for (int touched = 0; touched < scenes;) {
    const auto i = std::uniform_int_distribution<std::size_t>(0, laws.size() - 1)(rng);
    const CurveClass truth = kCurveClasses[i];
    const auto stroke = draw_stroke(truth, laws[i], rng);
    if (!stroke) {
      continue;
    }
    const Recognition answer = touch(*stroke, rng);
    ++touched;
    ++true_count[static_cast<std::size_t>(truth)];
    for (const Hypothesis& hypothesis : answer.hypotheses) {
      stated[static_cast<std::size_t>(hypothesis.shape.curve_class)] += hypothesis.probability;
    }
    if (!answer.hypotheses.empty()) {
      const double probability = answer.hypotheses.front().probability;
      const CurveClass named = answer.shape.curve_class;
      pooled.add(probability, named == truth);
      by_class[static_cast<std::size_t>(named)].add(probability, named == truth);
    }
  }
  std::printf("%d scenes, seed %llu\n%-24s %-11s %7s %9s %9s   %s\n", scenes,
              static_cast<unsigned long long>(seed), "answer", "bin", "scenes", "stated",
              "observed", "99.9 % band");
  int beside = bench::print_calibration("all", pooled);
  for (std::size_t i = 0; i < by_class.size(); ++i) {
    beside +=
        bench::print_calibration(std::string(name_of(static_cast<CurveClass>(i))), by_class[i]);
  }
  std::printf("bins beside their band: %d\n\n%-24s %12s %6s\n", beside, "class", "stated mass",
              "truth");
  for (std::size_t i = 0; i < stated.size(); ++i) {
    std::printf("%-24s %12.1f %6d\n", std::string(name_of(static_cast<CurveClass>(i))).c_str(),
                stated[i], true_count[i]);
  }
  return 0;
}

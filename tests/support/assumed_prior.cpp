#include "tests/support/assumed_prior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/curves/pose2.h"
#include "core/recognition/prior/arms.h"
#include "core/recognition/prior/touched_prior.h"
#include "tests/support/test_rng.h"

namespace palpate::test {
namespace {

constexpr int kSamples = 111;

/// Draws one coordinate by the inverse of its distribution function, the others at the centre: the
/// prior's factors are independent where there are no arms.
class CoordinateLaw {
 public:
  CoordinateLaw(Chart chart, int k) {
    constexpr int kSteps = 200000;
    const TouchedVector centre = prior_centre(chart);
    double sum = 0.0;
    double last = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      // The size's tails are exponential, the others' are powers.
      const double part = (i + 0.5) / kSteps;
      TouchedVector z = centre;
      z[k] += k == 0 && !chart.as_arc ? 40.0 * (part - 0.5) : 2.0 * std::tan(kPi * (part - 0.5));
      const double density = std::exp(log_prior(chart, z) - log_prior(chart, centre));
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

/// The coordinates of a class with arms, touched about its bend or on them.
TouchedVector drawn_touched_at(CurveClass curve_class, TouchedAt at, std::mt19937_64& rng) {
  // By the inverses of their distribution functions: angles, and the squared hyperbolic secant.
  const double log_of_size = std::atanh(uniform(rng, -1.0, 1.0));
  const auto student = [&](int freedom, double scale) {
    return scale / std::sqrt(freedom) * std::student_t_distribution<double>(freedom)(rng);
  };
  const bool bend = at == TouchedAt::Bend;
  constexpr double kHalfOfFour = 2.7001;  // scale by which half lies beyond 1, of 4 degrees
  TouchedVector z = TouchedVector::Zero();
  switch (curve_class) {
    case CurveClass::Hyperbola:
      if (bend) {
        z[1] = 1.0 + std::tan(uniform(rng, -0.25 * kPi, 0.5 * kPi));  // Cauchy's above 0
        z[2] = student(6, 2.0);
      } else {
        const double square = uniform(rng, 0.0, 1.0);  // of b / c
        z[1] = square / (1.0 - square);
        z[2] = student(6, 2.0) / std::sqrt(square);  // w = e y / p = c / b y / b
      }
      break;
    case CurveClass::Ellipse: {
      z[1] = uniform(rng, 0.0, 1.0);
      const double ratio2 = z[1];
      if (bend) {  // evenly by arc length
        double angle = 0.0;
        do {
          angle = uniform(rng, 0.0, kPi);
        } while (uniform(rng, 0.0, 1.0) >
                 std::sqrt(1.0 - (1.0 - ratio2) * std::pow(std::cos(angle), 2)));
        z[2] = std::atan2(std::sqrt(ratio2) * std::cos(angle), -std::sin(angle));
      } else {
        z[1] = 1.0 - std::sqrt(1.0 - ratio2);  // the density 2 (1 - m)
        z[2] = std::atan2(1.0, student(2, 3.0 * std::numbers::sqrt3));
      }
      break;
    }
    case CurveClass::Parabola:
      z[1] = bend ? student(6, 2.0) : student(2, 3.0 * std::numbers::sqrt3);
      break;
    default:  // cubical parabola
      z[1] = bend ? student(6, 2.0) : student(4, kHalfOfFour);
      z[2] = bend ? student(10, 1.4) : student(4, kHalfOfFour);
      break;
  }
  z[0] = expected_log_length(curve_class, at, z) + log_of_size;
  return z;
}

/// The prior in one set of coordinates, whose lengths are in half extents of what is touched.
class ChartLaw {
 public:
  explicit ChartLaw(Chart chart) : chart_(chart) {
    for (int k = 0; k < shape_coordinates(chart.curve_class); ++k) {
      if (has_arms(chart.curve_class)) {
        break;  // drawn below
      }
      coordinates_.emplace_back(chart, k);
    }
  }

  std::optional<TouchedShape> draw(std::mt19937_64& rng) const {
    TouchedVector z = prior_centre(chart_);
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      z[static_cast<Eigen::Index>(k)] = coordinates_[k](rng);
    }
    if (has_arms(chart_.curve_class)) {
      const bool on_arms = uniform(rng, 0.0, 1.0) < kShareOfArms;
      z = drawn_touched_at(chart_.curve_class, on_arms ? TouchedAt::Arms : TouchedAt::Bend, rng);
    }
    TouchedShape like;
    like.values[0] = random_sign(rng);
    return shape_at(chart_, z, like);
  }

 private:
  Chart chart_;
  std::vector<CoordinateLaw> coordinates_;
};

/// The prior of a class. Half of the spline's is one of arcs.
class ClassLaw {
 public:
  explicit ClassLaw(CurveClass curve_class) {
    charts_.emplace_back(Chart{curve_class});
    if (curve_class == CurveClass::CubicSpline) charts_.emplace_back(Chart{curve_class, true});
  }

  std::optional<TouchedShape> draw(std::mt19937_64& rng) const {
    return charts_[std::uniform_int_distribution<std::size_t>(0, charts_.size() - 1)(rng)].draw(
        rng);
  }

 private:
  std::vector<ChartLaw> charts_;
};

/// Half of the longer side of the points' box along their principal axes.
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

/// Places evenly along an arc whose middle is at t; nullopt where it goes all around, or over a
/// cusp.
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

/// The stroke about t whose half extent is 1.
std::optional<std::vector<Vec2>> stroke_on(const Curve& curve, double t) {
  constexpr double kExact = 1e-6;
  constexpr int kBisections = 24;  // of the lengths between, to kExact
  double low = 1.9;
  double high = 8.0;  // a circle's whole turn is 2 pi
  std::optional<std::vector<Vec2>> stroke;
  for (int i = 0; i < kBisections; ++i) {
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

/// The path of no class (posterior/free_form.h) in the frame of a tangent: y = sum c_k x^k, as many
/// terms as the recogniser has, those from the third on drawn for features of a size.
class FreePath {
 public:
  FreePath(double curvature, double size, std::mt19937_64& rng) {
    c_[2] = 0.5 * curvature;
    double power = 1.0 / (size * size);
    for (std::size_t k = 3; k < c_.size(); ++k) {
      c_[k] = std::normal_distribution<double>(0.0, power / static_cast<double>(k * (k - 1)))(rng);
      power /= size;
    }
  }
  /// The same path seen the other way.
  FreePath reversed() const {
    FreePath path = *this;
    for (std::size_t k = 0; k < c_.size(); k += 2) path.c_[k] = -c_[k];
    return path;
  }
  /// y and its first two derivatives.
  std::array<double, 3> at(double x) const {
    std::array<double, 3> y{};
    for (std::size_t k = c_.size(); k-- > 0;) {
      y[2] = y[2] * x + 2.0 * y[1];
      y[1] = y[1] * x + y[0];
      y[0] = y[0] * x + c_[k];
    }
    return y;
  }

 private:
  std::array<double, 12> c_{};
};

/// A path of no class as it goes on from a place, by steps along its arc. A section ends where it
/// has turned by a radian, the first one by half: it has another half behind. The next continues
/// place, tangent and curvature.
std::vector<Vec2> free_way(FreePath path, double size, double step, int steps,
                           std::mt19937_64& rng) {
  double most_turn = 0.5;
  std::vector<Vec2> way;
  Pose2 frame;
  double x = 0.0;
  for (int i = 0; i < steps; ++i) {
    const auto here = path.at(x);
    x += step / std::hypot(1.0, here[1] + 0.5 * here[2] * step);
    const auto there = path.at(x);
    way.push_back(frame * Vec2(x, there[0]));
    if (std::abs(std::atan(there[1])) > most_turn) {
      frame = {way.back().x(), way.back().y(), frame.theta + std::atan(there[1])};
      path = FreePath(there[2] / std::pow(std::hypot(1.0, there[1]), 3), size, rng);
      x = 0.0;
      most_turn = 1.0;
    }
  }
  return way;
}

/// A stroke on a path of no class, half of whose extent is 1.
std::optional<std::vector<Vec2>> draw_free_stroke(std::mt19937_64& rng) {
  constexpr std::array kSizes = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
  constexpr double kLongest = 4.0;  // half of a stroke: what turns so much is left out
  constexpr int kSteps = 2000;
  const double size = kSizes[std::uniform_int_distribution<std::size_t>(0, kSizes.size() - 1)(rng)];
  const FreePath path(std::normal_distribution<double>(0.0, 1.0 / size)(rng), size, rng);
  const auto ahead = free_way(path, size, kLongest / kSteps, kSteps, rng);
  const auto behind = free_way(path.reversed(), size, kLongest / kSteps, kSteps, rng);
  const auto stroke = [&](int steps) {
    std::vector<Vec2> places;
    for (int i = 0; i < kSamples; ++i) {
      const double at = steps * (2.0 * i / (kSamples - 1) - 1.0);
      const auto k = static_cast<std::size_t>(std::lround(std::abs(at)));
      places.push_back(k == 0 ? Vec2::Zero() : at > 0.0 ? ahead[k - 1] : Vec2(-behind[k - 1]));
    }
    return places;
  };
  int low = 0;
  int high = kSteps;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (half_extent(stroke(middle)) < 1.0 ? low : high) = middle;
  }
  if (high == kSteps) {
    return std::nullopt;
  }
  std::vector<Vec2> places = stroke(high);
  const double unit = half_extent(places);
  for (Vec2& place : places) {
    place /= unit;  // to the last step
  }
  return places;
}

const std::vector<ClassLaw>& laws_of_classes() {
  static const std::vector<ClassLaw> laws(kCurveClasses.begin(), kCurveClasses.end());
  return laws;
}

}  // namespace

AssumedScene draw_assumed(std::uint64_t seed, std::uint32_t number) {
  std::mt19937_64 rng = seeded_rng(seed, {number});
  const auto& laws = laws_of_classes();
  AssumedScene scene;
  std::optional<std::vector<Vec2>> stroke;
  while (!stroke) {
    // One more than the classes: none of them.
    const auto i = std::uniform_int_distribution<std::size_t>(0, laws.size())(rng);
    scene.truth = i < laws.size() ? kCurveClasses[i] : CurveClass::Unclassified;
    stroke = i < laws.size() ? draw_stroke(scene.truth, laws[i], rng) : draw_free_stroke(rng);
  }
  scene.sigma = log_uniform(rng, 1e-5, 2e-3);
  const double half_extent_m = log_uniform(rng, 5e-3, 0.5);
  scene.sigma_m = scene.sigma * half_extent_m;
  const Pose2 pose{uniform(rng, -1.0, 1.0), uniform(rng, -1.0, 1.0), uniform(rng, -kPi, kPi)};
  std::normal_distribution<double> noise(0.0, scene.sigma);
  for (const Vec2& place : *stroke) {
    const Vec2 touched = half_extent_m * (place + Vec2(noise(rng), noise(rng)));
    scene.samples.push_back({pose * touched, 0.0, 0});
  }
  return scene;
}

}  // namespace palpate::test

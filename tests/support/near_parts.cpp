#include "tests/support/near_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/scene_data.h"

namespace palpate::test {

std::vector<NearPart> near_parts() {
  const auto superellipse = [](double t) {
    constexpr double kPower = 2.0 / 1.8;
    const auto power = [](double v) { return std::copysign(std::pow(std::abs(v), kPower), v); };
    return Vec2(0.03 * power(std::cos(t)), 0.02 * power(std::sin(t)));
  };
  const auto two_arcs = [](double t) {
    constexpr double kRadius = 0.02;
    return Vec2(kRadius * std::sin(t), std::copysign(kRadius * (1.0 - std::cos(t)), t));
  };
  const auto egg = [](double t) {
    return Vec2((0.025 + 0.002 * std::cos(t)) * std::cos(t),
                0.02 * std::sin(t) * (1.0 + 0.1 * std::cos(t)));
  };
  const auto dented = [](double t) {
    const double dent = 0.0003 * std::exp(-std::pow((t - 1.0) / 0.3, 2));
    return Vec2((0.03 - dent) * std::cos(t), (0.02 - dent) * std::sin(t));
  };
  const auto spiral = [](double t) {
    return Vec2(0.02 * std::exp(0.03 * t) * std::cos(t), 0.02 * std::exp(0.03 * t) * std::sin(t));
  };
  const auto lobed = [](double t) {
    const double radius = 0.025 + 5e-5 * std::cos(3.0 * t);
    return Vec2(radius * std::cos(t), radius * std::sin(t));
  };
  return {{"superellipse", superellipse, 0.2, 1.4},
          {"two arcs", two_arcs, -1.0, 1.0},
          {"egg", egg, 0.0, 6.2},
          {"dented ellipse", dented, 0.0, 6.2},
          {"spiral", spiral, 0.0, 3.0},
          {"three lobes", lobed, 0.0, 6.2}};
}

Scene touched(const NearPart& part, double sigma_m, const std::function<double()>& normal) {
  constexpr int kSamples = 200;
  constexpr double kGap = 0.02;  // of the whole, between the strokes
  Scene scene;
  scene.sigma_m = sigma_m;
  scene.patches.resize(2);
  for (int i = 0; i < kSamples; ++i) {
    const int stroke = i < kSamples / 2 ? 0 : 1;
    const double share = (i + 0.5) / kSamples * (1.0 - kGap) + stroke * kGap;
    const Vec2 place = part.at(part.from + share * (part.to - part.from));
    const double x = normal();
    scene.patches[static_cast<std::size_t>(stroke)].push_back(place + sigma_m * Vec2(x, normal()));
  }
  return scene;
}

namespace {

/// The least chi-square of a class on the exact places: how far the part is from being of a class.
double misfit(const NearPart& part, double sigma_m) {
  const Recognition answer = recognise(touched(part, sigma_m, [] { return 0.0; }), sigma_m);
  double least = std::numeric_limits<double>::infinity();
  for (const Hypothesis& hypothesis : answer.hypotheses) {
    if (hypothesis.shape.curve_class != CurveClass::Unclassified) {
      least = std::min(least, hypothesis.chi2);
    }
  }
  return least;
}

}  // namespace

double noise_of_misfit(const NearPart& part, double chi2) {
  // The misfit goes with the square of the noise, but for what a fit weighs otherwise at another.
  double sigma_m = 1e-4;
  for (int i = 0; i < 20; ++i) {
    sigma_m *= std::sqrt(misfit(part, sigma_m) / chi2);
  }
  return sigma_m;
}

}  // namespace palpate::test

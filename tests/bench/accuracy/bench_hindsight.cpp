// What choosing the window costs: errors of the sliding window beside those of the best window of
// one length and degree, chosen with the truth at hand. Prints markdown.
//     bench_hindsight [--strokes N]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/local/jet_estimator.h"
#include "core/local/stream/sliding_window.h"
#include "core/numerics/legendre_fit.h"
#include "tests/support/stroke.h"

namespace palpate {
namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr std::array kLengths_m = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.3};
/// Of the size of the parts.
constexpr std::array kNoises = {0.0, 1e-5, 1e-4, 5e-4, 2e-3};
constexpr double kSize_m = 0.025;
/// What a noise of zero is stated as: double precision's own at 0.2 m from the origin. [m]
constexpr double kRounding_m = 1e-16;
/// Places looked at along a stroke.
constexpr std::size_t kPlaces = 12;
/// Lengths of fixed windows, from the fewest samples of a window on: a fifth apart, over which an
/// error that goes as the power -3.5 of the length changes by half.
constexpr std::size_t kFewest = 16;
constexpr double kNextLength = 1.2;

using Squares = std::array<double, 2>;  ///< of the errors of kappa and kappa_s

struct Place {
  Squares sliding{};
  std::vector<std::optional<Squares>> fixed;  ///< where such a window has room
};

std::vector<std::size_t> lengths_up_to(std::size_t samples) {
  std::vector<std::size_t> lengths;
  for (double length = kFewest; length <= static_cast<double>(samples); length *= kNextLength) {
    lengths.push_back(static_cast<std::size_t>(length));
  }
  return lengths;
}

Squares squares_of(const test::TrueStroke& stroke, const LocalEstimate& estimate) {
  const Eigen::Vector3d error = stroke.error_of(estimate);
  return {error[1] * error[1], error[2] * error[2]};
}

void add_places(const test::TrueStroke& stroke, const std::vector<Vec2>& samples, double sigma_m,
                std::vector<Place>* places) {
  SlidingWindow window({.sigma_m = sigma_m});
  std::vector<WindowEstimate> estimates;
  for (const Vec2& p : samples) {
    if (const auto estimate = window.add(p); estimate && estimate->result) {
      estimates.push_back(*estimate);
    }
  }
  const std::size_t step = std::max<std::size_t>(1, estimates.size() / kPlaces);
  for (std::size_t e = 0; e < estimates.size(); e += step) {
    Place place;
    place.sliding = squares_of(stroke, estimates[e].result.estimate);
    const std::size_t middle = (estimates[e].first_sample + estimates[e].end_sample) / 2;
    for (const std::size_t length : lengths_up_to(samples.size())) {
      for (int degree = kMinJetDegree; degree <= kMaxJetDegree; ++degree) {
        place.fixed.emplace_back();
        if (middle < length / 2 || middle - length / 2 + length > samples.size()) {
          continue;
        }
        const LocalResult result =
            jet_estimate(std::span(samples).subspan(middle - length / 2, length),
                         {.degree = degree, .sigma_m = sigma_m});
        if (result) {
          place.fixed.back() = squares_of(stroke, result.estimate);
        }
      }
    }
    places->push_back(std::move(place));
  }
}

/// The largest ratio over the fixed windows, each at the places where it has room and an estimate:
/// at least at half of them all.
double ratio_of(const std::vector<Place>& places, std::size_t quantity) {
  double worst = 0.0;
  const std::size_t candidates = places.empty() ? 0 : places.front().fixed.size();
  for (std::size_t c = 0; c < candidates; ++c) {
    double sliding = 0.0;
    double fixed = 0.0;
    std::size_t count = 0;
    for (const Place& place : places) {
      if (place.fixed[c]) {
        sliding += place.sliding[quantity];
        fixed += (*place.fixed[c])[quantity];
        ++count;
      }
    }
    if (2 * count >= places.size()) {
      worst = std::max(worst, std::sqrt(sliding / fixed));
    }
  }
  return worst;
}

/// Of the least that a rule which sees data can lose to who knows the truth: one term z, known to a
/// deviation of 1, is left out (error z) or taken in (error 1), beside an error b of what is in
/// anyway. The largest, over priors of z on 0 and +-d, of the square root of Bayes' mean of
/// (squared error) / (b^2 + min(z^2, 1)): for every rule the worst z is at least as bad.
double least_ratio_of_any_rule(double b) {
  constexpr double kStep = 0.01;
  constexpr double kFarthest = 12.0;
  double largest = 0.0;
  for (double d = 1.0; d < 4.0; d += 0.1) {
    for (double at_zero = 0.1; at_zero < 0.95; at_zero += 0.02) {
      const double zero = at_zero / (b * b);
      const double apart = (1.0 - at_zero) / (b * b + std::min(d * d, 1.0));
      double risk = 0.0;
      for (double x = -kFarthest; x < kFarthest; x += kStep) {
        const auto law = [&](double mean) {
          return std::exp(-0.5 * (x - mean) * (x - mean)) / std::sqrt(2.0 * kPi);
        };
        const double none = zero * law(0.0);
        const double above = 0.5 * apart * law(d);
        const double below = 0.5 * apart * law(-d);
        const double z = d * (above - below) / (none + above + below);
        risk += kStep * (none * z * z + above * (z - d) * (z - d) + below * (z + d) * (z + d));
      }
      largest = std::max(largest, risk + (zero + apart) * b * b);
    }
  }
  return std::sqrt(largest);
}

/// b where z is the next term for the quantity: of the orthonormal terms k and k + 2 of equal
/// noise, the derivatives at the middle of sqrt(2k + 1) P_k.
double share_of_lower(int order) {
  const auto basis = legendre_derivatives<4, 6>(0.0);
  return std::abs(basis(order, order) / basis(order, order + 2)) *
         std::sqrt((2.0 * order + 1.0) / (2.0 * order + 5.0));
}

void print_table(int strokes) {
  std::printf("| curve, stroke |");
  for (const double noise : kNoises) {
    std::printf(" %g |", noise);
  }
  std::printf("\n|---|---|---|---|---|---|\n");
  std::array<std::vector<double>, 2> all;
  for (std::size_t shape = 0; shape < test::kStrokeShapes; ++shape) {
    for (const double length : kLengths_m) {
      std::string name;
      std::string cells;
      for (const double noise : kNoises) {
        std::mt19937_64 rng(kSeed);
        std::normal_distribution<double> normal;
        std::vector<Place> places;
        for (int i = 0; i < strokes; ++i) {
          const test::TrueStroke stroke = test::random_stroke(shape, length, rng);
          name = stroke.name;
          std::vector<Vec2> samples = stroke.samples(test::usual_stride(stroke));
          for (Vec2& p : samples) {
            const double x = normal(rng);
            const double y = normal(rng);
            p += noise * kSize_m * Vec2(x, y);
          }
          add_places(stroke, samples, std::max(noise * kSize_m, kRounding_m), &places);
        }
        char cell[64];
        const std::array ratios = {ratio_of(places, 0), ratio_of(places, 1)};
        std::snprintf(cell, sizeof cell, " %.2f, %.2f |", ratios[0], ratios[1]);
        cells += cell;
        for (std::size_t k = 0; k < 2; ++k) {
          if (noise > 0.0 && ratios[k] > 0.0) {
            all[k].push_back(ratios[k]);
          }
        }
      }
      std::printf("| %s, %g mm |%s\n", name.c_str(), 1e3 * length, cells.c_str());
    }
  }
  constexpr double kAsked = 1.2;
  for (std::size_t k = 0; k < 2; ++k) {
    std::sort(all[k].begin(), all[k].end());
    const auto within = std::upper_bound(all[k].begin(), all[k].end(), kAsked) - all[k].begin();
    std::printf(
        "\n%s with noise: median %.2f, 90 %% below %.2f, largest %.2f; at most %.1f in %td of "
        "%zu\n",
        k == 0 ? "kappa" : "kappa_s", all[k][all[k].size() / 2], all[k][all[k].size() * 9 / 10],
        all[k].back(), kAsked, within, all[k].size());
    const double b = share_of_lower(static_cast<int>(k) + 2);
    std::printf("No rule that sees data is below %.2f everywhere (b = %.2f).\n",
                least_ratio_of_any_rule(b), b);
  }
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  CLI::App app(
      "The sliding window's rms error of kappa, kappa_s over that of the best jet of one degree (3 "
      "to 5) and window length, both chosen in hindsight for the cell and for kappa and kappa_s "
      "apart; columns: noise over the part's size");
  int strokes = 10;
  app.add_option("--strokes", strokes, "Of each curve, length and noise")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  palpate::print_table(strokes);
  return 0;
}

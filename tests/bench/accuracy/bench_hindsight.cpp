// Measures the cost of choosing the window from the data: errors of the sliding window compared
// with those of the best window of one length and degree, chosen with knowledge of the truth.
// Prints markdown.
//     bench_hindsight [--strokes N] [--curve NAME] [--length-mm L]
// Exits with 1 if the ratio of a cell exceeds the limit and neither few strokes nor a fixed window
// that the samples refute explain it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/local/aligned_frame.h"
#include "core/local/jet_estimator.h"
#include "core/local/legendre_curve.h"
#include "core/local/stream/sliding_window.h"
#include "core/numerics/polynomials/legendre_fit.h"
#include "core/numerics/probability/chi_square.h"
#include "tests/support/stroke.h"

namespace palpate {
namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr std::array kLengths_m = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.3};
/// Relative to the size of the parts.
constexpr std::array kNoises = {0.0, 1e-5, 1e-4, 5e-4, 2e-3};
constexpr double kSize_m = 0.025;
/// Stated noise when the true noise is zero: the rounding of doubles at 0.2 m from the origin. [m]
constexpr double kRounding_m = 1e-16;
/// Places evaluated along a stroke.
constexpr std::size_t kPlaces = 12;
/// Lengths of fixed windows, from the fewest samples of a window. Each is a fifth longer than the
/// one before; an error proportional to the power -3.5 of the length changes by half over such a
/// step.
constexpr std::size_t kFewest = 16;
constexpr double kNextLength = 1.2;

using Squares = std::array<double, 2>;  ///< of the errors of kappa and kappa_s

struct Place {
  Squares sliding{};
  Squares stated{};  ///< published variances
  double samples = 0.0;
  std::vector<std::optional<Squares>> fixed;  ///< if such a window has room
  std::vector<bool> contradicted;             ///< the samples refute its polynomial
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

/// True if noise leaves such large residuals about a polynomial of that degree in at most one of
/// 10,000 windows. If the noise is estimated, this cannot be decided: the estimate takes a bend for
/// noise.
bool is_contradicted(std::span<const Vec2> window, int degree, double sigma_m) {
  constexpr double kChance = 1e-4;
  const AlignedFrame frame = aligned_frame(window).frame;
  LegendreFit<kMaxJetDegree> plain;
  for (const Vec2& p : window) {
    const Vec2 uv = frame.to_frame(p);
    plain.add(uv.x(), uv.y(), 1.0);
  }
  if (!plain.factorise(0.0)) {
    return false;
  }
  // Noise that is equal in all directions appears as 1 + slope^2 of it.
  const auto start = plain.coefficients();
  LegendreFit<kMaxJetDegree> fit;
  double squares = 0.0;
  for (const Vec2& p : window) {
    const Vec2 uv = frame.to_frame(p);
    const double s = slope<kMaxJetDegree + 1>(start, uv.x());
    const double weight = 1.0 / (1.0 + s * s);
    fit.add(uv.x(), uv.y(), weight);
    squares += weight * uv.y() * uv.y();
  }
  if (!fit.factorise(0.0)) {
    return false;
  }
  const double left = squares - fit.scores().head(degree + 1).squaredNorm();
  const double sigma = sigma_m / frame.half_extent_m;
  return chi_square_survival(left / (sigma * sigma), static_cast<int>(window.size()) - degree - 1) <
         kChance;
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
    const LocalEstimate& estimate = estimates[e].result.estimate;
    place.sliding = squares_of(stroke, estimate);
    place.stated = {estimate.covariance(2, 2), estimate.covariance(3, 3)};
    place.samples = estimate.window_samples;
    const std::size_t middle = (estimates[e].first_sample + estimates[e].end_sample) / 2;
    for (const std::size_t length : lengths_up_to(samples.size())) {
      for (int degree = kMinJetDegree; degree <= kMaxJetDegree; ++degree) {
        place.fixed.emplace_back();
        place.contradicted.push_back(false);
        if (middle < length / 2 || middle - length / 2 + length > samples.size()) {
          continue;
        }
        const auto stretch = std::span(samples).subspan(middle - length / 2, length);
        const LocalResult result = jet_estimate(stretch, {.degree = degree, .sigma_m = sigma_m});
        if (result) {
          place.fixed.back() = squares_of(stroke, result.estimate);
          place.contradicted.back() = is_contradicted(stretch, degree, sigma_m);
        }
      }
    }
    places->push_back(std::move(place));
  }
}

/// The sliding window compared with the fixed window that gives the largest ratio.
struct Comparison {
  double ratio = 0.0;
  std::size_t candidate = 0;
  double samples = 0.0;         ///< mean, of the sliding windows
  double fixed_rms = 0.0;       ///< errors of the fixed window
  double stated_rms = 0.0;      ///< deviations that the sliding window publishes
  double worst_two = 0.0;       ///< the two largest squared errors of the sliding window
  double contradicted = 0.0;    ///< share of the places where the samples refute the fixed window
  double uncontradicted = 0.0;  ///< the ratio at the other places; 0 if there are none
};

/// The largest ratio over the fixed windows. Each is evaluated at the places where it has room and
/// an estimate; at least half of all.
Comparison compared(const std::vector<Place>& places, std::size_t quantity) {
  Comparison found;
  const std::size_t candidates = places.empty() ? 0 : places.front().fixed.size();
  for (std::size_t c = 0; c < candidates; ++c) {
    Comparison now;
    now.candidate = c;
    double sliding = 0.0;
    double fixed = 0.0;
    double stated = 0.0;
    double sliding_beside = 0.0;  // at the places where the samples do not refute the fixed window
    double fixed_beside = 0.0;
    double worst = 0.0;
    double second = 0.0;
    std::size_t refuted = 0;
    std::size_t count = 0;
    for (const Place& place : places) {
      if (place.fixed[c]) {
        const double square = place.sliding[quantity];
        const double beside = (*place.fixed[c])[quantity];
        sliding += square;
        fixed += beside;
        if (square > worst) {
          second = std::exchange(worst, square);
        } else {
          second = std::max(second, square);
        }
        if (place.contradicted[c]) {
          ++refuted;
        } else {
          sliding_beside += square;
          fixed_beside += beside;
        }
        stated += place.stated[quantity];
        now.samples += place.samples;
        ++count;
      }
    }
    const auto n = static_cast<double>(count);
    now.ratio = std::sqrt(sliding / fixed);
    if (2 * count >= places.size() && now.ratio > found.ratio) {
      now.samples /= n;
      now.fixed_rms = std::sqrt(fixed / n);
      now.stated_rms = std::sqrt(stated / n);
      now.contradicted = static_cast<double>(refuted) / n;
      now.uncontradicted = fixed_beside > 0.0 ? std::sqrt(sliding_beside / fixed_beside) : 0.0;
      now.worst_two = (worst + second) / sliding;
      found = now;
    }
  }
  return found;
}

/// A lower bound on the loss of any rule that sees only the data, against one that knows the truth.
/// One term z, known to a deviation of 1, is left out (error z) or included (error 1), in addition
/// to an unavoidable error b. Returns the largest value, over priors of z on 0 and +-d, of the
/// square root of Bayes' mean of (squared error) / (b^2 + min(z^2, 1)): for every rule the worst z
/// is at least as bad.
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

/// b if z is the next term for this quantity: from the orthonormal terms k and k + 2 with equal
/// noise, the derivatives of sqrt(2k + 1) P_k at the middle.
double share_of_lower(int order) {
  const auto basis = legendre_derivatives<4, 6>(0.0);
  return std::abs(basis(order, order) / basis(order, order + 2)) *
         std::sqrt((2.0 * order + 1.0) / (2.0 * order + 5.0));
}

constexpr double kAsked = 1.2;

/// A cell beyond the limit is repeated with this many times as many strokes: with few strokes, the
/// best of about sixty fixed windows, chosen afterwards, is partly luck.
constexpr int kMoreStrokes = 20;

struct Cell {
  std::string curve;
  std::array<Comparison, 2> found;  ///< kappa and kappa_s
};

Cell walked(std::size_t shape, double length_m, double noise, int strokes) {
  std::mt19937_64 rng(kSeed);
  std::normal_distribution<double> normal;
  Cell cell;
  std::vector<Place> places;
  for (int i = 0; i < strokes; ++i) {
    const test::TrueStroke stroke = test::random_stroke(shape, length_m, rng);
    cell.curve = stroke.name;
    std::vector<Vec2> samples = stroke.samples(test::usual_stride(stroke));
    for (Vec2& p : samples) {
      const double x = normal(rng);
      const double y = normal(rng);
      p += noise * kSize_m * Vec2(x, y);
    }
    add_places(stroke, samples, std::max(noise * kSize_m, kRounding_m), &places);
  }
  cell.found = {compared(places, 0), compared(places, 1)};
  return cell;
}

double ratio_unless_refuted(const Comparison& c) { return std::min(c.ratio, c.uncontradicted); }

/// The row of a cell above the limit. `more`: the result with more strokes, if it was repeated.
std::string row_of(const std::string& curve, double length, double noise, std::size_t quantity,
                   const Comparison& c, const std::optional<Comparison>& more) {
  constexpr std::size_t kDegrees = kMaxJetDegree - kMinJetDegree + 1;
  char text[256];
  std::snprintf(
      text, sizeof text,
      "| %s, %g mm, %g | %s | %.2f | %zu, degree %d | %.0f | %.2f | %.0f %% | %.0f %% | %.2f |",
      curve.c_str(), 1e3 * length, noise, quantity == 0 ? "kappa" : "kappa_s", c.ratio,
      lengths_up_to(1000000)[c.candidate / kDegrees],
      kMinJetDegree + static_cast<int>(c.candidate % kDegrees), c.samples,
      c.ratio * c.fixed_rms / c.stated_rms, 100.0 * c.worst_two, 100.0 * c.contradicted,
      c.uncontradicted);
  std::string row = text;
  if (more) {
    std::snprintf(text, sizeof text, " %.2f, %.2f |", more->ratio, more->uncontradicted);
    row += text;
  } else {
    row += " |";
  }
  return row;
}

/// Which strokes to evaluate: of one curve, of one length, or all.
struct Selection {
  int strokes = 10;
  std::string curve;
  double length_mm = 0.0;
};

class Table {
 public:
  /// Returns false if a cell is beyond the limit of any rule and nothing explains it.
  bool print(const Selection& selection) {
    std::printf("| curve, stroke |");
    for (const double noise : kNoises) {
      std::printf(" %g |", noise);
    }
    std::printf("\n|---|---|---|---|---|---|\n");
    for (std::size_t shape = 0; shape < test::kStrokeShapes; ++shape) {
      for (const double length : kLengths_m) {
        std::mt19937_64 rng(kSeed);
        const bool asked = (selection.curve.empty() ||
                            test::random_stroke(shape, length, rng).name == selection.curve) &&
                           (selection.length_mm == 0.0 ||
                            std::abs(1e3 * length / selection.length_mm - 1.0) < 0.01);
        if (asked) {
          print_row(shape, length, selection.strokes);
        }
      }
    }
    std::printf("\nAbove %.1f:\n\n", kAsked);
    std::printf(
        "| curve, stroke, noise | of | ratio | best fixed: samples | sliding: samples | error over "
        "published | two worst places' share | samples refute the best fixed | ratio elsewhere | "
        "both of %d times the strokes |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        kMoreStrokes);
    for (const std::string& row : above_) {
      std::printf("%s\n", row.c_str());
    }
    for (std::size_t k = 0; k < 2; ++k) {
      print_summary(k);
    }
    return unexplained_ == std::array{0, 0};
  }

 private:
  void print_row(std::size_t shape, double length, int strokes) {
    std::string cells;
    std::string name;
    for (const double noise : kNoises) {
      const Cell cell = walked(shape, length, noise, strokes);
      name = cell.curve;
      char text[64];
      std::snprintf(text, sizeof text, " %.2f, %.2f |", cell.found[0].ratio, cell.found[1].ratio);
      cells += text;
      for (std::size_t k = 0; k < 2 && noise > 0.0; ++k) {
        const Comparison& c = cell.found[k];
        if (c.ratio > 0.0) {
          all_[k].push_back(c.ratio);
        }
        if (c.ratio <= kAsked) {
          continue;
        }
        std::optional<Comparison> more;
        if (ratio_unless_refuted(c) > limits_[k]) {
          more = walked(shape, length, noise, kMoreStrokes * strokes).found[k];
          unexplained_[k] += ratio_unless_refuted(*more) > limits_[k] ? 1 : 0;
        }
        above_.push_back(row_of(name, length, noise, k, c, more));
      }
    }
    std::printf("| %s, %g mm |%s\n", name.c_str(), 1e3 * length, cells.c_str());
    std::fflush(stdout);
  }

  void print_summary(std::size_t k) {
    std::vector<double>& ratios = all_[k];
    if (ratios.empty()) {
      return;
    }
    std::sort(ratios.begin(), ratios.end());
    const auto within = std::upper_bound(ratios.begin(), ratios.end(), kAsked) - ratios.begin();
    std::printf(
        "\n%s with noise: median %.2f, 90 %% below %.2f, largest %.2f; at most %.1f in %td of "
        "%zu\n",
        k == 0 ? "kappa" : "kappa_s", ratios[ratios.size() / 2], ratios[ratios.size() * 9 / 10],
        ratios.back(), kAsked, within, ratios.size());
    std::printf(
        "No rule that sees data is below %.2f everywhere (b = %.2f); above that, where the samples "
        "do not refute the best fixed window: %d.\n",
        limits_[k], share_of_lower(static_cast<int>(k) + 2), unexplained_[k]);
  }

  std::vector<std::string> above_;
  std::array<std::vector<double>, 2> all_;
  std::array<int, 2> unexplained_{};  ///< beyond the limit of any rule, and no window refuted
  std::array<double, 2> limits_ = {least_ratio_of_any_rule(share_of_lower(2)),
                                   least_ratio_of_any_rule(share_of_lower(3))};
};

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  CLI::App app(
      "The sliding window's rms error of kappa, kappa_s over that of the best jet of one degree (3 "
      "to 5) and window length, both chosen in hindsight for the cell and for kappa and kappa_s "
      "apart; columns: noise over the part's size");
  palpate::Selection selection;
  app.add_option("--strokes", selection.strokes, "Of each curve, length and noise")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--curve", selection.curve, "This one only");
  app.add_option("--length-mm", selection.length_mm, "Strokes of this length only");
  CLI11_PARSE(app, argc, argv);
  return palpate::Table().print(selection) ? 0 : 1;
}

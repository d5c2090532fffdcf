#include "core/recognition/smooth/section_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/recognition/smooth/turning_sections.h"

namespace palpate {
namespace {

/// True if the samples turn too far to be a graph over their chord: by more than two radians, as
/// the chords between the means of their thirds show, which turn a third as much. Sections are cut
/// before that, except where their samples are few. Samples that scatter about a place show no
/// turn: along an even stroke a chord is 3.5 times as long as the scatter of a third about its
/// mean, which is a third of the stroke over sqrt(12); of noise alone it is as long at most.
bool is_no_graph(std::span<const FitPoint> points) {
  constexpr double kLargestTurn = 2.0 / 3.0;  // rad, of chords between thirds
  constexpr double kOfMotion = 2.0;           // chord over scatter, between 1 and 3.5
  const std::size_t n = points.size();
  double scatter = 0.0;
  const auto mean_of = [&](std::size_t begin, std::size_t end) {
    Vec2 sum = Vec2::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      sum += points[i].position;
    }
    Vec2 mean = sum / static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      scatter += (points[i].position - mean).squaredNorm() / static_cast<double>(n);
    }
    return mean;
  };
  const Vec2 first = mean_of(0, n / 3);
  const Vec2 middle = mean_of(n / 3, n - n / 3);
  const Vec2 before = middle - first;
  const Vec2 after = mean_of(n - n / 3, n) - middle;
  const double least = kOfMotion * kOfMotion * scatter;
  return before.squaredNorm() > least && after.squaredNorm() > least &&
         std::abs(turn_between(before, after)) > kLargestTurn;
}

}  // namespace

std::optional<SectionFit> fit_section(const FitData& data, const PatchSpan& section,
                                      const SectionNoise& noise) {
  const std::span<const FitPoint> points(data.points.data() + section.begin, section.size());
  const std::size_t n = points.size();
  if (n < kFewestOfSection) {
    return std::nullopt;
  }
  if (points.front().position == points.back().position) {
    return std::nullopt;
  }
  const ChordFrame frame = chord_frame(points.front().position, points.back().position);
  std::vector<double> x(n);
  std::vector<double> y(n);
  std::vector<double> w(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = frame.along(points[i].position);
    y[i] = frame.across(points[i].position);
    w[i] = points[i].inverse_sigma * points[i].inverse_sigma;
  }
  const int highest = std::min<int>(OrthogonalPolynomials::kMaxDegree, static_cast<int>(n) / 2 - 1);

  // A first fit gives the slopes, which convert residuals across the chord into distances.
  constexpr int kSlopeDegree = 3;
  const OrthogonalPolynomials first(x, w, y, std::min(kSlopeDegree, highest));
  for (std::size_t i = 0; i < n; ++i) {
    const double slope = first.evaluate(x[i], first.degree()).derivative / frame.half_length;
    w[i] /= 1.0 + slope * slope;
  }
  SectionFit fit{section, frame, OrthogonalPolynomials(x, w, y, highest), 1};
  const double count = static_cast<double>(n) / noise.time;
  // Where neighbours err together a section may be worth few samples, or less than one: there a
  // coefficient costs what it does by H. Akaike's criterion (1974).
  const double cost = noise.time > 1.0 ? std::max(std::log(count), 2.0) : std::log(count);
  // Of a known noise, chance takes more than sqrt(cost) deviations by a coefficient as seldom as a
  // normal law exceeds them. Where the noise is what is left over, it is Student's law, of so many
  // degrees of freedom, that t of them exceed as seldom, and n log chi2 falls by
  //   n log(1 + t^2 / left) = n / left ((8 left + 3) / (8 left + 1))^2 cost
  // (D. L. Wallace, 1959). At the known noise's cost high degrees go through the noise of few
  // samples.
  const auto cost_where_profiled = [&](int coefficients) {
    const double left = count - coefficients;
    const double wallace = (8.0 * left + 3.0) / (8.0 * left + 1.0);
    return left > 0.0 ? cost * count / left * wallace * wallace
                      : std::numeric_limits<double>::infinity();
  };
  const auto choose = [&](bool noise_known) {
    int degree = 1;
    double best = std::numeric_limits<double>::infinity();
    double paid = noise_known ? cost : cost_where_profiled(1);
    for (int d = 1; d <= highest; ++d) {
      const double chi2 =
          std::max(fit.polynomials.residual_sum(d), std::numeric_limits<double>::min());
      paid += noise_known ? cost : cost_where_profiled(d + 1);
      const double criterion =
          (noise_known ? chi2 / (noise.variance * noise.time) : count * std::log(chi2)) + paid;
      if (criterion < best) {
        best = criterion;
        degree = d;
      }
    }
    return degree;
  };
  const int by_residuals = choose(false);
  fit.degree = noise.known ? choose(true) : by_residuals;
  fit.is_graph = !is_no_graph(points);
  fit.shows_noise = by_residuals + 2 <= highest && fit.is_graph;
  return fit;
}

std::vector<double> residuals_of(const FitData& data, const SectionFit& fit, int degree) {
  std::vector<double> residuals;
  residuals.reserve(fit.section.size());
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    const FitPoint& point = data.points[i];
    const auto path = fit.polynomials.evaluate(fit.frame.along(point.position), degree);
    residuals.push_back(fit.distance(point, path) * point.inverse_sigma);
  }
  return residuals;
}

}  // namespace palpate

#include "core/recognition/posterior/free_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/numerics/matrices/triangular_root.h"
#include "core/numerics/probability/log_add.h"
#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

constexpr int kMostNodes = 12;  // of a section at a time; a smoothed one has at most ten
constexpr int kTerms = 12;      // of a path's power series: one more than the nodes tell
using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostNodes, 1>;

/// Sizes of features that a free-form part may have, in touched half extents, alike probable: a
/// factor of two apart, from an eighth (finer ones would not be one arc) to where paths are
/// straight lines to most probes.
constexpr std::array kSizes = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};

constexpr std::size_t kMiddleSize = 3;  ///< a half extent

/// Ordinate and its first two derivatives by the abscissa of a frame, and their covariance.
struct Junction {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  /// A square root of their covariance, R R^T: rounding cannot make it less than nothing.
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
};

/// Nodes of one section in its chord frame, lengths in half extents.
struct SectionNodes {
  Nodes x;
  Nodes y;
  Nodes weight;  ///< inverse standard deviation of y
};

/// The cosine of the angle between the path at a reduced point and its section's chord. A sample
/// that stands for itself has the direction of the chord between its neighbours, which noise of the
/// weight turns: what it may make of the sine's square is taken off. (Else samples closer than
/// their noise would lie in all directions, and nearer to any path.)
double cosine_to_axis(const SmoothModel& smooth, const ReducedSection& section, std::size_t k,
                      double weight) {
  const std::vector<FitPoint>& points = smooth.reduced.points;
  const double sine = cross(section.axis, points[k].tangent);
  double square = sine * sine;
  if (section.kept) {
    constexpr double kDeviations = 3.0;
    const std::size_t before = std::max(k, section.begin + 1) - 1;
    const std::size_t after = std::min(k + 1, section.end - 1);
    const double chord = (points[after].position - points[before].position).norm();
    const double in_noise = weight * points[k].inverse_sigma * chord;
    square -= 2.0 * kDeviations * kDeviations / (in_noise * in_noise);
  }
  return std::sqrt(1.0 - std::clamp(square, 0.0, 1.0));
}

SectionNodes nodes_of(const SmoothModel& smooth, const ReducedSection& section, std::size_t begin,
                      double weight) {
  const auto n = static_cast<Eigen::Index>(std::min<std::size_t>(kMostNodes, section.end - begin));
  SectionNodes nodes{Nodes(n), Nodes(n), Nodes(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = begin + static_cast<std::size_t>(i);
    const FitPoint& point = smooth.reduced.points[k];
    const Vec2 away = point.position - section.middle;
    const double cosine = point.tangent.isZero() ? 1.0 : cosine_to_axis(smooth, section, k, weight);
    nodes.x[i] = away.dot(section.axis);
    nodes.y[i] = cross(section.axis, away);
    nodes.weight[i] = weight * point.inverse_sigma * cosine;
  }
  return nodes;
}

/// The junction as the next section's frame sees it: the geometry exactly, its covariance to first
/// order in the normal offset, the angle and the curvature.
Junction in_frame(const Junction& junction, double x, const ReducedSection& from,
                  const ReducedSection& to, double* x_there) {
  const Vec2 point = from.middle + x * from.axis + junction.mean[0] * left_of(from.axis);
  const double slope = junction.mean[1];
  const Vec2 tangent = (from.axis + slope * left_of(from.axis)).normalized();
  const double cosine = tangent.dot(from.axis);
  const double cosine_there = std::max(tangent.dot(to.axis), 0.1);  // sections turn by a radian
  const double kappa = junction.mean[2] * cosine * cosine * cosine;
  const double ratio = cosine / cosine_there;
  const Eigen::Vector3d scale(ratio, ratio * ratio, ratio * ratio * ratio);
  Junction there;
  *x_there = (point - to.middle).dot(to.axis);
  there.mean = {cross(to.axis, point - to.middle), cross(to.axis, tangent) / cosine_there,
                kappa / (cosine_there * cosine_there * cosine_there)};
  there.root = scale.asDiagonal() * junction.root;
  return there;
}

/// The evidence of one section, and what it says of the path at its end.
struct SectionEvidence {
  double chi2 = 0.0;
  double log_determinant = 0.0;
  Junction end;
};

/// Terms of a path's power series as a normal law.
struct Series {
  using Coefficients = Eigen::Matrix<double, kTerms, 1>;
  using Root = Eigen::Matrix<double, kTerms, kTerms>;
  Coefficients mean = Coefficients::Zero();
  Root root = Root::Zero();  ///< a square root of their covariance, R R^T
};

/// y = sum c_k (x - origin)^k. At a patch's start c_0 and c_1 are the free place and direction;
/// later, c_0 to c_2 continue what came before. The rest has the prior of features of `size`:
/// c_k = size^(1-k) / (k (k - 1)), the series of a logarithm, which converges within `size`.
Series series_before(double size, const std::optional<Junction>& before) {
  const double width = std::sqrt(0.5 * std::numbers::pi);  // as offset and turn of a class
  Series series;
  double power = 1.0 / size;
  for (int k = 2; k < kTerms; ++k) {
    series.root(k, k) = power / (k * (k - 1));
    power /= size;
  }
  if (before) {
    const Eigen::Vector3d half(1.0, 1.0, 0.5);  // c_2 is half the second derivative
    series.mean.head<3>() = half.cwiseProduct(before->mean);
    series.root.topLeftCorner<3, 3>() = half.asDiagonal() * before->root;
  } else {
    series.root(0, 0) = series.root(1, 1) = width;
  }
  return series;
}

/// The path at `x` from the origin.
Junction junction_at(const Series& series, double x) {
  Eigen::Matrix<double, kTerms, 3> at = Eigen::Matrix<double, kTerms, 3>::Zero();
  double power = 1.0;
  for (int k = 0; k < kTerms; ++k) {
    at(k, 0) = power;
    if (k + 1 < kTerms) at(k + 1, 1) = (k + 1) * power;
    if (k + 2 < kTerms) at(k + 2, 2) = (k + 2) * (k + 1) * power;
    power *= x;
  }
  Eigen::Matrix<double, kTerms, 3> half = series.root.transpose().lazyProduct(at);
  Junction junction;
  junction.mean = at.transpose().lazyProduct(series.mean);
  absorb_rows(&half, &junction.root);
  return junction;
}

/// The evidence of one section's nodes, each told by those before it: Potter's square-root filter.
SectionEvidence evidence_of(const SectionNodes& nodes, double origin, double end, double size,
                            const std::optional<Junction>& before, bool goes_on) {
  Series series = series_before(size, before);
  SectionEvidence evidence;
  for (Eigen::Index i = 0; i < nodes.x.size(); ++i) {
    Series::Coefficients row;
    double power = nodes.weight[i];
    for (int k = 0; k < kTerms; ++k) {
      row[k] = power;
      power *= nodes.x[i] - origin;
    }
    const Series::Coefficients spread = series.root.transpose().lazyProduct(row);
    const double variance = spread.squaredNorm() + 1.0;
    const double innovation = nodes.weight[i] * nodes.y[i] - row.dot(series.mean);
    evidence.chi2 += innovation * innovation / variance;
    evidence.log_determinant += std::log(variance);
    const Series::Coefficients gain = series.root.lazyProduct(spread) / variance;
    series.mean += innovation * gain;
    series.root -= (gain / (1.0 + 1.0 / std::sqrt(variance))).lazyProduct(spread.transpose());
  }
  if (goes_on) {
    evidence.end = junction_at(series, end - origin);
  }
  return evidence;
}

/// A touch by itself is a path by itself, whose direction may be any: uniform over half a turn, as
/// measured normals are compared either way round.
void add_normal(const FitPoint& touch, double weight, FreeForm* paths) {
  if (touch.inverse_normal_sigma > 0.0) {
    const double sigma = 1.0 / (weight * touch.inverse_normal_sigma);
    paths->log_occam += std::min(0.0, std::log(std::sqrt(2.0 / std::numbers::pi) * sigma));
    paths->determined += 1.0;
  }
}

FreeForm paths_of(const SmoothModel& smooth, double size, double weight) {
  FreeForm paths;
  std::optional<Junction> junction;
  double junction_x = 0.0;
  const ReducedSection* last = nullptr;
  for (const ReducedSection& section : smooth.sections) {
    for (std::size_t begin = section.begin; begin < section.end; begin += kMostNodes) {
      const SectionNodes nodes = nodes_of(smooth, section, begin, weight);
      const bool joined = section.joined || begin > section.begin;
      std::optional<Junction> before;
      double origin = -section.half_length;
      if (joined && last != nullptr) {
        before = in_frame(*junction, junction_x, *last, section, &origin);
      }
      // The section's chord ends with its last point; a section taken in parts, with the part's.
      const double end =
          begin + kMostNodes >= section.end ? section.half_length : nodes.x[nodes.x.size() - 1];
      const bool goes_on = begin + kMostNodes < section.end ||
                           (&section != &smooth.sections.back() && (&section + 1)->joined);
      const SectionEvidence evidence =
          evidence_of(nodes, before ? origin : 0.0, end, size, before, goes_on);
      paths.chi2 += evidence.chi2;
      paths.log_occam -= 0.5 * evidence.log_determinant;
      paths.determined += static_cast<double>(nodes.x.size());
      if (section.end - section.begin == 1) {
        add_normal(smooth.reduced.points[begin], weight, &paths);
      }
      junction = evidence.end;
      junction_x = end;
      last = &section;
    }
  }
  return paths;
}

}  // namespace

FreeForm free_form(const SmoothModel& smooth, double inflation, WorkBudget& work) {
  const double weight = 1.0 / std::sqrt(inflation);
  FreeForm best;
  double top = -std::numeric_limits<double>::infinity();
  double sum = 0.0;  // of the evidences, over that of `best`
  const auto take = [&](std::size_t s) {
    work.spend(WorkKind::PathRow, smooth.reduced.points.size() + smooth.sections.size());
    const FreeForm paths = paths_of(smooth, kSizes[s], weight);
    const double value = paths.log_occam - 0.5 * paths.chi2;
    if (!std::isfinite(value)) {
      return false;  // sections much longer than the features: their power series overflows
    }
    if (value > top) {
      sum = sum * std::exp(top - value) + 1.0;
      top = value;
      best = paths;
    } else {
      sum += std::exp(value - top);
    }
    return value > top - kTailOfDensity;
  };
  // The evidence has one maximum: outwards from the middle until it has fallen off.
  const auto from = [&](std::size_t s, int step) {
    for (auto i = static_cast<int>(s); i >= 0 && i < static_cast<int>(kSizes.size()); i += step) {
      const double before = top;
      if (!take(static_cast<std::size_t>(i)) && top == before && std::isfinite(top)) {
        break;
      }
    }
  };
  from(kMiddleSize, 1);
  from(kMiddleSize - 1, -1);
  best.log_occam += std::log(sum / static_cast<double>(kSizes.size()));
  return best;
}

namespace {

/// A density's logarithm about its maximum.
struct Peak {
  double at = 0.0;
  double log_top = -std::numeric_limits<double>::infinity();
  double log_mass = -std::numeric_limits<double>::infinity();  ///< by Laplace's formula
};

/// Walks up from `at` in steps of `step` and less, to `width`. `log_at(u)`: the density's
/// logarithm.
template <typename LogAt>
Peak peak_from(const LogAt& log_at, double at, double step, double width) {
  Peak peak{at, log_at(at)};
  if (!std::isfinite(peak.log_top)) {
    return peak;
  }
  double before = 0.0;
  double after = 0.0;
  for (bool is_last = false; !is_last; step = std::max(0.5 * step, width)) {
    is_last = step <= width;
    before = log_at(peak.at - step);
    after = log_at(peak.at + step);
    while (std::max(before, after) > peak.log_top) {
      const bool is_up = after > before;
      peak.at += is_up ? step : -step;
      (is_up ? before : after) = std::exchange(peak.log_top, is_up ? after : before);
      (is_up ? after : before) = log_at(peak.at + (is_up ? step : -step));
    }
  }
  // A flat density is no wider than all noise there is.
  constexpr double kFlattest = 1e-2;
  const double bend = std::max((2.0 * peak.log_top - before - after) / (width * width), kFlattest);
  peak.log_mass = peak.log_top + 0.5 * std::log(2.0 * std::numbers::pi / bend);
  return peak;
}

}  // namespace

FreeForm free_form_over_noise(const SmoothModel& smooth, const Likelihood& likelihood,
                              WorkBudget& work) {
  if (!work.allows()) {
    return free_form(smooth, likelihood.inflation(), work);
  }
  const double left = likelihood.left(smooth.chi2);
  const double weight = 1.0 / std::sqrt(likelihood.inflation());
  const auto log_of_size = [&](double size) {
    return [&, size](double u) {  // the log of the noise
      work.spend(WorkKind::PathRow, smooth.reduced.points.size() + smooth.sections.size());
      const FreeForm there = paths_of(smooth, size, weight * std::exp(-u));
      const double value =
          there.log_occam - 0.5 * (there.chi2 + left * std::exp(-2.0 * u)) - likelihood.samples * u;
      return std::isfinite(value) ? value : -std::numeric_limits<double>::infinity();
    };
  };
  // The standard deviation of the log of a noise that so many samples tell.
  const double width = 1.0 / std::sqrt(2.0 * likelihood.samples);
  const double finest = 0.5 * std::log(likelihood.chi2_floor / likelihood.samples);
  const double largest = std::max(-std::log(rms_sigma(smooth.reduced)), finest + 1.0);
  constexpr int kStarts = 8;
  const double apart = (largest - finest) / kStarts;
  const auto log_of_middle = log_of_size(kSizes[kMiddleSize]);
  double start = finest;
  for (double log_top = -std::numeric_limits<double>::infinity(), u = finest; u <= largest;
       u += apart) {
    const double value = log_of_middle(u);
    start = value > log_top ? u : start;
    log_top = std::max(log_top, value);
  }
  Peak best = peak_from(log_of_middle, start, 0.5 * apart, width);
  double sum = best.log_mass;
  // The evidence has one maximum: outwards from the middle until it has fallen off.
  const auto from = [&](std::size_t s, int step, double at) {
    double before = best.log_mass;
    for (auto i = static_cast<int>(s);
         i >= 0 && i < static_cast<int>(kSizes.size()) && work.allows(); i += step) {
      constexpr double kNear = 2.0;  // from one size to the next, in widths
      const Peak peak =
          peak_from(log_of_size(kSizes[static_cast<std::size_t>(i)]), at, kNear * width, width);
      if (!std::isfinite(peak.log_top)) {
        break;
      }
      sum = log_add(sum, peak.log_mass);
      if (peak.log_mass < before && peak.log_mass < best.log_mass - kTailOfDensity) {
        break;
      }
      before = peak.log_mass;
      at = peak.at;
      best = peak.log_top > best.log_top ? peak : best;
    }
  };
  const double middle = best.at;
  from(kMiddleSize + 1, 1, middle);
  from(kMiddleSize - 1, -1, middle);
  FreeForm paths;
  paths.noise = std::exp(best.at);
  // Twice: Likelihood::log_evidence leaves out the half of its integral.
  paths.log_over_noise = std::log(2.0) + sum - std::log(static_cast<double>(kSizes.size()));
  return paths;
}

FreeForm over_times_the_noise(FreeForm paths, double times, double samples) {
  if (paths.log_over_noise) {
    *paths.log_over_noise += samples * std::log(times);
    paths.noise /= times;
  }
  return paths;
}

}  // namespace palpate

#include "core/recognition/weigh/best_in_full.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"
#include "core/recognition/smooth/across_noise.h"

namespace palpate {
namespace {

/// The normals of points in strokes as the points' own.
void give_normals(FitData* data) {
  for (std::size_t i = 0; i < data->details.size(); ++i) {
    const PointDetail& detail = data->details[i];
    if (detail.inverse_normal_sigma > 0.0) {
      data->points[i].normal = detail.normal;
      data->points[i].inverse_normal_sigma = detail.inverse_normal_sigma;
      data->normals_along_strokes = true;
    }
  }
}

struct PlacedInFull {
  ClassFit fit;
  CanonicalFit canonical;
};

/// To the optimum with weights of the curve found, as the fit of a given class has them. Each walk
/// leaves of the weights' error about the noise over the radius of curvature.
std::optional<PlacedInFull> placed_in_full(PlacedInFull start, const FitData& data,
                                           WorkBudget& work) {
  constexpr int kMostWalks = 10;  // with a tenth of an error left by each, to rounding
  constexpr double kSame = 1e-6;  // of chi-square: a thousandth of a deviation
  PlacedInFull placed = std::move(start);
  for (int walk = 0; walk < kMostWalks; ++walk) {
    const FitData weighed = weighed_across(placed.canonical, data, data);
    const auto fit = polish(placed.fit, weighed, work);
    auto canonical = fit ? to_canonical(*fit, weighed) : std::nullopt;
    if (!canonical) {
      return std::nullopt;
    }
    const bool same = std::abs(fit->chi2 - placed.fit.chi2) <= kSame;
    placed = {*fit, *std::move(canonical)};
    if (same || !work.allows()) {
      break;
    }
  }
  return placed;
}

/// The normals of strokes that the curve leaves beyond noise, single ones: more than may be set
/// aside are a misfit, as of samples.
std::vector<std::size_t> wrong_normals(const CanonicalFit& placed, const FitData& data) {
  std::vector<double> misses;
  for (std::size_t i = 0; i < data.details.size(); ++i) {
    if (data.details[i].inverse_normal_sigma > 0.0) {
      misses.push_back(std::abs(placed.points[i].normal_residual));
    }
  }
  const double limit = kNegligibleDeviations * std::max(1.0, median_of(misses) / kMedianOfNormal);
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < data.details.size(); ++i) {
    if (data.details[i].inverse_normal_sigma > 0.0 &&
        std::abs(placed.points[i].normal_residual) > limit) {
      wrong.push_back(i);
    }
  }
  return wrong.size() <= most_set_aside(misses.size()) ? wrong : std::vector<std::size_t>{};
}

/// Of the normals along strokes that count.
double squares_of_normals(const CanonicalFit& placed, const FitData& data) {
  double squares = 0.0;
  for (std::size_t i = 0; i < data.details.size(); ++i) {
    if (data.details[i].inverse_normal_sigma > 0.0 && has_normal(data.points[i])) {
      squares += placed.points[i].normal_residual * placed.points[i].normal_residual;
    }
  }
  return squares;
}

/// Form error moves places: normals count as they are.
double counted_in_full(double chi2, double of_normals, const Weighing& w) {
  const Likelihood& law = w.seen.likelihood ? *w.seen.likelihood : w.stated;
  return misfit_of(chi2 - of_normals, law) + of_normals;
}

/// Reduced points with the normals of their samples: each turned from the path's as they are in the
/// mean, so that how the path turns from sample to sample does not matter.
FitData reduced_with_normals(const Weighing& w, const FitData& data) {
  FitData reduced = w.reduced;
  std::vector<double> information(reduced.points.size(), 0.0);
  std::vector<double> turn(reduced.points.size(), 0.0);
  for (std::size_t i = 0; i < data.details.size(); ++i) {
    const FitPoint& point = data.points[i];
    if (data.details[i].inverse_normal_sigma > 0.0 && has_normal(point) &&
        !point.tangent.isZero()) {
      const std::size_t k = w.smooth.nearest_reduced[i];
      const double weight = point.inverse_normal_sigma * point.inverse_normal_sigma;
      information[k] += weight;
      turn[k] -= weight * normal_miss(point.normal, left_of(point.tangent));
    }
  }
  for (std::size_t k = 0; k < reduced.points.size(); ++k) {
    FitPoint& point = reduced.points[k];
    if (information[k] > 0.0 && !point.tangent.isZero()) {
      point.normal = Eigen::Rotation2Dd(turn[k] / information[k]) * left_of(point.tangent);
      point.inverse_normal_sigma = std::sqrt(information[k]);
      reduced.normals_along_strokes = true;
    }
  }
  return reduced;
}

}  // namespace

FitData weighed_across(const CanonicalFit& placed, const FitData& open, FitData data) {
  const double rounding = rounding_level(data);
  for (std::size_t i = 0; i < data.details.size(); ++i) {
    if (open.details[i].covariance.x() > 0.0) {
      weigh_across(data.frame.rotate_back(placed.points[i].normal), rounding, &data.details[i],
                   &data.points[i]);
    }
  }
  return data;
}

Weighing best_in_full(Weighing w, const FitData& data, WorkBudget& work) {
  if (!w.canonical[w.best] || !w.fits[w.best]->on_all) {
    return w;
  }
  FitData full = w.data;
  for (std::size_t i = 0; i < full.details.size(); ++i) {
    full.details[i].covariance = data.details[i].covariance;
    // As measured: noise along a stroke makes no curve lean that all strokes hold, and where they
    // were moved to is known only as well as each path (smooth/across_noise.h).
    full.points[i].position = data.points[i].position;
  }
  if (!w.seen.correlated && !(w.seen.correlation_length > 0.0)) {
    give_normals(&full);
  }
  auto placed = placed_in_full({*w.fits[w.best], *w.canonical[w.best]}, full, work);
  const auto wrong = placed && full.normals_along_strokes ? wrong_normals(placed->canonical, full)
                                                          : std::vector<std::size_t>{};
  for (const std::size_t i : wrong) {
    full.points[i].inverse_normal_sigma = 0.0;
  }
  if (!wrong.empty()) {
    placed = placed_in_full(*std::move(placed), full, work);
  }
  if (!placed) {  // no curve of the class has these places and normals
    w.counted_chi2 = std::numeric_limits<double>::infinity();
    return w;
  }
  if (full.normals_along_strokes) {
    w.reduced = reduced_with_normals(w, full);
    w.best_on_reduced =
        to_canonical(settled(*w.coarse[w.best], w.reduced, RivalOf::Best, work), w.reduced);
    w.best_evidence = w.best_on_reduced
                          ? evidence_of(*w.best_on_reduced, w.reduced, w.inflation, work)
                          : std::nullopt;
    w.residuals[w.best] = residual_count(full);
  }
  for (std::size_t i = 0; i < full.details.size(); ++i) {
    PointDetail& left = w.data.details[i];
    left.covariance.setZero();
    if (has_normal(full.points[i])) {
      left.inverse_normal_sigma = 0.0;
    }
  }
  w.counted_chi2 =
      counted_in_full(placed->fit.chi2, squares_of_normals(placed->canonical, full), w);
  w.fits[w.best] = std::move(placed->fit);
  w.canonical[w.best] = std::move(placed->canonical);
  return w;
}

}  // namespace palpate

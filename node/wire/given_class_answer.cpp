#include "node/wire/given_class_answer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/curves/curve.h"
#include "core/qualification/probe_correction.h"
#include "core/qualification/probe_residuals.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/given_correlation.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/joined_runs.h"
#include "core/recognition/verdict/determined.h"
#include "node/wire/convert.h"

namespace palpate {
namespace {

v1::GivenClassStatus to_wire(GivenStatus status) {
  switch (status) {
    case GivenStatus::Fitted:
      return v1::GIVEN_CLASS_STATUS_FITTED;
    case GivenStatus::NotFinite:
      return v1::GIVEN_CLASS_STATUS_NOT_FINITE;
    case GivenStatus::TooFewPoints:
      return v1::GIVEN_CLASS_STATUS_TOO_FEW_POINTS;
    case GivenStatus::Collinear:
      return v1::GIVEN_CLASS_STATUS_COLLINEAR;
    case GivenStatus::AtLimit:
      return v1::GIVEN_CLASS_STATUS_AT_LIMIT;
    case GivenStatus::Unfinished:
      return v1::GIVEN_CLASS_STATUS_UNFINISHED;
    case GivenStatus::NotDetermined:
      return v1::GIVEN_CLASS_STATUS_NOT_DETERMINED;
  }
  return v1::GIVEN_CLASS_STATUS_UNSPECIFIED;
}

/// A vector from the direction of travel at sample i towards the material; zero if the material
/// side is not known.
Vec2 into_material(const ProbedPatch& run, std::size_t i) {
  if (run.context.material_side == MaterialSide::Unspecified) {
    return Vec2::Zero();
  }
  const Vec2 travel = run.samples[std::min(i + 1, run.samples.size() - 1)].position_m -
                      run.samples[i > 0 ? i - 1 : 0].position_m;
  return run.context.material_side == MaterialSide::Left ? left_of(travel) : -left_of(travel);
}

/// The points of a fit, from runs whose probe offsets are already subtracted. `set_aside`: places
/// of points that do not count.
std::vector<GivenPoint> points_of(std::span<const ProbedPatch> runs,
                                  std::span<const std::size_t> set_aside) {
  std::vector<GivenPoint> points;
  std::size_t stroke = 0;
  for (const ProbedPatch& run : runs) {
    const std::vector<SampleDetail>& details = run.details;
    ++stroke;
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      GivenPoint point;
      point.position_m = run.samples[i].position_m;
      point.sigma_m = run.samples[i].sigma_m;
      point.tip_radius_m = run.context.tip_radius_m;
      point.into_material = into_material(run, i);
      point.stroke = stroke;
      if (!details.empty()) {
        point.normal = details[i].normal;
        point.normal_sigma_rad = details[i].normal_sigma_rad;
        point.covariance_m2 = details[i].covariance_m2;
        // A measured normal is more reliable than the direction of travel.
        if (details[i].normal_sigma_rad > 0.0) point.into_material = -details[i].normal;
      }
      points.push_back(point);
    }
  }
  for (const std::size_t place : set_aside) points.at(place).set_aside = true;
  return points;
}

/// A fit, and the points that it was made from.
struct PointsFitted {
  std::vector<GivenPoint> points;
  GivenFit fit;
  /// The largest chi-square that the noise, and the deviation of the probes' files, may leave.
  double most_chi2 = 0.0;
};

PointsFitted fit_runs(CurveClass curve_class, std::span<const ContactRun> runs,
                      std::span<const ProbeCharacter* const> probes,
                      std::span<const std::size_t> set_aside, const GivenOptions& options) {
  std::vector<ProbedPatch> raw;
  for (const ContactRun& run : runs) {
    const ProbeCharacter* probe = probes.empty() ? nullptr : probes[run.context.probe];
    raw.push_back(as_qualified({run.context, run.samples, probe, run.details}));
  }
  const bool probed = std::any_of(raw.begin(), raw.end(),
                                  [](const ProbedPatch& run) { return run.probe != nullptr; });
  std::vector<ProbedPatch> corrected = raw;
  PointsFitted fitted;
  for (int round = 0;; ++round) {
    fitted.points = points_of(corrected, set_aside);
    fitted.fit = fit_given_class(curve_class, fitted.points, options);
    const auto curve = probed && has_curve(fitted.fit)
                           ? make_curve(curve_class, fitted.fit.shape.values)
                           : std::nullopt;
    if (curve && round == kCorrectionRounds) {
      fitted.fit.covariance +=
          covariance_of_probes(*curve, fitted.fit.world_T_curve, corrected, options.touched_from);
    }
    if (!curve || round == kCorrectionRounds) {
      fitted.most_chi2 = most_chi2_of_probes(corrected, fitted.fit.dof);
      return fitted;
    }
    for (std::size_t i = 0; i < raw.size(); ++i) {
      corrected[i].samples =
          without_offset(raw[i], *curve, fitted.fit.world_T_curve, options.touched_from);
    }
  }
}

double half_extent_m(std::span<const GivenPoint> points) {
  Vec2 low = points.front().position_m;
  Vec2 high = low;
  for (const GivenPoint& point : points) {
    low = low.cwiseMin(point.position_m);
    high = high.cwiseMax(point.position_m);
  }
  return 0.5 * (high - low).maxCoeff();
}

/// Whether another shape of the class is nearly as probable.
bool has_rival(const GivenFit& fit, double recognized_probability) {
  return fit.rival && !(fit.rival->log_odds > log_odds(recognized_probability));
}

void write_verdict(const PointsFitted& fitted, const RecognizerOptions& options,
                   v1::Recognition& answer) {
  const GivenFit& fit = fitted.fit;
  // Deviations are those of the noise and of the probes: of residuals that these cannot have left
  // they say nothing.
  const bool by_noise = !fit.sigma_stated || fit.dof <= 0 || fit.chi2 <= fitted.most_chi2;
  const bool determined = fit.status == GivenStatus::Fitted && fit.bounded &&
                          is_determined(fit.shape, fit.covariance, half_extent_m(fitted.points),
                                        options.determined_fraction);
  answer.set_status(v1::RECOGNITION_STATUS_AMBIGUOUS);
  if (!by_noise) {
    answer.set_doubt(v1::RECOGNITION_DOUBT_MISFIT);
  } else if (has_rival(fit, options.recognized_probability)) {
    answer.set_doubt(v1::RECOGNITION_DOUBT_TWO_SHAPES);
  } else if (!determined) {
    answer.set_doubt(v1::RECOGNITION_DOUBT_UNDETERMINED);
  } else {
    answer.set_status(v1::RECOGNITION_STATUS_RECOGNIZED);
  }
}

void write_curve(CurveClass curve_class, const GivenFit& fit, v1::Recognition& answer) {
  palpate::to_wire(fit.shape, *answer.mutable_parameters());
  palpate::to_wire(fit.world_T_curve, *answer.mutable_pose());
  answer.set_pose_symmetry(static_cast<std::uint32_t>(pose_symmetry(curve_class)));
  palpate::to_wire(fit.covariance, *answer.mutable_covariance());
  answer.set_sigma_m(fit.sigma_m);
  v1::Hypothesis& hypothesis = *answer.mutable_hypotheses(0);
  *hypothesis.mutable_parameters() = answer.parameters();
  *hypothesis.mutable_pose() = answer.pose();
  hypothesis.set_chi2(fit.chi2);
  hypothesis.set_dof(static_cast<std::uint32_t>(std::max(fit.dof, 0)));
}

void write_rival(const GivenFit& fit, v1::Recognition& answer) {
  v1::Hypothesis& rival = *answer.add_hypotheses();
  v1::Hypothesis& first = *answer.mutable_hypotheses(0);
  first.set_probability(1.0 / (1.0 + std::exp(-fit.rival->log_odds)));
  rival.set_curve_class(answer.curve_class());
  rival.set_probability(1.0 - first.probability());
  palpate::to_wire(fit.rival->shape, *rival.mutable_parameters());
  palpate::to_wire(fit.rival->world_T_curve, *rival.mutable_pose());
  rival.set_chi2(fit.rival->chi2);
  rival.set_dof(first.dof());
}

/// `place_of`: of each sample in the file's order, its place among the points.
void write_form(const PointsFitted& fitted, std::span<const std::size_t> place_of,
                v1::GivenClassAnswer& given) {
  const GivenFit& fit = fitted.fit;
  given.set_rms_m(fit.rms_m);
  given.set_peak_to_valley_m(fit.peak_to_valley_m);
  const bool has_normals =
      std::any_of(fitted.points.begin(), fitted.points.end(),
                  [](const GivenPoint& point) { return point.normal_sigma_rad > 0.0; });
  for (const std::size_t place : place_of) {
    given.add_residual_m(fit.residuals[place].distance_m);
    if (has_normals) given.add_residual_normal_rad(fit.residuals[place].normal_rad);
  }
  given.set_normal_count(fit.normals);
}

}  // namespace

v1::GivenClassAnswer given_class_answer(CurveClass curve_class, std::span<const ContactRun> runs,
                                        std::span<const ProbeCharacter* const> probes,
                                        std::span<const std::size_t> left_out,
                                        const RecognizerOptions& options) {
  const JoinedRuns joined = joined_runs(runs);
  std::vector<std::size_t> set_aside;
  for (const std::size_t number : left_out) set_aside.push_back(joined.place_of.at(number - 1));
  PointsFitted fitted = fit_runs(curve_class, joined.runs, probes, set_aside,
                                 {options.sigma_m, options.touched_from});
  GivenFit& fit = fitted.fit;
  v1::GivenClassAnswer given;
  v1::Recognition& answer = *given.mutable_recognition();
  given.set_status(to_wire(fit.status));
  given.set_sigma_stated(fit.sigma_stated);
  for (const std::size_t number : left_out) {
    given.add_left_out(static_cast<std::uint32_t>(number));
  }
  answer.set_curve_class(to_wire(curve_class));
  answer.set_sample_count(fitted.points.size() - left_out.size());
  v1::Hypothesis& hypothesis = *answer.add_hypotheses();
  hypothesis.set_curve_class(answer.curve_class());
  hypothesis.set_probability(1.0);
  const bool at_limit = fit.status == GivenStatus::AtLimit;
  if (at_limit || !has_curve(fit)) {
    hypothesis.set_at_limit(at_limit);
    answer.set_status(v1::RECOGNITION_STATUS_AMBIGUOUS);
    answer.set_doubt(at_limit ? v1::RECOGNITION_DOUBT_AT_LIMIT
                              : v1::RECOGNITION_DOUBT_UNDETERMINED);
    return given;
  }
  answer.set_noise_correlation_m(count_correlation(fitted.points, &fit).length);
  write_verdict(fitted, options, answer);
  write_curve(curve_class, fit, answer);
  if (has_rival(fit, options.recognized_probability)) write_rival(fit, answer);
  write_form(fitted, joined.place_of, given);
  return given;
}

}  // namespace palpate

#include "node/tool/drawing/drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace palpate {
namespace {

// With this many chords, an ellipse that fills 1000 pixels is off by at most 0.03 pixels.
constexpr int kCurvePieces = 240;
constexpr int kRivalPieces = 120;
// Less probable hypotheses are listed but not drawn.
constexpr double kWorthDrawing = 1e-3;
// Number of touched points that determine how far an open curve is drawn.
constexpr std::size_t kMostForSpan = 128;

/// Contacts and some of the samples, because a patch too short for a contact has samples too.
std::vector<Vec2> touched_points(const ContactGroup& group, const v1::Recognition& answer) {
  std::vector<Vec2> points;
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    points.emplace_back(contact.x_m(), contact.y_m());
  }
  std::size_t count = 0;
  for (const ContactRun& run : group.runs) count += run.samples.size();
  const std::size_t step = count / kMostForSpan + 1;
  std::size_t index = 0;
  for (const ContactRun& run : group.runs) {
    // Both ends of every run, if there are few runs.
    const bool ends = group.runs.size() < kMostForSpan;
    for (std::size_t i = 0; i < run.samples.size(); ++i, ++index) {
      const bool is_end = i == 0 || i + 1 == run.samples.size();
      if (index % step == 0 || (ends && is_end)) points.push_back(run.samples[i].position_m);
    }
  }
  return points;
}

/// The band and the curvature's deviation change slowly along the curve and take most of the time
/// of a drawing. They are computed at every fourth place and interpolated between.
constexpr std::size_t kStep = 4;
static_assert(kCurvePieces % kStep == 0);

double between(double before, double after, double part) {
  return (1.0 - part) * before + part * after;
}

void add_band(const CurveModel& model, std::vector<CurvePlace>& places) {
  for (std::size_t i = 0; i < places.size(); i += kStep) {
    places[i].band = band_at(model, places[i].t);
    if (!places[i].band) return;
    for (std::size_t k = 1; i > 0 && k < kStep; ++k) {
      const double part = static_cast<double>(k) / kStep;
      const BandWidth& before = *places[i - kStep].band;
      const BandWidth& after = *places[i].band;
      places[i - kStep + k].band = BandWidth{between(before.left_m, after.left_m, part),
                                             between(before.right_m, after.right_m, part)};
    }
  }
}

void add_curvature(const CurveModel& model, std::vector<CurvePlace>& places) {
  for (CurvePlace& place : places) {
    const LocalGeometry local = geometry(model.curve, place.t);
    place.kappa = local.kappa;
    place.kappa_s = local.kappa_s;
  }
  const CurvatureDeviation deviation(model);
  for (std::size_t i = 0; i < places.size(); i += kStep) {
    places[i].kappa_sigma = deviation.at(places[i].t);
    if (!places[i].kappa_sigma) return;
    for (std::size_t k = 1; i > 0 && k < kStep; ++k) {
      places[i - kStep + k].kappa_sigma = between(
          *places[i - kStep].kappa_sigma, *places[i].kappa_sigma, static_cast<double>(k) / kStep);
    }
  }
}

std::vector<CurvePlace> sampled(const CurveModel& model, const CurveSpan& span, int pieces) {
  std::vector<CurvePlace> places;
  places.reserve(static_cast<std::size_t>(pieces) + 1);
  double arc = 0.0;
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(model.world_T_curve.theta).toRotationMatrix();
  for (int i = 0; i <= pieces; ++i) {
    const double t = span.from + (span.to - span.from) * i / pieces;
    const CurveDerivatives at = derivatives(model.curve, t);
    const Vec2 position = rotation * at.position + model.world_T_curve.translation();
    const double speed = at.first.norm();
    const Vec2 left = speed > 0.0 ? Vec2(rotation * left_of(at.first / speed)) : Vec2(0.0, 0.0);
    if (!places.empty()) arc += (position - places.back().position).norm();
    places.push_back({t, position, left, arc, std::nullopt, 0.0, 0.0, std::nullopt});
  }
  return places;
}

std::optional<DrawnCurve> draw(const std::optional<CurveModel>& model, v1::CurveClass curve_class,
                               double probability, std::span<const Vec2> touched, int pieces) {
  if (!model) return std::nullopt;
  const auto span = drawn_span(*model, touched);
  if (!span) return std::nullopt;
  return DrawnCurve{curve_class, probability, span->closed, sampled(*model, *span, pieces)};
}

double probability_of(const v1::Recognition& answer) {
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    if (hypothesis.curve_class() == answer.curve_class()) return hypothesis.probability();
  }
  return 0.0;
}

/// Arc length at t, interpolated from the first place; nullopt if t is not finite (answers come
/// from the network).
std::optional<double> arc_at(const DrawnCurve& curve, double t) {
  const CurvePlace& first = curve.places.front();
  const CurvePlace& last = curve.places.back();
  if (curve.closed) t = first.t + std::remainder(t - first.t - kPi, 2.0 * kPi) + kPi;
  const double pieces = static_cast<double>(curve.places.size() - 1);
  const double place = std::clamp((t - first.t) / (last.t - first.t), 0.0, 1.0) * pieces;
  if (!std::isfinite(place)) return std::nullopt;
  const auto before = static_cast<std::size_t>(std::min(std::floor(place), pieces - 1.0));
  const double part = place - static_cast<double>(before);
  return (1.0 - part) * curve.places[before].arc_m + part * curve.places[before + 1].arc_m;
}

std::vector<DrawnContact> draw_contacts(const v1::Recognition& answer,
                                        const std::optional<CurveModel>& model,
                                        const std::optional<DrawnCurve>& curve) {
  std::vector<DrawnContact> drawn;
  double along = 0.0;
  const v1::LocalizedContact* before = nullptr;
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    DrawnContact place{&contact, 0.0, contact.kappa_per_m()};
    if (curve) {
      const std::optional<double> arc_m = arc_at(*curve, contact.t());
      if (!arc_m) continue;
      place.arc_m = *arc_m;
      const double tangent =
          geometry(model->curve, contact.t()).tangent_angle + model->world_T_curve.theta;
      if (std::cos(contact.tangent_rad() - tangent) < 0.0) place.kappa = -place.kappa;
    } else {
      if (before != nullptr) {
        along += std::hypot(contact.x_m() - before->x_m(), contact.y_m() - before->y_m());
      }
      place.arc_m = along;
    }
    before = &contact;
    drawn.push_back(place);
  }
  return drawn;
}

double noise_of(const ContactSample& sample, double sigma_m) {
  return sample.sigma_m > 0.0 ? sample.sigma_m : sigma_m;
}

struct NearFoot {
  double t = 0.0;
  double distance = 0.0;  ///< positive to the left
};

double curvature_of(const CurveDerivatives& d) {
  const double speed = d.first.norm();
  return std::abs(cross(d.first, d.second)) / (speed * speed * speed);
}

/// The foot point by one Newton step from a near one, which takes half the time of full
/// convergence. nullopt if the step leads away, or if the distance may be wrong by more than
/// `tolerance`. On a circle of curvature kappa, a remaining component `along` the tangent makes the
/// distance wrong by kappa along^2 / (2 (1 - kappa distance)), which is below kappa along^2 for
/// kappa distance < 1/2.
std::optional<NearFoot> foot_by_one_step(const Curve& curve, const Vec2& point, double t,
                                         double tolerance) {
  const CurveDerivatives before = derivatives(curve, t);
  const Vec2 away = before.position - point;
  const double second = before.first.squaredNorm() + away.dot(before.second);
  if (!(second > 0.0)) return std::nullopt;
  t -= away.dot(before.first) / second;
  const CurveDerivatives there = derivatives(curve, t);
  const Vec2 beside = point - there.position;
  const Vec2 tangent = there.first.normalized();
  const double along = tangent.dot(beside);
  const double distance = cross(tangent, beside);
  // At least the larger of the two.
  const double kappa = curvature_of(before) + curvature_of(there);
  const bool is_near = beside.squaredNorm() <= away.squaredNorm() &&
                       kappa * std::abs(distance) < 0.5 && kappa * along * along <= tolerance;
  return is_near ? std::optional(NearFoot{t, distance}) : std::nullopt;
}

}  // namespace

double widest_band_m(const DrawnCurve& curve) {
  double widest_m = 0.0;
  for (const CurvePlace& place : curve.places) {
    if (place.band) widest_m = std::max({widest_m, place.band->left_m, -place.band->right_m});
  }
  return widest_m;
}

Drawing make_drawing(const ContactGroup& group, const v1::Recognition& answer,
                     Curvature curvature) {
  const std::vector<Vec2> touched = touched_points(group, answer);
  const std::optional<CurveModel> model = model_of(answer);
  Drawing drawing;
  drawing.curve = draw(model, answer.curve_class(), probability_of(answer), touched, kCurvePieces);
  if (drawing.curve) add_band(*model, drawing.curve->places);
  if (drawing.curve && curvature == Curvature::Along) {
    add_curvature(*model, drawing.curve->places);
  }
  drawing.contacts = draw_contacts(answer, model, drawing.curve);
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    if (hypothesis.curve_class() == answer.curve_class() ||
        !(hypothesis.probability() >= kWorthDrawing)) {
      continue;
    }
    const std::optional<CurveModel> other = model_of(hypothesis);
    auto rival =
        draw(other, hypothesis.curve_class(), hypothesis.probability(), touched, kRivalPieces);
    if (!rival) continue;
    if (curvature == Curvature::Along) add_curvature(*other, rival->places);
    drawing.rivals.push_back(std::move(*rival));
  }
  return drawing;
}

std::vector<SampleResidual> residuals_of(const CurveModel& model, const ContactRun& run,
                                         double sigma_m) {
  std::vector<SampleResidual> residuals;
  residuals.reserve(run.samples.size());
  // As a fraction of the noise; too small to be seen.
  constexpr double kTolerance = 1e-3;
  const ToLocal to_curve(model.world_T_curve);
  double sum = 0.0;
  for (const ContactSample& sample : run.samples) {
    const Vec2 local = to_curve(sample.position_m);
    std::optional<NearFoot> foot;
    if (!residuals.empty()) {
      foot = foot_by_one_step(model.curve, local, residuals.back().t,
                              kTolerance * noise_of(sample, sigma_m));
    }
    if (!foot) {
      const FootPoint exact = residuals.empty()
                                  ? foot_point(model.curve, local)
                                  : foot_point_near(model.curve, local, residuals.back().t);
      foot = {exact.t, exact.distance};
    }
    sum += foot->distance;
    residuals.push_back({foot->t, foot->distance, false});
  }
  // The centres of a tip lie on one side of the curve, one radius away.
  const double tip = std::copysign(run.context.tip_radius_m, sum);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    residuals[i].residual_m -= tip;
    residuals[i].is_far =
        std::abs(residuals[i].residual_m) > kFarSigmas * noise_of(run.samples[i], sigma_m);
  }
  return residuals;
}

}  // namespace palpate

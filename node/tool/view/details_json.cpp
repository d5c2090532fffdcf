#include "node/tool/view/details_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "node/files/quantity.h"
#include "node/tool/drawing/enlarged_residuals.h"
#include "node/tool/text/advice.h"
#include "node/tool/text/recognition_text.h"
#include "node/tool/view/picture_json.h"

namespace palpate {
namespace {

/// The largest width of the band.
std::string band_width_text(const DrawnCurve& curve) {
  const double widest_m = widest_band_m(curve);
  const LengthUnit unit = length_unit_for(widest_m);
  return with_digits(widest_m * unit.per_m, 2) + " " + std::string(unit.name);
}

template <typename ValueAt>
void write_along(const char* name, const DrawnCurve& curve, const ValueAt& value_at,
                 JsonText& json) {
  json.key(name).begin_array();
  for (const CurvePlace& at : curve.places) json.value(value_at(at), kChartDigits);
  json.end_array();
}

/// Curvature along the curve, its derivative, and their deviations.
void write_curve_chart(const DrawnCurve& curve, JsonText& json) {
  json.begin_object();
  write_along(
      "arc", curve, [](const CurvePlace& at) { return at.arc_m; }, json);
  write_along(
      "kappa", curve, [](const CurvePlace& at) { return at.kappa; }, json);
  write_along(
      "kappaS", curve, [](const CurvePlace& at) { return at.kappa_s; }, json);
  const bool is_known =
      std::all_of(curve.places.begin(), curve.places.end(),
                  [](const CurvePlace& at) { return at.kappa_sigma.has_value(); });
  if (is_known) {
    write_along(
        "kappaSigma", curve, [](const CurvePlace& at) { return *at.kappa_sigma; }, json);
  }
  json.end_object();
}

void write_contact_charts(const Drawing& drawing, JsonText& json) {
  json.begin_array();
  for (const DrawnContact& drawn : drawing.contacts) {
    const v1::LocalizedContact& contact = *drawn.contact;
    json.begin_object();
    json.member("probe", contact.probe());
    json.member("arc", drawn.arc_m, kChartDigits);
    json.member("kappa", drawn.kappa, kChartDigits);
    json.member("kappaSigma", contact.kappa_sigma_per_m(), kChartDigits);
    json.member("kappaS", contact.kappa_s_per_m2(), kChartDigits);
    json.member("kappaSSigma", contact.kappa_s_sigma_per_m2(), kChartDigits);
    json.end_object();
  }
  json.end_array();
}

void write_charts(const Drawing& drawing, JsonText& json) {
  json.begin_object();
  json.key("contacts");
  write_contact_charts(drawing, json);
  json.key("rivals").begin_array();
  for (const DrawnCurve& rival : drawing.rivals) write_curve_chart(rival, json);
  json.end_array();
  if (drawing.curve) {
    json.key("curve");
    write_curve_chart(*drawing.curve, json);
  }
  json.end_object();
}

void write_hypotheses(const v1::Recognition& answer, JsonText& json) {
  json.begin_array();
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    json.begin_object();
    json.member("class", spoken_name(hypothesis.curve_class()));
    json.member("probability", hypothesis.probability());
    json.member("chi2", hypothesis.chi2());
    json.member("dof", hypothesis.dof());
    json.member("atLimit", hypothesis.at_limit());
    json.end_object();
  }
  json.end_array();
}

void write_decisions(const v1::Recognition& answer, JsonText& json) {
  json.begin_array();
  for (const v1::Decision& decision : answer.decisions()) {
    json.begin_object();
    json.member("test", decision.test());
    json.member("value", decision.value());
    json.member("threshold", decision.threshold());
    json.member("passed", decision.passed());
    if (decision.has_p_value()) {
      json.member("pValue", decision.p_value());
    } else {
      json.key("pValue").null();
    }
    json.end_object();
  }
  json.end_array();
}

void write_invariants(const v1::Recognition& answer, JsonText& json) {
  json.begin_array();
  for (const v1::Invariant& invariant : answer.invariants()) {
    json.begin_object();
    json.member("name", invariant.name());
    json.member("class", spoken_name(invariant.curve_class()));
    json.member("text", with_sigma(invariant.value(), invariant.sigma()));
    json.end_object();
  }
  json.end_array();
}

void write_quantities(const v1::Recognition& answer, JsonText& json) {
  json.begin_array();
  for (const Quantity& quantity : quantities_of(answer)) {
    json.begin_object();
    json.member("name", quantity.name);
    json.member("value", quantity.value);
    json.member("sigma", quantity.sigma);
    json.member("text", quantity.text);
    json.end_object();
  }
  json.end_array();
}

/// Size of what was touched. An arc that is not determined yet can make the drawn curve far larger.
double touched_size_of(const LiveGroup& group, double drawn_size_m) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const ContactRun& run : group.touched.runs) {
    for (const ContactSample& sample : run.samples) {
      low = low.cwiseMin(sample.position_m);
      high = high.cwiseMax(sample.position_m);
    }
  }
  const double size = (high - low).maxCoeff();
  return size > 0.0 ? std::min(size, drawn_size_m) : drawn_size_m;
}

/// Writes the enlarged residuals as lines from the curve, and the samples far from it.
void write_residuals(const LiveGroup& group, const Drawing& drawing, JsonText& json) {
  const std::optional<CurveModel> model =
      drawing.curve ? model_of(group.answer) : std::optional<CurveModel>();
  // The view has no probe files: the curve is of corrected samples, these are as they came, and all
  // of them would be far from it.
  if (!model || !group.answer.probe_files().empty()) return;
  constexpr std::size_t kMostLines = 400;
  const double size_m = touched_size_of(group, drawn_size_m(drawing, group));
  const EnlargedResiduals residuals =
      enlarged_residuals(*model, group.touched, group.answer.sigma_m(), size_m, kMostLines);
  const StepCoordinates place = coordinates_of(drawing, group);
  json.member("step", place.step_m());
  json.key("residuals").begin_object();
  json.member("gain", residuals.gain);
  json.key("lines").begin_array();
  for (const EnlargedResiduals::Line& line : residuals.lines) {
    const auto foot = place.steps_to(line.foot);
    const auto end = place.steps_to(line.end);
    if (!foot || !end) continue;
    StepCoordinates::write(*foot, json);
    StepCoordinates::write(*end, json);
  }
  json.end_array();
  json.end_object();
  json.key("far").begin_array();
  for (const Vec2& point : residuals.far) place.write(point, json);
  json.end_array();
}

}  // namespace

const char* status_word(const v1::Recognition& answer) {
  switch (answer.status()) {
    case v1::RECOGNITION_STATUS_RECOGNIZED:
      return "recognized";
    case v1::RECOGNITION_STATUS_AMBIGUOUS:
      return "ambiguous";
    default:
      return "collecting";
  }
}

void write_details(LiveGroup& group, const Drawing& drawing, SteadyTime now, JsonText& json) {
  const v1::Recognition& answer = group.answer;
  json.begin_object();
  json.member("group", group.touched.name);
  json.member("object", std::to_string(group.touched.object));
  json.member("hasAnswer", group.has_answer);
  json.member("status", status_word(answer));
  json.member("statusText", group.has_answer ? status_text(answer) : "nothing yet");
  json.member("advice", advice_text(answer));
  json.member("class", spoken_name(answer.curve_class()));
  json.member("frame", answer.header().frame().empty() ? "world" : answer.header().frame());
  json.key("quantities");
  write_quantities(answer, json);
  json.key("hypotheses");
  write_hypotheses(answer, json);
  json.key("decisions");
  write_decisions(answer, json);
  json.key("invariants");
  write_invariants(answer, json);
  json.key("charts");
  write_charts(drawing, json);
  json.member("sampleCount", answer.sample_count());
  json.member("outlierCount", answer.outlier_count());
  json.member("dwellingCount", answer.dwelling_count());
  json.member("noise", noise_text(answer));
  json.member("noiseCorrelationMm", 1e3 * answer.noise_correlation_m(), 4);
  json.member("computeMs", 1e-6 * static_cast<double>(answer.compute_ns()), 4);
  json.member("answersPerS", group.answer_rate.per_second(now), 3);
  json.member("touchMs", 1e-6 * static_cast<double>(answer.newest_sample_stamp_ns()));
  json.member("answerMs", 1e-6 * static_cast<double>(group.answer_received_ns));
  if (drawing.curve && drawing.curve->places.front().band) {
    json.member("bandWidth", band_width_text(*drawing.curve));
  }
  write_residuals(group, drawing, json);
  json.end_object();
}

}  // namespace palpate

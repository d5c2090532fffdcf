#include "node/tool/view/details_json.h"

#include <algorithm>
#include <limits>

#include "node/tool/drawing/drawing.h"
#include "node/tool/drawing/enlarged_residuals.h"
#include "node/tool/text/advice.h"
#include "node/tool/text/quantity.h"
#include "node/tool/text/recognition_text.h"
#include "node/tool/view/json_numbers.h"
#include "node/tool/view/picture_json.h"

namespace palpate {
namespace {

using nlohmann::json;

/// Where the band is widest.
std::string band_width_text(const DrawnCurve& curve) {
  double widest_m = 0.0;
  for (const CurvePlace& place : curve.places) {
    if (place.band) widest_m = std::max({widest_m, place.band->left_m, -place.band->right_m});
  }
  const LengthUnit unit = length_unit_for(widest_m);
  return number(significant(widest_m * unit.per_m, 2)) + " " + std::string(unit.name);
}

/// Curvature along the curve, its derivative, and their deviations.
json curve_chart_json(const DrawnCurve& curve) {
  json::array_t arc, kappa, kappa_s, kappa_sigma;
  for (const CurvePlace& at : curve.places) {
    arc.emplace_back(significant(at.arc_m, kChartDigits));
    kappa.emplace_back(significant(at.kappa, kChartDigits));
    kappa_s.emplace_back(significant(at.kappa_s, kChartDigits));
    if (at.kappa_sigma) kappa_sigma.emplace_back(significant(*at.kappa_sigma, kChartDigits));
  }
  json chart{{"arc", std::move(arc)}, {"kappa", std::move(kappa)}, {"kappaS", std::move(kappa_s)}};
  if (kappa_sigma.size() == curve.places.size()) chart["kappaSigma"] = std::move(kappa_sigma);
  return chart;
}

json contact_charts_json(const Drawing& drawing) {
  json contacts = json::array();
  for (const DrawnContact& drawn : drawing.contacts) {
    const v1::LocalizedContact& contact = *drawn.contact;
    contacts.push_back(
        {{"probe", contact.probe()},
         {"arc", significant(drawn.arc_m, kChartDigits)},
         {"kappa", significant(drawn.kappa, kChartDigits)},
         {"kappaSigma", significant(contact.kappa_sigma_per_m(), kChartDigits)},
         {"kappaS", significant(contact.kappa_s_per_m2(), kChartDigits)},
         {"kappaSSigma", significant(contact.kappa_s_sigma_per_m2(), kChartDigits)}});
  }
  return contacts;
}

json charts_json(const Drawing& drawing) {
  json rivals = json::array();
  for (const DrawnCurve& rival : drawing.rivals) rivals.push_back(curve_chart_json(rival));
  json charts{{"contacts", contact_charts_json(drawing)}, {"rivals", std::move(rivals)}};
  if (drawing.curve) charts["curve"] = curve_chart_json(*drawing.curve);
  return charts;
}

json hypotheses_json(const v1::Recognition& answer) {
  json hypotheses = json::array();
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    hypotheses.push_back({{"class", spoken_name(hypothesis.curve_class())},
                          {"probability", hypothesis.probability()},
                          {"chi2", hypothesis.chi2()},
                          {"dof", hypothesis.dof()},
                          {"atLimit", hypothesis.at_limit()}});
  }
  return hypotheses;
}

json decisions_json(const v1::Recognition& answer) {
  json decisions = json::array();
  for (const v1::Decision& decision : answer.decisions()) {
    decisions.push_back({{"test", decision.test()},
                         {"value", decision.value()},
                         {"threshold", decision.threshold()},
                         {"passed", decision.passed()},
                         {"pValue", decision.has_p_value() ? json(decision.p_value()) : json()}});
  }
  return decisions;
}

json invariants_json(const v1::Recognition& answer) {
  json invariants = json::array();
  for (const v1::Invariant& invariant : answer.invariants()) {
    invariants.push_back({{"name", invariant.name()},
                          {"class", spoken_name(invariant.curve_class())},
                          {"text", with_sigma(invariant.value(), invariant.sigma())}});
  }
  return invariants;
}

json quantities_json(const v1::Recognition& answer) {
  json quantities = json::array();
  for (const Quantity& quantity : quantities_of(answer)) {
    quantities.push_back({{"name", quantity.name},
                          {"value", quantity.value},
                          {"sigma", quantity.sigma},
                          {"text", quantity.text}});
  }
  return quantities;
}

/// Of what was touched; an arc not yet determined makes the drawn curve far larger.
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

/// Lines from the curve to the samples, enlarged; and the samples that are far from it.
void add_residuals(const LiveGroup& group, const Drawing& drawing, json& details) {
  const std::optional<CurveModel> model =
      drawing.curve ? model_of(group.answer) : std::optional<CurveModel>();
  if (!model) return;
  constexpr std::size_t kMostLines = 400;
  const double size_m = touched_size_of(group, drawn_size_m(drawing, group));
  const EnlargedResiduals residuals =
      enlarged_residuals(*model, group.touched, group.answer.sigma_m(), size_m, kMostLines);
  const StepCoordinates place = coordinates_of(drawing, group);
  json::array_t lines;
  for (const EnlargedResiduals::Line& line : residuals.lines) {
    json::array_t ends;
    if (place.add(ends, line.foot) && place.add(ends, line.end)) {
      lines.insert(lines.end(), ends.begin(), ends.end());
    }
  }
  json::array_t far;
  for (const Vec2& point : residuals.far) place.add(far, point);
  details["step"] = place.step_m();
  details["residuals"] = {{"gain", residuals.gain}, {"lines", std::move(lines)}};
  details["far"] = std::move(far);
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

json details_json(LiveGroup& group, SteadyTime now) {
  const v1::Recognition& answer = group.answer;
  const Drawing drawing = make_drawing(group.touched, answer, Curvature::Along);
  const LengthUnit noise_unit = length_unit_for(answer.sigma_m());
  json details{
      {"group", group.touched.name},
      {"object", std::to_string(group.touched.object)},
      {"hasAnswer", group.has_answer},
      {"status", status_word(answer)},
      {"statusText", group.has_answer ? status_text(answer) : "nothing yet"},
      {"advice", advice_text(answer)},
      {"class", spoken_name(answer.curve_class())},
      {"frame", answer.header().frame().empty() ? "world" : answer.header().frame()},
      {"quantities", quantities_json(answer)},
      {"hypotheses", hypotheses_json(answer)},
      {"decisions", decisions_json(answer)},
      {"invariants", invariants_json(answer)},
      {"charts", charts_json(drawing)},
      {"sampleCount", answer.sample_count()},
      {"outlierCount", answer.outlier_count()},
      {"noise", number(answer.sigma_m() * noise_unit.per_m) + " " + std::string(noise_unit.name)},
      {"noiseCorrelationMm", significant(1e3 * answer.noise_correlation_m(), 4)},
      {"computeMs", significant(1e-6 * static_cast<double>(answer.compute_ns()), 4)},
      {"answersPerS", significant(group.answer_rate.per_second(now), 3)},
      {"touchMs", 1e-6 * static_cast<double>(answer.newest_sample_stamp_ns())},
      {"answerMs", 1e-6 * static_cast<double>(group.answer_received_ns)}};
  if (drawing.curve && drawing.curve->places.front().band) {
    details["bandWidth"] = band_width_text(*drawing.curve);
  }
  add_residuals(group, drawing, details);
  return details;
}

}  // namespace palpate

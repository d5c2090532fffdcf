#include "node/tool/view/picture_json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/tool/drawing/drawing.h"
#include "node/tool/drawing/enlarged_residuals.h"
#include "node/tool/drawing/pose_ellipse.h"
#include "node/tool/text/advice.h"
#include "node/tool/text/quantity.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

using nlohmann::json;

/// A number to so many significant digits: short in text.
double significant(double value, int digits) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double power = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(power) && power > 0.0 ? std::round(value * power) / power : value;
}

constexpr int kChartDigits = 5;

/// Coordinates relative to an origin, as short as the picture's size allows.
class Place {
 public:
  /// A millionth of the size, rounded down to a power of ten: at 1000 pixels a thousandth of one.
  Place(const Vec2& origin_m, double size_m) : origin_m_(origin_m) {
    constexpr double kFraction = 1e-6;
    const double power = std::floor(std::log10(kFraction * size_m));
    // One over a power of ten is exact for the steps of real parts, and prints short.
    per_step_ = std::isfinite(power) ? std::pow(10.0, -power) : 0.0;
  }

  void add(json& numbers, const Vec2& point) const {
    numbers.push_back(rounded(point.x() - origin_m_.x()));
    numbers.push_back(rounded(point.y() - origin_m_.y()));
  }

 private:
  double rounded(double value) const {
    return per_step_ > 0.0 ? std::round(value * per_step_) / per_step_ : value;
  }

  Vec2 origin_m_;
  double per_step_ = 0.0;
};

double size_of(const Drawing& drawing, const LiveGroup& group) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  const auto include = [&](const Vec2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  };
  if (drawing.curve) {
    for (const CurvePlace& place : drawing.curve->places) include(place.position);
  }
  for (const ContactRun& run : group.touched.runs) {
    include(run.samples.front().position_m);
    include(run.samples.back().position_m);
  }
  const double size = (high - low).maxCoeff();
  return std::isfinite(size) && size > 0.0 ? size : 1.0;
}

/// Where the band is widest.
std::string band_width_text(const DrawnCurve& curve) {
  double widest_m = 0.0;
  for (const CurvePlace& place : curve.places) {
    if (place.band) widest_m = std::max({widest_m, place.band->left_m, -place.band->right_m});
  }
  const LengthUnit unit = length_unit_for(widest_m);
  return number(significant(widest_m * unit.per_m, 2)) + " " + std::string(unit.name);
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

json curve_json(const DrawnCurve& curve, const Place& place) {
  json points = json::array();
  json left = json::array();
  json right = json::array();
  json arc = json::array();
  json kappa = json::array();
  json kappa_sigma = json::array();
  json kappa_s = json::array();
  bool has_band = !curve.places.empty();
  for (const CurvePlace& at : curve.places) {
    place.add(points, at.position);
    arc.push_back(significant(at.arc_m, kChartDigits));
    kappa.push_back(significant(at.kappa, kChartDigits));
    kappa_s.push_back(significant(at.kappa_s, kChartDigits));
    if (at.kappa_sigma) kappa_sigma.push_back(significant(*at.kappa_sigma, kChartDigits));
    has_band = has_band && at.band.has_value();
    if (at.band) {
      place.add(left, at.position + at.band->left_m * at.left);
      place.add(right, at.position + at.band->right_m * at.left);
    }
  }
  json result{{"class", spoken_name(curve.curve_class)},
              {"probability", curve.probability},
              {"closed", curve.closed},
              {"points", std::move(points)},
              {"arc", std::move(arc)},
              {"kappa", std::move(kappa)},
              {"kappaS", std::move(kappa_s)}};
  if (has_band) {
    result["bandWidth"] = band_width_text(curve);
    result["left"] = std::move(left);
    result["right"] = std::move(right);
  }
  if (kappa_sigma.size() == curve.places.size()) result["kappaSigma"] = std::move(kappa_sigma);
  return result;
}

json contacts_json(const Drawing& drawing, const Place& place) {
  json contacts = json::array();
  for (const DrawnContact& drawn : drawing.contacts) {
    const v1::LocalizedContact& contact = *drawn.contact;
    json at = json::array();
    place.add(at, {contact.x_m(), contact.y_m()});
    contacts.push_back(
        {{"probe", contact.probe()},
         {"patch", contact.patch()},
         {"at", std::move(at)},
         {"tangent", contact.tangent_rad()},
         {"arc", significant(drawn.arc_m, kChartDigits)},
         {"kappa", significant(drawn.kappa, kChartDigits)},
         {"kappaSigma", significant(contact.kappa_sigma_per_m(), kChartDigits)},
         {"kappaS", significant(contact.kappa_s_per_m2(), kChartDigits)},
         {"kappaSSigma", significant(contact.kappa_s_sigma_per_m2(), kChartDigits)}});
  }
  return contacts;
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

/// Lines from the curve to the samples, enlarged; and the samples that are far from it.
void add_residuals(const LiveGroup& group, const Drawing& drawing, const Place& place,
                   double size_m, json& picture) {
  const std::optional<CurveModel> model =
      drawing.curve ? model_of(group.answer) : std::optional<CurveModel>();
  if (!model) return;
  constexpr std::size_t kMostLines = 400;
  const EnlargedResiduals residuals =
      enlarged_residuals(*model, group.touched, group.answer.sigma_m(), size_m, kMostLines);
  json lines = json::array();
  for (const EnlargedResiduals::Line& line : residuals.lines) {
    place.add(lines, line.foot);
    place.add(lines, line.end);
  }
  json far = json::array();
  for (const Vec2& point : residuals.far) place.add(far, point);
  picture["residuals"] = {{"gain", residuals.gain}, {"lines", std::move(lines)}};
  picture["far"] = std::move(far);
}

double seconds_between(SteadyTime before, SteadyTime now) {
  return significant(std::chrono::duration<double>(now - before).count(), 4);
}

double probability_of_best(const v1::Recognition& answer) {
  return answer.hypotheses().empty() ? 0.0 : answer.hypotheses(0).probability();
}

json probes_json(const v1::NodeStatus& status, double status_age_s) {
  json probes = json::array();
  for (const v1::ProbeStatus& probe : status.probes()) {
    probes.push_back(
        {{"name", probe.probe()},
         {"group", probe.group()},
         {"alive", probe.alive()},
         {"samplesPerS", significant(probe.sample_rate_hz(), 4)},
         {"batchesPerS", significant(probe.message_rate_hz(), 4)},
         {"ageS", significant(std::max(probe.age_s(), 0.0) + status_age_s, 4)},
         {"gaps", probe.gaps()},
         {"missing", probe.missing()},
         {"restarts", probe.restarts()},
         {"rejected", probe.rejected()},
         {"latencyMs", significant(1e-6 * static_cast<double>(probe.latency_ns()), 4)}});
  }
  return probes;
}

}  // namespace

json overview_json(const LiveState& state, SteadyTime now) {
  json groups = json::array();
  for (const auto& [name, group] : state.groups()) {
    groups.push_back({{"name", name},
                      {"object", std::to_string(group.touched.object)},
                      {"status", status_word(group.answer)},
                      {"class", spoken_name(group.answer.curve_class())},
                      {"probability", probability_of_best(group.answer)},
                      {"ageS", seconds_between(group.last_heard, now)}});
  }
  json nodes = json::array();
  for (const auto& [name, node] : state.nodes()) {
    const v1::NodeStatus& status = node.status;
    const double age_s = seconds_between(node.last_heard, now);
    nodes.push_back(
        {{"name", name},
         {"version", status.version()},
         {"silentS", age_s},
         {"uptimeS", significant(status.uptime_s() + age_s, 6)},
         {"received", status.messages_received()},
         {"accepted", status.messages_accepted()},
         {"gaps", status.gaps()},
         {"missing", status.missing()},
         {"computeP50Ms", significant(1e-6 * static_cast<double>(status.compute_p50_ns()), 3)},
         {"computeP99Ms", significant(1e-6 * static_cast<double>(status.compute_p99_ns()), 3)},
         {"probes", probes_json(status, age_s)}});
  }
  return {{"groups", std::move(groups)}, {"nodes", std::move(nodes)}};
}

json picture_json(LiveGroup& group, SteadyTime now) {
  const v1::Recognition& answer = group.answer;
  const Drawing drawing = make_drawing(group.touched, answer);
  const double size_m = size_of(drawing, group);
  const Place place(group.origin_m, size_m);
  json rivals = json::array();
  for (const DrawnCurve& rival : drawing.rivals) rivals.push_back(curve_json(rival, place));
  const LengthUnit noise_unit = length_unit_for(answer.sigma_m());
  json picture{
      {"group", group.touched.name},
      {"object", std::to_string(group.touched.object)},
      {"version", group.version},
      {"origin", {group.origin_m.x(), group.origin_m.y()}},
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
      {"contacts", contacts_json(drawing, place)},
      {"rivals", std::move(rivals)},
      {"sampleCount", answer.sample_count()},
      {"outlierCount", answer.outlier_count()},
      {"noise", number(answer.sigma_m() * noise_unit.per_m) + " " + std::string(noise_unit.name)},
      {"noiseCorrelationMm", significant(1e3 * answer.noise_correlation_m(), 4)},
      {"computeMs", significant(1e-6 * static_cast<double>(answer.compute_ns()), 4)},
      {"answersPerS", significant(group.answer_rate.per_second(now), 3)},
      {"touchMs", 1e-6 * static_cast<double>(answer.newest_sample_stamp_ns())},
      {"answerMs", 1e-6 * static_cast<double>(group.answer_received_ns)}};
  if (drawing.curve) {
    picture["curve"] = curve_json(*drawing.curve, place);
    json at = json::array();
    place.add(at, {answer.pose().x_m(), answer.pose().y_m()});
    picture["pose"] = {{"at", std::move(at)}, {"theta", answer.pose().theta_rad()}};
    if (const auto model = model_of(answer); model) {
      if (const auto ellipse = pose_ellipse(*model)) {
        picture["pose"]["ellipse"] = {{"long", significant(ellipse->long_m, kChartDigits)},
                                      {"short", significant(ellipse->short_m, kChartDigits)},
                                      {"angle", significant(ellipse->angle_rad, kChartDigits)}};
      }
    }
  }
  add_residuals(group, drawing, place, touched_size_of(group, size_m), picture);
  return picture;
}

json samples_json(const LiveGroup& group, SentSamples& sent) {
  const bool anew = sent.generation != group.generation;
  if (anew) sent = {group.generation, {}};
  const auto& runs = group.touched.runs;
  sent.of_run.resize(runs.size(), 0);
  // The step of coordinates is a nanometre: finer than any probe.
  constexpr double kSizeForStep = 1e-3;
  const Place place(group.origin_m, kSizeForStep);
  json news = json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ContactRun& run = runs[i];
    std::size_t& count = sent.of_run[i];
    if (count >= run.samples.size()) continue;
    json points = json::array();
    for (std::size_t k = count; k < run.samples.size(); ++k) {
      place.add(points, run.samples[k].position_m);
    }
    count = run.samples.size();
    news.push_back({{"run", i},
                    {"probe", group.touched.probes[run.context.probe]},
                    {"patch", run.context.patch},
                    {"tipRadius", run.context.tip_radius_m},
                    {"points", std::move(points)}});
  }
  if (news.empty() && !anew) return nullptr;
  return {{"group", group.touched.name},
          {"object", std::to_string(group.touched.object)},
          {"generation", group.generation},
          {"anew", anew},
          {"received", group.samples_received},
          {"kept", group.samples_kept},
          {"origin", {group.origin_m.x(), group.origin_m.y()}},
          {"runs", std::move(news)}};
}

std::string to_text(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace palpate

#include "node/tool/view/picture_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "node/tool/drawing/pose_ellipse.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

/// Writes [x, y].
void write_place(const char* name, const StepCoordinates::Steps& steps, JsonText& json) {
  json.key(name).begin_array();
  StepCoordinates::write(steps, json);
  json.end_array();
}

void write_border(const char* name, const DrawnCurve& curve, double BandWidth::*border_m,
                  const StepCoordinates& place, JsonText& json) {
  json.key(name).begin_array();
  for (const CurvePlace& at : curve.places) {
    place.write(at.position + (*at.band).*border_m * at.left, json);
  }
  json.end_array();
}

void write_curve(const DrawnCurve& curve, const StepCoordinates& place, JsonText& json) {
  json.begin_object();
  json.member("class", spoken_name(curve.curve_class));
  json.member("probability", curve.probability);
  json.member("closed", curve.closed);
  json.key("points").begin_array();
  for (const CurvePlace& at : curve.places) place.write(at.position, json);
  json.end_array();
  const bool has_band = !curve.places.empty() &&
                        std::all_of(curve.places.begin(), curve.places.end(),
                                    [](const CurvePlace& at) { return at.band.has_value(); });
  if (has_band) {
    write_border("left", curve, &BandWidth::left_m, place, json);
    write_border("right", curve, &BandWidth::right_m, place, json);
  }
  json.end_object();
}

void write_contacts(const v1::Recognition& answer, const StepCoordinates& place, JsonText& json) {
  json.begin_array();
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    const auto at = place.steps_to({contact.x_m(), contact.y_m()});
    if (!at) continue;
    json.begin_object();
    write_place("at", *at, json);
    json.member("tangent", contact.tangent_rad(), kChartDigits);
    json.end_object();
  }
  json.end_array();
}

void write_pose(const v1::Recognition& answer, const StepCoordinates& place, JsonText& json) {
  const auto at = place.steps_to({answer.pose().x_m(), answer.pose().y_m()});
  if (!at) return;
  json.key("pose").begin_object();
  write_place("at", *at, json);
  json.member("theta", answer.pose().theta_rad());
  const std::optional<CurveModel> model = model_of(answer);
  if (const auto ellipse = model ? pose_ellipse(*model) : std::optional<PoseEllipse>()) {
    json.key("ellipse").begin_object();
    json.member("long", ellipse->long_m, kChartDigits);
    json.member("short", ellipse->short_m, kChartDigits);
    json.member("angle", ellipse->angle_rad, kChartDigits);
    json.end_object();
  }
  json.end_object();
}

/// Writes the members that both messages begin with.
void write_origin(const LiveGroup& group, const StepCoordinates& place, JsonText& json) {
  json.member("group", group.touched.name);
  json.member("object", std::to_string(group.touched.object));
  json.member("step", place.step_m());
  json.key("origin").begin_array();
  json.value(group.origin_m.x());
  json.value(group.origin_m.y());
  json.end_array();
}

}  // namespace

double drawn_size_m(const Drawing& drawing, const LiveGroup& group) {
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

StepCoordinates coordinates_of(const Drawing& drawing, const LiveGroup& group) {
  // A millionth of the size, rounded down to a power of ten: a thousandth of a pixel at 1000
  // pixels.
  constexpr double kFraction = 1e-6;
  return {group.origin_m,
          std::pow(10.0, std::floor(std::log10(kFraction * drawn_size_m(drawing, group))))};
}

void write_picture(const LiveGroup& group, const Drawing& drawing, JsonText& json) {
  const v1::Recognition& answer = group.answer;
  const StepCoordinates place = coordinates_of(drawing, group);
  json.begin_object();
  write_origin(group, place, json);
  json.member("version", group.version);
  json.member("class", spoken_name(answer.curve_class()));
  json.key("contacts");
  write_contacts(answer, place, json);
  json.key("rivals").begin_array();
  for (const DrawnCurve& rival : drawing.rivals) write_curve(rival, place, json);
  json.end_array();
  if (drawing.curve) {
    json.key("curve");
    write_curve(*drawing.curve, place, json);
    write_pose(answer, place, json);
  }
  json.member("sampleCount", answer.sample_count());
  json.member("touchMs", 1e-6 * static_cast<double>(answer.newest_sample_stamp_ns()));
  json.member("answerMs", 1e-6 * static_cast<double>(group.answer_received_ns));
  json.end_object();
}

bool has_news(const LiveGroup& group, const SentSamples& sent) {
  if (sent.generation != group.generation) return true;
  const auto& runs = group.touched.runs;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if ((i < sent.of_run.size() ? sent.of_run[i] : 0) < runs[i].samples.size()) return true;
  }
  return false;
}

void write_samples(const LiveGroup& group, SentSamples& sent, JsonText& json) {
  const bool anew = sent.generation != group.generation;
  if (anew) sent = {group.generation, {}};
  const auto& runs = group.touched.runs;
  sent.of_run.resize(runs.size(), 0);
  constexpr double kStep_m = 1e-9;  // finer than any probe
  const StepCoordinates place(group.origin_m, kStep_m);
  json.begin_object();
  write_origin(group, place, json);
  json.member("generation", group.generation);
  json.member("anew", anew);
  json.member("received", group.samples_received);
  json.member("kept", group.samples_kept);
  json.key("runs").begin_array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ContactRun& run = runs[i];
    const std::size_t known = std::exchange(sent.of_run[i], run.samples.size());
    if (known >= run.samples.size()) continue;
    json.begin_object();
    json.member("run", i);
    json.member("probe", group.touched.probes[run.context.probe]);
    json.member("patch", run.context.patch);
    json.member("tipRadius", run.context.tip_radius_m);
    json.key("points").begin_array();
    for (std::size_t k = known; k < run.samples.size(); ++k) {
      place.write(run.samples[k].position_m, json);
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

}  // namespace palpate

#include "node/tool/view/picture_json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/tool/drawing/pose_ellipse.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

using nlohmann::json;

json curve_json(const DrawnCurve& curve, const StepCoordinates& place) {
  json::array_t points, left, right;
  bool has_band = !curve.places.empty();
  for (const CurvePlace& at : curve.places) {
    place.add(points, at.position);
    has_band = has_band && at.band.has_value();
    if (!has_band) continue;
    place.add(left, at.position + at.band->left_m * at.left);
    place.add(right, at.position + at.band->right_m * at.left);
  }
  json result{{"class", spoken_name(curve.curve_class)},
              {"probability", curve.probability},
              {"closed", curve.closed},
              {"points", std::move(points)}};
  if (has_band) {
    result["left"] = std::move(left);
    result["right"] = std::move(right);
  }
  return result;
}

json contacts_json(const v1::Recognition& answer, const StepCoordinates& place) {
  json contacts = json::array();
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    json::array_t at;
    if (!place.add(at, {contact.x_m(), contact.y_m()})) continue;
    contacts.push_back(
        {{"at", std::move(at)}, {"tangent", significant(contact.tangent_rad(), kChartDigits)}});
  }
  return contacts;
}

json pose_json(const v1::Recognition& answer, const StepCoordinates& place) {
  json::array_t at;
  if (!place.add(at, {answer.pose().x_m(), answer.pose().y_m()})) return nullptr;
  json pose{{"at", std::move(at)}, {"theta", answer.pose().theta_rad()}};
  const std::optional<CurveModel> model = model_of(answer);
  if (const auto ellipse = model ? pose_ellipse(*model) : std::optional<PoseEllipse>()) {
    pose["ellipse"] = {{"long", significant(ellipse->long_m, kChartDigits)},
                       {"short", significant(ellipse->short_m, kChartDigits)},
                       {"angle", significant(ellipse->angle_rad, kChartDigits)}};
  }
  return pose;
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
  // A millionth of the size, rounded down to a power of ten: at 1000 pixels a thousandth of one.
  constexpr double kFraction = 1e-6;
  return {group.origin_m,
          std::pow(10.0, std::floor(std::log10(kFraction * drawn_size_m(drawing, group))))};
}

json picture_json(const LiveGroup& group) {
  const v1::Recognition& answer = group.answer;
  const Drawing drawing = make_drawing(group.touched, answer, Curvature::None);
  const StepCoordinates place = coordinates_of(drawing, group);
  json rivals = json::array();
  for (const DrawnCurve& rival : drawing.rivals) rivals.push_back(curve_json(rival, place));
  json picture{{"group", group.touched.name},
               {"object", std::to_string(group.touched.object)},
               {"version", group.version},
               {"origin", {group.origin_m.x(), group.origin_m.y()}},
               {"step", place.step_m()},
               {"class", spoken_name(answer.curve_class())},
               {"contacts", contacts_json(answer, place)},
               {"rivals", std::move(rivals)},
               {"sampleCount", answer.sample_count()},
               {"touchMs", 1e-6 * static_cast<double>(answer.newest_sample_stamp_ns())},
               {"answerMs", 1e-6 * static_cast<double>(group.answer_received_ns)}};
  if (drawing.curve) {
    picture["curve"] = curve_json(*drawing.curve, place);
    if (json pose = pose_json(answer, place); !pose.is_null()) picture["pose"] = std::move(pose);
  }
  return picture;
}

json samples_json(const LiveGroup& group, SentSamples& sent) {
  const bool anew = sent.generation != group.generation;
  if (anew) sent = {group.generation, {}};
  const auto& runs = group.touched.runs;
  sent.of_run.resize(runs.size(), 0);
  constexpr double kStep_m = 1e-9;  // finer than any probe
  const StepCoordinates place(group.origin_m, kStep_m);
  json news = json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ContactRun& run = runs[i];
    std::size_t& count = sent.of_run[i];
    if (count >= run.samples.size()) continue;
    json::array_t points;
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
          {"step", place.step_m()},
          {"origin", {group.origin_m.x(), group.origin_m.y()}},
          {"runs", std::move(news)}};
}

std::string to_text(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace palpate

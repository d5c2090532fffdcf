#include "node/tool/view/downloads.h"

#include <algorithm>
#include <set>
#include <utility>

#include "node/csv/contact_csv.h"
#include "node/tool/text/message_json.h"
#include "node/tool/view/details_json.h"
#include "node/tool/view/picture_json.h"

namespace palpate {
namespace {

/// Whether two strokes of a probe have one number: in a file they would be one.
bool has_number_again(const ContactGroup& touched) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  return std::any_of(touched.runs.begin(), touched.runs.end(), [&](const ContactRun& run) {
    return !seen.insert({run.context.probe, run.context.patch}).second;
  });
}

}  // namespace

std::string samples_csv(const LiveGroup& group) {
  ContactTable table;
  table.names = group.touched.probes;
  table.names.push_back(group.touched.name);
  const std::size_t name = table.names.size() - 1;
  const bool is_numbered_anew = has_number_again(group.touched);
  std::uint32_t strokes = 0;
  for (const ContactRun& run : group.touched.runs) {
    PatchContext context = run.context;
    if (is_numbered_anew) context.patch = strokes++;
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      table.rows.push_back({run.context.probe, name, group.touched.object, context, run.samples[i],
                            run.details.empty() ? SampleDetail() : run.details[i]});
    }
  }
  std::string text;
  if (is_numbered_anew) {
    text = "# patches are numbered anew: the probe's numbers came again after others\n";
  }
  if (group.samples_kept < group.samples_received) {
    text += "# " + std::to_string(group.samples_kept) + " of " +
            std::to_string(group.samples_received) + " samples: palpate record keeps them all\n";
  }
  return text + to_csv(table);
}

std::string answer_json(const LiveGroup& group) { return json_line(group.answer); }

std::string moments_json(LiveState& state, std::string_view group) {
  JsonText json;
  json.begin_object();
  json.key("times").begin_array();
  for (const std::int64_t time_ms : state.moments_of(group)) json.value(time_ms);
  json.end_array();
  json.end_object();
  return json.take();
}

std::string moment_json(const LiveState& state, std::string_view group, std::int64_t time_ms,
                        SteadyTime now) {
  const Moment* const moment = state.history().nearest(group, time_ms);
  if (moment == nullptr) return {};
  LiveGroup then = state.group_at(*moment);
  const Drawing drawing = make_drawing(then.touched, then.answer, Curvature::Along);
  SentSamples none;
  // A browser with another generation is sent all samples, even if there are none.
  none.generation = then.generation + 1;
  JsonText json;
  json.begin_object();
  json.member("group", then.touched.name);
  json.member("timeMs", moment->time_ms);
  json.key("picture");
  write_picture(then, drawing, json);
  json.key("details");
  write_details(then, drawing, now, json);
  json.key("samples");
  write_samples(then, none, json);
  json.end_object();
  return json.take();
}

}  // namespace palpate

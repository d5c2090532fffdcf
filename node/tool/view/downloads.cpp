#include "node/tool/view/downloads.h"

#include "node/csv/contact_csv.h"
#include "node/tool/text/message_json.h"
#include "node/tool/view/details_json.h"
#include "node/tool/view/picture_json.h"

namespace palpate {

std::string samples_csv(const LiveGroup& group) {
  ContactTable table;
  table.names = group.touched.probes;
  table.names.push_back(group.touched.name);
  const std::size_t name = table.names.size() - 1;
  for (const ContactRun& run : group.touched.runs) {
    for (const ContactSample& sample : run.samples) {
      table.rows.push_back({run.context.probe, name, group.touched.object, run.context, sample});
    }
  }
  std::string text;
  if (group.samples_kept < group.samples_received) {
    text = "# " + std::to_string(group.samples_kept) + " of " +
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

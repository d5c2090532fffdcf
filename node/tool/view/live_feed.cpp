#include "node/tool/view/live_feed.h"

#include "node/tool/view/details_json.h"
#include "node/tool/view/overview_json.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

// Words and numbers that change faster cannot be read. Ages are shown in tenths of a second.
constexpr milliseconds kOverviewPeriod{200};
// Details need a foot point for every sample: a third of the server's work at five a second.
constexpr milliseconds kDetailsPeriod{250};

template <typename Write>
std::string text_of(const Write& write) {
  JsonText json;
  write(json);
  return json.take();
}

}  // namespace

std::string LiveFeed::group_for(const Viewer& viewer, SteadyTime now) {
  return viewer.wanted.empty() ? state_.followed_group(viewer.shown, now) : viewer.wanted;
}

const LiveFeed::Drawn& LiveFeed::drawn_now(LiveGroup& group, SteadyTime now) {
  // There may be more drawn groups than existing ones only after a group has been removed.
  if (drawn_.size() > state_.groups().size()) {
    std::erase_if(drawn_,
                  [this](const auto& entry) { return state_.find(entry.first) == nullptr; });
  }
  Drawn& drawn = drawn_[group.touched.name];
  const bool is_picture_new = drawn.version != group.version;
  const bool are_details_new =
      drawn.details_version != group.version && now - drawn.details_drawn >= kDetailsPeriod;
  if (!is_picture_new && !are_details_new) return drawn;
  const Drawing drawing = make_drawing(group.touched, group.answer,
                                       are_details_new ? Curvature::Along : Curvature::None);
  if (is_picture_new) {
    drawn.picture = text_of([&](JsonText& json) { write_picture(group, drawing, json); });
    drawn.version = group.version;
  }
  if (are_details_new) {
    drawn.details = text_of([&](JsonText& json) { write_details(group, drawing, now, json); });
    drawn.details_version = group.version;
    drawn.details_drawn = now;
  }
  return drawn;
}

const LiveFeed::Overview& LiveFeed::overview_now(SteadyTime now) {
  const bool is_due = now - overview_.drawn >= kOverviewPeriod ||
                      overview_.status_version != state_.status_version();
  if (overview_.number == 0 || is_due) {
    ++overview_.number;
    overview_.status_version = state_.status_version();
    overview_.drawn = now;
    overview_.text = text_of([&](JsonText& json) { write_overview(state_, now, json); });
  }
  return overview_;
}

void LiveFeed::add_group(LiveGroup& group, Viewer& viewer, SteadyTime now, JsonText& message) {
  const Drawn& drawn = drawn_now(group, now);
  if (viewer.sent_version != drawn.version) {
    viewer.sent_version = drawn.version;
    message.key("picture").raw(drawn.picture);
  }
  if (viewer.sent_details_version != drawn.details_version) {
    viewer.sent_details_version = drawn.details_version;
    message.key("details").raw(drawn.details);
  }
  if (has_news(group, viewer.sent_samples)) {
    message.key("samples");
    write_samples(group, viewer.sent_samples, message);
  }
}

std::string LiveFeed::next_message(Viewer& viewer, SteadyTime now) {
  const std::string group_name = group_for(viewer, now);
  if (group_name != viewer.shown) {
    viewer.shown = group_name;
    viewer.sent_version = 0;
    viewer.sent_details_version = 0;
    viewer.sent_samples = {};
  }
  JsonText message;
  message.begin_object();
  const std::size_t nothing = message.text().size();
  if (LiveGroup* const group = state_.find(group_name); group != nullptr) {
    add_group(*group, viewer, now, message);
  }
  if (const Overview& overview = overview_now(now); viewer.sent_overview != overview.number) {
    viewer.sent_overview = overview.number;
    message.key("overview").raw(overview.text);
  }
  if (message.text().size() == nothing) return {};
  message.member("group", group_name);
  message.end_object();
  return message.take();
}

}  // namespace palpate

#include "node/tool/view/live_feed.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

// Ages are shown in tenths of a second.
constexpr milliseconds kOverviewPeriod{200};

}  // namespace

std::string LiveFeed::group_for(const Viewer& viewer, SteadyTime now) {
  return viewer.wanted.empty() ? state_.followed_group(viewer.shown, now) : viewer.wanted;
}

const std::string& LiveFeed::picture_of(LiveGroup& group, SteadyTime now) {
  std::erase_if(drawn_, [this](const auto& entry) { return state_.find(entry.first) == nullptr; });
  Drawn& drawn = drawn_[group.touched.name];
  if (drawn.version != group.version) {
    drawn.picture = to_text(picture_json(group, now));
    drawn.version = group.version;
  }
  return drawn.picture;
}

std::string LiveFeed::next_message(Viewer& viewer, SteadyTime now) {
  std::string parts;
  const auto add = [&parts](const char* name, const std::string& value) {
    parts += (parts.empty() ? "{\"" : ",\"") + std::string(name) + "\":" + value;
  };
  const std::string group_name = group_for(viewer, now);
  if (group_name != viewer.shown) {
    viewer.shown = group_name;
    viewer.sent_version = 0;
    viewer.sent_samples = {};
  }
  if (LiveGroup* const group = state_.find(group_name); group != nullptr) {
    if (viewer.sent_version != group->version) {
      viewer.sent_version = group->version;
      add("picture", picture_of(*group, now));
    }
    if (const nlohmann::json samples = samples_json(*group, viewer.sent_samples);
        !samples.is_null()) {
      add("samples", to_text(samples));
    }
  }
  const bool is_due = now - viewer.sent_overview >= kOverviewPeriod;
  if (is_due || viewer.sent_status_version != state_.status_version()) {
    viewer.sent_overview = now;
    viewer.sent_status_version = state_.status_version();
    add("overview", to_text(overview_json(state_, now)));
  }
  if (parts.empty()) return parts;
  add("group", to_text(group_name));
  return parts + "}";
}

}  // namespace palpate

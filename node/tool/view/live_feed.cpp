#include "node/tool/view/live_feed.h"

#include "node/tool/view/details_json.h"
#include "node/tool/view/overview_json.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

// Words and numbers that change faster cannot be read, and ages are shown in tenths of a second.
constexpr milliseconds kOverviewPeriod{200};
// These take a foot point of every sample besides: a third of the server's work at five a second.
constexpr milliseconds kDetailsPeriod{250};

/// A member of the message's object.
void add_part(const char* name, const std::string& value, std::string& parts) {
  parts += (parts.empty() ? "{\"" : ",\"") + std::string(name) + "\":" + value;
}

}  // namespace

std::string LiveFeed::group_for(const Viewer& viewer, SteadyTime now) {
  return viewer.wanted.empty() ? state_.followed_group(viewer.shown, now) : viewer.wanted;
}

LiveFeed::Drawn& LiveFeed::drawn_of(const LiveGroup& group) {
  std::erase_if(drawn_, [this](const auto& entry) { return state_.find(entry.first) == nullptr; });
  return drawn_[group.touched.name];
}

void LiveFeed::add_group(LiveGroup& group, Viewer& viewer, SteadyTime now, std::string& parts) {
  Drawn& drawn = drawn_of(group);
  if (viewer.sent_version != group.version) {
    if (drawn.version != group.version) {
      drawn.picture = to_text(picture_json(group));
      drawn.version = group.version;
    }
    viewer.sent_version = group.version;
    add_part("picture", drawn.picture, parts);
  }
  const bool is_due = now - drawn.details_drawn >= kDetailsPeriod;
  if (drawn.details_version != group.version && is_due) {
    drawn.details = to_text(details_json(group, now));
    drawn.details_version = group.version;
    drawn.details_drawn = now;
  }
  if (viewer.sent_details_version != drawn.details_version) {
    viewer.sent_details_version = drawn.details_version;
    add_part("details", drawn.details, parts);
  }
  if (const nlohmann::json samples = samples_json(group, viewer.sent_samples); !samples.is_null()) {
    add_part("samples", to_text(samples), parts);
  }
}

std::string LiveFeed::next_message(Viewer& viewer, SteadyTime now) {
  std::string parts;
  const std::string group_name = group_for(viewer, now);
  if (group_name != viewer.shown) {
    viewer.shown = group_name;
    viewer.sent_version = 0;
    viewer.sent_details_version = 0;
    viewer.sent_samples = {};
  }
  if (LiveGroup* const group = state_.find(group_name); group != nullptr) {
    add_group(*group, viewer, now, parts);
  }
  const bool is_due = now - viewer.sent_overview >= kOverviewPeriod;
  if (is_due || viewer.sent_status_version != state_.status_version()) {
    viewer.sent_overview = now;
    viewer.sent_status_version = state_.status_version();
    add_part("overview", to_text(overview_json(state_, now)), parts);
  }
  if (parts.empty()) return parts;
  add_part("group", to_text(group_name), parts);
  return parts + "}";
}

}  // namespace palpate

#include "node/wire/topics.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace palpate {
namespace {

constexpr std::array kKinds = {TopicKind::Contact, TopicKind::Recognition, TopicKind::Estimate,
                               TopicKind::Status};

// Not std::isalnum, because that depends on the locale.
bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == '-';
}

}  // namespace

bool is_valid_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameLength &&
         std::all_of(name.begin(), name.end(), is_name_character);
}

std::string_view topic_prefix(TopicKind kind) {
  switch (kind) {
    case TopicKind::Contact:
      return "contact/";
    case TopicKind::Recognition:
      return "recognition/";
    case TopicKind::Estimate:
      return "estimate/";
    case TopicKind::Status:
      return "status/";
  }
  return {};
}

std::string make_topic(TopicKind kind, std::string_view name) {
  assert(is_valid_name(name));
  std::string topic(topic_prefix(kind));
  topic.append(name).push_back('/');
  return topic;
}

std::optional<Topic> parse_topic(std::string_view text) {
  for (const TopicKind kind : kKinds) {
    const std::string_view prefix = topic_prefix(kind);
    if (!text.starts_with(prefix) || !text.ends_with('/') || text.size() <= prefix.size()) continue;
    const std::string_view name = text.substr(prefix.size(), text.size() - prefix.size() - 1);
    if (is_valid_name(name)) return Topic{kind, name};
  }
  return std::nullopt;
}

}  // namespace palpate

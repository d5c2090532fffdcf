// Builds and parses topics such as "contact/<probe>/".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

inline constexpr std::size_t kMaxNameLength = 64;
inline constexpr std::string_view kDefaultFrame = "world";

enum class TopicKind { Contact, Recognition, Estimate, Status };

struct Topic {
  TopicKind kind = TopicKind::Contact;
  std::string_view name;  ///< view into the parsed text
};

/// True for a valid name of a probe, group, node or frame: 1 to 64 of [A-Za-z0-9_.-].
bool is_valid_name(std::string_view name);

/// The prefix of all topics of that kind, e.g. "recognition/". Subscribe to it to receive them all.
std::string_view topic_prefix(TopicKind kind);

/// Returns e.g. "recognition/cup/". The name must be valid.
std::string make_topic(TopicKind kind, std::string_view name);

/// nullopt if the text is not a topic of the contract.
std::optional<Topic> parse_topic(std::string_view text);

}  // namespace palpate

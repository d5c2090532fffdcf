// Topics: "contact/<probe>/" and the like, built and parsed.
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
  std::string_view name;  ///< views the text that was parsed
};

/// Names of probes, groups, nodes and frames: 1 to 64 of [A-Za-z0-9_.-].
bool is_valid_name(std::string_view name);

/// The topics of that kind all begin so, e.g. "recognition/": subscribe to it for all of them.
std::string_view topic_prefix(TopicKind kind);

/// E.g. "recognition/cup/". The name must be valid.
std::string make_topic(TopicKind kind, std::string_view name);

/// nullopt where the text is no topic of this contract.
std::optional<Topic> parse_topic(std::string_view text);

}  // namespace palpate

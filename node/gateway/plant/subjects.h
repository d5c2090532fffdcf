// Builds and parses the plant's subjects, such as "palpate.<cell>.contact.<group>.<probe>".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node/wire/topics.h"

namespace palpate::gateway {

/// Encodes a name as one token of a subject: bytes other than [A-Za-z0-9_-] become '=' and two
/// capital hexadecimal digits, so that a dot does not split it and nothing is a wildcard. Different
/// names give different tokens.
std::string to_token(std::string_view name);

/// The inverse; nullopt if no name gives this token.
std::optional<std::string> from_token(std::string_view token);

/// "palpate.<cell>.<kind>", followed by one or two more tokens if given.
std::string make_subject(std::string_view cell, std::string_view kind, std::string_view name = {},
                         std::string_view second_name = {});

struct PlaceName {
  std::string cell;
  /// By the server's subject mapping: "0", "1", ...; empty = all groups of the cell.
  std::string partition;

  /// "press" or "press:0".
  std::string text() const { return partition.empty() ? cell : cell + ":" + partition; }
};

/// The subject filter for the contacts of a place: of all groups, or of one.
std::string contact_filter(const PlaceName& place, std::string_view group_token = "*");

struct ContactSubject {
  std::string group;
  std::string probe;
};

/// Parses "palpate.<cell>.contact.<group>.<probe>"; if the server maps subjects to partitions, the
/// partition precedes the group. nullopt if the subject has another form or a name is invalid.
std::optional<ContactSubject> parse_contact_subject(std::string_view subject);

/// How a message of the cell is sent to the plant.
struct Addressed {
  std::string subject;
  std::string id;     ///< the server drops a second message with the same id
  std::string group;  ///< of contacts; else empty
  std::uint64_t object = 0;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
};

/// Subject and id of a message of the cell. nullopt if it does not follow the contract: two frames,
/// a topic, and a payload that agrees with the topic.
std::optional<Addressed> address(std::string_view cell, std::string_view topic,
                                 std::string_view payload);

}  // namespace palpate::gateway

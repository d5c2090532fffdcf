// Subjects on the plant's side: "palpate.<cell>.contact.<group>.<probe>" and the like.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node/wire/topics.h"

namespace palpate::gateway {

/// A name as one token of a subject: bytes other than [A-Za-z0-9_-] become '=' and two capital
/// hexadecimal digits, so that a dot is no border and nothing is a wildcard. Two names never give
/// the same token.
std::string to_token(std::string_view name);

/// The name that gives this token; nullopt where none does.
std::optional<std::string> from_token(std::string_view token);

/// "palpate.<cell>.<kind>", or with a further token or two behind it.
std::string make_subject(std::string_view cell, std::string_view kind, std::string_view name = {},
                         std::string_view second_name = {});

struct PlaceName {
  std::string cell;
  std::string partition;  ///< of the server's mapping, "0", "1" ...; empty = all groups of the cell

  /// "press" or "press:0".
  std::string text() const { return partition.empty() ? cell : cell + ":" + partition; }
};

/// Of the contacts of a place: all of them, or those of one group.
std::string contact_filter(const PlaceName& place, std::string_view group_token = "*");

struct ContactSubject {
  std::string group;
  std::string probe;
};

/// Of "palpate.<cell>.contact.<group>.<probe>", where the server maps subjects to partitions with
/// the partition before the group. nullopt where the subject is none, or its names are no names of
/// the contract.
std::optional<ContactSubject> parse_contact_subject(std::string_view subject);

/// What the plant is told of a message of the cell.
struct Addressed {
  std::string subject;
  std::string id;     ///< the engine drops what comes twice under one
  std::string group;  ///< of contacts, "" else
  std::uint64_t object = 0;
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
};

/// Subject and id of a message of the cell; nullopt where it is none of the contract: two frames, a
/// topic, and a payload that agrees with it.
std::optional<Addressed> address(std::string_view cell, std::string_view topic,
                                 std::string_view payload);

}  // namespace palpate::gateway

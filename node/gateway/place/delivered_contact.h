// Parses a contact that the plant delivers, and its numbers in the stream and in the consumer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node/gateway/place/group_feed.h"

namespace palpate::gateway {

struct GroupContact {
  std::string group;
  FedContact contact;
};

/// Parses a contact; nullopt if subject and payload disagree or are not of this contract.
std::optional<GroupContact> read_contact(std::string_view subject, std::string_view payload,
                                         std::uint64_t stream_seq);

/// Numbers parsed from the reply subject
/// "$JS.ACK.STREAM.CONSUMER.TIMES.STREAM_SEQ.CONSUMER_SEQ.TIME.PENDING"; newer servers insert two
/// more tokens after "ACK".
struct DeliveryNumbers {
  std::uint64_t stream_seq = 0;
  std::uint64_t consumer_seq = 0;
};

DeliveryNumbers numbers_of(std::string_view reply);

}  // namespace palpate::gateway

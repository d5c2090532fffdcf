// The streams of a cell: contacts, recognitions, and the status of its nodes and gateways. How they
// are made, and how one message of them is read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "node/gateway/plant/plant.h"
#include "node/gateway/plant/subjects.h"

namespace palpate::gateway {

/// Limits of the streams that a gateway creates. Streams that exist already stay unchanged.
struct StreamLimits {
  int replicas = 1;                  ///< servers that hold each stream: 1, or 3 in a cluster
  double contacts_max_age_h = 24.0;  ///< age at which contacts are deleted; 0 = never
  /// Of each stream; beyond it the oldest are deleted; -1 = the server's limit.
  std::int64_t max_bytes = -1;
  /// How long the server remembers message ids, to drop duplicates; about 150 bytes per message.
  double duplicate_window_s = 120.0;
};

std::string contact_stream(std::string_view cell);
std::string recognition_stream(std::string_view cell);
std::string status_stream(std::string_view cell);

/// Creates the three streams. Calls done with what the engine says against it; empty if they exist
/// then.
void make_streams(Plant& plant, const void* owner, const std::string& cell,
                  const StreamLimits& limits, const std::function<void(const std::string&)>& done);

/// Asks for the last answer of a group. The message has status 404 if there is none.
void read_last_answer(Plant& plant, const void* owner, std::string_view cell,
                      std::string_view group, Plant::Handler handler);

/// Asks for the first contact of a group with at least this number in the stream. The message has
/// status 404 if there is none.
void read_contact_from(Plant& plant, const void* owner, const PlaceName& place,
                       std::string_view group, std::uint64_t seq, Plant::Handler handler);

}  // namespace palpate::gateway

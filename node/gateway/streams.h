// The streams of a cell: contacts, recognitions, and the status of its nodes and gateways.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "node/gateway/plant.h"

namespace palpate::gateway {

/// Of streams that a gateway makes because there are none; those that there are stay as they are.
struct StreamLimits {
  int replicas = 1;                  ///< servers that hold each stream: 1, or 3 of a cluster
  double contacts_max_age_h = 24.0;  ///< contacts are kept so long; 0 = for ever
  std::int64_t max_bytes = -1;       ///< of each stream; -1 = what the server has. The oldest go
  /// How long the engine remembers ids, to drop what comes twice: some 150 bytes a message.
  double duplicate_window_s = 120.0;
};

std::string contact_stream(std::string_view cell);
std::string recognition_stream(std::string_view cell);
std::string status_stream(std::string_view cell);

/// Asks for the three; done(true) where they are there.
void make_streams(Plant& plant, const void* owner, const std::string& cell,
                  const StreamLimits& limits, const std::function<void(bool)>& done);

}  // namespace palpate::gateway

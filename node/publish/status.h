// Fills in NodeStatus.
#pragma once

#include <cstdint>
#include <string_view>

#include "node/groups/compute_times.h"
#include "node/groups/intake.h"
#include "palpate/v1/node_status.pb.h"

namespace palpate {

/// Values that the intake does not know.
struct NodeVitals {
  double uptime_s = 0.0;
  std::string_view version;
  std::uint64_t recognitions_published = 0;
  std::uint64_t clients_denied = 0;
  std::uint64_t connections_cut = 0;
};

/// Sets all fields but the header. Clears `out` first.
void fill_status(Intake& intake, ComputeTimes& compute_times, const NodeVitals& vitals,
                 SteadyTime now, v1::NodeStatus& out);

/// Sets each probe's `alive` by its age. Returns how many changed.
int update_liveness(ProbeRegistry& probes, std::chrono::duration<double> timeout, SteadyTime now);

/// Resident memory of this process; 0 if not known. [bytes]
std::uint64_t resident_memory_bytes();

}  // namespace palpate

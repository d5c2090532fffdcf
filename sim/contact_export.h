// Converts simulated contacts to tables and messages.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "node/csv/contact_table.h"
#include "palpate/v1/contact.pb.h"
#include "sim/contacts.h"

namespace palpate::sim {

/// Appends the samples to a table, probe by probe. Stamps are times since the start of the scene.
void append_rows(const Scene& scene, std::span<const SimulatedProbe> probes, std::uint64_t object,
                 ContactTable& table);

/// A message and the time at which it is due: when its last sample has been taken.
struct TimedBatch {
  double time_s = 0.0;  ///< since the start of the scene
  std::size_t probe = 0;
  v1::ContactBatch batch;  ///< without header; sample stamps are times since the start [ns]
};

/// All messages of the scene, in the order in which they are due.
std::vector<TimedBatch> make_batches(const Scene& scene, std::span<const SimulatedProbe> probes,
                                     std::uint64_t object);

}  // namespace palpate::sim

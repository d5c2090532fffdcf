// Messages for the operator: which probes come and fall silent, which clients are refused, what is
// rejected, each by name, and how many objects had no answer. Only a few lines, however much
// happens.
#pragma once

#include <cstdint>

#include "node/groups/intake.h"
#include "node/security/zap_handler.h"

namespace palpate {

class OperatorLog {
 public:
  /// Logs what is new since the last call. `zap` is nullptr without CURVE.
  void tell(Intake& intake, const ZapHandler* zap, SteadyTime now);

 private:
  static void tell_probes(ProbeRegistry& probes, SteadyTime now);

  decltype(IntakeCounters::rejected) rejections_told_{};
  std::uint64_t denied_told_ = 0;
  std::uint64_t superseded_told_ = 0;  // objects
};

}  // namespace palpate

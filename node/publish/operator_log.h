// What an operator reads in the log: probes that come and fall silent, who is turned away and what
// is rejected, each by name. Few lines, however much happens.
#pragma once

#include <cstdint>

#include "node/groups/intake.h"
#include "node/security/zap_handler.h"

namespace palpate {

class OperatorLog {
 public:
  /// Logs what is new since the last call; `zap` is nullptr without CURVE.
  void tell(Intake& intake, const ZapHandler* zap, SteadyTime now);

 private:
  static void tell_probes(ProbeRegistry& probes, SteadyTime now);

  decltype(IntakeCounters::rejected) rejections_told_{};
  std::uint64_t denied_told_ = 0;
};

}  // namespace palpate

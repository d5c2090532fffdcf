// Any bytes as the two frames of a contact message: taken or refused with a reason, and what is
// taken is within its bounds.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "node/intake/ingest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The first byte divides the rest into topic and payload.
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t cut = std::min<std::size_t>(data[0], bytes.size());
  static palpate::ContactDecoder decoder;
  const palpate::IngestLimits limits;
  for (const std::string_view topic : {bytes.substr(0, cut), std::string_view("contact/p/")}) {
    const auto reason = decoder.decode(2, topic, bytes.substr(cut));
    if (reason != palpate::v1::REJECT_REASON_UNSPECIFIED) continue;
    const palpate::ContactMessage& message = decoder.message();
    if (message.samples.empty() || message.samples.size() > limits.max_samples_per_batch)
      std::abort();
    if (!message.details.empty() && message.details.size() != message.samples.size()) std::abort();
    for (const palpate::SampleDetail& detail : message.details) {
      if (!palpate::is_sound(detail)) std::abort();
    }
    for (const palpate::ContactSample& sample : message.samples) {
      const bool good = sample.position_m.allFinite() &&
                        sample.position_m.cwiseAbs().maxCoeff() <= limits.max_coordinate_m &&
                        sample.sigma_m >= 0.0 && sample.sigma_m <= limits.max_sigma_m;
      if (!good) std::abort();
    }
  }
  return 0;
}

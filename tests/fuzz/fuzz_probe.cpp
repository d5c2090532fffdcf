// Any bytes as a probe file: refused with its place, or a probe that says the same when written and
// read again.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "node/files/probe_file.h"
#include "node/process/quiet_protobuf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::silence_protobuf();
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto probe = palpate::parse_probe(text, "fuzz");
  if (!probe) {
    if (!std::string_view(probe.error).starts_with("fuzz:")) std::abort();
    return 0;
  }
  palpate::v1::Probe said = probe.value->described;
  palpate::to_wire(probe.value->character, said);
  const auto again = palpate::parse_probe(palpate::probe_text(said), "again");
  if (!again) std::abort();
  const auto& one = probe.value->character.offset.coefficients_m;
  const auto& other = again.value->character.offset.coefficients_m;
  if (one.size() != other.size() || one != other) std::abort();
  return 0;
}

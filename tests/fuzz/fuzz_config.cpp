// Any bytes as a configuration file: refused with a reason, or options that say the same again.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "node/config.h"
#include "node/files/text_format.h"
#include "node/process/quiet_protobuf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::silence_protobuf();
  const std::string text(reinterpret_cast<const char*>(data), size);
  palpate::v1::NodeConfig config;
  if (!palpate::parse_text(text, "fuzz", config).empty()) return 0;
  const auto options = palpate::make_options(config);
  if (!options) {
    if (options.error.empty()) std::abort();
    return 0;
  }
  const std::string said = palpate::to_text(palpate::to_config(*options.value));
  palpate::v1::NodeConfig again;
  if (!palpate::parse_text(said, "again", again).empty()) std::abort();
  const auto same = palpate::make_options(again);
  if (!same || palpate::to_text(palpate::to_config(*same.value)) != said) std::abort();
  return 0;
}

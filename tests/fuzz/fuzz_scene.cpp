// Any bytes as a scene, or as the scene of a part: read, or refused with its place.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "node/process/quiet_protobuf.h"
#include "sim/scene_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::silence_protobuf();
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto scene = palpate::sim::parse_scene(text, "fuzz");
  if (!scene && !std::string_view(scene.error).starts_with("fuzz:")) std::abort();
  return 0;
}

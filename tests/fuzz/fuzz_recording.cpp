// Any bytes as a recording: read, or refused.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "node/tool/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/tmp/fuzz_recording." + std::to_string(::getpid());
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      << "palpate1" << std::string(reinterpret_cast<const char*>(data), size);
  const auto recording = palpate::read_recording(path);
  if (!recording && recording.error.empty()) std::abort();
  ::unlink(path.c_str());
  return 0;
}

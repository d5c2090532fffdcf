// Any bytes as a recording: read, or refused.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "node/files/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/tmp/fuzz_recording." + std::to_string(::getpid());
  for (const char* magic : {"palpate1", "palpate2"}) {
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        << magic << std::string(reinterpret_cast<const char*>(data), size);
    palpate::RecordingReader reader;
    if (!reader.open(path).empty()) std::abort();
    palpate::RecordedMessage message;
    std::size_t read = 0;
    while (reader.next(message)) read += message.topic.size() + message.payload.size();
    if (read + reader.skipped_bytes() > size) std::abort();
  }
  ::unlink(path.c_str());
  return 0;
}

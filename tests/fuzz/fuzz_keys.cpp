// Any bytes as a file of keys: read, or refused with the file's name.
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "node/wire/curve_keys.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/tmp/fuzz_keys." + std::to_string(::getpid());
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      << std::string(reinterpret_cast<const char*>(data), size);
  ::chmod(path.c_str(), 0600);
  const auto clients = palpate::read_public_keys(path);
  const auto own = palpate::read_curve_keys(path);
  constexpr std::size_t kZ85Length = 40;
  if (clients) {
    if (clients.value->empty()) std::abort();
    for (const std::string& key : *clients.value) {
      if (key.size() != kZ85Length) std::abort();
    }
  } else if (!clients.error.starts_with(path)) {
    std::abort();
  }
  if (own ? own.value->public_key.size() != kZ85Length : !own.error.starts_with(path)) std::abort();
  ::unlink(path.c_str());
  return 0;
}

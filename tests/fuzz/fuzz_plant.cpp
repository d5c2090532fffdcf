// Any bytes as a subject of the plant, as a message of a cell, and as a file that a gateway's spool
// finds at its start.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "node/gateway/plant/subjects.h"
#include "node/gateway/spool.h"

namespace {

using namespace palpate;

void take_subject(std::string_view text) {
  // Any name has one token, without borders and wildcards, and comes back.
  const std::string token = gateway::to_token(text);
  if (token.find_first_of(".*> \t\r\n") != std::string::npos) std::abort();
  if (gateway::from_token(token) != text) std::abort();
  // Any token that is one is that of its name.
  if (const auto name = gateway::from_token(text)) {
    if (gateway::to_token(*name) != text) std::abort();
  }
  for (const std::string prefix : {"", "palpate.press.contact.", "palpate.press.contact.0."}) {
    const auto names = gateway::parse_contact_subject(prefix + std::string(text));
    if (!names) continue;
    if (!is_valid_name(names->group) || !is_valid_name(names->probe)) std::abort();
    const std::string again = gateway::make_subject("press", "contact", names->group, names->probe);
    const auto same = gateway::parse_contact_subject(again);
    if (!same || same->group != names->group || same->probe != names->probe) std::abort();
  }
}

void take_message(std::string_view text) {
  for (const char* topic : {"contact/f/", "recognition/g/", "status/n/", "estimate/f/"}) {
    const auto to = gateway::address("press", topic, text);
    if (to && to->subject.find_first_of("*> ") != std::string::npos) std::abort();
  }
  (void)gateway::address("press", text, text);
}

void take_spool(std::string_view text) {
  static const std::string folder = "/tmp/fuzz_plant." + std::to_string(::getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/0000000000000001.recording", std::ios::binary | std::ios::trunc)
      << "palpate2" << text;
  {
    gateway::Spool spool(folder, 1 << 16);
    const std::uint64_t damaged = spool.lost();  // of which nobody knows how many they were
    const std::uint64_t size = spool.size();
    spool.add("contact/f/", "new");
    std::uint64_t taken = 0;
    while (const auto one = spool.next()) {
      ++taken;
      spool.release(one->segment);
    }
    if (taken + spool.lost() - damaged != size + 1 || !spool.empty()) std::abort();
  }
  std::filesystem::remove_all(folder);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 3 == 0) take_subject(text);
  if (data[0] % 3 == 1) take_message(text);
  if (data[0] % 3 == 2) take_spool(text);
  return 0;
}

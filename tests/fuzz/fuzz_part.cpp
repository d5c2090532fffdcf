// Any bytes as the file of a known part: refused with its place, or matched, to numbers.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "node/process/quiet_protobuf.h"
#include "node/tool/part_match.h"

namespace {

using namespace palpate;

/// A stroke over an arc of 2 rad and 30 mm radius.
ContactGroup stroke() {
  constexpr int kSamples = 15;
  ContactGroup group;
  group.probes = {"finger"};
  ContactRun run;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2.0 * i / (kSamples - 1);
    run.samples.push_back({{0.03 * std::cos(angle), 0.03 * std::sin(angle)}, 1e-5, 0});
  }
  group.runs.push_back(run);
  return group;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  silence_protobuf();
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto part = parse_part(text, "fuzz");
  if (!part) {
    if (!std::string_view(part.error).starts_with("fuzz:")) std::abort();
    return 0;
  }
  static const ContactGroup group = stroke();
  const v1::PartMatch match = match_part(group, *part.value, {});
  for (const double probability : match.segment_probability()) {
    if (!(probability >= 0.0 && probability <= 1.0 + 1e-9)) std::abort();
  }
  for (const v1::PartPlacement& placement : match.placements()) {
    if (!(placement.probability() >= 0.0 && placement.probability() <= 1.0 + 1e-9)) std::abort();
  }
  if (part_match_text(match, false).empty()) std::abort();
  return 0;
}

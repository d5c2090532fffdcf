// Any bytes as a CSV file: read whole or refused with a place, and what is read is written and read
// alike. The same bytes as a file of points in any form: read whole or refused by its name.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "node/csv/contact_csv.h"
#include "node/csv/contact_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  palpate::ContactFileOptions options;
  options.plane = palpate::PointPlane::Fitted;
  for (const auto& points : {palpate::parse_contact_file(text, "fuzz.csv", {}),
                             palpate::parse_contact_file(text, "fuzz.csv", options)}) {
    if (!points && !std::string_view(points.error).starts_with("fuzz.csv:")) std::abort();
  }
  const auto table = palpate::parse_contact_csv(text, "fuzz.csv");
  if (!table) {
    if (!std::string_view(table.error).starts_with("fuzz.csv:")) std::abort();
    return 0;
  }
  const auto again = palpate::parse_contact_csv(palpate::to_csv(*table.value), "again.csv");
  if (!again || again.value->rows.size() != table.value->rows.size()) std::abort();
  return 0;
}

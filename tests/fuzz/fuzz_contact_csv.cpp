// Any bytes as a CSV file: read whole or refused with a place, and what is read is written and read
// alike.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "node/csv/contact_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto table = palpate::parse_contact_csv(text, "fuzz.csv");
  if (!table) {
    if (!std::string_view(table.error).starts_with("fuzz.csv:")) std::abort();
    return 0;
  }
  const auto again = palpate::parse_contact_csv(palpate::to_csv(*table.value), "again.csv");
  if (!again || again.value->rows.size() != table.value->rows.size()) std::abort();
  return 0;
}

#include "tests/bench/worst_case/csv_input.h"

#include <cstdio>
#include <map>
#include <tuple>

#include "node/csv/contact_csv.h"
#include "node/files/bounded_file.h"

namespace palpate::bench {

std::optional<TouchedInput> input_from(const std::string& path) {
  const Result<std::string> text = read_bounded(path, kMostContactFileBytes);
  const Result<ContactTable> table =
      text ? parse_contact_csv(*text.value, path) : Result<ContactTable>::fail(text.error);
  if (!table) {
    std::fprintf(stderr, "%s\n", table.error.c_str());
    return std::nullopt;
  }
  TouchedInput input;
  std::map<std::tuple<std::size_t, std::size_t, std::uint64_t, std::uint32_t>, std::size_t> places;
  for (const ContactRow& row : table.value->rows) {
    const auto [place, is_new] =
        places.try_emplace({row.group, row.probe, row.object, row.context.patch}, input.size());
    if (is_new) {
      PatchContext context = row.context;
      context.patch = static_cast<std::uint32_t>(input.size());
      input.push_back({context, {}});
    }
    input[place->second].samples.push_back(row.sample);
  }
  return input;
}

}  // namespace palpate::bench

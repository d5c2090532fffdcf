#include "node/gateway/plant/plant_message.h"

#include <charconv>
#include <cstdlib>

namespace palpate::gateway {
namespace {

std::string_view or_empty(const char* text) { return text == nullptr ? std::string_view() : text; }

}  // namespace

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string_view PlantMessage::reply() const { return or_empty(natsMsg_GetReply(message_.get())); }

std::string_view PlantMessage::payload() const {
  return {natsMsg_GetData(message_.get()),
          static_cast<std::size_t>(natsMsg_GetDataLength(message_.get()))};
}

std::string_view PlantMessage::header(const char* name) const {
  const char** values = nullptr;
  int count = 0;
  if (natsMsgHeader_Values(message_.get(), name, &values, &count) != NATS_OK) return {};
  const std::string_view last = count > 0 ? or_empty(values[count - 1]) : std::string_view();
  std::free(static_cast<void*>(values));  // the array; the texts belong to the message
  return last;
}

std::uint64_t PlantMessage::number(const char* name) const {
  return whole_number(header(name)).value_or(0);
}

}  // namespace palpate::gateway

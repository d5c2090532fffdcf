#include "node/gateway/place/delivered_contact.h"

#include <algorithm>

#include "node/gateway/plant/plant_message.h"
#include "node/gateway/plant/subjects.h"
#include "node/wire/parse.h"
#include "palpate/v1/contact.pb.h"

namespace palpate::gateway {

std::optional<GroupContact> read_contact(std::string_view subject, std::string_view payload,
                                         std::uint64_t stream_seq) {
  const std::optional<ContactSubject> names = parse_contact_subject(subject);
  v1::ContactBatch batch;
  if (!names || !parse(batch, payload) || !batch.has_header()) return std::nullopt;
  const v1::Header& header = batch.header();
  if (!header.source().empty() && header.source() != names->probe) return std::nullopt;
  if ((batch.group().empty() ? names->probe : batch.group()) != names->group) return std::nullopt;
  GroupContact read{names->group, {}};
  FedContact& contact = read.contact;
  contact.stream_seq = stream_seq;
  contact.probe = names->probe;
  contact.epoch = header.epoch();
  contact.seq = header.seq();
  contact.object = batch.object();
  contact.payload = payload;
  contact.bytes = payload.size();
  return read;
}

DeliveryNumbers numbers_of(std::string_view reply) {
  std::size_t token = 0;
  constexpr std::size_t kShort = 9;
  const auto tokens = static_cast<std::size_t>(std::count(reply.begin(), reply.end(), '.')) + 1;
  const std::size_t first = tokens <= kShort ? 5 : 7;
  DeliveryNumbers found;
  while (!reply.empty()) {
    const std::string_view text = reply.substr(0, reply.find('.'));
    const std::uint64_t number = whole_number(text).value_or(0);
    if (token == first) found.stream_seq = number;
    if (token == first + 1) found.consumer_seq = number;
    ++token;
    reply.remove_prefix(std::min(text.size() + 1, reply.size()));
  }
  return found;
}

}  // namespace palpate::gateway

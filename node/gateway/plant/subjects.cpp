#include "node/gateway/plant/subjects.h"

#include <array>
#include <charconv>
#include <vector>

#include "node/wire/parse.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/node_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::gateway {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEF";
constexpr char kEscape = '=';

bool is_plain(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

std::vector<std::string_view> tokens_of(std::string_view subject) {
  std::vector<std::string_view> tokens;
  for (;;) {
    const std::size_t dot = subject.find('.');
    tokens.push_back(subject.substr(0, dot));
    if (dot == std::string_view::npos) return tokens;
    subject.remove_prefix(dot + 1);
  }
}

std::string hexadecimal(std::uint64_t number) {
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16).ptr;
  return {digits.data(), end};
}

/// 64-bit FNV-1a.
std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

template <typename Message>
bool parse_with_header(Message& message, std::string_view payload) {
  return parse(message, payload) && message.has_header();
}

}  // namespace

std::string to_token(std::string_view name) {
  std::string token;
  for (const char c : name) {
    if (is_plain(c)) {
      token += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    token += kEscape;
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

std::optional<std::string> from_token(std::string_view token) {
  std::string name;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (is_plain(token[i])) {
      name += token[i];
      continue;
    }
    if (token[i] != kEscape || token.size() - i < 3) return std::nullopt;
    const std::size_t high = kDigits.find(token[i + 1]);
    const std::size_t low = kDigits.find(token[i + 2]);
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    const char c = static_cast<char>(16 * high + low);
    if (is_plain(c)) return std::nullopt;  // it already has a token
    name += c;
    i += 2;
  }
  return name;
}

std::string make_subject(std::string_view cell, std::string_view kind, std::string_view name,
                         std::string_view second_name) {
  std::string subject("palpate.");
  subject.append(to_token(cell)).append(".").append(kind);
  for (const std::string_view further : {name, second_name}) {
    if (!further.empty()) subject.append(".").append(to_token(further));
  }
  return subject;
}

std::string contact_filter(const PlaceName& place, std::string_view group_token) {
  std::string filter = make_subject(place.cell, "contact", place.partition);
  return filter.append(".").append(group_token).append(".*");
}

std::optional<ContactSubject> parse_contact_subject(std::string_view subject) {
  const std::vector<std::string_view> tokens = tokens_of(subject);
  if (tokens.size() < 5 || tokens.size() > 6) return std::nullopt;
  if (tokens[0] != "palpate" || tokens[2] != "contact") return std::nullopt;
  const auto group = from_token(tokens[tokens.size() - 2]);
  const auto probe = from_token(tokens.back());
  if (!group || !probe || !is_valid_name(*group) || !is_valid_name(*probe)) return std::nullopt;
  return ContactSubject{*group, *probe};
}

std::optional<Addressed> address(std::string_view cell, std::string_view topic,
                                 std::string_view payload) {
  const std::optional<Topic> parsed = parse_topic(topic);
  if (!parsed) return std::nullopt;
  Addressed to;
  v1::Header header;
  switch (parsed->kind) {
    case TopicKind::Contact: {
      v1::ContactBatch batch;
      if (!parse_with_header(batch, payload)) return std::nullopt;
      header = batch.header();
      if (!header.source().empty() && header.source() != parsed->name) return std::nullopt;
      to.group = batch.group().empty() ? std::string(parsed->name) : batch.group();
      if (!is_valid_name(to.group)) return std::nullopt;
      to.object = batch.object();
      to.subject = make_subject(cell, "contact", to.group, parsed->name);
      break;
    }
    case TopicKind::Recognition: {
      v1::Recognition recognition;
      if (!parse_with_header(recognition, payload) || recognition.group() != parsed->name)
        return std::nullopt;
      header = recognition.header();
      to.subject = make_subject(cell, "recognition", parsed->name);
      break;
    }
    case TopicKind::Status: {
      v1::NodeStatus status;
      if (!parse_with_header(status, payload)) return std::nullopt;
      header = status.header();
      to.subject = make_subject(cell, "status", parsed->name);
      break;
    }
    case TopicKind::Estimate:
      // Not forwarded: ten times as much data as the contacts that it is computed from.
      return std::nullopt;
  }
  to.epoch = header.epoch();
  to.seq = header.seq();
  // Each cell and kind has its own stream, so the topic's name is enough.
  to.id.append(parsed->name).append("/").append(hexadecimal(to.epoch));
  to.id.append("/").append(hexadecimal(to.seq));
  // A sender without epoch counts from 0 again after a restart; a hash of the payload tells its
  // messages apart.
  if (to.epoch == 0) to.id.append("/").append(hexadecimal(hash_of(payload)));
  return to;
}

}  // namespace palpate::gateway

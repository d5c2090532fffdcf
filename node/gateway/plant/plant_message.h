// A message of the plant.
#pragma once

#include <nats/nats.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate::gateway {

/// The number, if the text is one and nothing else.
std::optional<std::uint64_t> whole_number(std::string_view text);

class PlantMessage {
 public:
  /// `subscription`: the one that it came by; 0 = none.
  PlantMessage(std::uint64_t subscription, natsMsg* message)
      : subscription_(subscription), message_(message, &natsMsg_Destroy) {}

  std::uint64_t subscription() const { return subscription_; }
  std::string_view subject() const { return natsMsg_GetSubject(message_.get()); }
  /// Empty if it needs no answer.
  std::string_view reply() const;
  std::string_view payload() const;
  /// Empty if there is no header of that name. If there are several, the last one: the server adds
  /// its own after those of the sender.
  std::string_view header(const char* name) const;
  /// The number in a header; 0 if there is none.
  std::uint64_t number(const char* name) const;
  /// The server's status if it sends one in place of a payload, e.g. "404", "503"; else empty.
  std::string_view status() const { return header("Status"); }

 private:
  std::uint64_t subscription_;
  std::unique_ptr<natsMsg, void (*)(natsMsg*)> message_;
};

using Headers = std::vector<std::pair<std::string, std::string>>;

}  // namespace palpate::gateway

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

/// A text that is a number and nothing else.
std::optional<std::uint64_t> whole_number(std::string_view text);

class PlantMessage {
 public:
  /// `subscription`: by which it came; 0 = by none.
  PlantMessage(std::uint64_t subscription, natsMsg* message)
      : subscription_(subscription), message_(message, &natsMsg_Destroy) {}

  std::uint64_t subscription() const { return subscription_; }
  std::string_view subject() const { return natsMsg_GetSubject(message_.get()); }
  /// Empty where it wants no answer.
  std::string_view reply() const;
  std::string_view payload() const;
  /// Empty where it has none of that name. Of several the last: what the engine adds to a message
  /// comes behind what its sender has written.
  std::string_view header(const char* name) const;
  /// A number in a header; 0 where there is none.
  std::uint64_t number(const char* name) const;
  /// The engine's own word in place of a payload, e.g. "404", "503"; empty else.
  std::string_view status() const { return header("Status"); }

 private:
  std::uint64_t subscription_;
  std::unique_ptr<natsMsg, void (*)(natsMsg*)> message_;
};

using Headers = std::vector<std::pair<std::string, std::string>>;

}  // namespace palpate::gateway

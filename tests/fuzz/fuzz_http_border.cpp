// Any bytes as what a browser says of a request: nothing but this server's own address is let in,
// and what is let in is well-formed.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "node/tool/view/http_border.h"
#include "node/wire/topics.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::uint16_t kPort = 8090;
  if (const auto route = palpate::parse_route(text)) {
    const bool has_name = route->kind != palpate::Route::Kind::Live;
    if (has_name && !palpate::is_valid_name(route->name)) std::abort();
  }
  if (palpate::is_own_host(text, kPort)) {
    // Letters other than an IPv6 address's may only be those of "localhost".
    const bool has_letter = std::any_of(text.begin(), text.end(), [](char c) {
      return (c >= 'g' && c <= 'z') || (c >= 'G' && c <= 'Z');
    });
    if (has_letter && !text.starts_with("localhost:")) std::abort();
    if (text.find("8090") == std::string_view::npos) std::abort();
    if (!palpate::is_own_origin("http://" + std::string(text), text)) std::abort();
  }
  if (palpate::is_own_origin(text, "127.0.0.1:8090") && text != "http://127.0.0.1:8090")
    std::abort();
  if (const auto address = palpate::parse_listen_address(text)) {
    if (address->host.empty()) std::abort();
    (void)palpate::is_loopback_host(address->host);
  }
  return 0;
}

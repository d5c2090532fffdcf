#include "node/wire/endpoint.h"

#include <charconv>
#include <cstdint>
#include <system_error>

namespace palpate {
namespace {

constexpr std::string_view kBind = "bind:";
constexpr std::string_view kConnect = "connect:";
constexpr std::string_view kTcp = "tcp://";
constexpr std::string_view kIpc = "ipc://";
constexpr std::string_view kInproc = "inproc://";

// Checks the port after the last colon, because libzmq would take 99999 for 34463.
bool has_port(std::string_view tcp_address) {
  const std::size_t colon = tcp_address.rfind(':');
  if (colon == kTcp.size() - std::string_view("://").size()) return false;  // the colon of "tcp://"
  const std::string_view port = tcp_address.substr(colon + 1);
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  return port == "*" || (error == std::errc() && end == port.data() + port.size());
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text, bool bind_by_default) {
  const std::string original(text);
  Endpoint endpoint;
  endpoint.bind = bind_by_default;
  if (text.starts_with(kBind)) {
    endpoint.bind = true;
    text.remove_prefix(kBind.size());
  } else if (text.starts_with(kConnect)) {
    endpoint.bind = false;
    text.remove_prefix(kConnect.size());
  }
  if (text.starts_with(kInproc)) {
    return Result<Endpoint>::fail("\"" + original +
                                  "\": inproc:// reaches only within one process, and nobody else "
                                  "is in this one; use ipc://PATH");
  }
  for (const std::string_view transport : {kTcp, kIpc}) {
    if (text.starts_with(transport) && text.size() > transport.size()) {
      if (transport == kTcp && !has_port(text)) {
        return Result<Endpoint>::fail("\"" + original +
                                      "\": the port must be a number of 0 to 65535, or *");
      }
      endpoint.address = text;
      return Result<Endpoint>::ok(std::move(endpoint));
    }
  }
  return Result<Endpoint>::fail("\"" + original +
                                "\" is no endpoint: expected [bind:|connect:] and tcp://HOST:PORT "
                                "or ipc://PATH");
}

std::string to_string(const Endpoint& endpoint) {
  return std::string(endpoint.bind ? kBind : kConnect) + endpoint.address;
}

bool is_local(const Endpoint& endpoint) {
  const std::string_view address = endpoint.address;
  if (!address.starts_with(kTcp)) return true;
  std::string_view host = address.substr(kTcp.size());
  host = host.substr(0, host.rfind(':'));
  if (host == "localhost" || host == "lo" || host == "[::1]") return true;
  // 127.0.0.0/8, and only as an address: "127.example.org" is a name.
  return host.starts_with("127.") && host.find_first_not_of("0123456789.") == host.npos;
}

}  // namespace palpate

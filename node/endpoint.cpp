#include "node/endpoint.h"

namespace palpate {
namespace {

constexpr std::string_view kBind = "bind:";
constexpr std::string_view kConnect = "connect:";
constexpr std::string_view kTcp = "tcp://";
constexpr std::string_view kIpc = "ipc://";
constexpr std::string_view kInproc = "inproc://";

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
  for (const std::string_view transport : {kTcp, kIpc, kInproc}) {
    if (text.starts_with(transport) && text.size() > transport.size()) {
      endpoint.address = text;
      return Result<Endpoint>::ok(std::move(endpoint));
    }
  }
  return Result<Endpoint>::fail("\"" + original +
                                "\" is no endpoint: expected [bind:|connect:] and tcp://HOST:PORT, "
                                "ipc://PATH or inproc://NAME");
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

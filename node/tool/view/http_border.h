// What palpate view accepts of a browser's request, before anything is done with it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// The page's own address: a host and a port.
struct HostPort {
  std::string host;  ///< without brackets
  std::uint16_t port = 0;
};

/// "127.0.0.1:8090", "[::1]:8090", "localhost:8090"; the scheme "http://" and a last slash may
/// stand around it. nullopt for anything else.
std::optional<HostPort> parse_listen_address(std::string_view text);

/// True for 127.0.0.0/8, ::1 and "localhost".
bool is_loopback_host(std::string_view host);

/// Whether a request's Host header names this server: an IP address or "localhost", with our port.
/// A page of another site can make its own name mean our address (DNS rebinding); it cannot make an
/// address mean its name.
bool is_own_host(std::string_view host_header, std::uint16_t port);

/// Whether a request's Origin header is the page that `host_header` names.
bool is_own_origin(std::string_view origin_header, std::string_view host_header);

/// A request's target. `name` views the target.
struct Route {
  enum class Kind { Page, Live, SamplesCsv, AnswerJson, MomentsJson, MomentJson };
  Kind kind = Kind::Page;
  std::string_view name;     ///< file of the page, or a group
  std::int64_t time_ms = 0;  ///< of a moment, Unix time
};

/// "/", "/main.js", "/live", "/samples/<group>.csv", "/answer/<group>.json",
/// "/moments/<group>.json", "/moment/<Unix time in ms>/<group>.json"; what follows a question mark
/// is ignored. nullopt for anything else. Files of the page are looked up by the caller.
std::optional<Route> parse_route(std::string_view target);

}  // namespace palpate

// Checks a browser's request before anything is done with it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// A host and a port: the page's own address.
struct HostPort {
  std::string host;  ///< without brackets
  std::uint16_t port = 0;
};

/// Parses "127.0.0.1:8090", "[::1]:8090" or "localhost:8090"; a leading "http://" and a final slash
/// are permitted. nullopt for anything else.
std::optional<HostPort> parse_listen_address(std::string_view text);

/// True for 127.0.0.0/8, ::1 and "localhost".
bool is_loopback_host(std::string_view host);

/// True if a request's Host header names this server: an IP address or "localhost", with our port.
/// Prevents DNS rebinding: a page of another site can make its own host name point to our address,
/// but it cannot make its host name an address.
bool is_own_host(std::string_view host_header, std::uint16_t port);

/// True if a request's Origin header is the page that `host_header` names.
bool is_own_origin(std::string_view origin_header, std::string_view host_header);

/// A parsed request target. `name` is a view into the target.
struct Route {
  enum class Kind { Page, Live, SamplesCsv, AnswerJson, MomentsJson, MomentJson };
  Kind kind = Kind::Page;
  std::string_view name;     ///< file of the page, or a group
  std::int64_t time_ms = 0;  ///< of a moment, Unix time
};

/// Parses "/", "/main.js", "/live", "/samples/<group>.csv", "/answer/<group>.json",
/// "/moments/<group>.json" and "/moment/<Unix time in ms>/<group>.json". Ignores what follows a
/// question mark. nullopt for anything else. The caller looks up files of the page.
std::optional<Route> parse_route(std::string_view target);

}  // namespace palpate

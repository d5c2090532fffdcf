#include "node/tool/view/http_border.h"

#include <algorithm>
#include <charconv>

#include <boost/asio/ip/address.hpp>

#include "node/wire/topics.h"

namespace palpate {
namespace {

bool is_ip_address(std::string_view host) {
  // Rejects the zone of a link-local address ("%eth0"), which may be any text, and zero bytes, at
  // which the library stops reading.
  if (host.find_first_not_of("0123456789abcdefABCDEF.:") != std::string_view::npos) return false;
  boost::system::error_code error;
  boost::asio::ip::make_address(host, error);
  return !error;
}

/// Parses "HOST:PORT" or "[IPV6]:PORT".
std::optional<HostPort> parse_host_port(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  const std::string_view digits = text.substr(colon + 1);
  const bool in_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (in_brackets) host = host.substr(1, host.size() - 2);
  // An IPv6 address needs brackets; nothing else may have them.
  if ((host.find(':') != std::string_view::npos) != in_brackets || host.empty()) {
    return std::nullopt;
  }
  std::uint16_t port = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, port);
  if (error != std::errc() || stop != end || digits.empty()) return std::nullopt;
  return HostPort{std::string(host), port};
}

std::optional<Route> group_route(std::string_view target, std::string_view before,
                                 std::string_view after, Route::Kind kind) {
  if (!target.starts_with(before) || !target.ends_with(after) ||
      target.size() < before.size() + after.size()) {
    return std::nullopt;
  }
  const std::string_view name =
      target.substr(before.size(), target.size() - before.size() - after.size());
  return is_valid_name(name) ? std::optional(Route{kind, name, 0}) : std::nullopt;
}

/// Parses "/moment/<digits>/<group>.json".
std::optional<Route> moment_route(std::string_view target) {
  constexpr std::string_view kBefore = "/moment/";
  if (!target.starts_with(kBefore)) return std::nullopt;
  target.remove_prefix(kBefore.size());
  const std::size_t digits = target.find('/');
  // from_chars would accept a minus sign.
  if (digits == std::string_view::npos || target.starts_with('-')) return std::nullopt;
  std::int64_t time_ms = 0;
  const auto [stop, error] = std::from_chars(target.data(), target.data() + digits, time_ms);
  if (error != std::errc() || stop != target.data() + digits) return std::nullopt;
  auto route = group_route(target.substr(digits), "/", ".json", Route::Kind::MomentJson);
  if (route) route->time_ms = time_ms;
  return route;
}

}  // namespace

std::optional<HostPort> parse_listen_address(std::string_view text) {
  constexpr std::string_view kScheme = "http://";
  if (text.starts_with(kScheme)) text.remove_prefix(kScheme.size());
  if (text.ends_with('/')) text.remove_suffix(1);
  std::optional<HostPort> address = parse_host_port(text);
  if (!address || (address->host != "localhost" && !is_ip_address(address->host))) {
    return std::nullopt;
  }
  return address;
}

bool is_loopback_host(std::string_view host) {
  if (host == "localhost") return true;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  return !error && address.is_loopback();
}

bool is_own_host(std::string_view host_header, std::uint16_t port) {
  // Browsers omit HTTP's standard port.
  const bool has_port =
      host_header.rfind(':') != std::string_view::npos && !host_header.ends_with(']');
  const std::optional<HostPort> named =
      parse_host_port(has_port ? std::string(host_header) : std::string(host_header) + ":80");
  return named && named->port == port && (named->host == "localhost" || is_ip_address(named->host));
}

bool is_own_origin(std::string_view origin_header, std::string_view host_header) {
  constexpr std::string_view kScheme = "http://";
  return !host_header.empty() && origin_header.starts_with(kScheme) &&
         origin_header.substr(kScheme.size()) == host_header;
}

std::optional<Route> parse_route(std::string_view target) {
  target = target.substr(0, target.find('?'));
  if (target == "/") return Route{Route::Kind::Page, "index.html", 0};
  if (target == "/live") return Route{Route::Kind::Live, {}, 0};
  if (auto route = group_route(target, "/samples/", ".csv", Route::Kind::SamplesCsv)) return route;
  if (auto route = group_route(target, "/answer/", ".json", Route::Kind::AnswerJson)) return route;
  if (auto route = group_route(target, "/moments/", ".json", Route::Kind::MomentsJson)) {
    return route;
  }
  if (auto route = moment_route(target)) return route;
  // The page's files have plain names in one folder.
  if (target.size() < 2 || target.front() != '/' || !is_valid_name(target.substr(1))) {
    return std::nullopt;
  }
  return Route{Route::Kind::Page, target.substr(1), 0};
}

}  // namespace palpate

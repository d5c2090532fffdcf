// Runs `palpate view`. This header is light: Boost.Beast, Asio and the page are included only by
// its source.
#pragma once

#include <cstdint>
#include <functional>

#include "node/client/result_subscriber.h"
#include "node/tool/view/http_border.h"

namespace palpate {

/// Maximum of browsers that look on, each by a live feed: a socket and the last message.
inline constexpr long kMostViewers = 64;

/// Shows what arrives on the bus in browsers until `stop_fd` is readable. Calls `on_bound` with the
/// port. Throws std::invalid_argument if it cannot subscribe and boost::system::system_error if it
/// cannot listen.
void serve_live_view(const client::ResultSubscriberOptions& bus, const HostPort& listen,
                     int stop_fd, const std::function<void(std::uint16_t port)>& on_bound);

}  // namespace palpate

// Everything that palpate view runs. Its header is light: Boost.Beast, Asio and the page stay
// behind it.
#pragma once

#include <cstdint>
#include <functional>

#include "node/client/result_subscriber.h"
#include "node/tool/view/http_border.h"

namespace palpate {

/// Shows in browsers what comes on the bus, until `stop_fd` is readable. `on_bound` is told the
/// port. Throws std::invalid_argument where it cannot subscribe, boost::system::system_error where
/// it cannot listen.
void serve_live_view(const client::ResultSubscriberOptions& bus, const HostPort& listen,
                     int stop_fd, const std::function<void(std::uint16_t port)>& on_bound);

}  // namespace palpate

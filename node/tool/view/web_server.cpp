#include "node/tool/view/web_server.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/version.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "node/tool/view/downloads.h"
#include "node/tool/view/live_view.h"
#include "node/tool/view/page_files.h"

namespace palpate {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using namespace std::chrono_literals;

// Maximum of connections that are not live feeds. Each request must arrive within kRequestTime.
constexpr long kMostHttpConnections = 128;
constexpr auto kRequestTime = 5s;
constexpr std::uint32_t kMostHeaderBytes = 8192;
// How often viewers are checked: half the interval of pictures.
constexpr auto kTick = 15ms;

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

using Response = http::response<http::string_body>;

const char* content_type_of(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "application/octet-stream";
}

/// The requests of one connection, one after the other.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket&& socket, WebServer& server, std::shared_ptr<void> count)
      : stream_(std::move(socket)), server_(server), count_(std::move(count)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    parser_->body_limit(0);
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       self->on_read(error);
                     });
  }

 private:
  void on_read(beast::error_code error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout ||
        error == asio::error::operation_aborted || error == asio::error::connection_reset ||
        error == http::error::partial_message) {
      return;
    }
    if (error) {
      respond(http::status::bad_request, "not a request that this page makes\n", "text/plain",
              false);
      return;
    }
    answer(parser_->get());
  }

  void answer(const LiveSession::Request& request) {
    const std::string_view host = view_of(request[http::field::host]);
    const std::string_view origin = view_of(request[http::field::origin]);
    const bool is_ours = is_own_host(host, server_.port()) &&
                         request.count(http::field::host) == 1 &&
                         (origin.empty() || is_own_origin(origin, host));
    if (!is_ours) return refuse(http::status::forbidden, "another site's page may not look here\n");
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return refuse(http::status::method_not_allowed, "GET only\n");
    }
    const auto route = parse_route(view_of(request.target()));
    if (!route) return refuse(http::status::not_found, "no such page\n");
    switch (route->kind) {
      case Route::Kind::Live:
        return go_live(request, origin);
      case Route::Kind::Page:
        return send_page(route->name);
      case Route::Kind::SamplesCsv:
        return send_group(route->name, "text/csv", samples_csv);
      case Route::Kind::AnswerJson:
        return send_group(route->name, "application/json", answer_json);
      case Route::Kind::MomentsJson:
        return respond(http::status::ok, moments_json(server_.state(), route->name),
                       "application/json", parser_->keep_alive());
      case Route::Kind::MomentJson:
        return send_moment(*route);
    }
  }

  void go_live(const LiveSession::Request& request, std::string_view origin) {
    // A browser always names the page that opens a WebSocket.
    if (origin.empty() || !beast::websocket::is_upgrade(request)) {
      return refuse(http::status::forbidden, "the live feed is for this page only\n");
    }
    if (!server_.add_viewer(std::move(stream_), request)) {
      // The stream was not moved from.
      refuse(http::status::service_unavailable, "too many browsers look on\n");
    }
  }

  void send_page(std::string_view name) {
    for (const PageFile& file : page_files()) {
      if (file.name == name) {
        return respond(http::status::ok, std::string(file.content), content_type_of(name),
                       parser_->keep_alive());
      }
    }
    refuse(http::status::not_found, "no such page\n");
  }

  void send_group(std::string_view name, const char* type, std::string (*text)(const LiveGroup&)) {
    const LiveGroup* group = server_.state().find(name);
    if (group == nullptr) return refuse(http::status::not_found, "no such group\n");
    respond(http::status::ok, text(*group), type, parser_->keep_alive());
  }

  void send_moment(const Route& route) {
    std::string text =
        moment_json(server_.state(), route.name, route.time_ms, std::chrono::steady_clock::now());
    if (text.empty()) return refuse(http::status::not_found, "no such moment\n");
    respond(http::status::ok, std::move(text), "application/json", parser_->keep_alive());
  }

  void refuse(http::status status, const char* why) {
    respond(status, why, "text/plain", parser_->keep_alive());
  }

  void respond(http::status status, std::string body, const char* type, bool keep_alive) {
    const bool is_head = parser_->is_header_done() && parser_->get().method() == http::verb::head;
    response_ = Response(status, 11);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-cache");
    // Only this server's own files may be loaded or run, and no other page may frame it. The live
    // feed is named as well, because older browsers do not count WebSockets as 'self'.
    std::string policy =
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src "
        "'self'";
    if (status == http::status::ok) {
      policy += " ws://" + std::string(view_of(parser_->get()[http::field::host]));
    }
    response_.set("Content-Security-Policy",
                  policy +
                      "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
                      "require-trusted-types-for 'script'");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    response_.keep_alive(keep_alive);
    response_.content_length(body.size());
    if (!is_head) response_.body() = std::move(body);
    stream_.expires_after(kRequestTime);
    http::async_write(
        stream_, response_,
        [self = shared_from_this(), keep_alive](beast::error_code error, std::size_t) {
          if (!error && keep_alive) return self->read();
          beast::error_code ignored;
          self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        });
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kMostHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
  WebServer& server_;
  std::shared_ptr<void> count_;
};

tcp::endpoint endpoint_of(const HostPort& listen) {
  const std::string host = listen.host == "localhost" ? "127.0.0.1" : listen.host;
  return {asio::ip::make_address(host), listen.port};
}

}  // namespace

WebServer::WebServer(asio::io_context& io, const HostPort& listen, LiveState& state)
    : acceptor_(io), ticks_(io), accept_again_(io), state_(state), feed_(state) {
  const tcp::endpoint endpoint = endpoint_of(listen);
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(asio::socket_base::reuse_address(true));
  acceptor_.bind(endpoint);
  acceptor_.listen();
  port_ = acceptor_.local_endpoint().port();
  accept();
}

void WebServer::accept() {
  acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {
      // Out of descriptors: try again later, when connections have ended.
      accept_again_.expires_after(kTick);
      accept_again_.async_wait([this](beast::error_code stopped) {
        if (!stopped) accept();
      });
      return;
    }
    if (http_count_.use_count() <= kMostHttpConnections) {
      beast::error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<HttpSession>(std::move(socket), *this, http_count_)->read();
    }
    accept();
  });
}

bool WebServer::add_viewer(beast::tcp_stream&& stream, const LiveSession::Request& request) {
  if (live_count_.use_count() > kMostViewers) return false;
  auto session = std::make_shared<LiveSession>(std::move(stream), feed_, live_count_);
  session->accept(request);
  sessions_.push_back(session);
  if (sessions_.size() == 1) tick();
  return true;
}

void WebServer::tick() {
  std::erase_if(sessions_, [](const auto& session) { return session.expired(); });
  if (sessions_.empty()) return;
  const SteadyTime now = std::chrono::steady_clock::now();
  for (const auto& weak : sessions_) {
    if (const auto session = weak.lock()) session->tick(now);
  }
  ticks_.expires_after(kTick);
  ticks_.async_wait([this](beast::error_code stopped) {
    if (!stopped) tick();
  });
}

}  // namespace palpate

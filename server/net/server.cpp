// server/net/server.cpp: listener and HTTP connections (one of the two Beast translation units).
#include "server/net/server.hpp"

#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <optional>

#include "server/net/access.hpp"
#include "server/net/static_files.hpp"
#include "server/net/ws_connection.hpp"

namespace server::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Body = http::span_body<const char>;

/// One HTTP/1.1 connection: request, answer, request, until closed or upgraded.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(std::shared_ptr<Shared> shared, tcp::socket socket)
      : shared_(std::move(shared)), count_(shared_), stream_(std::move(socket)) {
    error_code error;
    const auto peer = stream_.socket().remote_endpoint(error);
    loopback_ = !error && peer.address().is_loopback();
  }
  void start() { read_header(shared_->options.header_timeout); }

 private:
  void read_header(std::chrono::milliseconds timeout);
  void on_header(error_code error);
  void on_body(error_code error);
  void complain(error_code error);
  bool adopt_head();
  bool wants_upgrade() const;
  void upgrade();
  void serve();
  void respond(Response response, bool keep_alive);
  void close();

  std::shared_ptr<Shared> shared_;
  ConnectionCount count_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{};
  std::optional<http::request_parser<http::string_body>> parser_{};
  Request request_{};
  bool loopback_ = false;
  std::shared_ptr<const std::string> body_{};
  std::optional<http::response<Body>> response_{};
};

void HttpConnection::read_header(std::chrono::milliseconds timeout) {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(shared_->options.max_header));
  parser_->body_limit(shared_->options.max_body);
  request_ = {};
  stream_.expires_after(timeout);
  http::async_read_header(stream_,
                          buffer_,
                          *parser_,
                          [self = shared_from_this()](error_code error, std::size_t) {
                            self->on_header(error);
                          });
}

/// Copies the head into request_. False when it does not parse.
bool HttpConnection::adopt_head() {
  const auto& head = parser_->get();
  request_.method = std::string(head.method_string());
  request_.loopback = loopback_;
  for (const auto& field : head) {
    request_.headers.emplace_back(std::string(field.name_string()), std::string(field.value()));
  }
  const auto target = head.target();
  return parse_target({target.data(), target.size()}, request_.path, request_.query);
}

bool HttpConnection::wants_upgrade() const {
  return request_.path == "/ws" && beast::websocket::is_upgrade(parser_->get());
}

void HttpConnection::on_header(error_code error) {
  if (error) {
    complain(error);
    return;
  }
  if (!adopt_head()) {
    respond(problem(400, "Bad target", "The address has a broken percent escape."), false);
    return;
  }
  const auto& head = parser_->get();
  if (head.count(http::field::content_length) > 0 && head.count(http::field::transfer_encoding) > 0) {
    respond(problem(400, "Ambiguous length", "Content-Length and Transfer-Encoding exclude each other."),
            false);
    return;
  }
  if (wants_upgrade()) {
    upgrade();
    return;
  }
  stream_.expires_after(shared_->options.body_timeout);
  http::async_read(stream_,
                   buffer_,
                   *parser_,
                   [self = shared_from_this()](error_code body_error, std::size_t) {
                     self->on_body(body_error);
                   });
}

void HttpConnection::complain(error_code error) {
  if (error == http::error::header_limit) {
    respond(problem(431, "Header too large", "The request's header is over the limit."), false);
  } else if (error == http::error::body_limit) {
    respond(problem(413, "Body too large", "The request's body is over the limit."), false);
  } else if (error == http::error::end_of_stream || error == beast::error::timeout ||
             error == asio::error::operation_aborted || error == asio::error::connection_reset ||
             error == asio::error::eof || error == http::error::partial_message) {
    close();
  } else {
    respond(problem(400, "Bad request", "This is not HTTP: " + error.message() + "."), false);
  }
}

void HttpConnection::on_body(error_code error) {
  if (error) {
    complain(error);
    return;
  }
  request_.body = std::move(parser_->get().body());
  serve();
}

void HttpConnection::upgrade() {
  if (auto refusal = refuse(shared_->options, request_, true)) {
    respond(std::move(*refusal), false);
    return;
  }
  UpgradeRequest request = parser_->release();
  std::string subprotocol = choose_subprotocol(request);
  if (subprotocol.empty()) {
    respond(problem(400,
                    "No subprotocol",
                    "Offer foxglove.websocket.v1 or foxglove.sdk.v1 in Sec-WebSocket-Protocol."),
            false);
    return;
  }
  stream_.expires_never();
  accept_websocket(
      shared_, stream_.release_socket(), std::move(request), std::move(subprotocol), loopback_);
}

void HttpConnection::serve() {
  const bool keep_alive = parser_->get().keep_alive();
  const Responder responder = [self = shared_from_this(), keep_alive](Response response) {
    self->respond(std::move(response), keep_alive);
  };
  stream_.expires_never();  // the answer may take as long as it takes
  try {
    if (auto refusal = refuse(shared_->options, request_, false)) {
      responder(std::move(*refusal));
    } else if (request_.path == "/ws") {
      responder(problem(426, "WebSocket only", "Connect to /ws with a WebSocket."));
    } else if (request_.path == "/api/v1/login" && request_.method == "POST") {
      responder(login(shared_->options, request_));
    } else if (request_.path.starts_with("/api/")) {
      shared_->router->dispatch(request_, responder);
    } else if (request_.method == "GET" || request_.method == "HEAD") {
      responder(serve_file(shared_->options.web_root, request_));
    } else {
      Response response = problem(405, "Method not allowed", "Files can only be read.");
      response.headers.emplace_back("Allow", "GET, HEAD");
      responder(std::move(response));
    }
  } catch (const std::exception& e) {
    responder(problem(500, "Internal error", e.what()));
  }
}

void HttpConnection::respond(Response response, bool keep_alive) {
  static const auto empty = std::make_shared<const std::string>();
  body_ = response.body ? std::move(response.body) : empty;
  const bool head = request_.method == "HEAD";
  response_.emplace();
  response_->version(11);
  response_->result(static_cast<unsigned>(response.status));
  response_->set(http::field::server, "Tautline");
  response_->set("X-Content-Type-Options", "nosniff");
  response_->set("Referrer-Policy", "no-referrer");
  if (!response.content_type.empty()) {
    response_->set(http::field::content_type, response.content_type);
  }
  if (request_.path.starts_with("/api/")) response_->set(http::field::cache_control, "no-store");
  for (const auto& [name, value] : response.headers) response_->set(name, value);
  response_->keep_alive(keep_alive);
  if (!head) response_->body() = beast::span<const char>(body_->data(), body_->size());
  if (response.status != 204 && response.status != 304) response_->content_length(body_->size());

  stream_.expires_after(shared_->options.idle_timeout);
  auto written = [self = shared_from_this(), keep_alive](error_code error, std::size_t) {
    if (error || !keep_alive || self->shared_->stopping) {
      self->close();
    } else {
      self->read_header(self->shared_->options.idle_timeout);
    }
  };
  if (!head) {
    http::async_write(stream_, *response_, std::move(written));
    return;
  }
  // HEAD: the length of what GET would send, and no body.
  auto serializer = std::make_shared<http::response_serializer<Body>>(*response_);
  http::async_write_header(stream_,
                           *serializer,
                           [serializer, written = std::move(written)](
                               error_code error, std::size_t n) mutable { written(error, n); });
}

void HttpConnection::close() {
  error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.close();
}

}  // namespace

struct Server::Impl {
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer accept_pause{io};
  std::shared_ptr<Shared> shared = std::make_shared<Shared>();
  std::vector<std::unique_ptr<asio::steady_timer>> timers{};
  std::optional<asio::signal_set> signals{};

  void listen();
  void accept();
  void tick(asio::steady_timer& timer,
            std::chrono::milliseconds period,
            std::shared_ptr<std::function<void()>> work);
};

void Server::Impl::listen() {
  const ServerOptions& options = shared->options;
  error_code error;
  const tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) return;
  std::string sentence =
      "Cannot listen on " + options.address + " port " + std::to_string(options.port) + ": ";
  if (error == asio::error::address_in_use) {
    sentence += "the port is in use, perhaps by another Tautline. Choose another with --port.";
  } else if (error == asio::error::access_denied) {
    sentence += "ports below 1024 need root. Choose another with --port.";
  } else {
    sentence += error.message() + ".";
  }
  throw ServerError(sentence);
}

void Server::Impl::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted || shared->stopping) return;
    if (error) {  // out of files, say: waiting beats spinning
      accept_pause.expires_after(std::chrono::milliseconds(100));
      accept_pause.async_wait([this](error_code aborted) {
        if (!aborted) accept();
      });
      return;
    }
    if (shared->connections < shared->options.max_connections) {
      std::make_shared<HttpConnection>(shared, std::move(socket))->start();
    }
    accept();
  });
}

void Server::Impl::tick(asio::steady_timer& timer,
                        std::chrono::milliseconds period,
                        std::shared_ptr<std::function<void()>> work) {
  timer.expires_after(period);
  timer.async_wait([this, &timer, period, work](error_code error) {
    if (error || shared->stopping) return;
    (*work)();
    tick(timer, period, work);
  });
}

Server::Server(ServerOptions options, const Router& router, WsHandlers handlers)
    : impl_(std::make_unique<Impl>()) {
  check_exposure(options);
  impl_->shared->options = std::move(options);
  impl_->shared->router = &router;
  impl_->shared->handlers = std::move(handlers);
  impl_->listen();
}

Server::~Server() = default;

std::uint16_t Server::port() const { return impl_->acceptor.local_endpoint().port(); }

std::string Server::url() const {
  const auto address = impl_->acceptor.local_endpoint().address();
  std::string host = address.to_string();
  if (address.is_unspecified()) host = "localhost";
  if (address.is_v6() && !address.is_unspecified()) host = "[" + host + "]";
  return "http://" + host + ":" + std::to_string(port());
}

void Server::run() {
  impl_->accept();
  impl_->io.run();
}

void Server::stop() {
  asio::post(impl_->io, [this] {
    impl_->shared->stopping = true;
    impl_->io.stop();
  });
}

void Server::post(std::function<void()> work) { asio::post(impl_->io, std::move(work)); }

void Server::every(std::chrono::milliseconds period, std::function<void()> work) {
  impl_->timers.push_back(std::make_unique<asio::steady_timer>(impl_->io));
  impl_->tick(*impl_->timers.back(),
              period,
              std::make_shared<std::function<void()>>(std::move(work)));
}

void Server::on_termination(std::function<void()> on_signal) {
  impl_->signals.emplace(impl_->io, SIGINT, SIGTERM);
  impl_->signals->async_wait([work = std::move(on_signal)](error_code error, int) {
    if (!error) work();
  });
}

}  // namespace server::net

// server/serve/net/http_connection.cpp: HTTP/1.1 on one socket. First of the two files that know
// Beast.
#include <algorithm>
#include <optional>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <fmt/format.h>

#include "server/serve/net/compression.hpp"
#include "server/serve/net/core.hpp"
#include "server/serve/net/response_writer.hpp"
#include "server/serve/net/upgrade.hpp"

namespace server::net {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

Response body_problem(std::size_t limit) {
  return problem(413, "the request body has more than " + std::to_string(limit) + " bytes");
}

Response parse_problem(const error_code& error, const Limits& limits) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return problem(
        431, "the request header has more than " + std::to_string(limits.header_bytes) + " bytes");
  }
  if (error == http::error::body_limit) return body_problem(limits.body_bytes);
  return problem(400, "this is not a well-formed HTTP request: " + error.message());
}

/// One request at a time: read header, check, read body, answer, repeat. Pipelined requests wait in
/// the buffer, so answers stay in order and memory stays bounded.
class HttpConnection final : public Connection,
                             public ResponseWriter::Host,
                             public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Core& core, Socket socket, const Address& peer)
      : core_(core), socket_(std::move(socket)), peer_(peer) {}

  void start();
  void check(Clock::time_point now) override;
  void go_away() override {
    // An answer in progress may still arrive while the server stops.
    if (phase_ != Phase::Writing && phase_ != Phase::Handler) finish();
  }
  void abort() noexcept override;
  std::optional<Clock::time_point> idle_since(Clock::time_point now) const override;

 private:
  enum class Phase { Idle, Header, Body, Handler, Writing, Draining };

  void next_request();
  void read_header();
  void on_header(const error_code& error);
  void take_header();
  bool admitted(bool upgrading);
  void upgrade();
  void send_continue();
  void read_body();
  void dispatch();
  void send_file(bool keep_alive);
  void respond(Response response, bool keep_alive);
  const WsEndpoint* endpoint() const;

  // ResponseWriter::Host
  void writing(std::size_t bytes) override {
    served_ = Clock::now();
    // A slow but steady reader of a large file gets enough time: 50 kB/s suffices.
    set_phase(Phase::Writing, core_.options.timeouts.body + std::chrono::milliseconds(bytes / 50));
  }
  void waiting() override { phase_ = Phase::Handler; }
  void written() override {
    core_.connections.release(number_);
    next_request();
  }
  void draining() override { set_phase(Phase::Draining, core_.options.timeouts.closing); }
  void finish() override;

  /// Calls `next` if the operation succeeds; otherwise closes the connection.
  auto then(void (HttpConnection::*next)()) {
    return [self = shared_from_this(), next](const error_code& error, auto...) {
      if (self->ended_) return;
      if (error) {
        self->finish();
      } else {
        (self.get()->*next)();
      }
    };
  }
  void set_phase(Phase phase, std::chrono::milliseconds limit) {
    phase_ = phase;
    deadline_ = Clock::now() + limit;
  }
  bool is_api() const {
    return request_.path.compare(0, 5, "/api/") == 0 || core_.router.knows(request_.path);
  }

  Core& core_;
  Socket socket_;
  const Address peer_;  // the other end: a client, or a proxy that speaks for many
  Connections::Number number_ = 0;
  bool ended_ = false;
  Phase phase_ = Phase::Idle;
  Clock::time_point deadline_{};
  Clock::time_point served_{};  // time of accept, or start of the last answer or slice
  std::string local_address_{};
  beast::flat_buffer buffer_{};
  std::optional<http::request_parser<http::string_body>> parser_{};
  Request request_{};
  ResponseWriter writer_{socket_};
  std::size_t body_limit_ = 0;
  BodyRoom::Place body_place_{};
};

void HttpConnection::start() {
  error_code error;
  const asio::ip::tcp::endpoint local = socket_.local_endpoint(error);
  if (error) return;  // the client has gone already
  local_address_ = address_of(local).text();
  served_ = Clock::now();
  number_ = core_.connections.add(
      shared_from_this(), peer_, Connections::Kind::Request, core_.access.is_proxy(peer_));
  buffer_.max_size(core_.options.limits.header_bytes + 65536);
  read_header();
}

void HttpConnection::check(Clock::time_point now) {
  if (ended_ || phase_ == Phase::Handler || now < deadline_) return;
  if (phase_ == Phase::Header || phase_ == Phase::Body) {
    if (buffer_.size() > 0 || phase_ == Phase::Body) {
      // Try once without waiting: the pending read cannot be answered in the ordinary way.
      write_at_once(socket_, problem(408, "the request did not arrive in time"));
    }
  }
  finish();
}

void HttpConnection::abort() noexcept {
  ended_ = true;
  body_place_ = BodyRoom::Place();
  error_code ignored;
  socket_.close(ignored);
}

std::optional<Clock::time_point> HttpConnection::idle_since(Clock::time_point now) const {
  // Half a request is not yet useful, and a client that does not take its answer no longer is.
  constexpr std::chrono::seconds kToTakeAnAnswer{10};
  if (phase_ == Phase::Handler) return std::nullopt;
  if (phase_ == Phase::Writing && now - served_ < kToTakeAnAnswer) return std::nullopt;
  return served_;
}

void HttpConnection::finish() {
  if (ended_) return;
  abort();
  core_.remove(number_);
}

void HttpConnection::next_request() {
  if (core_.stopping) {
    finish();
    return;
  }
  if (buffer_.size() > 0) {
    read_header();
    return;
  }
  set_phase(Phase::Idle, core_.options.timeouts.idle);
  socket_.async_wait(Socket::wait_read, then(&HttpConnection::read_header));
}

void HttpConnection::read_header() {
  set_phase(Phase::Header, core_.options.timeouts.header);
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(core_.options.limits.header_bytes));
  parser_->body_limit(core_.options.limits.body_bytes);
  http::async_read_header(socket_,
                          buffer_,
                          *parser_,
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                            self->on_header(error);
                          });
}

void HttpConnection::on_header(const error_code& error) {
  if (ended_) return;
  if (error && error.category() != http::make_error_code(http::error::bad_value).category()) {
    finish();  // the socket broke
    return;
  }
  if (error == http::error::end_of_stream || error == http::error::partial_message) {
    finish();
    return;
  }
  request_ = Request{};
  if (error) {
    respond(parse_problem(error, core_.options.limits), false);
    return;
  }
  take_header();
}

void HttpConnection::take_header() {
  const auto& message = parser_->get();
  request_.method = std::string(view(message.method_string()));
  for (const auto& field : message) {
    request_.headers.push_back(
        {std::string(view(field.name_string())), std::string(view(field.value()))});
  }
  core_.access.identify(request_, peer_);
  if (const auto wrong = parse_target(view(message.target()), request_)) {
    respond(problem(400, *wrong), false);
    return;
  }
  if (auto wrong = framing_problem(request_, message.version() < 11)) {
    respond(std::move(*wrong), false);
    return;
  }
  const bool upgrading = beast::websocket::is_upgrade(message);
  if (!admitted(upgrading)) return;
  if (upgrading) {
    upgrade();
    return;
  }
  const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
  if (has_body && request_.method != "GET" && request_.method != "HEAD") {
    std::string_view type = request_.header("Content-Type");
    type = type.substr(0, type.find(';'));
    while (!type.empty() && type.back() == ' ') type.remove_suffix(1);
    if (!equal_no_case(type, "application/json")) {
      respond(problem(415, "the body must be sent as Content-Type: application/json"), false);
      return;
    }
  }
  body_limit_ = std::min(core_.options.limits.body_bytes,
                         core_.router.body_limit(request_.method, request_.path));
  if (parser_->content_length().value_or(0) > body_limit_) {
    respond(body_problem(body_limit_), false);
    return;
  }
  parser_->body_limit(body_limit_);
  if (auto place =
          core_.bodies.take(has_body ? parser_->content_length().value_or(body_limit_) : 0)) {
    body_place_ = std::move(*place);
  } else {
    Response busy = problem(503, "the server has many large requests to read; try again");
    busy.headers.push_back({"Retry-After", "5"});
    respond(std::move(busy), false);
    return;
  }
  if (equal_no_case(request_.header("Expect"), "100-continue") && has_body) {
    send_continue();
  } else {
    read_body();
  }
}

/// Answers a request that may not pass; false if so.
bool HttpConnection::admitted(bool upgrading) {
  const Clock::time_point now = Clock::now();
  const Address client = Address::parse(request_.peer).value_or(peer_);
  if (client != peer_) {
    const Connections::Room room = core_.connections.charge(number_, client, now);
    if (room != Connections::Room::Yes) {
      respond(no_room(room), false);
      return false;
    }
  }
  if (auto refusal = core_.access.refuse(request_, local_address_, upgrading, is_api(), now)) {
    respond(std::move(*refusal), parser_->is_done());
    return false;
  }
  if (upgrading && !core_.connections.may_open_socket(client)) {
    respond(no_room(Connections::Room::AddressFull), false);
    return false;
  }
  // A client that may drive, and does, will be let in again.
  if (request_.role >= Role::Operator && core_.access.may_drive(request_, upgrading, is_api())) {
    core_.connections.welcome(client, now);
  }
  return true;
}

/// The WebSocket endpoint at the request's path; null if there is none.
const WsEndpoint* HttpConnection::endpoint() const {
  const auto found = std::ranges::find(core_.endpoints, request_.path, &WsEndpoint::path);
  return found == core_.endpoints.end() ? nullptr : &*found;
}

void HttpConnection::upgrade() {
  const WsEndpoint* const asked = endpoint();
  if (asked == nullptr) {
    respond(problem(404, "there is no WebSocket at " + request_.path), false);
    return;
  }
  if (!parser_->is_done() || buffer_.size() > 0) {
    respond(problem(400, "an upgrade request has no body and waits for its answer"), false);
    return;
  }
  const std::vector<std::string>& known = asked->subprotocols;
  std::string subprotocol = choose_subprotocol(known, request_.elements("Sec-WebSocket-Protocol"));
  if (subprotocol.empty() && !known.empty()) {
    const std::string names = fmt::format("{}", fmt::join(known, " or "));
    respond(problem(400, "the WebSocket at " + request_.path + " needs the subprotocol " + names),
            false);
    return;
  }
  if (const auto name = request_.query.find("name"); name != request_.query.end()) {
    request_.person = clean_name(name->second);
  }
  ended_ = true;  // the socket is moved away; do not touch it after this
  start_websocket(core_,
                  std::move(socket_),
                  parser_->get(),
                  *asked,
                  {.subprotocol = std::move(subprotocol),
                   .who = request_.visitor(),
                   .query = request_.query,
                   .login = core_.access.login_of(request_, Clock::now())});
  core_.remove(number_);
}

void HttpConnection::send_continue() {
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  set_phase(Phase::Body, core_.options.timeouts.body);
  asio::async_write(
      socket_, asio::buffer(kContinue.data(), kContinue.size()), then(&HttpConnection::read_body));
}

void HttpConnection::read_body() {
  set_phase(Phase::Body, core_.options.timeouts.body);
  if (parser_->is_done()) {
    dispatch();
    return;
  }
  http::async_read(
      socket_,
      buffer_,
      *parser_,
      [self = shared_from_this()](const error_code& error, std::size_t) {
        if (self->ended_) return;
        if (!error) {
          self->dispatch();
        } else if (error == http::error::body_limit) {
          self->respond(body_problem(self->body_limit_), false);
        } else if (error == http::error::bad_chunk || error == http::error::bad_chunk_extension) {
          self->respond(parse_problem(error, self->core_.options.limits), false);
        } else {
          self->finish();
        }
      });
}

void HttpConnection::dispatch() {
  request_.body = std::move(parser_->get().body());
  phase_ = Phase::Handler;
  const bool keep_alive = parser_->get().keep_alive();
  if (endpoint() != nullptr) {
    Response response = problem(426, request_.path + " is a WebSocket; connect with an upgrade");
    response.headers.push_back({"Upgrade", "websocket"});
    respond(std::move(response), keep_alive);
    return;
  }
  if (!is_api()) {
    send_file(keep_alive);
    return;
  }
  const Responder responder([weak = weak_from_this(), keep_alive](Response response) {
    const auto self = weak.lock();
    if (self && !self->ended_) self->respond(std::move(response), keep_alive);
  });
  const std::string method_and_path =
      request_.method + ' ' + request_.target;  // undecoded, so that it stays on one line
  const std::string failure = core_.router.dispatch(request_, responder);
  std::string().swap(request_.body);  // the handler has copied what it keeps
  if (!failure.empty()) core_.log(method_and_path + " failed: " + failure);
}

void HttpConnection::send_file(bool keep_alive) {
  if (!core_.options.offload) {
    respond(core_.files.get(request_), keep_alive);
    return;
  }
  core_.options.offload([&core = core_, weak = weak_from_this(), request = request_, keep_alive] {
    Response response = core.files.get(request);
    asio::post(core.context, [weak, keep_alive, response = std::move(response)]() mutable {
      const auto self = weak.lock();
      if (self && !self->ended_) self->respond(std::move(response), keep_alive);
    });
  });
}

void HttpConnection::respond(Response response, bool keep_alive) {
  body_place_ = BodyRoom::Place();
  served_ = Clock::now();
  compress_json(request_, response);
  if (auto cookie = core_.access.renewal(request_, served_)) {
    response.headers.push_back(std::move(*cookie));
  }
  writer_.write(shared_from_this(),
                std::move(response),
                {.keep_alive = keep_alive && !core_.stopping,
                 .http_1_0 = parser_->got_some() && parser_->get().version() < 11,
                 .head_only = request_.method == "HEAD"});
}

}  // namespace

void start_http(Core& core, Socket socket, const Address& peer) {
  std::make_shared<HttpConnection>(core, std::move(socket), peer)->start();
}

}  // namespace server::net

// server/net/server.cpp: the listener, the timers and the life of the io thread.
#include "server/net/server.hpp"

#include <algorithm>
#include <exception>
#include <list>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode

#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/system/error_code.hpp>

#include "server/net/core.hpp"

namespace server::net {
namespace {

using Acceptor = asio::basic_socket_acceptor<asio::ip::tcp, Executor>;
using Timer = asio::basic_waitable_timer<Clock, asio::wait_traits<Clock>, Executor>;

asio::ip::address parse_address(const std::string& text) {
  if (text == "localhost") return asio::ip::address_v4::loopback();
  boost::system::error_code error;
  asio::ip::address address = asio::ip::make_address(text, error);
  if (error) {
    throw ServerError("cannot listen on '" + text +
                      "': give an IP address such as 127.0.0.1 or 0.0.0.0");
  }
  return address;
}

void require_protection(const asio::ip::address& address, const AccessOptions& access) {
  if (address.is_loopback() || !access.token.empty() || access.insecure) return;
  throw ServerError("listening on " + address.to_string() +
                    " reaches beyond this machine: set a token, or say --insecure to let anyone "
                    "in who can reach the port");
}

}  // namespace

struct Server::Impl {
  explicit Impl(ServerOptions options)
      : core(checked(std::move(options))),
        acceptor(core.context.get_executor()),
        sweep_timer(core.context.get_executor()),
        retry_timer(core.context.get_executor()) {}

  struct Periodic {
    Periodic(Impl& owner, std::chrono::milliseconds every, std::function<void()> run)
        : timer(owner.core.context.get_executor()), period(every), fn(std::move(run)) {}
    Timer timer;
    std::chrono::milliseconds period;
    std::function<void()> fn;
  };

  static ServerOptions checked(ServerOptions options) {
    require_protection(parse_address(options.address), options.access);
    return options;
  }

  void listen();
  void accept();
  void welcome(Socket socket);
  void sweep();
  void schedule(Periodic& periodic);
  void guarded(const std::function<void()>& fn);
  void begin_stop();

  Core core;  // first: it holds the io_context everything below refers to
  Acceptor acceptor;
  Timer sweep_timer;
  Timer retry_timer;
  std::list<Periodic> timers{};
};

void Server::Impl::listen() {
  const asio::ip::address address = parse_address(core.options.address);
  const asio::ip::tcp::endpoint endpoint(address, core.options.port);
  const std::string where = address.to_string() + " port " + std::to_string(core.options.port);
  boost::system::error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) return;
  if (error == asio::error::address_in_use) {
    throw ServerError("cannot listen on " + where +
                      ": another program uses that port; stop it or choose another with --port");
  }
  if (error == asio::error::access_denied) {
    throw ServerError("cannot listen on " + where +
                      ": ports below 1024 need privileges; choose another with --port");
  }
  if (error == boost::system::errc::address_not_available) {
    throw ServerError("cannot listen on " + where + ": this machine has no such address");
  }
  throw ServerError("cannot listen on " + where + ": " + error.message());
}

void Server::Impl::accept() {
  acceptor.async_accept([this](boost::system::error_code error, Socket socket) {
    if (core.stopping || error == asio::error::operation_aborted) return;
    if (!error) {
      guarded([&] { welcome(std::move(socket)); });
      accept();
      return;
    }
    // Mostly "too many open files": the next try would fail at once too, so wait a little.
    core.log("cannot accept a connection: " + error.message());
    retry_timer.expires_after(std::chrono::milliseconds(100));
    retry_timer.async_wait([this](boost::system::error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void Server::Impl::welcome(Socket socket) {
  boost::system::error_code ignored;
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.non_blocking(true, ignored);
  if (core.connections.size() < core.options.limits.connections) {
    start_http(core, std::move(socket));
    return;
  }
  Response response = problem(503, "the server has as many connections as it takes");
  response.headers.push_back({"Retry-After", "5"});
  const std::string text = response_head(response, response.body->size(), false) + *response.body;
  socket.write_some(asio::buffer(text),
                    ignored);  // fresh socket: fits, or the client is out of luck
}

void Server::Impl::sweep() {
  const Timeouts& t = core.options.timeouts;
  const auto shortest =
      std::min({t.header, t.body, t.idle, t.ws_silence, t.ws_ping, t.ws_stalled, t.closing});
  sweep_timer.expires_after(
      std::clamp(shortest / 4, std::chrono::milliseconds(10), std::chrono::milliseconds(1000)));
  sweep_timer.async_wait([this](boost::system::error_code cancelled) {
    if (cancelled) return;
    // Over a copy: a connection that ends takes itself out of the map.
    std::vector<std::shared_ptr<Connection>> open;
    open.reserve(core.connections.size());
    for (const auto& [number, connection] : core.connections) open.push_back(connection);
    const Clock::time_point now = Clock::now();
    for (const auto& connection : open) guarded([&] { connection->check(now); });
    sweep();
  });
}

void Server::Impl::schedule(Periodic& periodic) {
  periodic.timer.async_wait([this, &periodic](boost::system::error_code cancelled) {
    if (cancelled) return;
    guarded(periodic.fn);
    const Clock::time_point now = Clock::now();
    Clock::time_point next = periodic.timer.expiry() + periodic.period;
    if (next <= now) next += ((now - next) / periodic.period + 1) * periodic.period;
    periodic.timer.expires_at(next);
    schedule(periodic);
  });
}

void Server::Impl::guarded(const std::function<void()>& fn) {
  try {
    fn();
  } catch (const std::exception& error) {
    core.log(std::string("an io task failed: ") + error.what());
  } catch (...) {
    core.log("an io task failed");
  }
}

void Server::Impl::begin_stop() {
  if (core.stopping) return;
  core.stopping = true;
  boost::system::error_code ignored;
  acceptor.close(ignored);
  retry_timer.cancel();
  std::vector<std::shared_ptr<Connection>> open;
  open.reserve(core.connections.size());
  for (const auto& [number, connection] : core.connections) open.push_back(connection);
  for (const auto& connection : open) guarded([&] { connection->go_away(); });
  if (core.connections.empty()) {
    core.context.stop();
    return;
  }
  // Whoever does not take the goodbye in time is cut off by run().
  sweep_timer.expires_after(std::chrono::milliseconds(300));
  sweep_timer.async_wait([this](boost::system::error_code) { core.context.stop(); });
}

Server::Server(ServerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {
  impl_->listen();
  impl_->core.router.add("POST",
                         std::string(Access::kLoginPath),
                         SyncHandler([core = &impl_->core](const Request& request) {
                           return core->access.login(request);
                         }));
}

Server::~Server() {
  while (!impl_->core.connections.empty()) {
    const auto connection = impl_->core.connections.begin()->second;
    impl_->core.connections.erase(impl_->core.connections.begin());
    connection->abort();
  }
}

Router& Server::router() {
  return impl_->core.router;
}
const Router& Server::router() const {
  return impl_->core.router;
}

void Server::add(WsEndpoint endpoint) {
  impl_->core.endpoints.push_back(std::move(endpoint));
}

std::uint16_t Server::port() const {
  return impl_->acceptor.local_endpoint().port();
}

std::string Server::url() const {
  const asio::ip::address address = impl_->acceptor.local_endpoint().address();
  const std::string host = address.is_v6() ? '[' + address.to_string() + ']' : address.to_string();
  return "http://" + host + ':' + std::to_string(port()) + '/';
}

void Server::run() {
  impl_->accept();
  impl_->sweep();
  while (!impl_->core.context.stopped()) {
    impl_->guarded([this] { impl_->core.context.run(); });
  }
  while (!impl_->core.connections.empty()) {
    const auto connection = impl_->core.connections.begin()->second;
    impl_->core.connections.erase(impl_->core.connections.begin());
    connection->abort();
  }
}

void Server::stop() {
  asio::post(impl_->core.context, [impl = impl_.get()] { impl->begin_stop(); });
}

void Server::post(std::function<void()> fn) {
  asio::post(impl_->core.context,
             [impl = impl_.get(), task = std::move(fn)] { impl->guarded(task); });
}

void Server::every(std::chrono::milliseconds period, std::function<void()> fn) {
  if (period <= std::chrono::milliseconds(0)) {
    throw std::invalid_argument("a timer's period must be above zero");
  }
  Impl::Periodic& periodic = impl_->timers.emplace_back(*impl_, period, std::move(fn));
  periodic.timer.expires_after(period);
  impl_->schedule(periodic);
}

std::size_t Server::connections() const {
  return impl_->core.connections.size();
}

}  // namespace server::net

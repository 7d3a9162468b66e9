// server/serve/net/server.cpp: the listener, the timers and the life of the io thread.
#include "server/serve/net/server.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <list>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode

#include <boost/asio/ip/address.hpp>
#include <boost/asio/posix/basic_stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/system/error_code.hpp>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include "server/run/io_thread.hpp"
#include "server/serve/net/core.hpp"

namespace server::net {
namespace {

using Acceptor = asio::basic_socket_acceptor<asio::ip::tcp, Executor>;
using Timer = asio::basic_waitable_timer<Clock, asio::wait_traits<Clock>, Executor>;

constexpr std::size_t kLoginBytes = 4096;  // of a login's body

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

/// Each connection is an open file. Allows as many as the system permits, less a share for the rest
/// of the program: the database, the devices, the page's files.
std::size_t affordable_connections(std::size_t wanted) {
  constexpr rlim_t kForTheRest = 128;
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return wanted;
  files.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &files);
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return wanted;
  const rlim_t rest = std::min(kForTheRest, files.rlim_cur / 2);
  return static_cast<std::size_t>(std::min<rlim_t>(wanted, files.rlim_cur - rest));
}

}  // namespace

Address address_of(const asio::ip::tcp::endpoint& endpoint) {
  return Address::parse(endpoint.address().to_string()).value_or(Address());
}

Response no_room(Connections::Room why) {
  Response response = why == Connections::Room::AddressFull
                          ? problem(429, "this address has as many connections as one may have")
                          : problem(503, "the server has as many connections as it takes");
  response.headers.push_back({"Retry-After", "5"});
  return response;
}

void write_at_once(Socket& socket, const Response& response) {
  const std::string text = response_head(response, response.body->size(), false) + *response.body;
  boost::system::error_code ignored;
  socket.write_some(asio::buffer(text), ignored);
}

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

  /// An eventfd: written by any thread, read by this one.
  struct Bell {
    Bell(Impl& owner, int file, std::function<void()> run)
        : descriptor(owner.core.context.get_executor(), file), fd(file), fn(std::move(run)) {}
    asio::posix::basic_stream_descriptor<Executor> descriptor;
    int fd;
    std::function<void()> fn;
    std::atomic<bool> rung{false};
  };

  static ServerOptions checked(ServerOptions options) {
    require_protection(parse_address(options.address), options.access);
    options.limits.connections = affordable_connections(options.limits.connections);
    return options;
  }

  void listen();
  void accept();
  void welcome(Socket socket);
  void sweep();
  Response logout(const Request& request);
  void schedule(Periodic& periodic);
  void listen_for(Bell& bell);
  void guarded(const std::function<void()>& fn);
  void begin_stop();

  Core core;  // first: everything below refers to its io_context
  Acceptor acceptor;
  Timer sweep_timer;
  Timer retry_timer;
  Bucket accept_lines{10, 0.1, Clock::now()};  // log lines while accepting fails
  std::list<Periodic> timers{};
  std::list<Bell> bells{};
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
    // Usually "too many open files": the next try would also fail at once, so wait a little.
    if (accept_lines.take(Clock::now())) {
      core.log("cannot accept a connection: " + error.message());
    }
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
  const asio::ip::tcp::endpoint remote = socket.remote_endpoint(ignored);
  if (ignored) return;  // the client has gone already
  const Address peer = address_of(remote);
  const Connections::Room room =
      core.connections.make_room(peer, core.access.is_proxy(peer), Clock::now());
  if (room == Connections::Room::Yes) {
    start_http(core, std::move(socket), peer);
    return;
  }
  write_at_once(socket, no_room(room));  // new socket: the answer fits its buffer, or is lost
}

void Server::Impl::sweep() {
  const Timeouts& t = core.options.timeouts;
  const auto shortest =
      std::min({t.header, t.body, t.idle, t.ws_silence, t.ws_ping, t.ws_stalled, t.closing});
  sweep_timer.expires_after(
      std::clamp(shortest / 4, std::chrono::milliseconds(10), std::chrono::milliseconds(1000)));
  sweep_timer.async_wait([this](boost::system::error_code cancelled) {
    if (cancelled) return;
    const Clock::time_point now = Clock::now();
    for (const auto& connection : core.connections.all()) {
      guarded([&] { connection->check(now); });
      if (!connection->login().empty()) core.access.keep_login(connection->login(), now);
    }
    core.access.sweep(now);
    if (const std::string line = core.connections.report(now); !line.empty()) core.log(line);
    sweep();
  });
}

/// Ends the login and all connections opened with it.
Response Server::Impl::logout(const Request& request) {
  const std::string login = core.access.login_of(request, Clock::now());
  for (const auto& connection : core.connections.all()) {
    if (!login.empty() && connection->login() == login) connection->logged_out();
  }
  return core.access.logout(request);
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

void Server::Impl::listen_for(Bell& bell) {
  bell.descriptor.async_wait(
      asio::posix::descriptor_base::wait_read, [this, &bell](boost::system::error_code cancelled) {
        if (cancelled) return;
        std::uint64_t count = 0;
        [[maybe_unused]] const auto bytes = ::read(bell.fd, &count, sizeof(count));
        bell.rung.store(false);
        guarded(bell.fn);
        listen_for(bell);
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
  for (const auto& connection : core.connections.all()) {
    guarded([&] { connection->go_away(); });
  }
  if (core.connections.empty()) {
    core.context.stop();
    return;
  }
  // run() cuts off a client that does not take the goodbye in time.
  sweep_timer.expires_after(std::chrono::milliseconds(300));
  sweep_timer.async_wait([this](boost::system::error_code) { core.context.stop(); });
}

Server::Server(ServerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {
  impl_->listen();
  impl_->core.router.add("POST",
                         std::string(Access::kLoginPath),
                         SyncHandler([core = &impl_->core](const Request& request) {
                           return core->access.login(request, Clock::now());
                         }),
                         kLoginBytes);
  impl_->core.router.add(
      "POST",
      std::string(Access::kLogoutPath),
      SyncHandler([impl = impl_.get()](const Request& request) { return impl->logout(request); }),
      kLoginBytes);
  impl_->core.router.need("POST", Access::kLoginPath, Role::Nobody);
  impl_->core.router.need("POST", Access::kLogoutPath, Role::Nobody);
}

Server::~Server() {
  impl_->core.connections.abort_all();
}

Router& Server::router() {
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
  const IoThreadMark mark;
  impl_->accept();
  impl_->sweep();
  while (!impl_->core.context.stopped()) {
    impl_->guarded([this] { impl_->core.context.run(); });
  }
  impl_->core.connections.abort_all();
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

void Server::after(std::chrono::milliseconds delay, std::function<void()> fn) {
  const auto timer = std::make_shared<Timer>(impl_->core.context.get_executor());
  timer->expires_after(delay);
  timer->async_wait(
      [impl = impl_.get(), timer, task = std::move(fn)](boost::system::error_code cancelled) {
        if (!cancelled) impl->guarded(task);
      });
}

std::function<void()> Server::bell(std::function<void()> fn) {
  const int file = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (file < 0) throw ServerError("the system has no more files to open");
  Impl::Bell& bell = impl_->bells.emplace_back(*impl_, file, std::move(fn));
  impl_->listen_for(bell);
  return [&bell] {
    if (bell.rung.exchange(true)) return;
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto bytes = ::write(bell.fd, &one, sizeof(one));
  };
}

std::size_t Server::connections() const {
  return impl_->core.connections.size();
}

std::size_t Server::most_connections() const {
  return impl_->core.options.limits.connections;
}

const Access& Server::access() const {
  return impl_->core.access;
}

}  // namespace server::net

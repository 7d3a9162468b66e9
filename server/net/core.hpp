// server/net/core.hpp: what the connections of one server share. Internal to server/net: the only
// header here that shows Asio.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "server/net/access.hpp"
#include "server/net/router.hpp"
#include "server/net/server.hpp"
#include "server/net/static_files.hpp"
#include "server/net/websocket.hpp"

namespace server::net {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;
// The concrete executor spares every operation a type-erased one.
using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<asio::ip::tcp, Executor>;

/// One open connection. The core owns it until remove(); pending operations share it.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Called about once a second: closes the connection when its time is up.
  virtual void check(Clock::time_point now) = 0;
  /// The server stops: say goodbye if the protocol has a way to, then close.
  virtual void go_away() = 0;
  /// Ends the connection now; runs no operation afterwards and does not touch the core again.
  virtual void abort() noexcept = 0;
};

struct Core {
  explicit Core(ServerOptions server_options)
      : options(std::move(server_options)), access(options.access), files(options.web_root) {}

  const ServerOptions options;
  Access access;
  StaticFiles files;
  Router router{};
  std::vector<WsEndpoint> endpoints{};
  std::map<std::uint64_t, std::shared_ptr<Connection>> connections{};  // by number, oldest first
  std::uint64_t next_connection = 1;
  std::uint32_t next_client = 1;
  bool stopping = false;
  asio::io_context context{1};

  std::uint64_t add(std::shared_ptr<Connection> connection) {
    connections.emplace(next_connection, std::move(connection));
    return next_connection++;
  }
  /// Forgets a connection that has ended. The last one of a stopping server ends run().
  void remove(std::uint64_t number) {
    connections.erase(number);
    if (stopping && connections.empty()) context.stop();
  }
  void log(std::string_view line) const {
    if (options.log) options.log(line);
  }
};

/// Serves HTTP on an accepted socket; hands over to start_websocket on an upgrade.
void start_http(Core& core, Socket socket);

}  // namespace server::net

// server/serve/net/core.hpp: state that all connections of a server share. Internal to server/net:
// the only header here that exposes Asio.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "server/serve/net/access.hpp"
#include "server/serve/net/body_room.hpp"
#include "server/serve/net/connections.hpp"
#include "server/serve/net/router.hpp"
#include "server/serve/net/server.hpp"
#include "server/serve/net/static_files.hpp"
#include "server/serve/net/websocket.hpp"

namespace server::net {

namespace asio = boost::asio;
// The concrete executor avoids a type-erased one in every operation.
using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<asio::ip::tcp, Executor>;

struct Core {
  explicit Core(ServerOptions server_options)
      : options(std::move(server_options)),
        access(options.access, options.log),
        files(options.web_root),
        connections({options.limits.connections,
                     options.limits.connections_per_address,
                     options.limits.connections_kept}) {}

  const ServerOptions options;
  Access access;
  StaticFiles files;
  Router router{};
  std::vector<WsEndpoint> endpoints{};
  Connections connections;
  BodyRoom bodies{};
  std::uint32_t next_client = 1;
  bool stopping = false;
  asio::io_context context{1};

  /// Removes a connection that has ended. The last one of a stopping server ends run().
  void remove(Connections::Number number) {
    connections.remove(number);
    if (stopping && connections.empty()) context.stop();
  }
  void log(std::string_view line) const {
    if (options.log) options.log(line);
  }
};

/// The address of one end of a connection.
Address address_of(const asio::ip::tcp::endpoint& endpoint);

/// The answer for a connection or a request without room.
Response no_room(Connections::Room why);

/// Tries once to write, without waiting, where the ordinary way is not possible.
void write_at_once(Socket& socket, const Response& response);
/// Serves HTTP on an accepted socket; hands over to start_websocket on an upgrade.
void start_http(Core& core, Socket socket, const Address& peer);

}  // namespace server::net

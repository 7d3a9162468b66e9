// server/net/ws_connection.hpp: the seam between the two Beast translation units.
#pragma once

#include <utility>  // Boost 1.74 in C++20 mode does not compile without it first

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "server/net/server.hpp"

namespace server::net {

/// What connections share with their server.
struct Shared {
  ServerOptions options{};
  const Router* router = nullptr;
  WsHandlers handlers{};
  std::size_t connections = 0;
  std::uint64_t next_client = 1;
  bool stopping = false;
};

/// Counts a connection for as long as it lives.
class ConnectionCount {
 public:
  explicit ConnectionCount(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {
    ++shared_->connections;
  }
  ~ConnectionCount() { --shared_->connections; }
  ConnectionCount(const ConnectionCount&) = delete;
  ConnectionCount& operator=(const ConnectionCount&) = delete;

 private:
  std::shared_ptr<Shared> shared_;
};

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// The subprotocol to answer with, empty when none of ours is offered.
std::string choose_subprotocol(const UpgradeRequest& request);

/// Takes the socket over and speaks WebSocket on it until either side ends it.
void accept_websocket(std::shared_ptr<Shared> shared,
                      boost::asio::ip::tcp::socket socket,
                      UpgradeRequest request,
                      std::string subprotocol,
                      bool loopback);

}  // namespace server::net

// server/serve/net/upgrade.hpp: the hand-over from HTTP to WebSocket. Internal to server/net,
// included by the two translation units that know Beast.
#pragma once

#include <map>
#include <string>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/serve/net/core.hpp"

namespace server::net {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// The connecting client, from a request that has passed every check.
struct WsVisitor {
  std::string subprotocol{};
  Visitor who{};
  std::map<std::string, std::string> query{};
  std::string login{};
};

/// Answers the upgrade and then serves the WebSocket.
void start_websocket(Core& core,
                     Socket socket,
                     const UpgradeRequest& request,
                     const WsEndpoint& endpoint,
                     WsVisitor visitor);

}  // namespace server::net

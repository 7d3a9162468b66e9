// server/serve/api/event_stream.hpp: server-sent events about something that changes.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/serve/net/http.hpp"
#include "server/serve/workers.hpp"

namespace server {

struct ApiContext;

/// `data` is one line.
struct Event {
  std::string name{};
  std::string data{};
  bool operator==(const Event&) const = default;
};

/// A text/event-stream answer. `look` runs on a worker about four times a second; its event is sent
/// if it differs from the last one. The stream ends when `look` returns nothing.
net::Response event_stream(ApiContext& context, std::function<std::optional<Event>(Worker&)> look);

}  // namespace server

// server/foxglove/protocol.hpp: the Foxglove WebSocket protocol v1 as values; no sockets here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace server::foxglove {

/// A message that breaks the protocol; what() is a sentence for the client's status line.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Client to server, text.
struct Subscribe {
  struct One {
    std::uint32_t id = 0;
    std::uint32_t channel = 0;
  };
  std::vector<One> subscriptions{};
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids{};
};
struct Advertise {
  struct Channel {
    std::uint32_t id = 0;
    std::string topic{};
    std::string encoding{};
  };
  std::vector<Channel> channels{};
};
struct Unadvertise {
  std::vector<std::uint32_t> ids{};
};
struct GetParameters {
  std::vector<std::string> names{};  // empty: all
  std::optional<std::string> id{};
};
struct SetParameters {
  struct One {
    std::string name{};
    nlohmann::json value{};  // null: unset
  };
  std::vector<One> parameters{};
  std::optional<std::string> id{};
};
struct SubscribeParameters {
  std::vector<std::string> names{};  // empty: all
};
struct UnsubscribeParameters {
  std::vector<std::string> names{};
};
using ClientText = std::variant<Subscribe,
                                Unsubscribe,
                                Advertise,
                                Unadvertise,
                                GetParameters,
                                SetParameters,
                                SubscribeParameters,
                                UnsubscribeParameters>;
/// Throws ProtocolError on anything else.
ClientText parse_text(std::string_view text);

// Client to server, binary.
struct ClientMessage {
  std::uint32_t channel = 0;
  std::string_view payload{};
};
struct ServiceRequest {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
  std::string_view encoding{};
  std::string_view payload{};
};
using ClientBinary = std::variant<ClientMessage, ServiceRequest>;
/// Views into `bytes`. Throws ProtocolError; every length is checked against the frame's.
ClientBinary parse_binary(std::string_view bytes);

// Server to client.
struct Channel {
  std::uint32_t id = 0;
  std::string topic{};
  std::string encoding{};
  std::string schema_name{};
  std::string schema{};
  std::string schema_encoding{};
};
struct Service {
  std::uint32_t id = 0;
  std::string name{};
  std::string type{};
};
enum class StatusLevel { Info = 0, Warning = 1, Error = 2 };

std::string server_info(const std::string& session_id);
std::string advertise(const std::vector<Channel>& channels);
std::string advertise_services(const std::vector<Service>& services);
std::string status(StatusLevel level, const std::string& message);
/// `parameters`: [{"name", "value", "type"?}].
std::string parameter_values(const nlohmann::json& parameters, const std::optional<std::string>& id);
std::string service_failure(std::uint32_t service, std::uint32_t call, const std::string& message);

/// Opcode 0x01, subscription id, log time; the payload follows.
std::array<std::byte, 13> message_header(std::uint32_t subscription, std::uint64_t time_ns);
std::string time_message(std::uint64_t time_ns);
std::string service_response(std::uint32_t service, std::uint32_t call, std::string_view json);

}  // namespace server::foxglove

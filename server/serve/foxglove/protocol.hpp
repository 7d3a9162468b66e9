// server/serve/foxglove/protocol.hpp: Foxglove WebSocket protocol v1, converts bytes to values and
// back; no I/O.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

namespace server::foxglove {

/// Subprotocol names, the preferred first. The frames are the same under both.
inline constexpr std::string_view kLegacySubprotocol = "foxglove.websocket.v1";
inline constexpr std::string_view kSdkSubprotocol = "foxglove.sdk.v1";

/// A client's message is invalid; what() is a sentence for its status message.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Channel {
  std::uint32_t id = 0;
  std::string topic{};
  std::string encoding{};         // "json", "flatbuffer"
  std::string schema_name{};      // "foxglove.LaserScan"
  std::string schema{};           // JSON Schema text, or base64 of a .bfbs
  std::string schema_encoding{};  // "jsonschema", "flatbuffer"
};

struct Service {
  std::uint32_t id = 0;
  std::string name{};
  std::string type{};
  std::string request_schema{};   // JSON Schema text
  std::string response_schema{};  // JSON Schema text
};

struct Parameter {
  std::string name{};
  nlohmann::json value{};  // null: not set
  std::string type{};      // "float64", "float64_array", "byte_array" or empty
};

// Client text operations.
struct Subscription {
  std::uint32_t id = 0;  // chosen by the client
  std::uint32_t channel_id = 0;
};
struct Subscribe {
  std::vector<Subscription> subscriptions{};
};
struct Unsubscribe {
  std::vector<std::uint32_t> subscription_ids{};
};
struct ClientChannel {
  std::uint32_t id = 0;  // chosen by the client
  std::string topic{};
  std::string encoding{};
  std::string schema_name{};
};
struct ClientAdvertise {
  std::vector<ClientChannel> channels{};
};
struct ClientUnadvertise {
  std::vector<std::uint32_t> channel_ids{};
};
struct GetParameters {
  std::vector<std::string> names{};  // empty: all
  std::optional<std::string> id{};
};
struct SetParameters {
  std::vector<Parameter> parameters{};
  std::optional<std::string> id{};
};
struct SubscribeParameterUpdates {
  std::vector<std::string> names{};  // empty: all
};
struct UnsubscribeParameterUpdates {
  std::vector<std::string> names{};  // empty: all
};
using ClientText = std::variant<Subscribe,
                                Unsubscribe,
                                ClientAdvertise,
                                ClientUnadvertise,
                                GetParameters,
                                SetParameters,
                                SubscribeParameterUpdates,
                                UnsubscribeParameterUpdates>;

// Client binary messages; the views point into the parsed bytes.
struct ClientMessage {
  std::uint32_t channel_id = 0;
  std::string_view payload{};
};
struct ServiceRequest {
  std::uint32_t service_id = 0;
  std::uint32_t call_id = 0;
  std::string_view encoding{};
  std::string_view payload{};
};
using ClientBinary = std::variant<ClientMessage, ServiceRequest>;

/// Throws ProtocolError on bad JSON, an unknown op, or a missing or wrong field.
ClientText parse_text(std::string_view text);
/// Throws ProtocolError on an unknown opcode or a length that does not fit the frame.
ClientBinary parse_binary(std::string_view bytes);

enum class StatusLevel : int { Info = 0, Warning = 1, Error = 2 };

// Server text operations.
std::string server_info(const std::string& session_id);
std::string advertise(std::span<const Channel> channels);
std::string status(StatusLevel level, std::string_view message);
std::string parameter_values(std::span<const Parameter> parameters,
                             const std::optional<std::string>& id = std::nullopt);
/// Gives request and response schemas in the newer and the older form, for new and old viewers.
std::string advertise_services(std::span<const Service> services);
std::string service_call_failure(std::uint32_t service_id,
                                 std::uint32_t call_id,
                                 std::string_view message);

// Server binary messages.
using MessageHeader = std::array<std::byte, 13>;  // 0x01, u32 subscription, u64 log time [ns]
using TimeMessage = std::array<std::byte, 9>;     // 0x02, u64 time [ns]
MessageHeader message_header(std::uint32_t subscription_id, std::uint64_t t_ns);
TimeMessage time_message(std::uint64_t t_ns);
std::string service_response(std::uint32_t service_id,
                             std::uint32_t call_id,
                             std::string_view encoding,
                             std::string_view payload);

}  // namespace server::foxglove
